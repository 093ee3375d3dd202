// SPDX-License-Identifier: BSD-3-Clause
// The fiducial tracker nodelet as a node of its own.
#include "depth_object_tracker/ros/fiducial_tracker_nodelet.h"

#include <nodelet/loader.h>
#include <nodelet/nodelet.h>
#include <ros/ros.h>
#include <boost/function.hpp>
#include <boost/make_shared.hpp>

int main(int argc, char** argv) {
  ros::init(argc, argv, "fiducial_tracker");
  ros::NodeHandle node;  // keeps the node alive until the end
  // Made here, not looked up as a plugin: the node runs wherever its executable does.
  const boost::function<boost::shared_ptr<nodelet::Nodelet>(const std::string&)> create = [](const std::string&) {
    return boost::make_shared<depth_object_tracker::FiducialTrackerNodelet>();
  };
  nodelet::Loader loader(create);
  const nodelet::V_string arguments(argv + 1, argv + argc);
  if (!loader.load(ros::this_node::getName(), "depth_object_tracker/FiducialTracker", ros::names::getRemappings(),
                   arguments))
    return 1;
  ros::spin();
  return 0;
}
