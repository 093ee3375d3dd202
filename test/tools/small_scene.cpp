// SPDX-License-Identifier: BSD-3-Clause
#include "small_scene.h"

#include "depth_object_tracker/geometry/mesh_loader.h"
#include "depth_object_tracker/render/depth_renderer.h"

#include <sys/wait.h>

#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>

#include <cstdio>
#include <fstream>
#include <sstream>

namespace depth_object_tracker {
namespace {

constexpr std::uint16_t kWallMm = 1100;

/// A box of 12 x 16 x 8 cm whose faces are split so that it has more than eight vertices.
std::string boxObj() {
  std::ostringstream text;
  const double half[3] = {0.06, 0.08, 0.04};
  for (int i = 0; i < 8; ++i) {
    text << "v " << ((i & 1) ? half[0] : -half[0]) << ' ' << ((i & 2) ? half[1] : -half[1]) << ' '
         << ((i & 4) ? half[2] : -half[2]) << '\n';
  }
  text << "f 1 2 4 3\nf 5 6 8 7\nf 1 2 6 5\nf 3 4 8 7\nf 1 3 7 5\nf 2 4 8 6\n";
  return text.str();
}

PinholeCamera camera() {
  return {SmallScene::kWidth, SmallScene::kHeight, 140.0, 140.0, 79.5, 59.5};
}

nlohmann::json poseJson(const Pose& pose) {
  nlohmann::json entry;
  for (int i = 0; i < 9; ++i) entry["cam_R_m2c"].push_back(pose.linear()(i / 3, i % 3));
  for (int i = 0; i < 3; ++i) entry["cam_t_m2c"].push_back(1e3 * pose.translation()(i));
  entry["obj_id"] = 1;
  return entry;
}

std::string slurp(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

}  // namespace

Pose SmallScene::truth(int frame) {
  Pose pose = Pose::Identity();
  pose.linear() = expSo3({0.5, 0.6 + 0.02 * frame, -0.3});
  pose.translation() = Eigen::Vector3d(0.02 + 0.003 * frame, -0.01, 0.7);
  return pose;
}

SmallScene::SmallScene(int num_frames) {
  std::filesystem::create_directories(path() + "/depth");
  write("mesh.obj", boxObj());
  DepthRenderer renderer(loadMesh(file("mesh.obj")));
  nlohmann::json cameras, truths, controls;
  for (int k = 0; k < num_frames; ++k) {
    cv::Mat depth(kHeight, kWidth, CV_16UC1, cv::Scalar(kWallMm));
    for (const CoveredPixel& pixel : renderer.render(truth(k), camera())) {
      depth.at<std::uint16_t>(pixel.row, pixel.col) = static_cast<std::uint16_t>(std::lround(1e3f * pixel.depth));
    }
    cv::imwrite(picture(k), depth);
    const std::string key = std::to_string(k);
    cameras[key] = {{"cam_K", {140, 0, 79.5, 0, 140, 59.5, 0, 0, 1}}, {"depth_scale", 1.0}, {"timestamp", k / 30.0}};
    truths[key] = {poseJson(truth(k))};
    controls[key] = {{"grasped", true}, {"linear", {0.01 * k, 0.0, 0.0}}, {"angular", {0.0, 0.0, 0.02 * k}}};
  }
  write("scene_camera.json", cameras.dump());
  write("scene_gt.json", truths.dump());
  write("scene_control.json", controls.dump());
  write("init.json", poseJson(truth(0)).dump());
}

std::string SmallScene::picture(int frame) const {
  char name[40];
  std::snprintf(name, sizeof(name), "depth/%06d.png", frame);
  return file(name);
}

void SmallScene::write(const std::string& name, const std::string& content) const {
  std::ofstream(file(name), std::ios::binary) << content;
}

void SmallScene::writePicture(int frame, int width, int height, int bits, int channels) const {
  cv::imwrite(picture(frame),
              cv::Mat(height, width, CV_MAKETYPE(bits == 16 ? CV_16U : CV_8U, channels), cv::Scalar::all(200)));
}

std::string SmallScene::read(const std::string& name) const {
  return slurp(file(name));
}

std::string replaceFirst(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  if (at == std::string::npos) throw std::runtime_error("\"" + from + "\" is not in the text");
  return text.replace(at, from.size(), to);
}

ProgramRun runProgram(const std::string& program, const std::vector<std::string>& arguments) {
  const TemporaryFolder folder;
  const std::string out = (folder.path() / "out").string();
  const std::string err = (folder.path() / "err").string();
  std::string command = "'" + program + "'";
  for (const std::string& argument : arguments) command += " '" + argument + "'";
  const int status = std::system((command + " >" + out + " 2>" + err).c_str());
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, slurp(out), slurp(err)};
}

}  // namespace depth_object_tracker
