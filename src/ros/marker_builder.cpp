// SPDX-License-Identifier: BSD-3-Clause
#include "depth_object_tracker/ros/marker_builder.h"

#include "depth_object_tracker/ros/message_conversions.h"

#include <boost/make_shared.hpp>

#include <Eigen/Geometry>

namespace depth_object_tracker {
namespace {

std_msgs::ColorRGBA makeColor(float red, float green, float blue, float alpha) {
  std_msgs::ColorRGBA color;
  color.r = red;
  color.g = green;
  color.b = blue;
  color.a = alpha;
  return color;
}

/// As bright as the panel's lamp for the same state; what is not seen is fainter.
std_msgs::ColorRGBA colorOf(TrackerState state) {
  switch (state) {
    case TrackerState::kTracking:
      return makeColor(0.4f, 1.0f, 0.5f, 0.65f);
    case TrackerState::kInitializing:
      return makeColor(0.5f, 0.75f, 1.0f, 0.7f);
    case TrackerState::kOccluded:
      return makeColor(1.0f, 0.8f, 0.2f, 0.6f);
    default:
      return makeColor(1.0f, 0.3f, 0.25f, 0.4f);
  }
}

/// rviz lights the side from which the corners go clockwise; meshes go counter-clockwise seen from outside.
void addTriangles(const TriangleMesh& mesh, visualization_msgs::Marker& marker) {
  marker.points.reserve(3 * mesh.triangles.size());
  for (const auto& triangle : mesh.triangles) {
    for (const std::uint32_t index : {triangle[0], triangle[2], triangle[1]}) {
      geometry_msgs::Point point;
      point.x = mesh.vertices[index].x();
      point.y = mesh.vertices[index].y();
      point.z = mesh.vertices[index].z();
      marker.points.push_back(point);
    }
  }
}

}  // namespace

void MarkerBuilder::setObject(const BuiltTracker& object) {
  template_ = visualization_msgs::Marker();
  template_.ns = object.name;
  template_.action = visualization_msgs::Marker::ADD;
  if (use_mesh_resource_) {
    template_.type = visualization_msgs::Marker::MESH_RESOURCE;
    template_.mesh_resource = "file://" + object.mesh_file;
    template_.scale.x = template_.scale.y = template_.scale.z = object.mesh_scale;
  } else {
    template_.type = visualization_msgs::Marker::TRIANGLE_LIST;
    template_.scale.x = template_.scale.y = template_.scale.z = 1.0;
    addTriangles(object.tracker->object().mesh, template_);
  }
}

visualization_msgs::Marker MarkerBuilder::ghost(float red, float green, float blue, float alpha) const {
  visualization_msgs::Marker marker = template_;
  marker.pose.orientation.w = 1.0;
  marker.color = makeColor(red, green, blue, alpha);
  return marker;
}

visualization_msgs::MarkerArrayPtr MarkerBuilder::build(const std_msgs::Header& header,
                                                        const TrackerResult& result) const {
  auto message = boost::make_shared<visualization_msgs::MarkerArray>();
  const bool is_shown = result.has_pose && result.state != TrackerState::kUninitialized;
  if (is_shown) {
    message->markers.push_back(template_);
    message->markers[0].pose = toPoseMessage(result.T_camera_object);
    message->markers[0].color = colorOf(result.state);
  } else {
    message->markers.resize(1);
    message->markers[0].ns = template_.ns;
    message->markers[0].action = visualization_msgs::Marker::DELETE;
    message->markers[0].pose.orientation.w = 1.0;
  }
  message->markers[0].header = header;
  return message;
}

}  // namespace depth_object_tracker
