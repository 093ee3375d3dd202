// SPDX-License-Identifier: BSD-3-Clause
// Boards and arms that pass between the camera and the object.
#include "depth_object_tracker/simulator/passing_occluders.h"

#include "depth_object_tracker/geometry/shape_meshes.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace depth_object_tracker {
namespace {

constexpr std::uint64_t kStream = 105;
constexpr double kLengthM = 1.6;   // long side: always ends outside of the image
constexpr double kBoardM = 0.012;  // thickness along the view
constexpr double kHideMarginPx = 25.0;
constexpr std::size_t kOutlinePoints = 300;

double smoothStep(double x) {
  const double y = std::clamp(x, 0.0, 1.0);
  return y * y * (3.0 - 2.0 * y);
}

}  // namespace

PassingOccluders::PassingOccluders(const SimulationConfig& config, const TriangleMesh& object)
    : kind_(config.occluders),
      camera_(config.camera),
      min_range_m_(config.sensor.min_range_m),
      random_(config.seed, kStream) {
  const std::size_t step = std::max<std::size_t>(1, object.vertices.size() / kOutlinePoints);
  for (std::size_t k = 0; k < object.vertices.size(); k += step) outline_.push_back(object.vertices[k].cast<double>());
  plan(0.3);
}

void PassingOccluders::plan(double after_s) {
  const bool full = kind_ == Occluders::kFull;
  event_.number += 1;
  event_.start_s = after_s + (full ? random_.uniform(0.7, 1.6) : random_.uniform(0.5, 1.6));
  event_.end_s = event_.start_s + (full ? 1.9 : random_.uniform(1.2, 2.0));
  event_.is_board = full || random_.uniform() < 0.6;
  event_.sweeps = !full && random_.uniform() < 0.5;
  event_.coverage = full ? 1.0 : event_.sweeps ? random_.uniform(0.25, 0.5) : random_.uniform(0.35, 0.65);
  // Arms come from the sides, boards from anywhere but straight down.
  const double angle = random_.uniform(-0.4, 0.4) + (random_.uniform() < 0.5 ? 0.0 : M_PI);
  event_.direction_image = Eigen::Vector2d(std::cos(angle), std::sin(angle));
  begun_ = false;
}

PassingOccluders::Extent PassingOccluders::extentOf(const Pose& T_camera_object) const {
  constexpr double kInf = std::numeric_limits<double>::infinity();
  Extent extent{kInf, -kInf, kInf, -kInf, kInf};
  const Eigen::Vector2d along = event_.direction_image, across(-along.y(), along.x());
  for (const Eigen::Vector3d& p_object : outline_) {
    const Eigen::Vector3d p_camera = T_camera_object * p_object;
    const Eigen::Vector2d pixel = camera_.project(p_camera);
    extent.along_min = std::min(extent.along_min, along.dot(pixel));
    extent.along_max = std::max(extent.along_max, along.dot(pixel));
    extent.across_min = std::min(extent.across_min, across.dot(pixel));
    extent.across_max = std::max(extent.across_max, across.dot(pixel));
    extent.nearest_m = std::min(extent.nearest_m, p_camera.z());
  }
  return extent;
}

void PassingOccluders::begin(const Pose& T_camera_object) {
  begun_ = true;
  const Extent extent = extentOf(T_camera_object);
  event_.depth_m = std::clamp(0.72 * extent.nearest_m, min_range_m_ + 0.02, std::max(0.48, extent.nearest_m - 0.09));
  const double along_px = extent.along_max - extent.along_min, across_px = extent.across_max - extent.across_min;
  // A sweeping thing is as thick as the share that it hides; one that comes in is as thick as the object is across.
  event_.thickness_px = event_.sweeps ? event_.coverage * along_px : 1.25 * across_px + 2.0 * kHideMarginPx;
  const double thickness_m = event_.thickness_px * event_.depth_m / camera_.fx;
  const Eigen::Vector3d half_length(0.5 * kLengthM, 0.0, 0.0);
  mesh_ = event_.is_board ? makeBox({kLengthM, thickness_m, kBoardM})
                          : makeCapsule(-half_length, half_length, 0.5 * thickness_m, 0.5 * thickness_m, 24);
}

double PassingOccluders::leadingEdge(const Extent& extent, double t_s) const {
  const double image_px = std::hypot(camera_.width, camera_.height);
  const double share = (t_s - event_.start_s) / (event_.end_s - event_.start_s);
  const double covered =
      event_.coverage * (extent.along_max - extent.along_min) + (event_.coverage >= 1.0 ? kHideMarginPx : 0.0);
  const double in = smoothStep(share / 0.25) * smoothStep((1.0 - share) / 0.25);
  return extent.along_min + covered - (1.0 - in) * 0.6 * image_px;
}

std::optional<PassingOccluders::Placed> PassingOccluders::at(double t_s, const Pose& T_camera_object) {
  if (kind_ == Occluders::kNone) return std::nullopt;
  if (t_s > event_.end_s) plan(event_.end_s + (kind_ == Occluders::kFull ? 1.2 : 0.0));
  if (t_s < event_.start_s) return std::nullopt;
  if (!begun_) begin(T_camera_object);
  const Extent extent = extentOf(T_camera_object);
  const Eigen::Vector2d along = event_.direction_image, across(-along.y(), along.x());
  const double scale = event_.depth_m / camera_.fx;
  const double across_middle = 0.5 * (extent.across_min + extent.across_max);
  double along_middle = leadingEdge(extent, t_s) - 0.5 * kLengthM / scale;
  Eigen::Vector2d long_side = along;
  if (event_.sweeps) {
    const double reach = 0.6 * std::hypot(camera_.width, camera_.height);
    const double share = (t_s - event_.start_s) / (event_.end_s - event_.start_s);
    const double middle = along.dot(Eigen::Vector2d(camera_.cx, camera_.cy));
    along_middle = middle + (2.0 * share - 1.0) * reach;
    long_side = across;
  }
  const Eigen::Vector2d pixel = along_middle * along + across_middle * across;
  Placed placed{event_.number, Pose::Identity()};
  placed.T_camera_occluder.translation() = event_.depth_m * camera_.ray(pixel.x(), pixel.y());
  const Eigen::Vector3d x(long_side.x(), long_side.y(), 0.0), y(-long_side.y(), long_side.x(), 0.0);
  placed.T_camera_occluder.linear() << x, y, Eigen::Vector3d::UnitZ();
  return placed;
}

}  // namespace depth_object_tracker
