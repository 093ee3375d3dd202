// SPDX-License-Identifier: BSD-3-Clause
// How the simulated object and the hand that holds it move.
#include "depth_object_tracker/simulator/object_motion.h"

#include "depth_object_tracker/simulator/static_world.h"

#include <algorithm>
#include <limits>
#include <stdexcept>

namespace depth_object_tracker {
namespace {

constexpr std::uint64_t kStream = 109;
constexpr double kImageMarginPx = 10.0;
constexpr double kTableMarginM = 0.01;

// Outermost vertices in many directions: enough to test what the whole object reaches.
std::vector<Eigen::Vector3d> extremeVertices(const TriangleMesh& mesh) {
  std::vector<Eigen::Vector3d> extremes;
  RandomSource random(0, kStream);
  for (int k = 0; k < 120; ++k) {
    const Eigen::Vector3f direction = random.unitVector().cast<float>();
    const auto farthest =
        std::max_element(mesh.vertices.begin(), mesh.vertices.end(),
                         [&](const auto& a, const auto& b) { return a.dot(direction) < b.dot(direction); });
    extremes.push_back(farthest->cast<double>());
  }
  return extremes;
}

}  // namespace

ObjectMotion::ObjectMotion(const TriangleMesh& object, const SimulationConfig& config)
    : config_(config),
      T_world_camera_(makeCameraMount(config).T_world_camera()),
      centroid_(surfaceCentroid(object)),
      outline_(extremeVertices(object)) {
  if (config.scenario == Scenario::kSlip) slips_.emplace(config.seed, centroid_);
  const SmoothMotionConfig motion = motionConfig();
  motion_.emplace(motion, [this](const Pose& T_camera_centre) { return isInView(objectAt(T_camera_centre)); });
  if (!isInView(held(0.0))) {
    throw std::invalid_argument("the object (diameter " + std::to_string(diameter(object)) +
                                " m) does not fit into the camera's view at " + std::to_string(config.distance_m) +
                                " m; take a larger distance or check the mesh's unit");
  }
}

SmoothMotionConfig ObjectMotion::motionConfig() const {
  RandomSource random(config_.seed, kStream);
  const Eigen::Matrix3d R_camera_world = T_world_camera_.linear().transpose();
  const bool is_static = config_.scenario == Scenario::kStatic;
  const Eigen::Matrix3d R_world_yaw = expSo3(random.uniform(0.0, 2.0 * M_PI) * Eigen::Vector3d::UnitZ());
  const Eigen::Vector3d tilt = is_static ? Eigen::Vector3d::Zero() : (0.26 * random.unitVector()).eval();
  SmoothMotionConfig motion;
  motion.base_rotation = R_camera_world * expSo3(tilt) * R_world_yaw;
  motion.centre_m = Eigen::Vector3d(-0.02, -0.015, config_.distance_m);
  if (is_static) {
    const Eigen::Vector3d ahead = T_world_camera_ * motion.centre_m;
    const Eigen::Vector3d standing(ahead.x(), ahead.y(), lowestOver(R_world_yaw));
    motion.centre_m = T_world_camera_.inverse() * standing;
  }
  motion.amplitude_m = Eigen::Vector3d::Constant(is_static ? 0.0 : config_.amplitude_m);
  motion.amplitude_rad = is_static ? 0.0 : config_.amplitude_rad;
  motion.peak_speed_m_s = peakSpeed(config_.scenario, config_.speed);
  motion.peak_speed_rad_s = peakAngularSpeed(config_.scenario, config_.speed);
  motion.duration_s = config_.duration_s;
  motion.first_rest_s = config_.first_rest_s;
  motion.seed = config_.seed;
  return motion;
}

double ObjectMotion::lowestOver(const Eigen::Matrix3d& R_world_object) const {
  double lowest = std::numeric_limits<double>::infinity();
  for (const Eigen::Vector3d& p_object : outline_) {
    lowest = std::min(lowest, (R_world_object * (p_object - centroid_)).z());
  }
  return -lowest;
}

Pose ObjectMotion::objectAt(const Pose& T_camera_centre) const {
  return T_camera_centre * Eigen::Translation3d(-centroid_);
}

Pose ObjectMotion::held(double t_s) {
  return objectAt(motion_->pose(t_s));
}

bool ObjectMotion::isInView(const Pose& T_camera_object) const {
  const PinholeCamera& camera = config_.camera;
  const double above = config_.scenario == Scenario::kStatic ? -kTableMarginM : kTableMarginM;
  return std::all_of(outline_.begin(), outline_.end(), [&](const Eigen::Vector3d& p_object) {
    const Eigen::Vector3d p_camera = T_camera_object * p_object;
    if (p_camera.z() < config_.min_depth_m || p_camera.z() > config_.max_depth_m) return false;
    const Eigen::Vector2d pixel = camera.project(p_camera);
    return pixel.x() >= kImageMarginPx && pixel.x() <= camera.width - 1 - kImageMarginPx &&
           pixel.y() >= kImageMarginPx && pixel.y() <= camera.height - 1 - kImageMarginPx &&
           (T_world_camera_ * p_camera).z() >= above;
  });
}

}  // namespace depth_object_tracker
