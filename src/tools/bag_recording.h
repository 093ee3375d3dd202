// SPDX-License-Identifier: BSD-3-Clause
// A rosbag as the tracker's input: which topics matter, camera_info of every image, the truth.
#pragma once

#include "depth_object_tracker/geometry/pose.h"

#include <rosbag/bag.h>
#include <rosbag/message_instance.h>
#include <sensor_msgs/CameraInfo.h>

#include <functional>
#include <map>
#include <optional>
#include <string>

namespace depth_object_tracker {

/// Reads what is small in a first pass; images are read one at a time.
class BagRecording {
 public:
  /// @param image_topic empty = the only depth image in the bag.
  /// @throws InputError when the file is no bag, is cut off, or leaves open which image is meant.
  BagRecording(const std::string& path, const std::string& image_topic);

  const std::string& imageTopic() const { return image_topic_; }
  const std::string& infoTopic() const { return info_topic_; }
  std::size_t numImages() const { return num_images_; }

  /// camera_info of the image's own stamp, else the newest before it, else the first; null where there is none.
  sensor_msgs::CameraInfoConstPtr infoFor(const ros::Time& stamp) const;

  /// Ground truth of the image's stamp (to the millisecond).
  std::optional<Pose> truthAt(const ros::Time& stamp) const;
  std::optional<Pose> firstTruth() const;

  /// All messages in the order in which they were recorded.
  void forEach(const std::function<void(const rosbag::MessageInstance&)>& take) const;

 private:
  void chooseImageTopic();
  void readInfosAndTruth();

  std::string path_;
  rosbag::Bag bag_;
  std::string image_topic_, info_topic_;
  std::size_t num_images_ = 0;
  std::map<ros::Time, sensor_msgs::CameraInfoConstPtr> infos_;
  std::map<ros::Time, Pose> truths_;
};

}  // namespace depth_object_tracker
