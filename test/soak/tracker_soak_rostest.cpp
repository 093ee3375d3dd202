// SPDX-License-Identifier: BSD-3-Clause
// Many frames through the nodelet, with all that happens in a day: nothing leaks, nothing hangs.
#include "../ros/rostest_main.h"
#include "resource_use.h"
#include "soak_client.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdio>

namespace depth_object_tracker {
namespace {

const char* const kName = "/tracker";

/// What happens besides images, by chance. @param rarity this many times more seldom: searches take most of the time.
class SoakEvents {
 public:
  SoakEvents(SoakClient& client, SoakScene& scene, int rarity)
      : client_(client), scene_(scene), rarity_(static_cast<unsigned>(std::max(1, rarity))), random_(11) {}

  /// @param lost the tracker searches. @return false when a service did not answer.
  bool happen(bool lost) {
    if (oneIn(200)) note(5), scene_.hideFor(count(5, 60), 1.0);
    if (oneIn(300)) note(5), scene_.hideFor(count(20, 100), 0.3 + 0.01 * count(0, 40));
    if (oneIn(900)) note(6), scene_.vanishFor(count(30, 90));
    if (oneIn(300)) note(7), client_.setGrasp(grasped_ = !grasped_);
    if (oneIn(1500)) note(8), client_.jumpBack(5.0);
    bool answered = true;
    // Somebody who watches helps.
    lost_frames_ = lost ? lost_frames_ + 1 : 0;
    if (lost_frames_ > kLostPatience && !scene_.isHidden()) {
      lost_frames_ = 0;
      answered = note(0, client_.initialiseAt(scene_.truth()));
    }
    if (oneIn(150)) answered = note(0, client_.initialiseAt(scene_.truth())) && answered;
    if (oneIn(2000)) answered = note(1, client_.initialiseAnywhere()) && answered;
    if (oneIn(700)) answered = note(2, load()) && answered;
    if (oneIn(1500)) answered = note(3, client_.reset() && client_.initialiseAt(scene_.truth())) && answered;
    if (oneIn(1500)) answered = note(4, client_.setPaused(true) && client_.setPaused(false)) && answered;
    return answered;
  }

  void print() const {
    std::printf("initialised %d, searched %d, loaded %d, reset %d, paused %d times\n", counts_[0], counts_[1],
                counts_[2], counts_[3], counts_[4]);
    std::printf("hidden %d, taken away %d, grasped or let go %d, time set back %d times\n", counts_[5], counts_[6],
                counts_[7], counts_[8]);
  }

 private:
  static constexpr int kLostPatience = 30;  // images

  bool oneIn(unsigned frames) { return random_() % (rarity_ * frames) == 0; }
  int count(int low, int high) { return low + static_cast<int>(random_() % static_cast<unsigned>(high - low + 1)); }
  bool note(std::size_t kind, bool answered = true) {
    ++counts_[kind];
    return answered;
  }
  bool load() {
    const std::size_t object = random_() % scene_.numObjects();
    scene_.showObject(object);
    return client_.loadObject(SoakScene::meshUri(object)) && client_.initialiseAt(scene_.truth());
  }

  SoakClient& client_;
  SoakScene& scene_;
  unsigned rarity_;
  std::mt19937_64 random_;
  bool grasped_ = false;
  int lost_frames_ = 0;
  std::array<int, 9> counts_{};
};

float share(const std::vector<float>& sorted, double part) {
  return sorted[std::min(sorted.size() - 1, static_cast<std::size_t>(part * static_cast<double>(sorted.size())))];
}

void printLatency(std::vector<float> latencies) {
  std::sort(latencies.begin(), latencies.end());
  std::printf("latency [ms]: median %.2f, 99 %% %.2f, 99.9 %% %.2f, most %.2f\n", 1e3 * share(latencies, 0.5),
              1e3 * share(latencies, 0.99), 1e3 * share(latencies, 0.999), 1e3 * latencies.back());
}

TEST(TrackerSoak, NothingLeaksAndNothingHangs) {
  const int frames = ros::param::param("~frames", 1000);
  ros::param::set(std::string(kName) + "/mesh", SoakScene::meshUri(0));
  ros::param::set(std::string(kName) + "/tracker/num_particles", 16);
  ros::param::set(std::string(kName) + "/tracker/target_model_pixels", 150);
  SoakScene scene(7);
  SoakClient client(kName);
  SoakEvents events(client, scene, ros::param::param("~rarity", 1));
  std::vector<float> latencies(static_cast<std::size_t>(frames), 0.0f);  // touched now: it does not grow later
  std::array<int, 5> states{};
  std::array<double, 5> state_s{};
  bool lost = false;
  ResourceUse early, end;
  const int sample = std::clamp(frames / 8, 1, 100);
  std::array<std::size_t, 2> most_kib{};  // resident, in the third quarter and in the last: it varies with the object
  const ros::WallTime begin = ros::WallTime::now();
  ASSERT_TRUE(client.initialiseAt(scene.truth()));
  for (int k = 0; k < frames; ++k) {
    ASSERT_TRUE(events.happen(lost)) << "a service did not answer at frame " << k;
    TrackerStatus status;
    ASSERT_TRUE(client.send(scene.next(), scene.twist(), status)) << "no status for frame " << k << ": a deadlock?";
    latencies[static_cast<std::size_t>(k)] = status.latency_s;
    const std::size_t state = std::min<std::size_t>(4, status.state);
    ++states[state];
    state_s[state] += static_cast<double>(status.latency_s);
    lost = state == TrackerStatus::LOST;
    if (k == frames / 5) early = readResourceUse();
    if (k >= frames / 2 && k % sample == 0) {
      std::size_t& most = most_kib[k >= frames / 4 * 3 ? 1 : 0];
      most = std::max(most, readResourceUse().resident_kib);
    }
    if (frames >= 20 && k % (frames / 20) == 0) {
      end = readResourceUse();
      std::printf("frame %d: %zu KiB resident, %zu KiB of heap, %zu handles, %zu threads, %.1f s\n", k,
                  end.resident_kib, end.heap_kib, end.handles, end.threads, (ros::WallTime::now() - begin).toSec());
      std::fflush(stdout);
    }
  }
  end = readResourceUse();
  const double growth = static_cast<double>(most_kib[1]) / static_cast<double>(most_kib[0]) - 1.0;
  std::printf("%d frames in %.1f s\n", frames, (ros::WallTime::now() - begin).toSec());
  std::printf("frames INITIALIZING %d, TRACKING %d, OCCLUDED %d, LOST %d, UNINITIALIZED %d\n", states[1], states[2],
              states[3], states[4], states[0]);
  std::printf("seconds INITIALIZING %.1f, TRACKING %.1f, OCCLUDED %.1f, LOST %.1f, UNINITIALIZED %.1f\n", state_s[1],
              state_s[2], state_s[3], state_s[4], state_s[0]);
  events.print();
  std::printf("resident memory: at most %zu KiB in the third quarter, %zu KiB in the last: %+.2f %%\n", most_kib[0],
              most_kib[1], 100.0 * growth);
  std::printf("most at any time, with what malloc keeps: %zu KiB\n", end.peak_kib);
  std::printf("handles %zu -> %zu, threads %zu -> %zu (first fifth -> end)\n", early.handles, end.handles,
              early.threads, end.threads);
  printLatency(latencies);
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)  // sanitizers keep what is freed, on purpose
  EXPECT_LE(growth, ros::param::param("~max_growth", 0.02));         // of resident memory in the last half
#endif
  EXPECT_LE(end.handles, early.handles + 2);  // connections to the master come and go
  EXPECT_LE(end.threads, early.threads);
  EXPECT_GT(states[TrackerStatus::TRACKING], frames / 2);
}

}  // namespace
}  // namespace depth_object_tracker

int main(int argc, char** argv) {
  return runRosTests(argc, argv, "tracker_soak");
}
