// SPDX-License-Identifier: BSD-3-Clause
// Default configuration on scene folders outside of this package: never lost, errors below stated bounds. Skipped, with
// the folder's name, where the scenes are not.
#include "depth_object_tracker/tools/bop_models_info.h"
#include "depth_object_tracker/tools/bop_scene.h"
#include "depth_object_tracker/tools/scene_pictures.h"
#include "depth_object_tracker/tools/sequence_summary.h"
#include "depth_object_tracker/tracker/input_check.h"
#include "depth_object_tracker/tracker/object_tracker.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <optional>
#include <vector>

namespace depth_object_tracker {
namespace {

namespace fs = std::filesystem;

/// Folder with the scenes: environment variable DEPTH_OBJECT_TRACKER_DATA, else beside this package.
fs::path dataFolder() {
  const char* folder = std::getenv("DEPTH_OBJECT_TRACKER_DATA");
  return folder != nullptr ? fs::path(folder) : fs::path(SHARED_DATA_FOLDER);
}

struct RecordedScene {
  const char* path;
  double max_median_error_m;  ///< ADD, or ADD-S where symmetries are declared
};

std::ostream& operator<<(std::ostream& out, const RecordedScene& scene) {
  return out << scene.path;
}

ObjectModel loadSceneObject(const fs::path& folder) {
  ObjectDescription description;
  description.name = folder.filename().string();
  description.mesh = (folder / "mesh.obj").string();
  const fs::path models_info = folder / "models_info.json";
  if (fs::exists(models_info)) {
    description.symmetries = loadBopSymmetries(models_info.string(), 1, 1.0).value_or(Symmetries());
  }
  return loadObject(description);
}

class RecordedScenes : public testing::TestWithParam<RecordedScene> {};
INSTANTIATE_TEST_SUITE_P(Data, RecordedScenes,
                         testing::Values(RecordedScene{"simulated/human_drill", 0.002},
                                         RecordedScene{"simulated/robot_bracket", 0.002},
                                         RecordedScene{"simulated/human_spatula", 0.004},
                                         RecordedScene{"simulated/human_bottle_fast", 0.002},
                                         RecordedScene{"real/ycbv_gelatin_box", 0.003}),
                         [](const auto& test) { return fs::path(test.param.path).filename().string(); });

TEST_P(RecordedScenes, AreTrackedWithinTheBound) {
  const fs::path folder = dataFolder() / GetParam().path;
  if (!fs::exists(folder / "scene_camera.json")) {
    GTEST_SKIP() << "no scene in " << folder << "; set DEPTH_OBJECT_TRACKER_DATA to the folder that holds "
                 << GetParam().path;
  }
  const BopScene scene = loadBopScene(folder.string(), BopSceneOptions());
  ObjectTracker tracker(loadSceneObject(folder), TrackerConfig());
  tracker.initialise(loadPoseFile((folder / "init.json").string()));
  const PoseErrorMeter meter(tracker.object().mesh, tracker.object().symmetries);
  SequenceSummary summary(meter.symmetric(), meter.degreesOfFreedom());
  ScenePictures pictures(scene.frames, [](const std::string& message) { ADD_FAILURE() << message; });
  std::vector<double> errors;
  for (const SceneFrame& frame : scene.frames) {
    const DepthPicture picture = pictures.read(frame);
    const TrackerResult result =
        tracker.update(picture.view(frame.depth_unit_m), pictures.camera(frame), frame.stamp_s, frame.control);
    ASSERT_TRUE(frame.T_camera_object_truth.has_value());
    const PoseError error = meter.measure(result.T_camera_object, *frame.T_camera_object_truth);
    summary.add(result, error,
                meter.normalisedErrorSquared(result.T_camera_object, result.covariance, *frame.T_camera_object_truth),
                frame.visible_fraction);
    if (frame.visible_fraction.value_or(1.0) < SequenceSummary::kMinVisibleFraction) continue;
    errors.push_back(meter.symmetric() ? error.adds_m : error.add_m);
    EXPECT_NE(result.state, TrackerState::kLost) << "frame " << frame.id << ": " << result.reason;
  }
  summary.print(std::cout);
  EXPECT_EQ(summary.losses().frames, 0);
  EXPECT_LT(percentile(errors, 0.5), GetParam().max_median_error_m);
}

/// Every folder below the data folder that holds a scene with mesh and initial pose.
std::vector<fs::path> sceneFolders() {
  std::vector<fs::path> folders;
  if (!fs::exists(dataFolder())) return folders;
  for (const auto& entry : fs::recursive_directory_iterator(dataFolder())) {
    const fs::path folder = entry.path().parent_path();
    if (entry.path().filename() == "scene_camera.json" && fs::exists(folder / "mesh.obj") &&
        fs::exists(folder / "init.json")) {
      folders.push_back(folder);
    }
  }
  return folders;
}

/// What the self-check says about one image; about the initial pose only where one is given.
InputFindings findingsOf(const ObjectModel& object, const DepthImageView& depth, const PinholeCamera& camera,
                         const std::optional<Pose>& initial) {
  const double diameter_m = diameter(object.mesh), max_depth_m = TrackerConfig().pixel.max_depth_m;
  const DepthSummary summary = summariseDepth(depth, max_depth_m);
  InputFindings findings = checkDepth(summary, depth.pixel_type, max_depth_m);
  const auto add = [&](const InputFindings& more) { findings.insert(findings.end(), more.begin(), more.end()); };
  add(checkCamera(camera, false));
  add(checkMeshSize(diameter_m, summary, camera));
  if (initial) add(checkInitialPose(object.mesh, diameter_m, *initial, depth, camera));
  return findings;
}

TEST(SelfCheckOnRecordedScenes, FindsNothingInAnyImage) {
  const std::vector<fs::path> folders = sceneFolders();
  if (folders.empty()) GTEST_SKIP() << "no scenes below " << dataFolder() << "; set DEPTH_OBJECT_TRACKER_DATA";
  for (const fs::path& folder : folders) {
    const BopScene scene = loadBopScene(folder.string(), BopSceneOptions());
    const ObjectModel object = loadSceneObject(folder);
    ScenePictures pictures(scene.frames, [](const std::string& message) { ADD_FAILURE() << message; });
    std::optional<Pose> initial = loadPoseFile((folder / "init.json").string());
    for (const SceneFrame& frame : scene.frames) {
      const DepthPicture picture = pictures.read(frame);
      for (const auto& finding :
           findingsOf(object, picture.view(frame.depth_unit_m), pictures.camera(frame), initial)) {
        ADD_FAILURE() << folder.filename() << ", frame " << frame.id << ": " << finding.message;
      }
      initial.reset();
    }
  }
  std::cout << folders.size() << " scenes\n";
}

}  // namespace
}  // namespace depth_object_tracker
