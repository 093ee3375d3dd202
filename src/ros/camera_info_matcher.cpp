// SPDX-License-Identifier: BSD-3-Clause
#include "depth_object_tracker/ros/camera_info_matcher.h"

namespace depth_object_tracker {

void CameraInfoMatcher::addImage(const sensor_msgs::ImageConstPtr& image) {
  if (waiting_.image) {  // the previous image's camera_info never came
    stamps_match_ = false;
    flushWaiting(infos_.empty() ? nullptr : infos_.back());
  }
  last_image_stamp_ = image->header.stamp;
  waiting_ = {image, nullptr, std::chrono::steady_clock::now()};
  if (const auto info = findInfo(image->header.stamp)) {
    stamps_match_ = true;
    flushWaiting(info);
  } else if (!stamps_match_) {
    flushWaiting(infos_.empty() ? nullptr : infos_.back());
  }
}

void CameraInfoMatcher::addInfo(const sensor_msgs::CameraInfoConstPtr& info) {
  infos_.push_back(info);
  if (infos_.size() > kKeptInfos) infos_.pop_front();
  if (info->header.stamp != last_image_stamp_) return;
  stamps_match_ = true;
  if (waiting_.image) flushWaiting(info);
}

sensor_msgs::CameraInfoConstPtr CameraInfoMatcher::findInfo(const ros::Time& stamp) const {
  for (auto info = infos_.rbegin(); info != infos_.rend(); ++info) {
    if ((*info)->header.stamp == stamp) return *info;
  }
  return nullptr;
}

void CameraInfoMatcher::flushWaiting(const sensor_msgs::CameraInfoConstPtr& info) {
  CameraFrame frame;
  std::swap(frame, waiting_);
  frame.info = info;
  output_(std::move(frame));
}

}  // namespace depth_object_tracker
