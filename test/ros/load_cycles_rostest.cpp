// SPDX-License-Identifier: BSD-3-Clause
// Objects that come and go: a process that loads and unloads trackers, and a tracker that is given other objects, does
// not grow.
#include <gtest/gtest.h>

#include "rostest_main.h"
#include "tracker_harness.h"

#include <depth_object_tracker/LoadObject.h>

#include <malloc.h>
#include <netinet/in.h>
#include <ros/connection_manager.h>
#include <ros/xmlrpc_manager.h>
#include <sys/socket.h>

#include <cstdio>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <string>

namespace depth_object_tracker {
namespace {

constexpr int kWarmUp = 3;
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
// A cycle takes twenty times as long. Leaks are the sanitizer's then, and one thread or file too many shows after a
// few.
constexpr int kNodeletCycles = 8, kObjectCycles = 6;
#else
constexpr int kNodeletCycles = 50, kObjectCycles = 20;
#endif

struct Resources {
  long in_use_kb = 0, resident_kb = 0, threads = 0, files = 0;
};

/// Port of a socket's own or other end; 0 for what is none.
template <typename GetName>
int portOf(int file, GetName getName) {
  sockaddr_in address = {};
  socklen_t size = sizeof address;
  const bool is_known = getName(file, reinterpret_cast<sockaddr*>(&address), &size) == 0;
  return is_known && address.sin_family == AF_INET ? ntohs(address.sin_port) : 0;
}

/// roscpp keeps its connections to the master for the next call, as many as there ever were calls side by side; and
/// others, the log's collector among them, connect as often as they please.
bool isRosGraph(int file) {
  const int here = portOf(file, getsockname), there = portOf(file, getpeername);
  return there != 0 && (there == static_cast<int>(ros::master::getPort()) ||
                        here == static_cast<int>(ros::ConnectionManager::instance()->getTCPPort()) ||
                        here == static_cast<int>(ros::XMLRPCManager::instance()->getServerPort()));
}

Resources measure() {
  malloc_trim(0);
  Resources now;
  const struct mallinfo2 memory = mallinfo2();  // of all arenas
  now.in_use_kb = static_cast<long>((memory.uordblks + memory.hblkhd) / 1024);
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);) {
    if (line.rfind("VmRSS:", 0) == 0) now.resident_kb = std::stol(line.substr(6));
    if (line.rfind("Threads:", 0) == 0) now.threads = std::stol(line.substr(8));
  }
  for (const auto& file : std::filesystem::directory_iterator("/proc/self/fd"))
    if (!isRosGraph(std::stoi(file.path().filename()))) ++now.files;
  return now;
}

/// Threads and sockets end a moment after their owners.
bool isBackAt(const Resources& before) {
  return waitUntil(
      [&] {
        const Resources now = measure();
        return now.threads <= before.threads && now.files <= before.files;
      },
      20.0);
}

void expectNoGrowth(const Resources& before, const char* what, int num_cycles) {
  EXPECT_TRUE(isBackAt(before));
  const Resources after = measure();
  std::printf(
      "%s, %d times: in use %+ld kB (of %ld), resident memory %+ld kB (of %ld), threads %+ld, open files %+ld\n", what,
      num_cycles, after.in_use_kb - before.in_use_kb, before.in_use_kb, after.resident_kb - before.resident_kb,
      before.resident_kb, after.threads - before.threads, after.files - before.files);
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)  // sanitizers keep what is freed, on purpose
  // The harness keeps every message: some 5 kB a cycle. The smallest thing that a tracker could leave behind, a mesh,
  // is ten times that.
  EXPECT_LT(after.in_use_kb - before.in_use_kb, 20 * num_cycles);
  // A tracker takes some tens of megabytes. By how the threads happen to share the heap's arenas, the same bytes in use
  // take up to four more or less.
  EXPECT_LT(after.resident_kb - before.resident_kb, 12000);
#endif
}

TEST(LoadCycles, NodeletsThatComeAndGoLeaveNothing) {
  setGoodParameters("/load_cycles");
  const auto cycle = [] {
    TrackerHarness tracker("/load_cycles");
    ASSERT_TRUE(tracker.isReady());
    ASSERT_TRUE(tracker.initialise());
    for (int i = 0; i < 5; ++i) tracker.step();
  };
  for (int i = 0; i < kWarmUp; ++i) cycle();
  ros::WallDuration(1.0).sleep();
  const Resources before = measure();
  for (int i = 0; i < kNodeletCycles; ++i) cycle();
  expectNoGrowth(before, "nodelet loaded, used and unloaded", kNodeletCycles);
}

TEST(LoadCycles, ObjectsThatAreExchangedLeaveNothing) {
  setGoodParameters("/load_cycles");
  TrackerHarness tracker("/load_cycles");
  ASSERT_TRUE(tracker.isReady());
  int number = 0;
  const auto cycle = [&] {
    LoadObject call;
    call.request.mesh =
        std::string(PROJECT_SOURCE_FOLDER) + (++number % 2 == 0 ? "/meshes/bracket.obj" : "/meshes/mug.obj");
    ASSERT_TRUE(ros::service::call("/load_cycles/load_object", call) && call.response.success) << call.response.message;
    ASSERT_TRUE(tracker.initialise());
    for (int i = 0; i < 3; ++i) tracker.step();
  };
  for (int i = 0; i < 2 * kWarmUp; ++i) cycle();
  const Resources before = measure();
  for (int i = 0; i < kObjectCycles; ++i) cycle();
  expectNoGrowth(before, "~load_object", kObjectCycles);
}

TEST(LoadCycles, ATrackerWithoutImagesUsesHardlyAnyProcessorTime) {
  setGoodParameters("/load_cycles");
  TrackerHarness tracker("/load_cycles");
  ASSERT_TRUE(tracker.isReady());
  const auto used_s = [] { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; };
  const double before_s = used_s();
  ros::WallDuration(3.0).sleep();
  EXPECT_LT(used_s() - before_s, 0.6) << "seconds of processor time in three seconds, of all threads";
}

TEST(LoadCycles, RelativePathsAreMeantFromTheGivenFolder) {
  ros::param::set("/load_cycles_from/paths_from", std::string(PROJECT_SOURCE_FOLDER) + "/meshes");
  ros::param::set("/load_cycles_from/mesh", "bracket.obj");
  TrackerHarness tracker("/load_cycles_from");
  ASSERT_TRUE(tracker.isReady());
  EXPECT_TRUE(tracker.initialise());
  EXPECT_EQ(tracker.status()->object_name, "bracket");
}

}  // namespace
}  // namespace depth_object_tracker

int main(int argc, char** argv) {
  return runRosTests(argc, argv, "load_cycles_rostest");
}
