// SPDX-License-Identifier: BSD-3-Clause
// BOP scene folders: file formats.
#include "depth_object_tracker/simulator/scene_writer.h"

#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <optional>
#include <stdexcept>

namespace depth_object_tracker {
namespace {

using Json = nlohmann::ordered_json;
constexpr int kObjectId = 1;
constexpr int kNoisyCompression = 1;  // noise does not get smaller by trying longer

double roundedTo(double value, double unit) {
  return std::round(value / unit) * unit;
}

Json vectorJson(const Eigen::Vector3d& vector, double unit) {
  Json json = Json::array();
  for (int k = 0; k < 3; ++k) json.push_back(roundedTo(vector[k], unit));
  return json;
}

Json poseJson(const Pose& T_camera_object) {
  Json rotation = Json::array();
  for (int row = 0; row < 3; ++row) {
    for (int col = 0; col < 3; ++col) rotation.push_back(T_camera_object.linear()(row, col));
  }
  return {{"cam_R_m2c", rotation},
          {"cam_t_m2c", vectorJson(1000.0 * T_camera_object.translation(), 1e-6)},
          {"obj_id", kObjectId}};
}

Json modelsInfo(const ObjectModel& object) {
  const BoundingBox box = boundingBox(object.mesh);
  const Eigen::Vector3d size = box.size();
  Json info{{"diameter", diameter(object.mesh)},
            {"min_x", box.min.x()},
            {"min_y", box.min.y()},
            {"min_z", box.min.z()},
            {"size_x", size.x()},
            {"size_y", size.y()},
            {"size_z", size.z()}};
  for (const SymmetryAxis& axis : object.symmetries.continuous) {
    info["symmetries_continuous"].push_back(
        {{"axis", vectorJson(axis.axis, 1e-12)}, {"offset", vectorJson(axis.offset, 1e-12)}});
  }
  for (const Pose& pose : object.symmetries.discrete) {
    Json matrix = Json::array();
    for (int row = 0; row < 4; ++row) {
      for (int col = 0; col < 4; ++col) matrix.push_back(pose.matrix()(row, col));
    }
    info["symmetries_discrete"].push_back(matrix);
  }
  return {{std::to_string(kObjectId), info}};
}

std::string numbered(const std::filesystem::path& folder, int number) {
  char name[32];
  std::snprintf(name, sizeof(name), "%06d.png", number);
  return (folder / name).string();
}

template <typename Pixel>
void writePicture(const std::string& path, const PinholeCamera& camera, const std::vector<Pixel>& pixels,
                  int compression = 4) {
  const int type = sizeof(Pixel) == 2 ? CV_16UC1 : CV_8UC1;
  // OpenCV's constructor takes non-const memory but imwrite only reads it.
  const cv::Mat picture(camera.height, camera.width, type, const_cast<Pixel*>(pixels.data()));
  if (!cv::imwrite(path, picture, {cv::IMWRITE_PNG_COMPRESSION, compression})) {
    throw std::runtime_error("cannot write " + path);
  }
}

}  // namespace

class SceneWriter::Implementation {
 public:
  Implementation(const std::string& folder, const ObjectModel& object, const PinholeCamera& camera,
                 const Pose& T_camera_object_init, int occlusion_every);
  void addStereo(const StereoPairConfig& config, const std::string& fiducials_file);
  void add(const SimulatedFrame& frame);
  void finish();

 private:
  void createFolder(const std::string& name) const;
  std::ofstream open(const std::string& name) const;
  void writeJson(const std::string& name, const Json& json) const { open(name) << json.dump() << '\n'; }
  void writeMesh(const TriangleMesh& mesh) const;
  void addKinematics(const SimulatedFrame& frame);

  std::filesystem::path folder_;
  PinholeCamera camera_;
  std::optional<PinholeCamera> stereo_camera_;
  int occlusion_every_;
  int num_frames_ = 0;
  Json scene_camera_ = Json::object(), scene_gt_ = Json::object(), scene_control_ = Json::object();
  std::string visibility_ = "frame,object_pixels_unoccluded,object_pixels_visible,fraction_visible\n";
  std::string kinematics_ = "frame,t,px,py,pz,qw,qx,qy,qz\n";
};

SceneWriter::Implementation::Implementation(const std::string& folder, const ObjectModel& object,
                                            const PinholeCamera& camera, const Pose& T_camera_object_init,
                                            int occlusion_every)
    : folder_(folder), camera_(camera), occlusion_every_(occlusion_every) {
  for (const char* part : {"depth", "occlusion"}) createFolder(part);
  writeMesh(object.mesh);
  writeJson("models_info.json", modelsInfo(object));
  writeJson("init.json", poseJson(T_camera_object_init));
}

void SceneWriter::Implementation::createFolder(const std::string& name) const {
  std::error_code error;
  std::filesystem::create_directories(folder_ / name, error);
  if (error) throw std::runtime_error("cannot create " + (folder_ / name).string() + ": " + error.message());
}

void SceneWriter::Implementation::addStereo(const StereoPairConfig& config, const std::string& fiducials_file) {
  for (const char* part : {"stereo/left", "stereo/right"}) createFolder(part);
  std::error_code error;
  const auto copy = std::filesystem::copy_options::overwrite_existing;
  std::filesystem::copy_file(fiducials_file, folder_ / "fiducials.yaml", copy, error);
  if (error) throw std::runtime_error("cannot copy " + fiducials_file + ": " + error.message());
  const PinholeCamera& camera = config.camera;
  stereo_camera_ = camera;
  writeJson("stereo.json", {{"cam_K", {camera.fx, 0, camera.cx, 0, camera.fy, camera.cy, 0, 0, 1}},
                            {"baseline_m", config.baseline_m},
                            {"left_in_camera_m", {config.left_x_m, config.left_y_m, config.left_z_m}}});
}

std::ofstream SceneWriter::Implementation::open(const std::string& name) const {
  std::ofstream file(folder_ / name);
  if (!file) throw std::runtime_error("cannot write " + (folder_ / name).string());
  return file;
}

void SceneWriter::Implementation::writeMesh(const TriangleMesh& mesh) const {
  std::ofstream file = open("mesh.obj");
  file.precision(8);
  for (const Eigen::Vector3f& vertex : mesh.vertices) file << "v " << vertex.transpose() << '\n';
  for (const auto& triangle : mesh.triangles) {
    file << "f " << triangle[0] + 1 << ' ' << triangle[1] + 1 << ' ' << triangle[2] + 1 << '\n';
  }
}

void SceneWriter::Implementation::add(const SimulatedFrame& frame) {
  writePicture(numbered(folder_ / "depth", num_frames_), camera_, frame.depth_mm);
  if (stereo_camera_) {
    writePicture(numbered(folder_ / "stereo/left", num_frames_), *stereo_camera_, frame.left, kNoisyCompression);
    writePicture(numbered(folder_ / "stereo/right", num_frames_), *stereo_camera_, frame.right, kNoisyCompression);
  }
  if (num_frames_ % occlusion_every_ == 0) {
    writePicture(numbered(folder_ / "occlusion", num_frames_), camera_, frame.occlusion);
  }
  const std::string key = std::to_string(num_frames_);
  scene_camera_[key] = {{"cam_K", {camera_.fx, 0, camera_.cx, 0, camera_.fy, camera_.cy, 0, 0, 1}},
                        {"depth_scale", 1.0},
                        {"timestamp", roundedTo(frame.stamp_s, 1e-6)}};
  scene_gt_[key] = Json::array({poseJson(frame.T_camera_object)});
  visibility_ += key + ',' + std::to_string(frame.object_pixels) + ',' + std::to_string(frame.visible_pixels) + ',' +
                 std::to_string(frame.visibleFraction()) + '\n';
  if (frame.control) addKinematics(frame);
  ++num_frames_;
}

void SceneWriter::Implementation::addKinematics(const SimulatedFrame& frame) {
  scene_control_[std::to_string(num_frames_)] = {{"grasped", frame.control->grasped},
                                                 {"linear", vectorJson(frame.control->linear_m_s, 1e-6)},
                                                 {"angular", vectorJson(frame.control->angular_rad_s, 1e-6)},
                                                 {"slipping", frame.slipping}};
  const Pose& pose = frame.T_camera_object_kinematics;
  const Eigen::Quaterniond q(pose.linear());
  char row[256];
  std::snprintf(row, sizeof(row), "%d,%.6f,%.7f,%.7f,%.7f,%.9f,%.9f,%.9f,%.9f\n", num_frames_, frame.stamp_s,
                pose.translation().x(), pose.translation().y(), pose.translation().z(), q.w(), q.x(), q.y(), q.z());
  kinematics_ += row;
}

void SceneWriter::Implementation::finish() {
  writeJson("scene_camera.json", scene_camera_);
  writeJson("scene_gt.json", scene_gt_);
  open("visibility.csv") << visibility_;
  if (scene_control_.empty()) return;
  writeJson("scene_control.json", scene_control_);
  open("fk.csv") << kinematics_;
}

SceneWriter::SceneWriter(const std::string& folder, const ObjectModel& object, const PinholeCamera& camera,
                         const Pose& T_camera_object_init, int occlusion_every)
    : implementation_(std::make_unique<Implementation>(folder, object, camera, T_camera_object_init, occlusion_every)) {
}
SceneWriter::~SceneWriter() = default;
void SceneWriter::addStereo(const StereoPairConfig& config, const std::string& fiducials_file) {
  implementation_->addStereo(config, fiducials_file);
}
void SceneWriter::add(const SimulatedFrame& frame) {
  implementation_->add(frame);
}
void SceneWriter::finish() {
  implementation_->finish();
}

}  // namespace depth_object_tracker
