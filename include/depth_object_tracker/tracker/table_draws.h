// SPDX-License-Identifier: BSD-3-Clause
// Poses of an object that rests on a plane which the image shows: something stands out of the plane, and the object
// stays on it in a few ways only.
#pragma once

#include "depth_object_tracker/filter/random.h"
#include "depth_object_tracker/geometry/stable_poses.h"
#include "depth_object_tracker/tracker/oriented_points.h"
#include "depth_object_tracker/tracker/plane_finder.h"

#include <cstdint>
#include <optional>
#include <vector>

namespace depth_object_tracker {

class TableDraws {
 public:
  /// @param centre_object, object_points as objectPoints() has them.
  TableDraws(const TriangleMesh& mesh, const Eigen::Vector3d& centre_object,
             const std::vector<OrientedPoint>& object_points, std::uint64_t seed);

  /// Finds what stands out of the planes. @param max_depth_m, step_px as for imagePoints().
  void setImage(const std::vector<ImagePlane>& planes, const DepthImageView& depth, const PinholeCamera& camera,
                double max_depth_m, int step_px);

  /// False when nothing stands on any plane.
  bool hasSomethingStanding() const { return !tables_.empty(); }

  /// Draw `number` of an endless sequence. hasSomethingStanding() must hold. Thread-safe.
  Pose draw(std::uint64_t number) const;

  /// How far the lowest point of the object is above the plane that it is nearest to [m]; infinite without planes.
  double heightOverTable(const Pose& T_camera_centre) const;

  /// The plane with most standing on it; nullopt without any plane.
  std::optional<ImagePlane> table() const;

 private:
  struct Table {
    ImagePlane plane;
    std::vector<OrientedPoint> standing;  // points of the image above it, normals told with the plane's
  };
  const Table& chooseTable(double uniform) const;
  const StablePose& chooseRest(double uniform) const;
  Pose drawResting(const Table& table, std::uint64_t number) const;
  Pose drawLeaning(const Table& table, std::uint64_t number) const;
  double lowestOver(const ImagePlane& plane, const Pose& T_camera_centre) const;

  double diameter_m_, feature_m_;
  CounterRandom random_;
  std::vector<OrientedPoint> object_points_;
  std::vector<StablePose> rests_;
  std::vector<double> rest_weights_;  // summed up, last = 1
  std::vector<ImagePlane> planes_;
  std::vector<Table> tables_;
  std::vector<double> table_weights_;  // summed up, last = 1
};

}  // namespace depth_object_tracker
