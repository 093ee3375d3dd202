// SPDX-License-Identifier: BSD-3-Clause
// pose_marker: shows an object's mesh in rviz at the poses of a topic, such as the ground truth beside the estimate.
#include "depth_object_tracker/ros/object_source.h"

#include <geometry_msgs/PoseStamped.h>
#include <ros/ros.h>
#include <visualization_msgs/Marker.h>

#include <exception>

namespace dot = depth_object_tracker;

namespace {

/// rviz reads the mesh file itself: the messages stay small.
visualization_msgs::Marker makeMarker(const std::string& object) {
  const auto has_suffix = [&](const std::string& suffix) {
    return object.size() > suffix.size() && object.compare(object.size() - suffix.size(), suffix.size(), suffix) == 0;
  };
  dot::ObjectDescription description;
  if (has_suffix(".yaml") || has_suffix(".yml")) {
    description = dot::loadObjectDescription(dot::resolveMeshUri(object, dot::findPackage));
  } else {
    description.mesh = object;
  }
  visualization_msgs::Marker marker;
  marker.ns = "pose_marker";
  marker.type = visualization_msgs::Marker::MESH_RESOURCE;
  marker.mesh_resource = "file://" + dot::resolveMeshUri(description.mesh, dot::findPackage);
  marker.scale.x = marker.scale.y = marker.scale.z = description.mesh_scale;
  marker.color.r = marker.color.g = marker.color.b = 1.0f;
  marker.color.a = 0.35f;
  return marker;
}

int run() {
  ros::NodeHandle node, private_node("~");
  visualization_msgs::Marker marker = makeMarker(private_node.param<std::string>("object", ""));
  const ros::Publisher publisher = private_node.advertise<visualization_msgs::Marker>("marker", 2);
  const boost::function<void(const geometry_msgs::PoseStampedConstPtr&)> show =
      [&](const geometry_msgs::PoseStampedConstPtr& pose) {
        if (publisher.getNumSubscribers() == 0) return;
        marker.header = pose->header;
        marker.pose = pose->pose;
        publisher.publish(marker);
      };
  const ros::Subscriber subscriber = node.subscribe<geometry_msgs::PoseStamped>("pose", 2, show);
  ros::spin();
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  ros::init(argc, argv, "pose_marker");
  try {
    return run();
  } catch (const std::exception& error) {
    ROS_FATAL_STREAM("pose_marker: ~object: " << error.what());
    return 1;
  }
}
