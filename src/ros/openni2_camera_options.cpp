// SPDX-License-Identifier: BSD-3-Clause
#include "depth_object_tracker/ros/openni2_camera_options.h"

#include "depth_object_tracker/ros/option_reader.h"

#include <XmlRpcValue.h>

#include <algorithm>
#include <cmath>

namespace depth_object_tracker {
namespace {

/// A serial number that a launch file or YAML takes for a number is meant as text.
void readDevice(const ros::NodeHandle& node, OpenNI2CameraOptions& options) {
  XmlRpc::XmlRpcValue value;
  if (!node.getParam("device", value)) return;
  if (value.getType() == XmlRpc::XmlRpcValue::TypeInt) {
    options.camera.device = std::to_string(static_cast<int>(value));
  } else if (value.getType() == XmlRpc::XmlRpcValue::TypeString) {
    options.camera.device = static_cast<std::string>(value);
  } else {
    options.problems.push_back("parameter '" + node.resolveName("device") +
                               "' must be text: a URI, a serial number (with str: before it in a launch file) or the "
                               "path of an .oni recording");
  }
}

void readWholeNumber(OptionReader& reader, const std::string& key, int high, int& option) {
  double number = option;
  reader.readNumber(key, 1.0, high, number);
  option = static_cast<int>(std::lround(std::min(std::max(number, 1.0), static_cast<double>(high))));
}

}  // namespace

OpenNI2CameraOptions loadOpenNI2CameraOptions(const ros::NodeHandle& private_node) {
  OpenNI2CameraOptions options;
  readDevice(private_node, options);
  OptionReader reader(private_node, options.problems);
  std::string paths_from;
  reader.read("paths_from", "the path of a folder", paths_from);
  if (isRecording(options.camera.device)) options.camera.device = pathFrom(paths_from, options.camera.device);
  readWholeNumber(reader, "width", 4096, options.camera.mode.width);
  readWholeNumber(reader, "height", 4096, options.camera.mode.height);
  readWholeNumber(reader, "fps", 1000, options.camera.mode.fps);
  reader.read("registration", "true or false", options.camera.registration);
  reader.read("loop", "true or false", options.camera.loop);
  reader.readNumber("playback_speed", 0.0, 1000.0, options.camera.playback_speed);
  reader.read("camera_name", "a word", options.camera_name);
  reader.read("camera_info_url", "a URL", options.camera_info_url);
  reader.read("depth_frame_id", "the name of a frame", options.depth_frame_id);
  reader.read("rgb_frame_id", "the name of a frame", options.rgb_frame_id);
  reader.read("parent_frame_id", "the name of a frame", options.parent_frame_id);
  reader.readNumber("time_offset_s", -1.0, 1.0, options.time_offset_s);
  return options;
}

}  // namespace depth_object_tracker
