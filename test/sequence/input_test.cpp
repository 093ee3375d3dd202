// SPDX-License-Identifier: BSD-3-Clause
// Stamps that repeat, jump and stop; images without readings; input that cannot be used.
#include "tracking_run.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>

namespace depth_object_tracker {
namespace {

constexpr int kSettleFrames = 12;

class Input : public testing::Test {
 protected:
  Input() : scene_("drill", 4), run_(scene_, restingPose()) { run_.rest(restingPose(), kSettleFrames); }

  std::vector<std::uint16_t> emptyImage() const {
    return std::vector<std::uint16_t>(static_cast<std::size_t>(scene_.camera().width * scene_.camera().height), 0);
  }

  /// After whatever a test did: tracking goes on.
  void expectRecovery(int frames = 10) {
    run_.rest(restingPose(), frames);
    EXPECT_EQ(run_.result().state, TrackerState::kTracking);
    EXPECT_LT(run_.lastError(), 0.004);
  }

  ScriptedScene scene_;
  TrackingRun run_;
};

bool sameBytes(const TrackerResult& a, const TrackerResult& b) {
  return std::memcmp(a.T_camera_object.matrix().data(), b.T_camera_object.matrix().data(), 16 * sizeof(double)) == 0 &&
         std::memcmp(a.covariance.data(), b.covariance.data(), 36 * sizeof(double)) == 0 &&
         a.effective_sample_size == b.effective_sample_size && a.log_likelihood == b.log_likelihood;
}

TEST_F(Input, DuplicateStampsAreIgnoredAndLeaveNoTrace) {
  ScriptedScene other_scene("drill", 4);
  TrackingRun undisturbed(other_scene, restingPose());
  undisturbed.rest(restingPose(), kSettleFrames);
  ASSERT_TRUE(sameBytes(undisturbed.result(), run_.result()));
  const std::vector<std::uint16_t> noise = emptyImage();
  for (int k = 0; k < 5; ++k) {
    const TrackerResult before = run_.result();
    run_.stepWithImage(noise, std::nullopt, 0.0);
    EXPECT_EQ(run_.result().input, TrackerResult::Input::kDuplicateStamp);
    EXPECT_TRUE(run_.result().T_camera_object.isApprox(before.T_camera_object, 0.0));
    EXPECT_EQ(run_.result().state, before.state);
    undisturbed.step(restingPose());
    run_.step(restingPose());
    EXPECT_EQ(run_.result().input, TrackerResult::Input::kUsed);
    EXPECT_TRUE(sameBytes(undisturbed.result(), run_.result()));
  }
}

TEST_F(Input, AJumpBackKeepsThePoseAndStartsAnew) {
  run_.step(restingPose(), std::nullopt, -50.0);
  EXPECT_EQ(run_.result().input, TrackerResult::Input::kTimeJumpedBack);
  EXPECT_TRUE(run_.result().has_pose);
  EXPECT_LT(run_.lastError(), 0.01);
  EXPECT_TRUE(run_.result().state == TrackerState::kInitializing || run_.result().state == TrackerState::kTracking);
  expectRecovery();
}

TEST_F(Input, AGapOfSecondsIsSurvived) {
  const Pose moved = movedBy(restingPose(), 0.015, 0.01, -0.01, {0.0, 0.1, 0.0});
  run_.step(moved, std::nullopt, 3.0);
  EXPECT_TRUE(run_.result().has_pose);
  for (int k = 0; k < 8; ++k) run_.step(moved);
  EXPECT_EQ(run_.result().state, TrackerState::kTracking);
  EXPECT_LT(run_.lastError(), 0.004);
}

TEST_F(Input, StampsTenSecondsAheadAndBackAreSurvived) {
  run_.step(restingPose(), std::nullopt, 10.0);
  run_.step(restingPose(), std::nullopt, -10.0);
  expectRecovery();
}

TEST_F(Input, ImagesWithoutAnyReadingHoldThePose) {
  const std::vector<std::uint16_t> nothing = emptyImage();
  const Pose before = run_.result().T_camera_object;
  for (int k = 0; k < 30; ++k) {
    run_.stepWithImage(nothing, restingPose());
    EXPECT_NE(run_.result().state, TrackerState::kLost) << "nothing speaks against the pose";
    EXPECT_LT(scene_.error(run_.result().T_camera_object, before), 0.02);
  }
  EXPECT_NE(run_.result().state, TrackerState::kTracking);
  EXPECT_FALSE(run_.result().reason.empty());
  EXPECT_EQ(run_.result().valid_pixel_fraction, 0.0);
  EXPECT_EQ(run_.result().visible_fraction, 0.0);
  expectRecovery();
}

TEST_F(Input, UnusableImagesAreNamedAndChangeNothing) {
  const std::vector<std::uint16_t> image = scene_.render(restingPose());
  const PinholeCamera camera = scene_.camera();
  const Pose before = run_.result().T_camera_object;
  DepthImageView no_data = scene_.view(image), too_small = no_data, short_rows = no_data;
  no_data.data = nullptr;
  too_small.width = 320;
  short_rows.step = 100;
  PinholeCamera no_focal = camera, not_finite = camera;
  no_focal.fx = 0.0;
  not_finite.cx = std::numeric_limits<double>::quiet_NaN();
  double stamp = run_.stamp();
  ObjectTracker& tracker = run_.tracker();
  for (const TrackerResult& result :
       {tracker.update(no_data, camera, stamp += 0.01), tracker.update(too_small, camera, stamp += 0.01),
        tracker.update(short_rows, camera, stamp += 0.01), tracker.update(scene_.view(image), no_focal, stamp += 0.01),
        tracker.update(scene_.view(image), not_finite, stamp += 0.01),
        tracker.update(scene_.view(image), camera, std::numeric_limits<double>::quiet_NaN())}) {
    EXPECT_EQ(result.input, TrackerResult::Input::kUnusable);
    EXPECT_FALSE(result.reason.empty());
    EXPECT_TRUE(result.T_camera_object.isApprox(before, 0.0));
  }
  run_.step(restingPose(), std::nullopt, 0.1);
  EXPECT_EQ(run_.result().input, TrackerResult::Input::kUsed);
  EXPECT_TRUE(run_.result().reason.empty()) << run_.result().reason;
  expectRecovery();
}

TEST_F(Input, WithoutAnInitialPoseNothingIsClaimed) {
  run_.tracker().reset();
  run_.step(restingPose());
  EXPECT_EQ(run_.result().state, TrackerState::kUninitialized);
  EXPECT_FALSE(run_.result().has_pose);
  EXPECT_FALSE(run_.result().reason.empty());
  EXPECT_TRUE(run_.tracker().particles().T_camera_object.empty());
  run_.tracker().initialise(restingPose());
  expectRecovery();
}

TEST_F(Input, AnotherResolutionOfTheSameCameraIsFollowed) {
  // The driver switches to half the size: every second pixel.
  const std::vector<std::uint16_t> image = scene_.render(restingPose());
  PinholeCamera camera = scene_.camera();
  camera.width /= 2;
  camera.height /= 2;
  camera.fx /= 2.0;
  camera.fy /= 2.0;
  camera.cx /= 2.0;
  camera.cy /= 2.0;
  std::vector<std::uint16_t> half;
  for (int row = 0; row < camera.height; ++row) {
    for (int col = 0; col < camera.width; ++col)
      half.push_back(image[static_cast<std::size_t>(2 * row * 640 + 2 * col)]);
  }
  DepthImageView view = scene_.view(half);
  view.width = camera.width;
  view.height = camera.height;
  view.step = static_cast<std::size_t>(camera.width) * 2;
  TrackerResult result;
  for (int k = 1; k <= 5; ++k) result = run_.tracker().update(view, camera, run_.stamp() + 0.03 * k);
  EXPECT_EQ(result.input, TrackerResult::Input::kUsed);
  EXPECT_LT(scene_.error(result.T_camera_object, restingPose()), 0.006);
  run_.step(restingPose(), std::nullopt, 0.2);
  expectRecovery();
}

}  // namespace
}  // namespace depth_object_tracker
