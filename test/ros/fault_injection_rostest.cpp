// SPDX-License-Identifier: BSD-3-Clause
// Faults between camera and tracker: the tracker outlives each, says what is wrong, and its pose is good within a
// second of good images. Beside it, in the same manager, a tracker that has no object.
#include <gtest/gtest.h>

#include "faulty_camera.h"
#include "node_process.h"
#include "rostest_main.h"

#include <csignal>
#include <cstdio>

namespace depth_object_tracker {
namespace {

const char* const kTracker = "/tracker";
constexpr int kSecond = 30;  // frames

class Faults : public testing::Test {
 protected:
  static void SetUpTestSuite() { camera_ = new FaultyCamera(kTracker); }
  static void TearDownTestSuite() {
    delete camera_;
    camera_ = nullptr;
  }
  void SetUp() override {
    ASSERT_TRUE(camera().waitUntilConnected());
    camera().setFault("none");
    ASSERT_TRUE(camera().waitUntilThrough());
    ASSERT_TRUE(camera().initialise());
    ASSERT_GT(camera().framesUntilGood(2 * kSecond), 0);
    camera().takeWasLost();
    first_status_ = camera().numStatuses();
    first_log_ = camera().numLogs();
  }

  static FaultyCamera& camera() { return *camera_; }

  static void send(int num_frames) {
    for (int i = 0; i < num_frames; ++i) {
      camera().sendFrame();
      ros::WallDuration(0.02).sleep();  // most of them are seen
    }
  }

  /// Waits until the tracker has said so, in a status, a log line or /diagnostics.
  void expectSaid(const std::string& text) {
    EXPECT_TRUE(waitUntil([&] { return camera().hasSaid(text, first_status_, first_log_); }, 20.0 * kSlowness))
        << text << " was not said";
  }

  /// Good images again: a second of them is enough, or it says LOST and comes back by itself.
  static void expectGoodAgain(const std::string& fault) {
    camera().setFault("none");
    int frames = camera().framesUntilGood(kSecond);
    const bool was_lost = camera().takeWasLost();
    if (frames < 0 && was_lost) frames = camera().framesUntilGood(10 * kSecond);
    EXPECT_GT(frames, 0) << fault << ": no good pose";
    std::printf("fault %-15s good again after %d frames, error %.2f mm%s\n", fault.c_str(), frames,
                1000.0 * camera().errorM(), was_lost ? ", was LOST" : "");
    EXPECT_TRUE(std::isfinite(camera().errorM()));
  }

  static FaultyCamera* camera_;
  std::size_t first_status_ = 0, first_log_ = 0;
};
FaultyCamera* Faults::camera_ = nullptr;

TEST_F(Faults, DroppedImages) {
  camera().setFault("drop");
  send(45);
  expectGoodAgain("drop");
}

TEST_F(Faults, DelayedImages) {
  camera().setFault("delay");
  send(90);
  expectSaid("s behind the clock");
  expectGoodAgain("delay");
}

TEST_F(Faults, DuplicatedImages) {
  camera().setFault("duplicate");
  for (int i = 0; i < 10; ++i) camera().sendGoodFrame();
  expectSaid("repeats the one before");
  expectGoodAgain("duplicate");
}

TEST_F(Faults, ReorderedImages) {
  camera().setFault("reorder");
  for (int i = 0; i < 10; ++i) {
    send(2);
    ros::WallDuration(0.2).sleep();
  }
  expectSaid("jumped back in time");
  expectGoodAgain("reorder");
}

TEST_F(Faults, TruncatedImages) {
  camera().setFault("truncate");
  send(20);
  expectSaid("but its header promises");
  expectGoodAgain("truncate");
}

TEST_F(Faults, CorruptedImages) {
  camera().setFault("corrupt");
  for (int i = 0; i < 20; ++i) camera().sendGoodFrame();
  expectGoodAgain("corrupt");
}

TEST_F(Faults, ResolutionThatChanges) {
  camera().setFault("resolution");
  for (int i = 0; i < 20; ++i) camera().sendGoodFrame();
  expectGoodAgain("resolution");
}

TEST_F(Faults, EncodingThatChanges) {
  camera().setFault("encoding");
  for (int i = 0; i < 20; ++i) camera().sendGoodFrame();
  expectSaid("the image's encoding is 'bgr8'");
  expectGoodAgain("encoding");
}

TEST_F(Faults, IntrinsicsThatAreNotNumbers) {
  camera().setFault("nan_intrinsics");
  send(20);
  expectSaid("camera_info's K is not usable");
  expectGoodAgain("nan_intrinsics");
}

TEST_F(Faults, ThirtySecondsWithoutImages) {
  camera().setFault("stop");
  camera().sendFrame();
  ros::WallDuration(30.0).sleep();
  camera().skip(30.0);
  expectSaid("no image on '/faulty/depth/image_raw'");
  expectGoodAgain("stop_30_s");
}

TEST_F(Faults, TimeThatJumpsForward) {
  ros::WallDuration(6.0).sleep();  // the log keeps silent about the same thing for a while
  camera().setFault("time_forward");
  camera().sendGoodFrame();
  expectSaid("s after the one before");
  expectGoodAgain("time_forward");
}

TEST_F(Faults, TimeThatJumpsBack) {
  camera().setFault("time_back");
  camera().sendGoodFrame();
  expectSaid("jumped back in time");
  expectGoodAgain("time_back");
}

TEST_F(Faults, CameraThatRestarts) {
  const int process = processOf("/fault_injector");
  ASSERT_GT(process, 0);
  ASSERT_EQ(kill(process, SIGKILL), 0);
  ASSERT_TRUE(waitUntil([&] {
    const int now = processOf("/fault_injector");
    return now > 0 && now != process;
  }));
  camera().forgetInjector();
  ASSERT_TRUE(camera().waitUntilConnected());
  ASSERT_TRUE(camera().waitUntilThrough());
  expectGoodAgain("camera_restart");
}

TEST_F(Faults, ManagerThatIsKilledComesBackWithItsTrackers) {
  const int manager = processOf("/manager"), loader = processOf("/tracker");
  ASSERT_GT(manager, 0);
  std::printf("manager %d, loader %d\n", manager, loader);
  ASSERT_EQ(kill(manager, SIGKILL), 0);
  ASSERT_TRUE(waitUntil([&] {
    const int now = processOf("/manager");
    return now > 0 && now != manager;
  }));
  // A new tracker, with the same parameters and no pose yet.
  ASSERT_TRUE(waitUntil(
      [&] {
        camera().sendFrame();
        const auto status = camera().status();
        return status && status->state == TrackerStatus::UNINITIALIZED && status->frames_received > 0;
      },
      120.0));
  ASSERT_TRUE(camera().waitUntilConnected());
  ASSERT_TRUE(camera().waitUntilThrough());
  ASSERT_TRUE(camera().initialise());
  expectGoodAgain("manager_killed");
}

TEST_F(Faults, ATrackerWithoutAnObjectHoldsNobodyUp) {
  Recorder<TrackerStatus> broken(ros::NodeHandle(), "/broken/status");
  ASSERT_TRUE(waitUntil([&] { return broken.size() > 0; }));
  EXPECT_NE(broken.newest()->reason.find("/no/such/mesh.obj"), std::string::npos) << broken.newest()->reason;
  const std::uint64_t seen = broken.newest()->frames_received;
  EXPECT_GT(camera().framesUntilGood(kSecond), 0);
  for (int i = 0; i < 10; ++i) {
    EXPECT_EQ(static_cast<int>(camera().sendGoodFrame().state), static_cast<int>(TrackerStatus::TRACKING));
  }
  EXPECT_TRUE(waitUntil([&] { return broken.newest()->frames_received > seen; })) << "it has the images too";
}

}  // namespace
}  // namespace depth_object_tracker

int main(int argc, char** argv) {
  return runRosTests(argc, argv, "fault_injection_rostest");
}
