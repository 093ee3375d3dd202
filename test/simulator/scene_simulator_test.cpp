// SPDX-License-Identifier: BSD-3-Clause
// The simulated scene: deterministic, in view, as fast as asked for, and truthful about what it shows.
#include "depth_object_tracker/simulator/scene_simulator.h"
#include "depth_object_tracker/geometry/mesh_loader.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace depth_object_tracker {
namespace {

constexpr double kFrameS = 1.0 / 30.0;

TriangleMesh loadTestMesh(const std::string& name) {
  return loadMesh(std::string(PROJECT_SOURCE_FOLDER) + "/meshes/" + name + ".obj");
}

SimulationConfig makeConfig(Scenario scenario, Speed speed, Occluders occluders = Occluders::kNone,
                            std::uint64_t seed = 5) {
  SimulationConfig config;
  config.scenario = scenario;
  config.speed = speed;
  config.occluders = occluders;
  config.seed = seed;
  return config;
}

TEST(SceneSimulator, SameSeedGivesSameBytesAnotherSeedOthers) {
  const TriangleMesh mesh = loadTestMesh("mug");
  const SimulationConfig config = makeConfig(Scenario::kHuman, Speed::kMedium, Occluders::kPassing);
  SimulationConfig other_config = config;
  other_config.seed = config.seed + 1;
  SceneSimulator first(mesh, config), second(mesh, config), other(mesh, other_config);
  for (int k = 0; k < 60; k += 7) {
    const SimulatedFrame a = first.render(k * kFrameS);
    const SimulatedFrame& b = second.render(k * kFrameS);
    EXPECT_EQ(a.depth_mm, b.depth_mm) << "frame " << k;
    EXPECT_EQ(a.occlusion, b.occlusion) << "frame " << k;
    EXPECT_TRUE(a.T_camera_object.matrix() == b.T_camera_object.matrix());
    EXPECT_NE(a.depth_mm, other.render(k * kFrameS).depth_mm);
  }
}

class SceneMotion : public testing::TestWithParam<std::pair<Scenario, Speed>> {};

TEST_P(SceneMotion, RestsFirstThenReachesItsPeakSpeeds) {
  const TriangleMesh mesh = loadTestMesh("drill");
  const auto [scenario, speed] = GetParam();
  const SimulationConfig config = makeConfig(scenario, speed);
  SceneSimulator simulator(mesh, config);
  const Eigen::Vector3d centre = surfaceCentroid(mesh);
  EXPECT_TRUE(simulator.truth(0.0).isApprox(simulator.truth(config.first_rest_s), 1e-12));
  double peak_m_s = 0.0, peak_rad_s = 0.0;
  constexpr double kStepS = 1e-3;
  for (double t = 0.0; t < config.duration_s; t += kStepS) {
    const Pose before = simulator.truth(t), after = simulator.truth(t + kStepS);
    peak_m_s = std::max(peak_m_s, (after * centre - before * centre).norm() / kStepS);
    peak_rad_s = std::max(peak_rad_s, difference(after, before).tail<3>().norm() / kStepS);
  }
  EXPECT_NEAR(peak_m_s, peakSpeed(scenario, speed), 0.05 * peakSpeed(scenario, speed));
  EXPECT_NEAR(peak_rad_s, peakAngularSpeed(scenario, speed), 0.05 * peakAngularSpeed(scenario, speed));
}

INSTANTIATE_TEST_SUITE_P(All, SceneMotion,
                         testing::Values(std::pair{Scenario::kHuman, Speed::kSlow},
                                         std::pair{Scenario::kHuman, Speed::kFast},
                                         std::pair{Scenario::kRobot, Speed::kMedium}));

TEST(SceneSimulator, KeepsTheObjectInViewForMinutes) {
  const TriangleMesh mesh = loadTestMesh("spatula");
  SimulationConfig config = makeConfig(Scenario::kHuman, Speed::kMedium);
  config.duration_s = 600.0;
  SceneSimulator simulator(mesh, config);
  const Pose T_world_camera = makeCameraMount(config).T_world_camera();
  for (double t = 0.0; t < 200.0; t += 0.25) {
    const Pose T_camera_object = simulator.truth(t);
    for (std::size_t k = 0; k < mesh.vertices.size(); k += 10) {
      const Eigen::Vector3d p_camera = T_camera_object * mesh.vertices[k].cast<double>();
      const Eigen::Vector2d pixel = config.camera.project(p_camera);
      // The path is checked at discrete times; a little may be lost between them.
      ASSERT_GT(p_camera.z(), config.min_depth_m - 0.03) << "at " << t;
      ASSERT_TRUE(pixel.x() > 0.0 && pixel.x() < config.camera.width - 1.0 && pixel.y() > 0.0 &&
                  pixel.y() < config.camera.height - 1.0)
          << "at " << t << " s: " << pixel.transpose();
      ASSERT_GT((T_world_camera * p_camera).z(), -0.01) << "in the table at " << t;
    }
  }
}

TEST(SceneSimulator, MaskSaysWhatTheImageShows) {
  SceneSimulator simulator(loadTestMesh("drill"), makeConfig(Scenario::kHuman, Speed::kMedium, Occluders::kPassing));
  for (int k = 0; k < 150; k += 15) {
    const SimulatedFrame& frame = simulator.render(k * kFrameS);
    const auto count = [&](std::uint8_t value) {
      return static_cast<int>(std::count(frame.occlusion.begin(), frame.occlusion.end(), value));
    };
    EXPECT_EQ(count(255), frame.visible_pixels);
    EXPECT_EQ(count(255) + count(128), frame.object_pixels);
    EXPECT_EQ(count(0) + frame.object_pixels, static_cast<int>(frame.occlusion.size()));
    EXPECT_GT(frame.object_pixels, 1000);
    // Readings on the visible object lie in its depth range.
    const double z = frame.T_camera_object.translation().z();
    int readings = 0, near_object = 0;
    for (std::size_t i = 0; i < frame.occlusion.size(); ++i) {
      if (frame.occlusion[i] != 255 || frame.depth_mm[i] == 0) continue;
      ++readings;
      near_object += std::abs(frame.depth_mm[i] / 1000.0 - z) < 0.3 ? 1 : 0;
    }
    EXPECT_GT(readings, 0.7 * frame.visible_pixels);
    EXPECT_GT(near_object, 0.9 * readings);
  }
}

TEST(SceneSimulator, HandHidesSomeOfTheObjectAndMovesWithIt) {
  for (const char* name : {"drill", "mug", "box", "bottle", "spatula", "bracket"}) {
    SceneSimulator simulator(loadTestMesh(name), makeConfig(Scenario::kHuman, Speed::kMedium));
    for (int k = 0; k < 150; k += 30) {
      const SimulatedFrame& frame = simulator.render(k * kFrameS);
      EXPECT_GT(frame.visibleFraction(), 0.3) << name << " frame " << k;
      EXPECT_LT(frame.visibleFraction(), 0.999) << name << " frame " << k;
    }
  }
}

TEST(SceneSimulator, FullOccludersHideEverythingForAboutASecond) {
  SceneSimulator simulator(loadTestMesh("box"), makeConfig(Scenario::kHuman, Speed::kSlow, Occluders::kFull));
  int hidden = 0;
  for (int k = 0; k < 150; ++k) hidden += simulator.render(k * kFrameS).visible_pixels == 0 ? 1 : 0;
  EXPECT_GT(hidden, 15);
  EXPECT_LT(hidden, 75);
}

TEST(SceneSimulator, ObjectOnTheTableStandsStill) {
  SceneSimulator simulator(loadTestMesh("mug"), makeConfig(Scenario::kStatic, Speed::kFast));
  EXPECT_TRUE(simulator.truth(0.0).isApprox(simulator.truth(4.0)));
  EXPECT_GT(simulator.render(0.0).visibleFraction(), 0.95);
}

TEST(SceneSimulator, CommandedTwistsLeadRoughlyWhereTheHandGoes) {
  SceneSimulator simulator(loadTestMesh("bracket"), makeConfig(Scenario::kRobot, Speed::kMedium));
  const Pose first = simulator.render(0.0).T_camera_object;
  Eigen::Vector3d position = first.translation();
  double travelled = 0.0, kinematics_error = 0.0;
  Pose last = first;
  for (int k = 1; k < 150; ++k) {
    const SimulatedFrame& frame = simulator.render(k * kFrameS);
    ASSERT_TRUE(frame.control.has_value());
    EXPECT_TRUE(frame.control->grasped);
    position += frame.control->linear_m_s * kFrameS;
    travelled += (frame.T_camera_object.translation() - last.translation()).norm();
    last = frame.T_camera_object;
    const double error = (frame.T_camera_object_kinematics.translation() - frame.T_camera_object.translation()).norm();
    kinematics_error = std::max(kinematics_error, error);
  }
  // Noise, bias (3 mm/s) and scale (5 %) must show, but no more than they can explain.
  const double drift = (position - last.translation()).norm();
  EXPECT_GT(travelled, 0.1);
  EXPECT_GT(drift, 1e-4);
  EXPECT_LT(drift, 0.003 * 5.0 + 0.06 * travelled + 0.01);
  EXPECT_GT(kinematics_error, 0.005);
  EXPECT_LT(kinematics_error, 0.15);
}

TEST(SceneSimulator, SlipsMoveTheObjectInTheHand) {
  const SimulationConfig config = makeConfig(Scenario::kSlip, Speed::kSlow);
  SimulationConfig secure = config;
  secure.scenario = Scenario::kRobot;
  const TriangleMesh mesh = loadTestMesh("mug");
  SceneSimulator slipping(mesh, config), held(mesh, secure);
  EXPECT_TRUE(slipping.truth(1.0).isApprox(held.truth(1.0), 1e-9));
  double moved = 0.0;
  for (double t = 0.0; t < 5.0; t += 0.1) {
    moved = std::max(moved, (slipping.truth(t).translation() - held.truth(t).translation()).norm());
  }
  EXPECT_GT(moved, 0.005);
  EXPECT_LT(moved, 0.08);
}

TEST(SceneSimulator, RoughInitialPoseIsOffByWhatWasAskedFor) {
  const TriangleMesh mesh = loadTestMesh("drill");
  SceneSimulator simulator(mesh, makeConfig(Scenario::kHuman, Speed::kMedium));
  const Pose rough = simulator.roughInitialPose(0.005, 0.07), truth = simulator.truth(0.0);
  const Eigen::Vector3d centre = surfaceCentroid(mesh);
  EXPECT_NEAR((rough * centre - truth * centre).norm(), 0.005, 1e-9);
  EXPECT_NEAR(difference(rough, truth).tail<3>().norm(), 0.07, 1e-9);
}

TEST(SceneSimulator, BadInputIsRefusedWithAReason) {
  EXPECT_THROW(SceneSimulator(TriangleMesh(), SimulationConfig()), std::invalid_argument);
  TriangleMesh huge = loadTestMesh("box");
  for (Eigen::Vector3f& vertex : huge.vertices) vertex *= 10.0f;
  EXPECT_THROW(SceneSimulator(huge, SimulationConfig()), std::invalid_argument);
  try {
    scenarioFromName("juggler");
    FAIL() << "unknown scenario accepted";
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find("juggler"), std::string::npos);
    EXPECT_NE(std::string(error.what()).find("human"), std::string::npos);
  }
}

}  // namespace
}  // namespace depth_object_tracker
