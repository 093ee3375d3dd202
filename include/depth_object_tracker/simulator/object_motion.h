// SPDX-License-Identifier: BSD-3-Clause
// How the simulated object and the hand that holds it move.
#pragma once

#include "depth_object_tracker/geometry/triangle_mesh.h"
#include "depth_object_tracker/simulator/hand_slips.h"
#include "depth_object_tracker/simulator/simulation_config.h"
#include "depth_object_tracker/simulator/smooth_motion.h"

#include <optional>

namespace depth_object_tracker {

/// Keeps the whole object inside of the image, off the table and between the configured depths. Not thread-safe.
class ObjectMotion {
 public:
  /// @throws std::invalid_argument when the object is too large for the view.
  ObjectMotion(const TriangleMesh& object, const SimulationConfig& config);

  /// Where the object would be had it never moved in the hand.
  Pose held(double t_s);

  /// Pose of the object in its own frame at the grasp; identity where it does not slip.
  Pose slipped(double t_s) { return slips_ ? slips_->offset(t_s) : Pose::Identity(); }
  bool isSlipping(double t_s) { return slips_ && slips_->isSlipping(t_s); }
  double pusherPresence(double t_s) { return slips_ ? slips_->pusherPresence(t_s) : 0.0; }

 private:
  bool isInView(const Pose& T_camera_object) const;
  double lowestOver(const Eigen::Matrix3d& R_world_object) const;
  SmoothMotionConfig motionConfig() const;
  Pose objectAt(const Pose& T_camera_centre) const;

  SimulationConfig config_;
  Pose T_world_camera_;
  Eigen::Vector3d centroid_;
  std::vector<Eigen::Vector3d> outline_;  // some vertices, outermost ones among them
  std::optional<HandSlips> slips_;
  std::optional<SmoothMotion> motion_;
};

}  // namespace depth_object_tracker
