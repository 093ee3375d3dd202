// SPDX-License-Identifier: BSD-3-Clause
// The room around the moved object.
#include "depth_object_tracker/simulator/static_world.h"

#include "depth_object_tracker/geometry/shape_meshes.h"
#include "depth_object_tracker/simulator/random_source.h"

namespace depth_object_tracker {
namespace {

constexpr std::uint64_t kStream = 104;
constexpr double kWallDistance = 1.9;
constexpr double kTableThickness = 0.03;
constexpr double kFloorBelowTable = 0.75;

void appendBox(TriangleMesh& mesh, const Eigen::Vector3d& size, const Eigen::Vector3d& middle, double yaw_rad,
               const Pose& T_camera_world) {
  Pose T_world_box = Pose::Identity();
  T_world_box.translation() = middle;
  T_world_box.linear() = expSo3(yaw_rad * Eigen::Vector3d::UnitZ());
  appendMesh(mesh, makeBox(size), T_camera_world * T_world_box);
}

}  // namespace

CameraMount makeCameraMount(const SimulationConfig& config) {
  CameraMount mount;
  mount.T_world_link.translation() = Eigen::Vector3d(0.0, 0.0, config.camera_height_m);
  mount.T_world_link.linear() = expSo3(config.camera_pitch_rad * Eigen::Vector3d::UnitY());
  mount.T_link_camera.linear() << 0.0, 0.0, 1.0, -1.0, 0.0, 0.0, 0.0, -1.0, 0.0;
  return mount;
}

TriangleMesh makeStaticWorld(const SimulationConfig& config) {
  RandomSource random(config.seed, kStream);
  const Pose T_camera_world = makeCameraMount(config).T_world_camera().inverse();
  TriangleMesh mesh;
  appendBox(mesh, {1.6, 1.7, kTableThickness}, {0.7, 0.0, -0.5 * kTableThickness}, 0.0, T_camera_world);
  appendBox(mesh, {0.1, 12.0, 8.0}, {kWallDistance + 0.05, 0.0, 0.0}, 0.0, T_camera_world);
  appendBox(mesh, {8.0, 12.0, 0.1}, {0.0, 0.0, -kFloorBelowTable - 0.05}, 0.0, T_camera_world);
  const double side = random.uniform() < 0.5 ? -1.0 : 1.0;
  appendBox(mesh, {0.32, 0.75, 0.7}, {kWallDistance - 0.16, side * random.uniform(0.6, 0.75), 0.62}, 0.0,
            T_camera_world);
  constexpr int kClutter = 4;
  for (int k = 0; k < kClutter; ++k) {
    const Eigen::Vector3d size(random.uniform(0.05, 0.13), random.uniform(0.05, 0.13), random.uniform(0.06, 0.2));
    const double y = -0.55 + 1.1 * (k + random.uniform(0.2, 0.8)) / kClutter;
    appendBox(mesh, size, {random.uniform(1.0, 1.38), y, 0.5 * size.z()}, random.uniform(0.0, 1.6), T_camera_world);
  }
  return mesh;
}

}  // namespace depth_object_tracker
