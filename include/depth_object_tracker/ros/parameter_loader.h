// SPDX-License-Identifier: BSD-3-Clause
// The ROS parameters of the tracker nodelet: `~tracker/...` for the algorithm, a handful of `~...` for the nodelet
// itself.
#pragma once

#include "depth_object_tracker/ros/frame_lookup.h"
#include "depth_object_tracker/tracker/tracker_config.h"

#include <XmlRpcValue.h>
#include <ros/node_handle.h>

#include <string>
#include <vector>

namespace depth_object_tracker {

struct TrackerParameters {
  TrackerConfig config;
  std::vector<std::string> problems;  ///< one sentence each, naming key, value and valid range; empty = all good
};

/// @param value what the parameter server holds at `name`: a map from key to value; an invalid XmlRpcValue means that
/// there is
///   none, which gives the defaults.
TrackerParameters loadTrackerParameters(XmlRpc::XmlRpcValue value, const std::string& name);

/// Where the object's mesh comes from.
struct ObjectSource {
  std::string object_file;  ///< object YAML; wins over the rest
  std::string name;
  std::string mesh;         ///< `package://`, `file://` or a plain path
  double mesh_scale = 1.0;  ///< metres per unit of the mesh file
};

/// Value of ~init_file that names no file: the whole image is searched at the start.
inline constexpr const char* kSearch = "search";

struct NodeletOptions {
  ObjectSource object;
  std::string paths_from;  ///< folder that relative paths of files below are meant from; empty = the process's
  std::vector<std::string> object_folders;  ///< from which ~load_object may read, besides packages
  std::string init_file;                    ///< JSON pose at start, or kSearch; empty = wait to be told
  std::string last_pose_file;               ///< the last good pose is kept there and taken up again; empty = not
  bool interactive_marker = true;           ///< the mesh in rviz, to be dragged to the object
  std::string image_transport = "raw";
  bool publish_tf = true;
  bool publish_diagnostics = true;
  FrameOptions frames;
  bool marker_use_mesh_resource = false;  ///< rviz loads the mesh file itself, instead of a triangle list
  bool share_estimates = true;            ///< with the other trackers of this process on the same images
  bool publish_debug = false;             ///< ~debug/last_image_address
  double control_wait_s = 0.02;           ///< longest wait for the control twist that belongs to an image
  std::vector<std::string> problems;      ///< as in TrackerParameters
  std::vector<std::string> warnings;      ///< parameters that nobody reads, with the nearest that somebody does
};

NodeletOptions loadNodeletOptions(const ros::NodeHandle& private_node);

}  // namespace depth_object_tracker
