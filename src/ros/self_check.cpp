// SPDX-License-Identifier: BSD-3-Clause
#include "depth_object_tracker/ros/self_check.h"

namespace depth_object_tracker {
namespace {

constexpr int kFirstImages = 5;
constexpr std::chrono::seconds kPeriod{1};

bool isPart(const sensor_msgs::CameraInfo& info) {
  return info.roi.width != 0 && info.roi.height != 0 &&
         (info.roi.width != info.width || info.roi.height != info.height);
}

/// Pixels of an image that was binned in one direction more than in the other are not square, and that is right.
bool isBinnedUnevenly(const sensor_msgs::CameraInfo& info) {
  return std::max(1u, info.binning_x) != std::max(1u, info.binning_y);
}

}  // namespace

void SelfCheck::restart() {
  num_looks_ = 0;
  mesh_is_odd_ = false;
  input_findings_.clear();
  pose_findings_.clear();
}

bool SelfCheck::look(const CameraFrame& frame, const DepthImageView& depth, const PinholeCamera& camera,
                     const ObjectTracker* tracker) {
  const Clock::time_point now = frame.received_at;
  if (num_looks_ >= kFirstImages && now - last_look_ < kPeriod) return false;
  last_look_ = now;
  ++num_looks_;
  input_findings_.clear();
  const std::string about_image = "image on '" + image_topic_ + "' ",
                    about_info = "camera_info on '" + info_topic_ + "': ";

  const double max_depth_m = tracker != nullptr ? tracker->config().pixel.max_depth_m : PixelModelConfig().max_depth_m;
  const DepthSummary summary = summariseDepth(depth, max_depth_m);
  const InputFindings depth_findings = checkDepth(summary, depth.pixel_type, max_depth_m);
  for (const InputFinding& finding : depth_findings) input_findings_.push_back(about_image + finding.message);
  for (const InputFinding& finding : checkCamera(camera, isPart(*frame.info))) {
    if (finding.kind == InputFinding::Kind::kPixelAspect && isBinnedUnevenly(*frame.info)) continue;
    input_findings_.push_back(about_info + finding.message);
  }
  const std::string &image_frame = frame.image->header.frame_id, &info_frame = frame.info->header.frame_id;
  if (!image_frame.empty() && !info_frame.empty() && image_frame != info_frame) {
    input_findings_.push_back(about_image + "has frame_id '" + image_frame + "', but the camera_info on '" +
                              info_topic_ + "' has '" + info_frame +
                              "': do they belong to one camera? The image's is used");
  }
  mesh_is_odd_ = false;
  if (tracker == nullptr || !depth_findings.empty()) return true;  // odd depths say nothing about sizes
  for (const InputFinding& finding : checkMeshSize(tracker->diameterM(), summary, camera)) {
    mesh_is_odd_ = true;
    input_findings_.push_back("object '" + tracker->object().name + "': " + finding.message);
  }
  return true;
}

void SelfCheck::lookAtPose(const Pose& T_camera_object, const DepthImageView& depth, const PinholeCamera& camera,
                           const ObjectTracker& tracker) {
  pose_findings_.clear();
  if (mesh_is_odd_) return;  // no pose of it makes sense
  for (const InputFinding& finding :
       checkInitialPose(tracker.object().mesh, tracker.diameterM(), T_camera_object, depth, camera)) {
    pose_findings_.push_back(finding.message);
  }
}

std::vector<std::string> SelfCheck::findings() const {
  std::vector<std::string> all = input_findings_;
  all.insert(all.end(), pose_findings_.begin(), pose_findings_.end());
  return all;
}

std::string describeMissingParent(const std::string& camera_frame, const tf2::BufferCore& tf) {
  std::string parent;
  if (camera_frame.empty() || tf._getParent(camera_frame, ros::Time(), parent)) return "";
  return "tf knows no parent of the camera's frame '" + camera_frame +
         "': poses in that frame are right, but only rviz with this Fixed Frame can show them; publish where the "
         "camera "
         "is, for example with static_transform_publisher";
}

}  // namespace depth_object_tracker
