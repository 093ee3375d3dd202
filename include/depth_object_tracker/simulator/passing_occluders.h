// SPDX-License-Identifier: BSD-3-Clause
// Boards and arms that pass between the camera and the object.
#pragma once

#include "depth_object_tracker/geometry/pinhole_camera.h"
#include "depth_object_tracker/geometry/pose.h"
#include "depth_object_tracker/geometry/triangle_mesh.h"
#include "depth_object_tracker/simulator/random_source.h"
#include "depth_object_tracker/simulator/simulation_config.h"

#include <optional>
#include <vector>

namespace depth_object_tracker {

/// One passage of one thing. `coverage` is the share of the object's extent along `direction_image` that is hidden.
struct OccluderEvent {
  bool is_board = true;  ///< else an arm
  bool sweeps = true;    ///< crosses the whole object; else it comes in, waits and leaves the way it came
  double start_s = 0.0;
  double end_s = 0.0;
  double coverage = 0.5;
  Eigen::Vector2d direction_image = Eigen::Vector2d::UnitX();
  double depth_m = 0.0;       ///< set when it begins
  double thickness_px = 0.0;  ///< across its long side, set when it begins
  std::size_t number = 0;
};

/// Endless plan of passages, one at a time. Ask with increasing time. Not thread-safe.
class PassingOccluders {
 public:
  PassingOccluders(const SimulationConfig& config, const TriangleMesh& object);

  struct Placed {
    std::size_t number;  ///< of the passage; a new number means a new mesh
    Pose T_camera_occluder;
  };
  /// What is before the object now, if anything.
  std::optional<Placed> at(double t_s, const Pose& T_camera_object);

  /// Shape of the passage last returned by at().
  const TriangleMesh& mesh() const { return mesh_; }

 private:
  struct Extent {
    double along_min, along_max, across_min, across_max, nearest_m;
  };
  void plan(double after_s);
  void begin(const Pose& T_camera_object);
  Extent extentOf(const Pose& T_camera_object) const;
  double leadingEdge(const Extent& extent, double t_s) const;

  Occluders kind_;
  PinholeCamera camera_;
  double min_range_m_;
  RandomSource random_;
  std::vector<Eigen::Vector3d> outline_;  // some vertices of the object
  OccluderEvent event_;
  bool begun_ = false;
  TriangleMesh mesh_;
};

}  // namespace depth_object_tracker
