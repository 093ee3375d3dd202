// SPDX-License-Identifier: BSD-3-Clause
// The object as an rviz marker: a triangle list, or the mesh file for rviz to load.
#pragma once

#include "depth_object_tracker/ros/object_source.h"

#include <std_msgs/Header.h>
#include <visualization_msgs/MarkerArray.h>

namespace depth_object_tracker {

class MarkerBuilder {
 public:
  /// @param use_mesh_resource rviz reads the mesh file itself: textures, but it must see the same file system.
  explicit MarkerBuilder(bool use_mesh_resource) : use_mesh_resource_(use_mesh_resource) {}

  /// Copies the mesh once; the object's tracker must not be null.
  void setObject(const BuiltTracker& object);

  /// The object in one colour [0, 1], without header and pose.
  visualization_msgs::Marker ghost(float red, float green, float blue, float alpha) const;

  /// The object at its pose: green TRACKING, blue INITIALIZING, amber OCCLUDED, faint red where it was LOST. A state
  /// without a pose to show gives a deletion.
  visualization_msgs::MarkerArrayPtr build(const std_msgs::Header& header, const TrackerResult& result) const;

 private:
  bool use_mesh_resource_;
  visualization_msgs::Marker template_;
};

}  // namespace depth_object_tracker
