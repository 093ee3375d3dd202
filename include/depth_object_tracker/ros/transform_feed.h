// SPDX-License-Identifier: BSD-3-Clause
// The tf buffer of a nodelet, filled by a thread of its own.
#pragma once

#include <ros/callback_queue.h>
#include <ros/node_handle.h>
#include <ros/spinner.h>
#include <tf2_ros/buffer.h>
#include <tf2_ros/transform_listener.h>

#include <memory>

namespace depth_object_tracker {

/// tf2_ros::TransformListener's own thread looks for messages a hundred times a second, which costs a node that waits
/// for images half of its processor time. This one sleeps until a message comes.
class TransformFeed {
 public:
  TransformFeed();

  TransformFeed(const TransformFeed&) = delete;
  TransformFeed& operator=(const TransformFeed&) = delete;

  tf2_ros::Buffer& buffer() { return buffer_; }

 private:
  // In the order of dependence: the spinner stops before the queue and the buffer go.
  tf2_ros::Buffer buffer_;
  ros::CallbackQueue queue_;
  ros::NodeHandle node_;
  std::unique_ptr<tf2_ros::TransformListener> listener_;
  ros::AsyncSpinner spinner_;
};

}  // namespace depth_object_tracker
