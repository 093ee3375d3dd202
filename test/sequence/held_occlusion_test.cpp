// SPDX-License-Identifier: BSD-3-Clause
// A robot's gripper hides four fifths of the pixels of what it holds, for seconds, while it moves it: the robot's
// motion, noisy and biased, keeps the pose. Or it hides it from the first image on: the pose follows the hand.
#include "depth_object_tracker/robot/hand_motion.h"
#include "depth_object_tracker/simulator/random_source.h"
#include "scripted_scene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

namespace depth_object_tracker {
namespace {

constexpr double kFrameS = 1.0 / 30.0;
constexpr int kSeenFrames = 30, kHiddenFrames = 90, kFrames = kSeenFrames + kHiddenFrames;
constexpr double kHiddenShare = 0.8;      // of the object's pixels
constexpr double kGripperBeforeM = 0.02;  // how far the gripper lies before what is nearest of the object
constexpr double kLargestErrorM = 0.005;
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

enum class Side { kLeft, kRight };

struct Case {
  std::string object;
  Side hidden;
};

/// A board that moves with the object, before it, and goes on beside it.
class Gripper {
 public:
  explicit Gripper(ScriptedScene& scene) : scene_(scene), renderer_(scene.object().mesh) {}

  /// Hides this share of the object's pixels, to one column; 1 = all of it.
  Board at(const Pose& T_camera_object, Side side, double share) {
    constexpr int kBesideCols = 20;
    std::vector<int> cols;
    double nearest_m = T_camera_object.translation().z();
    for (const CoveredPixel& pixel : renderer_.render(T_camera_object, scene_.camera())) {
      nearest_m = std::min(nearest_m, static_cast<double>(pixel.depth));
      cols.push_back(side == Side::kLeft ? pixel.col : -pixel.col);
    }
    std::sort(cols.begin(), cols.end());
    const auto hidden = static_cast<std::size_t>(std::ceil(share * static_cast<double>(cols.size())));
    const int last = cols[std::min(cols.size(), hidden) - 1];
    const int beyond = share < 1.0 ? 0 : kBesideCols;
    const double depth_m = nearest_m - kGripperBeforeM;
    return side == Side::kLeft ? Board{cols.front() - kBesideCols, last + 1 + beyond, depth_m}
                               : Board{-last - beyond, -cols.front() + 1 + kBesideCols, depth_m};
  }

 private:
  ScriptedScene& scene_;
  DepthRenderer renderer_;
};

/// ADD [m]; ADD-S of the bottle, which looks the same from all sides.
class ErrorMeter {
 public:
  explicit ErrorMeter(const ScriptedScene& scene) : meter_(scene.object().mesh, symmetriesOf(scene.object().name)) {}
  double measure(const Pose& estimate, const Pose& truth) const { return meter_.measure(estimate, truth).adds_m; }

 private:
  static Symmetries symmetriesOf(const std::string& object) {
    Symmetries symmetries;
    if (object == "bottle") symmetries.continuous.push_back({Eigen::Vector3d::UnitZ(), Eigen::Vector3d::Zero()});
    return symmetries;
  }
  PoseErrorMeter meter_;
};

struct Errors {
  double median_m, largest_m;
  double alone_m;  // largest of what the robot says alone, added up from the true pose on
};

Pose carried(const Pose& T_camera_object, const ControlInput& control) {
  Vector6d displacement;
  displacement << control.linear_m_s * kFrameS, control.angular_rad_s * kFrameS;
  return perturb(T_camera_object, displacement);
}

/// ADD while the gripper hides most of the object.
Errors track(const Case& given, bool with_control) {
  ScriptedScene scene(given.object, 5);
  Gripper gripper(scene);
  const ErrorMeter meter(scene);
  ObjectTracker tracker(scene.object(), TrackerConfig());
  tracker.initialise(movedBy(heldAt(0.0), 0.004, -0.003, 0.004, {0.03, -0.04, 0.02}));
  RandomSource random(6);
  std::vector<double> errors;
  Pose alone = heldAt(0.0);
  double alone_m = 0.0;
  for (int k = 0; k < kFrames; ++k) {
    const Pose truth = heldAt(k * kFrameS), before = heldAt(std::max(0, k - 1) * kFrameS);
    std::optional<Board> board;
    if (k >= kSeenFrames) board = gripper.at(truth, given.hidden, kHiddenShare);
    const auto& image = scene.render(truth, board);
    std::optional<ControlInput> control = reported(before, truth, random);
    alone = k < kSeenFrames ? truth : carried(alone, *control);
    alone_m = std::max(alone_m, meter.measure(alone, truth));
    if (!with_control) control.reset();
    const TrackerResult result = tracker.update(scene.view(image), scene.camera(), 10.0 + k * kFrameS, control);
    if (k >= kSeenFrames) errors.push_back(meter.measure(result.T_camera_object, truth));
  }
  return {median(errors), *std::max_element(errors.begin(), errors.end()), alone_m};
}

class HiddenByTheGripper : public testing::TestWithParam<Case> {};

TEST_P(HiddenByTheGripper, StaysWithinMillimetres) {
  const Errors with = track(GetParam(), true);
  std::printf("%s: ADD median / largest %.2f / %.2f mm, of the control alone %.2f mm\n", GetParam().object.c_str(),
              1e3 * with.median_m, 1e3 * with.largest_m, 1e3 * with.alone_m);
  // Of the spatula's handle, thin and steep, the camera measures next to nothing: the control's own error remains.
  const bool nothing_left = GetParam().object == "spatula" && GetParam().hidden == Side::kRight;
  EXPECT_LT(with.largest_m, nothing_left ? with.alone_m + 0.002 : kLargestErrorM);
}

std::vector<Case> allObjectsFromBothSides() {
  std::vector<Case> cases;
  for (const char* object : {"bottle", "box", "bracket", "drill", "mug", "spatula"}) {
    cases.push_back({object, Side::kLeft});
    cases.push_back({object, Side::kRight});
  }
  return cases;
}

std::string nameOf(const testing::TestParamInfo<Case>& tested) {
  return tested.param.object + (tested.param.hidden == Side::kLeft ? "FromTheLeft" : "FromTheRight");
}

INSTANTIATE_TEST_SUITE_P(Objects, HiddenByTheGripper, testing::ValuesIn(allObjectsFromBothSides()), nameOf);

/// The pose comes from kinematics while the gripper hides all or most of the object; then the gripper opens.
struct Revealed {
  double while_hidden_m, at_end_m;  // ADD: largest, at most; of the last image
  TrackerState state;
};

Revealed revealLater(const Case& given, double share) {
  constexpr int kHidden = 60, kRevealed = 30;
  ScriptedScene scene(given.object, 7);
  Gripper gripper(scene);
  const ErrorMeter meter(scene);
  ObjectTracker tracker(scene.object(), TrackerConfig());
  tracker.initialise(movedBy(heldAt(0.0), 0.008, -0.006, 0.008, {0.04, -0.05, 0.03}));
  RandomSource random(8);
  Revealed result{0.0, 0.0, TrackerState::kUninitialized};
  for (int k = 0; k < kHidden + kRevealed; ++k) {
    const Pose truth = heldAt(k * kFrameS), before = heldAt(std::max(0, k - 1) * kFrameS);
    std::optional<Board> board;
    if (k < kHidden) board = gripper.at(truth, given.hidden, share);
    const auto& image = scene.render(truth, board);
    const TrackerResult tracked =
        tracker.update(scene.view(image), scene.camera(), 10.0 + k * kFrameS, reported(before, truth, random));
    result.at_end_m = meter.measure(tracked.T_camera_object, truth);
    if (k < kHidden) result.while_hidden_m = std::max(result.while_hidden_m, result.at_end_m);
    result.state = tracked.state;
  }
  return result;
}

class HiddenFromTheStart : public testing::TestWithParam<Case> {};

TEST_P(HiddenFromTheStart, FollowsTheHandUntilItIsSeen) {
  for (const double share : {1.0, kHiddenShare}) {
    const Revealed revealed = revealLater(GetParam(), share);
    std::printf("%s, %.0f %% hidden: ADD at most %.1f mm, at the end %.2f mm\n", GetParam().object.c_str(), 1e2 * share,
                1e3 * revealed.while_hidden_m, 1e3 * revealed.at_end_m);
    EXPECT_LT(revealed.while_hidden_m, 0.03);  // it starts with half of that
    EXPECT_LT(revealed.at_end_m, 0.002);
    EXPECT_EQ(revealed.state, TrackerState::kTracking);
  }
}

INSTANTIATE_TEST_SUITE_P(Objects, HiddenFromTheStart, testing::ValuesIn(allObjectsFromBothSides()), nameOf);

/// The fifth that is beside the gripper from the first image on is enough where it stands out before the wall.
TEST(PartlyHiddenFromTheStart, IsFoundBesideTheGripper) {
  for (const char* object : {"bottle", "box", "drill", "mug"}) {
    EXPECT_LT(revealLater({object, Side::kLeft}, kHiddenShare).while_hidden_m, kLargestErrorM) << object;
  }
}

/// The robot says nothing any more, and what it said is worth less and less: the wait for the hand to open ends.
/// A box that was searched without knowing how it is turned looks the same after half a turn about any of its axes.
double errorUpToHalfTurns(const ScriptedScene& scene, const Pose& estimate, const Pose& truth) {
  double error_m = scene.error(estimate, truth);
  for (int axis = 0; axis < 3; ++axis) {
    error_m = std::min(error_m, scene.error(estimate * Eigen::AngleAxisd(M_PI, Eigen::Vector3d::Unit(axis)), truth));
  }
  return error_m;
}

TEST(HiddenInASilentRobotsHand, IsSearchedOnceTheHandIsNoLongerKnown) {
  constexpr int kFollowed = 10, kHidden = 100, kRevealed = 45;
  ScriptedScene scene("box", 9);
  Gripper gripper(scene);
  ObjectTracker tracker(scene.object(), TrackerConfig());
  tracker.initialise(movedBy(heldAt(0.0), 0.008, -0.006, 0.008, {0.04, -0.05, 0.03}));
  RandomSource random(10);
  TrackerResult result;
  int waited = 0;
  double error_m = 0.0;
  for (int k = 0; k < kHidden + kRevealed; ++k) {
    const Pose truth = heldAt(std::min(k, kFollowed) * kFrameS);
    std::optional<Board> board;
    if (k < kHidden) board = gripper.at(truth, Side::kLeft, 1.0);
    std::optional<ControlInput> control;
    if (k < kFollowed) control = reported(heldAt(std::max(0, k - 1) * kFrameS), truth, random);
    const auto& image = scene.render(truth, board);
    result = tracker.update(scene.view(image), scene.camera(), 10.0 + k * kFrameS, control);
    waited += result.reason.find("following the hand") != std::string::npos ? 1 : 0;
    error_m = errorUpToHalfTurns(scene, result.T_camera_object, truth);
  }
  EXPECT_GE(waited, kFollowed);
  EXPECT_LT(waited, kHidden);
  EXPECT_EQ(result.state, TrackerState::kTracking);
  EXPECT_LT(error_m, 0.002);
}

TEST(HeldWithoutControl, IsWorse) {
  const Case box{"box", Side::kRight};
  EXPECT_GT(track(box, false).median_m, track(box, true).median_m);
}

}  // namespace
}  // namespace depth_object_tracker
