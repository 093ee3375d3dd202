// SPDX-License-Identifier: BSD-3-Clause
// A frame's work is bounded whatever the camera shows: counted in poses and pixels, which no busy machine changes.
#include "../sequence/scripted_scene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cstdio>

namespace depth_object_tracker {
namespace {

constexpr double kFrameS = 1.0 / 30.0;

struct Work {
  double evaluations = 0.0, pixels = 0.0, seconds = 0.0;

  void add(const TrackerResult& result, double seconds_taken) {
    evaluations = std::max(evaluations, static_cast<double>(result.pose_evaluations));
    pixels = std::max(pixels, static_cast<double>(result.pixels));
    seconds = std::max(seconds, seconds_taken);
  }
  void print(const char* what) const {
    std::printf("%s: at most %.0f evaluated poses, %.0f pixels, %.1f ms a frame\n", what, evaluations, pixels,
                1e3 * seconds);
  }
};

/// Tracks an object at rest and tells the most that a frame after the first `skip` took.
Work workOf(const Pose& truth, const std::optional<Pose>& shown, int frames, int skip) {
  ScriptedScene scene("drill", 5);
  ObjectTracker tracker(scene.object(), TrackerConfig());
  tracker.initialise(truth);
  Work work;
  double stamp_s = 100.0;
  for (int k = 0; k < frames; ++k) {
    const auto& image = scene.render(k < skip ? std::make_optional(truth) : shown);
    const auto begin = std::chrono::steady_clock::now();
    const TrackerResult result = tracker.update(scene.view(image), scene.camera(), stamp_s += kFrameS);
    if (k >= skip) work.add(result, std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
  }
  return work;
}

Pose atDistance(double z_m) {
  Pose pose = restingPose();
  pose.translation().z() = z_m;
  return pose;
}

TEST(WorstCase, AnObjectThatFillsTheImageCostsNoMoreThanTheTargetResolution) {
  const Work usual = workOf(restingPose(), restingPose(), 30, 15);
  const Work filling = workOf(atDistance(0.22), atDistance(0.22), 30, 15);
  usual.print("at 0.75 m");
  filling.print("at 0.22 m");
  const double target = TrackerConfig().resolution.target_model_pixels;
  EXPECT_LT(filling.pixels, 2.0 * target);
  EXPECT_LT(filling.evaluations, 3.0 * usual.evaluations + 2.0 * TrackerConfig().filter.num_particles);
}

TEST(WorstCase, AnEmptySceneIsSearchedWithinABound) {
  const Work usual = workOf(restingPose(), restingPose(), 30, 15);
  const Work empty = workOf(restingPose(), std::nullopt, 120, 15);
  empty.print("empty scene");
  EXPECT_LT(empty.pixels, 2.0 * TrackerConfig().resolution.target_model_pixels);
  EXPECT_LT(empty.evaluations, 3.0 * usual.evaluations + 2.0 * TrackerConfig().filter.num_particles);
}

TEST(WorstCase, AnImageWithoutReadingsIsHeldThrough) {
  ScriptedScene scene("drill", 5);
  ObjectTracker tracker(scene.object(), TrackerConfig());
  tracker.initialise(restingPose());
  double stamp_s = 100.0;
  for (int k = 0; k < 15; ++k)
    tracker.update(scene.view(scene.render(restingPose())), scene.camera(), stamp_s += kFrameS);
  const std::vector<std::uint16_t> nothing(static_cast<std::size_t>(scene.camera().width * scene.camera().height), 0);
  Work work;
  for (int k = 0; k < 60; ++k) {
    work.add(tracker.update(scene.view(nothing), scene.camera(), stamp_s += kFrameS), 0.0);
  }
  EXPECT_LT(work.evaluations, 10.0 * TrackerConfig().filter.num_particles);
  TrackerResult result;
  for (int k = 0; k < 30; ++k) {
    result = tracker.update(scene.view(scene.render(restingPose())), scene.camera(), stamp_s += kFrameS);
  }
  EXPECT_EQ(result.state, TrackerState::kTracking);
  EXPECT_LT(scene.error(result.T_camera_object, restingPose()), 0.003);
}

}  // namespace
}  // namespace depth_object_tracker
