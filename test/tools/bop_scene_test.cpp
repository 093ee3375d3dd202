// SPDX-License-Identifier: BSD-3-Clause
#include "depth_object_tracker/tools/bop_scene.h"

#include "depth_object_tracker/tools/bop_models_info.h"
#include "depth_object_tracker/tools/depth_picture.h"
#include "depth_object_tracker/tools/input_error.h"
#include "depth_object_tracker/tools/scene_pictures.h"
#include "small_scene.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace depth_object_tracker {
namespace {

using testing::HasSubstr;

std::string problemOf(const SmallScene& scene) {
  return messageOf<InputError>([&] { loadBopScene(scene.path(), {}); });
}

TEST(BopScene, ReadsWhatTheFolderHolds) {
  const SmallScene scene;
  const BopScene read = loadBopScene(scene.path(), {});
  ASSERT_EQ(read.frames.size(), 6u);
  EXPECT_EQ(read.scene_id, 7);
  EXPECT_DOUBLE_EQ(read.frames[3].stamp_s, 0.1);
  EXPECT_DOUBLE_EQ(read.frames[3].depth_unit_m, 1e-3);
  EXPECT_DOUBLE_EQ(read.frames[3].camera.cx, 79.5);
  ASSERT_TRUE(read.frames[3].T_camera_object_truth);
  EXPECT_LT(difference(*read.frames[3].T_camera_object_truth, SmallScene::truth(3)).norm(), 1e-9);
  ASSERT_TRUE(read.frames[3].control);
  EXPECT_DOUBLE_EQ(read.frames[3].control->linear_m_s.x(), 0.03);
  EXPECT_TRUE(read.warnings.empty());
}

TEST(BopScene, FramesAreSortedAsNumbers) {
  const SmallScene scene(12);
  const BopScene read = loadBopScene(scene.path(), {});
  for (int k = 0; k < 12; ++k) EXPECT_EQ(read.frames[static_cast<std::size_t>(k)].id, k);
}

TEST(BopScene, TimestampsDefaultToTheFrameRate) {
  const SmallScene scene;
  scene.write("scene_camera.json", R"({"4": {"cam_K": [1,0,0,0,1,0,0,0,1], "depth_scale": 0.1, "more": []}})");
  const BopScene read = loadBopScene(scene.path(), {1, 10.0, true});
  EXPECT_DOUBLE_EQ(read.frames[0].stamp_s, 0.4);
  EXPECT_DOUBLE_EQ(read.frames[0].depth_unit_m, 1e-4);
}

TEST(BopScene, StrideAveragesControlOverTheSkippedFrames) {
  const SmallScene scene;
  std::vector<SceneFrame> frames = loadBopScene(scene.path(), {}).frames;
  std::vector<SceneFrame> chosen = everyNthFrame(frames, 2);
  ASSERT_EQ(chosen.size(), 3u);
  EXPECT_EQ(chosen[2].id, 4);
  EXPECT_NEAR(chosen[2].control->linear_m_s.x(), 0.01 * (3 + 4) / 2, 1e-12);
  EXPECT_NEAR(chosen[2].control->angular_rad_s.z(), 0.02 * (3 + 4) / 2, 1e-12);

  frames[4].stamp_s += 1.0 / 30.0;  // the second half of the interval lasts twice as long
  EXPECT_NEAR(everyNthFrame(frames, 2)[2].control->linear_m_s.x(), 0.01 * (3 + 2 * 4) / 3, 1e-12);

  frames[3].control.reset();  // free for half of the interval: nothing is known of its motion there
  EXPECT_FALSE(everyNthFrame(frames, 2)[2].control);
}

TEST(BopScene, NoControlWhereItIsNotWantedOrNotHeld) {
  const SmallScene scene;
  EXPECT_FALSE(loadBopScene(scene.path(), {1, 30.0, false}).frames[1].control);
  scene.write("scene_control.json", R"({"1": {"grasped": false}, "2": {"grasped": true}})");
  const BopScene read = loadBopScene(scene.path(), {});
  EXPECT_FALSE(read.frames[1].control);
  EXPECT_FALSE(read.frames[2].control->has_twist);
}

TEST(BopScene, GroundTruthThatIsShorterOrOfAnotherObjectIsAWarning) {
  const SmallScene scene;
  const std::string pose = scene.read("init.json");
  scene.write("scene_gt.json", R"({"1": [)" + pose + "]}");
  BopScene read = loadBopScene(scene.path(), {});
  EXPECT_FALSE(read.frames[0].T_camera_object_truth);
  EXPECT_TRUE(read.first_truth);
  ASSERT_EQ(read.warnings.size(), 1u);
  EXPECT_THAT(read.warnings[0], HasSubstr("lacks 5 of 6 frames"));
  read = loadBopScene(scene.path(), {5, 30.0, true});
  EXPECT_FALSE(read.first_truth);
  EXPECT_THAT(read.warnings[0], HasSubstr("--object-id"));
}

TEST(BopScene, BadInputSaysFileAndKey) {
  EXPECT_THAT(messageOf<InputError>([] { loadBopScene("/no/such/folder", {}); }), HasSubstr("/no/such/folder"));
  struct Case {
    std::string file, content, expected;
  };
  const std::string camera = R"("cam_K": [1,0,0,0,1,0,0,0,1], "depth_scale": 1)";
  for (const Case& bad : std::vector<Case>{
           {"scene_camera.json", "{\"0\": {", "not valid JSON"},
           {"scene_camera.json", "", "not valid JSON"},
           {"scene_camera.json", "[]", "JSON object"},
           {"scene_camera.json", "{}", "lists no frame"},
           {"scene_camera.json", R"({"0": 5})", "frame 0"},
           {"scene_camera.json", R"({"0": {"depth_scale": 1}})", "cam_K"},
           {"scene_camera.json", R"({"0": {"cam_K": [1,0,0,0,1,0,0,0,1]}})", "depth_scale"},
           {"scene_camera.json", R"({"0": {"cam_K": [1,0,0,0,1,0,0,0], "depth_scale": 1}})", "9 numbers"},
           {"scene_camera.json", R"({"0": {"cam_K": [0,0,0,0,1,0,0,0,1], "depth_scale": 1}})", "fx"},
           {"scene_camera.json", R"({"0": {"cam_K": [NaN,0,0,0,1,0,0,0,1], "depth_scale": 1}})", "not valid JSON"},
           {"scene_camera.json", R"({"0": {"cam_K": [1,0,0,0,1,0,0,0,1], "depth_scale": -1}})", "depth_scale"},
           {"scene_camera.json", R"({"0": {"cam_K": [1,0,0,0,1,0,0,0,1], "depth_scale": "1"}})", "depth_scale"},
           {"scene_camera.json", "{\"zero\": {" + camera + "}}", "zero"},
           {"scene_camera.json", "{\"-1\": {" + camera + "}}", "-1"},
           {"scene_camera.json", "{\"0\": {" + camera + "}, \"00\": {" + camera + "}}", "twice"},
           {"scene_camera.json", "{\"0\": {" + camera + ", \"timestamp\": null}}", "timestamp"},
           {"scene_gt.json", "{\"0\": {}}", "frame 0"},
           {"scene_gt.json", R"({"0": [{"obj_id": 1}]})", "cam_R_m2c"},
           {"scene_gt.json", R"({"0": [{"obj_id": 1, "cam_R_m2c": [2,0,0,0,1,0,0,0,1], "cam_t_m2c": [0,0,1]}]})",
            "rotation"},
           {"scene_gt.json", R"({"0": [{"obj_id": 1, "cam_R_m2c": [-1,0,0,0,1,0,0,0,1], "cam_t_m2c": [0,0,1]}]})",
            "rotation"},
           {"scene_control.json", R"({"0": {"linear": [0,0,0]}})", "grasped"},
           {"scene_control.json", R"({"0": {"grasped": true, "linear": [0,0,0]}})", "angular"},
           {"visibility.csv", "frame,share\n", "fraction_visible"},
           {"visibility.csv", "frame,fraction_visible\n0,high\n", "line 2"},
           {"visibility.csv", "frame,fraction_visible\n1e300,1\n", "not a frame number"}}) {
    const SmallScene scene(2);
    scene.write(bad.file, bad.content);
    const std::string message = problemOf(scene);
    EXPECT_THAT(message, HasSubstr(bad.expected)) << bad.content;
    EXPECT_THAT(message, HasSubstr(bad.file)) << bad.content;
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
  }
}

TEST(BopScene, BadPicturesAreEmptyFramesWithAWarning) {
  const SmallScene scene(7);
  const std::vector<SceneFrame> frames = loadBopScene(scene.path(), {}).frames;
  std::filesystem::remove(scene.picture(0));            // missing: no warning, but counted
  scene.writePicture(2, 80, 60, 16, 1);                 // wrong size
  scene.writePicture(3, 160, 120, 8, 1);                // wrong type
  scene.writePicture(4, 160, 120, 16, 3);               // colour
  std::filesystem::resize_file(scene.picture(5), 200);  // truncated
  scene.write("depth/000006.png", "this is not a picture");
  std::vector<std::string> warnings;
  ScenePictures pictures(frames, [&](const std::string& warning) { warnings.push_back(warning); });
  for (const SceneFrame& frame : frames) {
    const DepthPicture picture = pictures.read(frame);
    EXPECT_EQ(picture.width, SmallScene::kWidth);
    EXPECT_EQ(picture.height, SmallScene::kHeight);
    const bool has_readings =
        std::any_of(picture.counts.begin(), picture.counts.end(), [](auto count) { return count > 0; });
    EXPECT_EQ(has_readings, frame.id == 1) << frame.id;
  }
  EXPECT_EQ(pictures.numMissing(), 1);
  ASSERT_EQ(warnings.size(), 5u);
  EXPECT_THAT(warnings[0], HasSubstr("80 x 60"));
  EXPECT_THAT(warnings[1], HasSubstr("8 bits"));
  EXPECT_THAT(warnings[2], HasSubstr("3 channel"));
  EXPECT_THAT(warnings[3], HasSubstr("truncated"));
}

TEST(BopScene, APictureThatPromisesGigabytesIsRefusedBeforeTheyAreTaken) {
  const TemporaryFolder folder;
  const std::string start("\x89PNG\r\n\x1a\n\0\0\0\rIHDR\0\0\x7d\0\0\0\x7d\0\x10\0\0\0\0", 29);
  EXPECT_THAT(messageOf<InputError>([&] { readDepthPicture(folder.write("a.png", start)); }),
              HasSubstr("promises 32000x32000 pixels"));
}

TEST(BopModelsInfo, SymmetriesAreInTheMeshFilesUnit) {
  const TemporaryFolder folder;
  const std::string file = folder.write("models_info.json", R"({"3": {"diameter": 9,
    "symmetries_continuous": [{"axis": [0, 0, 2], "offset": [10, 20, 0]}],
    "symmetries_discrete": [[1,0,0,30, 0,-1,0,0, 0,0,-1,0, 0,0,0,1]]}})");
  const std::optional<Symmetries> symmetries = loadBopSymmetries(file, 3, 0.001);
  ASSERT_TRUE(symmetries);
  ASSERT_EQ(symmetries->continuous.size(), 1u);
  EXPECT_TRUE(symmetries->continuous[0].axis.isApprox(Eigen::Vector3d::UnitZ()));
  EXPECT_TRUE(symmetries->continuous[0].offset.isApprox(Eigen::Vector3d(0.01, 0.02, 0.0)));
  ASSERT_EQ(symmetries->discrete.size(), 1u);
  EXPECT_TRUE(symmetries->discrete[0].translation().isApprox(Eigen::Vector3d(0.03, 0.0, 0.0)));
  EXPECT_FALSE(loadBopSymmetries(file, 1, 1.0));
  const std::string bad = folder.write("bad.json", R"({"1": {"symmetries_discrete": [[1, 2, 3]]}})");
  EXPECT_THAT(messageOf<InputError>([&] { loadBopSymmetries(bad, 1, 1.0); }), HasSubstr("16 numbers"));
}

}  // namespace
}  // namespace depth_object_tracker
