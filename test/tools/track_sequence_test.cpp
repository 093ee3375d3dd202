// SPDX-License-Identifier: BSD-3-Clause
// The program track_sequence from the outside.
#include "small_scene.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>

#include <algorithm>
#include <fstream>
#include <sstream>

namespace depth_object_tracker {
namespace {

using testing::HasSubstr;

ProgramRun track(const SmallScene& scene, std::vector<std::string> options) {
  options.insert(options.begin(), {scene.path(), "--output", scene.output("est.csv")});
  return runProgram(TRACK_SEQUENCE, options);
}

std::vector<std::string> linesOf(const std::string& path) {
  std::ifstream file(path);
  std::vector<std::string> lines;
  for (std::string line; std::getline(file, line);) lines.push_back(line);
  return lines;
}

/// Estimates without the column of times.
std::vector<std::string> estimatesOf(const SmallScene& scene) {
  std::vector<std::string> lines = linesOf(scene.output("est.csv"));
  for (std::string& line : lines) line.resize(line.rfind(','));
  return lines;
}

TEST(TrackSequence, TracksAndWritesARowPerFrame) {
  const SmallScene scene;
  const ProgramRun run =
      track(scene, {"--trace", scene.output("trace.jsonl"), "--occlusion-dir", scene.output("occlusion")});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_EQ(run.err, "");  // no progress bar in a pipe
  EXPECT_THAT(run.out, HasSubstr("ADD [mm]"));
  const std::vector<std::string> rows = linesOf(scene.output("est.csv"));
  ASSERT_EQ(rows.size(), 7u);
  EXPECT_EQ(rows[0], "scene_id,im_id,obj_id,score,R,t,time");
  EXPECT_EQ(rows[1].substr(0, 6), "7,0,1,");
  EXPECT_EQ(std::count(rows[1].begin(), rows[1].end(), ','), 6);
  EXPECT_EQ(std::count(rows[1].begin(), rows[1].end(), ' '), 8 + 2);
}

TEST(TrackSequence, FollowsTheBox) {
  const SmallScene scene;
  ASSERT_EQ(track(scene, {"--trace", scene.output("trace.jsonl")}).exit_code, 0);
  const std::vector<std::string> lines = linesOf(scene.output("trace.jsonl"));
  ASSERT_EQ(lines.size(), 6u);
  for (std::size_t k = 0; k < lines.size(); ++k) {
    const nlohmann::json line = nlohmann::json::parse(lines[k]);
    const std::vector<double> numbers = line["T_camera_object"];
    Pose pose = Pose::Identity();
    pose.matrix() = Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>>(numbers.data());
    const Vector6d error = difference(pose, SmallScene::truth(static_cast<int>(k)));
    EXPECT_LT(error.head<3>().norm(), 0.01) << k;
    EXPECT_LT(error.tail<3>().norm(), 0.15) << k;
  }
}

TEST(TrackSequence, TheTraceHasEveryField) {
  const SmallScene scene(2);
  ASSERT_EQ(track(scene, {"--trace", scene.output("trace.jsonl")}).exit_code, 0);
  const nlohmann::json line = nlohmann::json::parse(linesOf(scene.output("trace.jsonl")).at(1));
  for (const char* key :
       {"frame", "stamp", "status", "T_camera_object", "covariance", "effective_sample_size", "num_particles",
        "visible_fraction", "score", "log_likelihood", "pixels", "pose_evaluations", "simd_target", "time_s"}) {
    EXPECT_TRUE(line.contains(key)) << key;
  }
  EXPECT_EQ(line["T_camera_object"].size(), 16u);
  EXPECT_EQ(line["covariance"].size(), 36u);
  EXPECT_EQ(line["status"], "TRACKING");
  EXPECT_GT(line["pose_evaluations"], 0);
  for (const char* key : {"total", "proposal", "render_likelihood", "resample"})
    EXPECT_TRUE(line["time_s"].contains(key)) << key;
  EXPECT_GE(line["time_s"]["total"].get<double>(), line["time_s"]["render_likelihood"].get<double>());
}

TEST(TrackSequence, SameSeedSameBytesOnAnyNumberOfThreads) {
  const SmallScene scene;
  ASSERT_EQ(track(scene, {}).exit_code, 0);
  const std::vector<std::string> first = estimatesOf(scene);
  ASSERT_EQ(track(scene, {"--num-threads", "2"}).exit_code, 0);
  EXPECT_EQ(estimatesOf(scene), first);
  ASSERT_EQ(track(scene, {"--seed", "2"}).exit_code, 0);
  EXPECT_NE(estimatesOf(scene), first);
}

TEST(TrackSequence, OcclusionPicturesHaveTheInputsSize) {
  const SmallScene scene(2);
  ASSERT_EQ(track(scene, {"--occlusion-dir", scene.output("occlusion")}).exit_code, 0);
  const cv::Mat picture = cv::imread(scene.output("occlusion/000001.png"), cv::IMREAD_UNCHANGED);
  ASSERT_EQ(picture.type(), CV_8UC1);
  EXPECT_EQ(picture.cols, SmallScene::kWidth);
  EXPECT_EQ(picture.rows, SmallScene::kHeight);
  EXPECT_EQ(picture.at<std::uint8_t>(0, 0), 0);      // the wall
  EXPECT_GT(picture.at<std::uint8_t>(57, 83), 0);    // the box
  EXPECT_LT(picture.at<std::uint8_t>(57, 83), 128);  // which nothing hides
}

TEST(TrackSequence, StrideAndMissingPictures) {
  const SmallScene scene;
  std::filesystem::remove(scene.picture(2));
  std::filesystem::resize_file(scene.picture(4), 100);
  const ProgramRun run = track(scene, {"--stride", "2"});
  EXPECT_EQ(run.exit_code, 0);
  EXPECT_THAT(run.err, HasSubstr("warning: 1 of 3 frames have no depth picture"));
  EXPECT_THAT(run.err, HasSubstr("000004.png: truncated"));
  const std::vector<std::string> rows = linesOf(scene.output("est.csv"));
  ASSERT_EQ(rows.size(), 4u);
  EXPECT_EQ(rows[3].substr(0, 6), "7,4,1,");
}

TEST(TrackSequence, TheCommandLineWinsOverTheConfiguration) {
  const SmallScene scene(2);
  scene.write("config.yaml", "num_particles: 31\n");
  const auto particles = [&](const std::vector<std::string>& options) {
    std::vector<std::string> all = {"--config", scene.file("config.yaml"), "--trace", scene.output("trace.jsonl")};
    all.insert(all.end(), options.begin(), options.end());
    EXPECT_EQ(track(scene, all).exit_code, 0);
    return nlohmann::json::parse(linesOf(scene.output("trace.jsonl")).at(1))["num_particles"].get<int>();
  };
  EXPECT_EQ(particles({}), 31);
  EXPECT_EQ(particles({"--num-particles", "37"}), 37);
}

TEST(TrackSequence, UsageErrorsEndWithTwo) {
  const SmallScene scene(1);
  EXPECT_EQ(runProgram(TRACK_SEQUENCE, {}).exit_code, 2);
  EXPECT_EQ(runProgram(TRACK_SEQUENCE, {scene.path()}).exit_code, 2);
  EXPECT_EQ(runProgram(TRACK_SEQUENCE, {"--help"}).exit_code, 0);
  for (const std::vector<std::string>& options : std::vector<std::vector<std::string>>{{"--num-particles", "0"},
                                                                                       {"--num-particles", "many"},
                                                                                       {"--stride", "0"},
                                                                                       {"--fps", "-3"},
                                                                                       {"--proposal", "best"},
                                                                                       {"--downsampling", "0"},
                                                                                       {"--downsampling", "half"},
                                                                                       {"--mesh-scale", "0"},
                                                                                       {"--seed", "-1"},
                                                                                       {"--unknown"}}) {
    EXPECT_EQ(track(scene, options).exit_code, 2) << options[0];
  }
}

TEST(TrackSequence, InputErrorsEndWithOneLine) {
  const SmallScene scene(2);
  const std::string init_nan = scene.output("nan.json");
  std::ofstream(init_nan) << R"({"cam_R_m2c": [1,0,0,0,1,0,0,0,1], "cam_t_m2c": [0, 0, NaN]})";
  const std::string unknown_key = scene.output("unknown.yaml");
  std::ofstream(unknown_key) << "num_particels: 5\n";
  const std::vector<std::pair<std::vector<std::string>, std::string>> cases = {
      {{"--mesh", "/no/mesh.obj"}, "/no/mesh.obj"},
      {{"--mesh-scale", "0.001"}, "mesh_scale"},
      {{"--models-info", "/no/info.json"}, "/no/info.json"},
      {{"--config", "/no/config.yaml"}, "/no/config.yaml"},
      {{"--config", unknown_key}, "num_particels"},
      {{"--init", "/no/init.json"}, "/no/init.json"},
      {{"--init", init_nan}, "nan.json"},
      {{"--trace", "/no/trace.jsonl"}, "/no/trace.jsonl"},
      {{"--occlusion-dir", "/proc/occlusion"}, "/proc/occlusion"},
      {{"--object-id", "9"}, "no initial pose"}};
  for (const auto& [options, expected] : cases) {
    const ProgramRun run = track(scene, options);
    EXPECT_EQ(run.exit_code, 1) << options[1];
    EXPECT_THAT(run.err, HasSubstr("error: "));
    EXPECT_THAT(run.err, HasSubstr(expected));
    const std::size_t error = run.err.find("error: ");
    EXPECT_EQ(run.err.find('\n', error), run.err.size() - 1) << run.err;  // one line, the last
  }
  EXPECT_EQ(runProgram(TRACK_SEQUENCE, {"/no/scene", "--output", "/tmp/x.csv"}).exit_code, 1);
  EXPECT_EQ(runProgram(TRACK_SEQUENCE, {scene.path(), "--output", "/no/folder/x.csv"}).exit_code, 1);
}

TEST(TrackSequence, ASceneWithoutReadablePicturesIsAnError) {
  const SmallScene scene(2);
  std::filesystem::remove(scene.picture(0));
  std::filesystem::remove(scene.picture(1));
  const ProgramRun run = track(scene, {});
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_THAT(run.err, HasSubstr("000000.png"));
}

}  // namespace
}  // namespace depth_object_tracker
