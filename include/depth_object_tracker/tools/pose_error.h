// SPDX-License-Identifier: BSD-3-Clause
// Distance between an estimated and a true pose as the object's points see it.
#pragma once

#include "depth_object_tracker/geometry/pose.h"
#include "depth_object_tracker/geometry/symmetry.h"
#include "depth_object_tracker/geometry/triangle_mesh.h"
#include "depth_object_tracker/tools/nearest_point_index.h"

#include <optional>
#include <vector>

namespace depth_object_tracker {

struct PoseError {
  double add_m = 0.0;   ///< mean distance of corresponding model points
  double adds_m = 0.0;  ///< mean distance to the nearest model point; = add_m when the object has no declared symmetry
  double translation_m = 0.0;  ///< of the mesh origin; between equivalent poses where symmetries are declared
  double rotation_rad = 0.0;   ///< likewise
};

/// Measures errors of one object.
class PoseErrorMeter {
 public:
  static constexpr std::size_t kMaxQueryPoints = 2000;   ///< vertices that are averaged over, evenly chosen
  static constexpr std::size_t kMaxIndexPoints = 50000;  ///< vertices among which ADD-S looks for the nearest

  /// @param mesh with at least one triangle.
  PoseErrorMeter(const TriangleMesh& mesh, Symmetries symmetries);

  PoseError measure(const Pose& T_camera_object_estimate, const Pose& T_camera_object_truth) const;

  /// Normalised estimation error squared: e^T C^-1 e with e = [t_gt - t_est; Log(R_gt R_est^T)], folded onto the truth
  /// where symmetries are declared. One continuous symmetry leaves its free direction out (5 degrees of freedom instead
  /// of 6). nullopt when the covariance is not positive definite.
  std::optional<double> normalisedErrorSquared(const Pose& T_camera_object_estimate, const Matrix6d& covariance,
                                               const Pose& T_camera_object_truth) const;

  /// Of normalisedErrorSquared().
  int degreesOfFreedom() const { return symmetries_.continuous.size() == 1 ? 5 : 6; }

  bool symmetric() const { return !symmetries_.empty(); }

 private:
  double meanNearestDistance(const Pose& T_truth_estimate) const;

  Symmetries symmetries_;
  std::vector<Eigen::Vector3f> points_;
  NearestPointIndex index_;
};

}  // namespace depth_object_tracker
