// SPDX-License-Identifier: BSD-3-Clause
#include "tools/trial_scene.h"

#include "depth_object_tracker/geometry/stable_poses.h"
#include "depth_object_tracker/render/depth_renderer.h"
#include "depth_object_tracker/simulator/depth_sensor.h"
#include "depth_object_tracker/simulator/random_source.h"

#include <algorithm>
#include <cmath>

namespace depth_object_tracker {
namespace {

constexpr double kFps = 30.0;
constexpr double kBetweenTrialsS = 1.7;
constexpr std::uint64_t kTableStream = 210;
constexpr float kNothingM = 20.0f;

SimulationConfig heldConfig(Scenario scenario, std::uint64_t seed) {
  constexpr double kDurationS = 60.0;
  SimulationConfig config;
  config.scenario = scenario;
  config.seed = seed;
  config.duration_s = kDurationS;
  return config;
}

TrialFrame copyOf(const SimulatedFrame& frame) {
  return {frame.depth_mm, frame.stamp_s, frame.T_camera_object, frame.T_camera_object_kinematics};
}

const StablePose& drawRest(const std::vector<StablePose>& rests, double uniform) {
  for (const StablePose& rest : rests) {
    uniform -= rest.probability;
    if (uniform < 0.0) return rest;
  }
  return rests.front();
}

bool isInView(const TriangleMesh& mesh, const Pose& T_camera_object, const PinholeCamera& camera) {
  constexpr double kMarginPx = 8.0, kNearestM = 0.47, kFarthestM = 1.3;
  return std::all_of(mesh.vertices.begin(), mesh.vertices.end(), [&](const Eigen::Vector3f& vertex) {
    const Eigen::Vector3d p = T_camera_object * vertex.cast<double>();
    if (p.z() < kNearestM || p.z() > kFarthestM) return false;
    const Eigen::Vector2d pixel = camera.project(p);
    return pixel.x() > kMarginPx && pixel.y() > kMarginPx && pixel.x() < camera.width - kMarginPx &&
           pixel.y() < camera.height - kMarginPx;
  });
}

/// Resting anyhow on the table, all of it in view.
Pose placeOnTable(const ObjectModel& object, const SimulationConfig& config, RandomSource& random) {
  constexpr int kTrials = 1000;
  const Eigen::Vector3d centre = surfaceCentroid(object.mesh);
  const std::vector<StablePose> rests = stablePoses(object.mesh, centre);
  const Pose T_camera_world = makeCameraMount(config).T_world_camera().inverse();
  Pose T_camera_object = Pose::Identity();
  for (int k = 0; k < kTrials; ++k) {
    const StablePose& rest = drawRest(rests, random.uniform());
    Pose T_world_object = Pose::Identity();
    T_world_object.linear() = expSo3(random.uniform(0.0, 2.0 * M_PI) * Eigen::Vector3d::UnitZ()) *
                              Eigen::Quaterniond::FromTwoVectors(rest.up, Eigen::Vector3d::UnitZ()).toRotationMatrix();
    T_world_object.translation() =
        Eigen::Vector3d(random.uniform(0.4, 0.95), random.uniform(-0.4, 0.4), rest.height_m) -
        T_world_object.linear() * centre;
    T_camera_object = T_camera_world * T_world_object;
    if (isInView(object.mesh, T_camera_object, config.camera)) break;
  }
  return T_camera_object;
}

void merge(const std::vector<CoveredPixel>& pixels, int width, std::vector<float>& depth_m) {
  for (const CoveredPixel& pixel : pixels) {
    float& depth = depth_m[static_cast<std::size_t>(pixel.row) * static_cast<std::size_t>(width) +
                           static_cast<std::size_t>(pixel.col)];
    depth = std::min(depth, pixel.depth);
  }
}

}  // namespace

HeldScenes::HeldScenes(const ObjectModel& object, Scenario scenario, std::uint64_t seed)
    : simulator_(object.mesh, heldConfig(scenario, seed)) {}

TrialScene HeldScenes::next(int num_frames) {
  constexpr int kMostWaiting = 10;
  constexpr double kSeenEnough = 0.5;
  TrialScene scene;
  scene.camera = simulator_.config().camera;
  stamp_s_ += kBetweenTrialsS;
  for (int k = 0; k < kMostWaiting && simulator_.render(stamp_s_).visibleFraction() < kSeenEnough; ++k) {
    stamp_s_ += 0.2;
  }
  for (int k = 0; k < num_frames; ++k) {
    stamp_s_ += 1.0 / kFps;
    scene.frames.push_back(copyOf(simulator_.render(stamp_s_)));
  }
  return scene;
}

TrialScene makeTableScene(const ObjectModel& object, int num_frames, std::uint64_t seed) {
  RandomSource random(seed, kTableStream);
  SimulationConfig config;
  config.seed = seed;
  config.camera_height_m = random.uniform(0.5, 0.75);
  config.camera_pitch_rad = random.uniform(0.45, 0.9);
  const Pose T_camera_object = placeOnTable(object, config, random);
  const PinholeCamera& camera = config.camera;
  std::vector<float> depth_m(static_cast<std::size_t>(camera.width) * static_cast<std::size_t>(camera.height),
                             kNothingM);
  merge(DepthRenderer(makeStaticWorld(config)).render(Pose::Identity(), camera), camera.width, depth_m);
  merge(DepthRenderer(object.mesh).render(T_camera_object, camera), camera.width, depth_m);
  DepthSensor sensor(config.sensor, camera, seed);
  TrialScene scene;
  scene.camera = camera;
  const Pose T_camera_world = makeCameraMount(config).T_world_camera().inverse();
  scene.table_normal = T_camera_world.linear().col(2);
  scene.table_offset_m = scene.table_normal.dot(T_camera_world.translation());
  for (int k = 0; k < num_frames; ++k) {
    TrialFrame frame;
    frame.stamp_s = k / kFps;
    frame.T_camera_object = frame.T_camera_object_kinematics = T_camera_object;
    frame.depth_mm.resize(depth_m.size());
    sensor.measure(depth_m, static_cast<std::uint64_t>(k), frame.depth_mm.data());
    scene.frames.push_back(std::move(frame));
  }
  return scene;
}

}  // namespace depth_object_tracker
