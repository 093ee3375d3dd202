// SPDX-License-Identifier: BSD-3-Clause
// A simulated sequence, written as a scene folder and read back by the scene reader.
#include "depth_object_tracker/simulator/scene_writer.h"
#include "depth_object_tracker/tools/bop_models_info.h"
#include "depth_object_tracker/tools/bop_scene.h"
#include "depth_object_tracker/tools/depth_picture.h"
#include "temporary_folder.h"

#include <gtest/gtest.h>

#include <cstring>
#include <stdexcept>

namespace depth_object_tracker {
namespace {

ObjectModel loadTestObject(const std::string& name) {
  const std::string root = PROJECT_SOURCE_FOLDER;
  return loadObject(loadObjectDescription(root + "/config/objects/" + name + ".yaml"),
                    [&](const std::string&) { return root; });
}

TEST(SceneWriter, WhatIsWrittenCanBeReadBack) {
  const TemporaryFolder temporary;
  const std::string folder = (temporary.path() / "000042").string();
  const ObjectModel object = loadTestObject("bottle");
  SimulationConfig config;
  config.scenario = Scenario::kRobot;
  SceneSimulator simulator(object.mesh, config);
  SceneWriter writer(folder, object, config.camera, simulator.roughInitialPose());
  std::vector<SimulatedFrame> frames;
  for (int k = 0; k < 12; ++k) {
    frames.push_back(simulator.render(k / 30.0));
    writer.add(frames.back());
  }
  writer.finish();

  const BopScene scene = loadBopScene(folder, {});
  ASSERT_EQ(scene.frames.size(), frames.size());
  EXPECT_EQ(scene.scene_id, 42);
  for (std::size_t k = 0; k < frames.size(); ++k) {
    const SceneFrame& read = scene.frames[k];
    EXPECT_NEAR(read.stamp_s, frames[k].stamp_s, 1e-6);
    ASSERT_TRUE(read.T_camera_object_truth && read.control && read.visible_fraction);
    EXPECT_LT(difference(*read.T_camera_object_truth, frames[k].T_camera_object).norm(), 1e-6);
    EXPECT_LT((read.control->linear_m_s - frames[k].control->linear_m_s).norm(), 1e-5);
    EXPECT_NEAR(*read.visible_fraction, frames[k].visibleFraction(), 1e-4);
    const DepthPicture picture = readDepthPicture(read.depth_path);
    EXPECT_EQ(picture.counts, frames[k].depth_mm);
    EXPECT_DOUBLE_EQ(read.depth_unit_m, 1e-3);
  }
  EXPECT_LT(difference(loadPoseFile(folder + "/init.json"), simulator.roughInitialPose()).norm(), 1e-6);
  const auto symmetries = loadBopSymmetries(folder + "/models_info.json", 1, 1.0);
  ASSERT_TRUE(symmetries.has_value());
  EXPECT_EQ(symmetries->continuous.size(), object.symmetries.continuous.size());
  EXPECT_EQ(loadMesh(folder + "/mesh.obj").triangles.size(), object.mesh.triangles.size());
}

TEST(SceneWriter, UnwritableFolderIsAnError) {
  EXPECT_THROW(SceneWriter("/proc/no_such_folder/scene", loadTestObject("box"), PinholeCamera(), Pose::Identity()),
               std::runtime_error);
}

}  // namespace
}  // namespace depth_object_tracker
