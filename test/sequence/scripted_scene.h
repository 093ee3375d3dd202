// SPDX-License-Identifier: BSD-3-Clause
// An object before a wall, moved as a test says, seen by the simulated structured-light camera.
#pragma once

#include "depth_object_tracker/geometry/depth_image.h"
#include "depth_object_tracker/geometry/pose.h"
#include "depth_object_tracker/render/depth_renderer.h"
#include "depth_object_tracker/simulator/depth_sensor.h"
#include "depth_object_tracker/tools/pose_error.h"
#include "depth_object_tracker/tracker/object_tracker.h"

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace depth_object_tracker {

/// A board parallel to the image that covers the columns [begin, end) at a depth, of the rows [begin_row, end_row).
struct Board {
  int begin = 0, end = 0;
  double depth_m = 0.5;
  int begin_row = 0, end_row = std::numeric_limits<int>::max();
};

class ScriptedScene {
 public:
  /// @param mesh_name file in meshes/, without ".obj".
  ScriptedScene(const std::string& mesh_name, std::uint64_t seed);

  const PinholeCamera& camera() const { return camera_; }
  const ObjectModel& object() const { return object_; }

  /// What the camera sees in its next image. @param T_camera_object nullopt: the object is not there.
  const std::vector<std::uint16_t>& render(const std::optional<Pose>& T_camera_object,
                                           const std::optional<Board>& board = std::nullopt);

  /// Columns that the object covers at a pose: first, and one past the last.
  std::pair<int, int> columnsOf(const Pose& T_camera_object);

  /// ADD [m].
  double error(const Pose& estimate, const Pose& truth) const { return meter_.measure(estimate, truth).add_m; }
  std::optional<double> normalisedErrorSquared(const TrackerResult& result, const Pose& truth) const {
    return meter_.normalisedErrorSquared(result.T_camera_object, result.covariance, truth);
  }

  /// View of an image of this camera [mm], which must outlive it.
  DepthImageView view(const std::vector<std::uint16_t>& image) const;

 private:
  PinholeCamera camera_;
  ObjectModel object_;
  DepthRenderer renderer_;
  DepthSensor sensor_;
  PoseErrorMeter meter_;
  std::uint64_t num_images_ = 0;
  std::vector<float> true_depth_m_;
  std::vector<std::uint16_t> image_;
};

/// A pose from which every face of the shipped meshes is seen well enough: tilted, 0.75 m away.
Pose restingPose();

/// The same pose, moved; rotation about the object's middle near enough for tests.
Pose movedBy(const Pose& pose, double x, double y, double z, const Eigen::Vector3d& rotation = Eigen::Vector3d::Zero());

double median(std::vector<double> values);

}  // namespace depth_object_tracker
