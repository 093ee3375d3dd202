// SPDX-License-Identifier: BSD-3-Clause
// A robot's gripper hides four fifths of what it holds while it moves it: the robot's motion, noisy and biased, keeps
// the pose.
#include "depth_object_tracker/robot/hand_motion.h"
#include "depth_object_tracker/simulator/random_source.h"
#include "scripted_scene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>

namespace depth_object_tracker {
namespace {

constexpr double kFrameS = 1.0 / 30.0;
constexpr int kSeenFrames = 30, kFrames = 75;
constexpr double kHiddenShare = 0.8;
constexpr double kGripperBeforeM = 0.06;  // from the object's origin to the gripper's fingers
constexpr double kNoiseM = 0.006, kNoiseRad = 0.02, kBiasM = 0.003, kBiasRad = 0.01, kScaleError = 0.05;

Pose heldAt(double t_s) {
  const double s = std::sin(1.2 * t_s), c = std::sin(0.9 * t_s);
  return movedBy(restingPose(), 0.1 * s, 0.05 * c, 0.04 * s, {0.2 * s, 0.3 * c, 0.25 * s});
}

/// What a robot says of the motion from `from` to `to`: off by some percent, a bias and white noise.
ControlInput reported(const Pose& from, const Pose& to, RandomSource& random) {
  ControlInput control = carryWithHand(from, to, from, kFrameS);
  control.linear_m_s =
      (1.0 + kScaleError) * control.linear_m_s + Eigen::Vector3d::Constant(kBiasM) + kNoiseM * random.normalVector();
  control.angular_rad_s = (1.0 + kScaleError) * control.angular_rad_s + Eigen::Vector3d::Constant(kBiasRad) +
                          kNoiseRad * random.normalVector();
  return control;
}

struct Errors {
  double median_m, largest_m;
};

/// ADD while the gripper hides most of the object.
Errors track(const std::string& mesh, bool with_control) {
  ScriptedScene scene(mesh, 5);
  ObjectTracker tracker(scene.object(), TrackerConfig());
  tracker.initialise(movedBy(heldAt(0.0), 0.004, -0.003, 0.004, {0.03, -0.04, 0.02}));
  RandomSource random(6);
  std::vector<double> errors;
  for (int k = 0; k < kFrames; ++k) {
    const Pose truth = heldAt(k * kFrameS), before = heldAt(std::max(0, k - 1) * kFrameS);
    std::optional<Board> gripper;
    if (k >= kSeenFrames) {
      const auto [begin, end] = scene.columnsOf(truth);
      gripper = Board{begin - 20, begin + static_cast<int>(kHiddenShare * (end - begin)),
                      truth.translation().z() - kGripperBeforeM};
    }
    const auto& image = scene.render(truth, gripper);
    const ControlInput control = reported(before, truth, random);
    const TrackerResult result = tracker.update(scene.view(image), scene.camera(), 10.0 + k * kFrameS,
                                                with_control ? std::optional<ControlInput>(control) : std::nullopt);
    if (k >= kSeenFrames) errors.push_back(scene.error(result.T_camera_object, truth));
  }
  return {median(errors), *std::max_element(errors.begin(), errors.end())};
}

class HiddenByTheGripper : public testing::TestWithParam<const char*> {};

TEST_P(HiddenByTheGripper, StaysWithinMillimetres) {
  const Errors with = track(GetParam(), true), without = track(GetParam(), false);
  std::printf("%s: ADD median / largest with control %.2f / %.2f mm, without %.2f / %.2f mm\n", GetParam(),
              1e3 * with.median_m, 1e3 * with.largest_m, 1e3 * without.median_m, 1e3 * without.largest_m);
  EXPECT_LT(with.median_m, 0.003);
  EXPECT_LT(with.largest_m, 0.007);
  EXPECT_LT(with.median_m, 1.2 * without.median_m);
}

INSTANTIATE_TEST_SUITE_P(Objects, HiddenByTheGripper, testing::Values("drill", "bracket"));

}  // namespace
}  // namespace depth_object_tracker
