// SPDX-License-Identifier: BSD-3-Clause
// depth_object_tracker/FiducialTracker: an object's pose by the AprilTags on it, beside the depth tracker for
// comparison.
#pragma once

#include "depth_object_tracker/ros/fiducial_options.h"
#include "depth_object_tracker/ros/held_motion.h"
#include "depth_object_tracker/ros/throttled_log.h"
#include "depth_object_tracker/ros/transform_feed.h"

#include <depth_object_tracker/Grasp.h>
#include <image_transport/subscriber_filter.h>
#include <message_filters/subscriber.h>
#include <message_filters/sync_policies/approximate_time.h>
#include <message_filters/sync_policies/exact_time.h>
#include <message_filters/synchronizer.h>
#include <nodelet/nodelet.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>
#include <sensor_msgs/JointState.h>
#include <tf2_ros/transform_broadcaster.h>

#include <memory>
#include <optional>
#include <string>

namespace depth_object_tracker {

/// Works in the callbacks of its node handle, one at a time. Pictures that come while one is worked on are dropped but
/// for the newest.
class FiducialTrackerNodelet : public nodelet::Nodelet {
 private:
  using Image = sensor_msgs::Image;
  using Info = sensor_msgs::CameraInfo;
  using StereoPolicy = message_filters::sync_policies::ExactTime<Image, Info, Image, Info>;
  using RgbdPolicy = message_filters::sync_policies::ApproximateTime<Image, Info, Image>;

  void onInit() override;
  void start();
  void subscribeStereo();
  void subscribeRgbd();
  void subscribeMotion();
  std::string topic(const std::string& name) const;
  void onStereo(const sensor_msgs::ImageConstPtr& left, const sensor_msgs::CameraInfoConstPtr& left_info,
                const sensor_msgs::ImageConstPtr& right, const sensor_msgs::CameraInfoConstPtr& right_info);
  void onRgbd(const sensor_msgs::ImageConstPtr& image, const sensor_msgs::CameraInfoConstPtr& info,
              const sensor_msgs::ImageConstPtr& depth);
  std::string trackStereo(const Image& left, const Info& left_info, const Image& right, const Info& right_info);
  std::string trackRgbd(const Image& image, const Info& info, const Image& depth);
  std::optional<ControlInput> controlFor(const std_msgs::Header& header);
  void publish(const std_msgs::Header& header, const std::string& problem);
  void publishPose(const std_msgs::Header& header);
  void publishStatus(const std_msgs::Header& header, const std::string& problem);

  FiducialOptions options_;
  std::optional<ThrottledLog> log_;
  std::unique_ptr<TransformFeed> tf_;
  std::unique_ptr<tf2_ros::TransformBroadcaster> tf_broadcaster_;
  std::unique_ptr<FiducialTracker> tracker_;
  HeldMotion held_motion_;
  std::string camera_frame_;
  std::optional<double> last_stamp_s_;
  ros::Publisher pose_, status_;
  ros::Subscriber grasp_subscriber_, twist_subscriber_, joint_subscriber_, command_subscriber_;
  image_transport::SubscriberFilter first_image_, second_image_;
  message_filters::Subscriber<Info> first_info_, second_info_;
  std::unique_ptr<message_filters::Synchronizer<StereoPolicy>> stereo_;
  std::unique_ptr<message_filters::Synchronizer<RgbdPolicy>> rgbd_;
};

}  // namespace depth_object_tracker
