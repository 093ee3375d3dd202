// SPDX-License-Identifier: BSD-3-Clause
// The simulated camera's noise in numbers, beside that of recorded and other simulated sequences where they are at
// hand.
#include "noise_statistics.h"
#include "millimetre_view.h"

#include "depth_object_tracker/geometry/mesh_loader.h"
#include "depth_object_tracker/simulator/scene_simulator.h"
#include "depth_object_tracker/tools/bop_scene.h"
#include "depth_object_tracker/tools/depth_picture.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <iostream>

namespace depth_object_tracker {
namespace {

constexpr int kMaxFrames = 10;

std::filesystem::path dataFolder() {
  const char* folder = std::getenv("DEPTH_OBJECT_TRACKER_DATA");
  return folder ? std::filesystem::path(folder) : std::filesystem::path(PROJECT_SOURCE_FOLDER) / "../shared/data";
}

NoiseStatistics ofSimulation(const std::string& object, std::uint64_t seed) {
  const TriangleMesh mesh = loadMesh(std::string(PROJECT_SOURCE_FOLDER) + "/meshes/" + object + ".obj");
  SimulationConfig config;
  config.seed = seed;
  SceneSimulator simulator(mesh, config);
  NoiseStatistics statistics(mesh);
  for (int k = 0; k < kMaxFrames; ++k) {
    const SimulatedFrame& frame = simulator.render(0.5 * k);
    const DepthImageView view = viewOf(frame.depth_mm, config.camera);
    statistics.add(view, config.camera, frame.T_camera_object);
  }
  return statistics;
}

NoiseStatistics ofScene(const std::filesystem::path& folder) {
  const BopScene scene = loadBopScene(folder.string(), {});
  NoiseStatistics statistics(loadMesh((folder / "mesh.obj").string()));
  const std::size_t step = std::max<std::size_t>(1, scene.frames.size() / kMaxFrames);
  for (std::size_t k = 0; k < scene.frames.size(); k += step) {
    const SceneFrame& frame = scene.frames[k];
    const DepthPicture picture = readDepthPicture(frame.depth_path);
    PinholeCamera camera = frame.camera;
    camera.width = picture.width;
    camera.height = picture.height;
    statistics.add(picture.view(frame.depth_unit_m), camera, frame.T_camera_object_truth.value());
  }
  return statistics;
}

// Sizes that structured-light cameras show (Khoshelham and Elberink 2012; Nguyen, Izadi and Lovell 2012), with room for
// what a smooth patch is: bent surfaces add a little to the plane fit.
void expectLikeAStructuredLightCamera(const NoiseStatistics& ours) {
  EXPECT_GT(ours.planeStddev(1), 0.0008);  // 0.60 to 0.75 m
  EXPECT_LT(ours.planeStddev(1), 0.0022);
  EXPECT_GT(ours.planeStddev(5), 1.4 * ours.planeStddev(1));  // grows with depth
  EXPECT_LT(ours.planeStddev(5), 0.012);
  EXPECT_GT(ours.objectStddev(), 0.0007);
  EXPECT_LT(ours.objectStddev(), 0.0030);
  EXPECT_LT(ours.interiorHoleShare(), 0.05);
  EXPECT_GT(ours.edgeHoleShare(), 0.08);
  EXPECT_LT(ours.edgeHoleShare(), 0.5);
  EXPECT_GT(ours.edgeOutlierShare(), 0.01);
  EXPECT_LT(ours.edgeOutlierShare(), 0.3);
}

TEST(NoiseStatistics, SimulatedCameraIsLikeStructuredLight) {
  std::cout << NoiseStatistics::header() << '\n';
  for (const char* object : {"drill", "box"}) {
    const NoiseStatistics ours = ofSimulation(object, 1);
    std::cout << ours.row(std::string("this simulator, ") + object) << '\n';
    expectLikeAStructuredLightCamera(ours);
  }
}

TEST(NoiseStatistics, IsOfTheSizeOfRecordedSequences) {
  const std::filesystem::path data = dataFolder();
  if (!std::filesystem::is_directory(data)) {
    GTEST_SKIP() << "no sequences to compare with at " << data << "; set DEPTH_OBJECT_TRACKER_DATA to their folder";
  }
  const NoiseStatistics ours = ofSimulation("drill", 1);
  std::cout << NoiseStatistics::header() << '\n' << ours.row("this simulator, drill") << '\n';
  for (const char* name : {"simulated/human_drill", "simulated/robot_bracket", "simulated/human_bottle_fast",
                           "real/ycbv_gelatin_box", "real/hand_mug"}) {
    if (!std::filesystem::is_directory(data / name)) continue;
    std::cout << ofScene(data / name).row(name) << '\n';
  }
  if (!std::filesystem::is_directory(data / "simulated/human_drill")) GTEST_SKIP() << "no simulated/human_drill";
  const NoiseStatistics theirs = ofScene(data / "simulated/human_drill");
  const auto expectSimilar = [](double a, double b, const char* what) {
    EXPECT_LT(a, 1.6 * b) << what;
    EXPECT_GT(a, b / 1.6) << what;
  };
  for (const std::size_t bin : {1U, 2U, 3U, 4U, 5U}) {
    expectSimilar(ours.planeStddev(bin), theirs.planeStddev(bin), "noise about a plane");
  }
  expectSimilar(ours.objectStddev(), theirs.objectStddev(), "noise on the object");
  expectSimilar(ours.edgeHoleShare(), theirs.edgeHoleShare(), "holes at edges");
}

}  // namespace
}  // namespace depth_object_tracker
