// SPDX-License-Identifier: BSD-3-Clause
// One seed gives one result, byte for byte, on any number of threads.
#include "depth_object_tracker/geometry/simd_target.h"
#include "followed_scene.h"
#include "tracking_run.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <vector>

namespace depth_object_tracker {
namespace {

/// Everything that a run says, timings left out, as bytes.
std::string bytesOfRun(int num_threads, std::uint64_t seed, Proposal proposal) {
  TrackerConfig config;
  config.filter.num_threads = num_threads;
  config.filter.seed = seed;
  config.filter.proposal = proposal;
  ScriptedScene scene("drill", 9);
  Pose truth = restingPose();
  TrackingRun run(scene, truth, config);
  std::string bytes;
  const auto append = [&](const void* data, std::size_t size) { bytes.append(static_cast<const char*>(data), size); };
  for (int k = 0; k < 11; ++k) {
    truth = movedBy(truth, 0.2 / 30.0, 0, 0.1 / 30.0, {0, 0.02, 0});
    // A board comes in between, so that occlusion, search and reappearance take part.
    const std::optional<Board> board = k >= 5 && k < 8 ? std::make_optional(Board{200, 440, 0.5}) : std::nullopt;
    const TrackerResult result = run.step(truth, board);
    append(result.T_camera_object.matrix().data(), 16 * sizeof(double));
    append(result.covariance.data(), 36 * sizeof(double));
    append(result.twist.data(), 6 * sizeof(double));
    append(result.twist_covariance.data(), 36 * sizeof(double));
    for (const double value :
         {result.effective_sample_size, result.log_likelihood, result.visible_fraction, result.score}) {
      append(&value, sizeof(value));
    }
    const ParticlePoses particles = run.tracker().particles();
    for (const Pose& pose : particles.T_camera_object) append(pose.matrix().data(), 16 * sizeof(double));
    append(particles.weights.data(), particles.weights.size() * sizeof(float));
    const OcclusionMap map = run.tracker().occlusionMap();
    append(map.p_occluded.data(), map.p_occluded.size() * sizeof(float));
  }
  return bytes;
}

class Determinism : public testing::TestWithParam<Proposal> {};
INSTANTIATE_TEST_SUITE_P(Proposals, Determinism, testing::Values(Proposal::kInformed, Proposal::kProcess));

TEST_P(Determinism, SameBytesOnAnyNumberOfThreadsAndEveryTime) {
  const std::string once = bytesOfRun(1, 1, GetParam());
  EXPECT_TRUE(once == bytesOfRun(1, 1, GetParam())) << "a repeated run differs";
  EXPECT_TRUE(once == bytesOfRun(2, 1, GetParam())) << "two threads differ from one";
  EXPECT_TRUE(once == bytesOfRun(3, 1, GetParam())) << "three threads differ from one";
  EXPECT_FALSE(once == bytesOfRun(1, 2, GetParam())) << "the seed must matter, else this test shows nothing";
}

/// A palm behind an object that is hardly seen: it is searched in the hand from the first image on.
std::vector<Pose> posesInAGripper(int num_threads) {
  constexpr int kImages = 12;
  SimulationConfig scene;
  scene.scenario = Scenario::kRobot;
  scene.hand_coverage = 0.8;
  scene.seed = 101;
  TrackerConfig config;
  config.filter.num_threads = num_threads;
  std::vector<Pose> poses;
  followScene(
      "mug", scene, kImages,
      [&](const SimulatedFrame&, const TrackerResult& result, double) { poses.push_back(result.T_camera_object); },
      config);
  return poses;
}

TEST(Determinism, SearchesInTheHandAreTheSameOnAnyNumberOfThreads) {
  const std::vector<Pose> one = posesInAGripper(1), three = posesInAGripper(3);
  ASSERT_EQ(one.size(), three.size());
  for (std::size_t k = 0; k < one.size(); ++k) EXPECT_TRUE(one[k].matrix() == three[k].matrix()) << "image " << k;
}

TEST(Determinism, SameBytesWithEveryInstructionSet) {
  const std::string best = bytesOfRun(1, 1, Proposal::kInformed);
  for (const std::string& target : availableSimdTargets()) {
    ASSERT_TRUE(selectSimdTarget(target));
    EXPECT_TRUE(best == bytesOfRun(1, 1, Proposal::kInformed)) << target;
  }
  selectSimdTarget("auto");
}

TEST(Effort, LessTakesFewerParticlesAndPixelsAndStillTracks) {
  ScriptedScene scene("drill", 9);
  Pose truth = restingPose();
  TrackingRun run(scene, truth);
  const auto track = [&](double effort, int frames) {
    run.setEffort(effort);
    for (int k = 0; k < frames; ++k) {
      truth = movedBy(truth, 0.1 / 30.0, 0, 0, {0, 0.01, 0});
      run.step(truth);
    }
    return run.result();
  };
  const TrackerResult full = track(1.0, 5);
  const TrackerResult less = track(0.1, 10);
  const TrackerResult again = track(1.0, 5);
  EXPECT_EQ(full.num_particles, TrackerConfig().filter.num_particles);
  EXPECT_NEAR(less.num_particles, std::max(24.0, std::sqrt(0.1) * full.num_particles), 1.0);
  EXPECT_LT(less.pixels, 0.7 * full.pixels);
  EXPECT_EQ(again.num_particles, full.num_particles);
  EXPECT_GT(again.pixels, 0.7 * full.pixels);
  EXPECT_EQ(run.lostFrames(), 0);
  EXPECT_LT(run.lastError(), 0.003);
}

}  // namespace
}  // namespace depth_object_tracker
