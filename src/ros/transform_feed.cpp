// SPDX-License-Identifier: BSD-3-Clause
#include "depth_object_tracker/ros/transform_feed.h"

namespace depth_object_tracker {

TransformFeed::TransformFeed() : spinner_(1, &queue_) {
  node_.setCallbackQueue(&queue_);
  listener_ = std::make_unique<tf2_ros::TransformListener>(buffer_, node_, false);
  buffer_.setUsingDedicatedThread(true);
  spinner_.start();
}

}  // namespace depth_object_tracker
