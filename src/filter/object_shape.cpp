// SPDX-License-Identifier: BSD-3-Clause
#include "depth_object_tracker/filter/object_shape.h"

#include "depth_object_tracker/model/pixel_likelihood.h"

#include <algorithm>
#include <cmath>

namespace depth_object_tracker {
namespace {

constexpr double kCoarsestLevelErrorM = 0.002;

double boundingRadius(const TriangleMesh& mesh, const Eigen::Vector3d& centre) {
  double squared = 0.0;
  for (const Eigen::Vector3f& vertex : mesh.vertices) {
    squared = std::max(squared, (vertex.cast<double>() - centre).squaredNorm());
  }
  return std::sqrt(squared);
}

}  // namespace

ObjectShape::ObjectShape(const TriangleMesh& mesh, const Eigen::Vector3d& centre, bool level_of_detail)
    : levels(std::make_shared<RenderLevels>(mesh, level_of_detail ? kCoarsestLevelErrorM : 0.0)),
      centre_object(centre),
      radius_m(boundingRadius(mesh, centre)) {}

double allowedLevelError(double depth_m, double cell_m, const PixelModelConfig& config) {
  constexpr double kShareOfNoise = 0.07, kShareOfCell = 0.03;
  return std::min(kShareOfNoise * surfaceNoiseStddev(depth_m, config), kShareOfCell * cell_m);
}

}  // namespace depth_object_tracker
