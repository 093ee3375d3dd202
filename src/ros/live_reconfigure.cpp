// SPDX-License-Identifier: BSD-3-Clause
#include "depth_object_tracker/ros/live_reconfigure.h"

#include "depth_object_tracker/tracker/live_parameters.h"
#include "depth_object_tracker/tracker/tracker_parameters.h"

#include <dynamic_reconfigure/config_tools.h>
#include <ros/console.h>

#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>
#include <variant>

namespace depth_object_tracker {
namespace {

/// The server reads its first values there, and a file may have brought them in below another name.
void writeParameters(const ros::NodeHandle& node, const TrackerConfig& config) {
  for (const std::string& name : listLiveParameters()) {
    const ParameterValue value = getTrackerParameter(config, name);
    if (const int* number = std::get_if<int>(&value)) node.setParam(name, *number);
    if (const double* number = std::get_if<double>(&value)) node.setParam(name, *number);
  }
}

}  // namespace

TrackerLiveConfig toLiveConfig(const TrackerConfig& config) {
  TrackerLiveConfig live = TrackerLiveConfig::__getDefault__();
  dynamic_reconfigure::Config message;
  live.__toMessage__(message);
  for (const std::string& name : listLiveParameters()) {
    const ParameterValue value = getTrackerParameter(config, name);
    for (auto& entry : message.ints) {
      if (entry.name == name) entry.value = std::get<int>(value);
    }
    for (auto& entry : message.doubles) {
      if (entry.name == name) entry.value = std::get<double>(value);
    }
  }
  live.__fromMessage__(message);
  return live;
}

TrackerConfig fromLiveConfig(const TrackerLiveConfig& live, const TrackerConfig& config) {
  TrackerConfig changed = config;
  dynamic_reconfigure::Config message;
  live.__toMessage__(message);
  for (const auto& entry : message.ints) setTrackerParameter(changed, entry.name, entry.value);
  for (const auto& entry : message.doubles) setTrackerParameter(changed, entry.name, entry.value);
  return changed;
}

LiveReconfigure::LiveReconfigure(const ros::NodeHandle& private_node, const TrackerConfig& config, Callback callback)
    : config_(config), callback_(std::move(callback)), node_(private_node, "tracker") {
  writeParameters(node_, config);
  server_ = std::make_unique<dynamic_reconfigure::Server<TrackerLiveConfig>>(node_);
  server_->setConfigDefault(toLiveConfig(TrackerConfig()));
  server_->setCallback([this](TrackerLiveConfig& live, std::uint32_t) { onChange(live); });
}

void LiveReconfigure::logChange(const std::string& name, const TrackerConfig& before,
                                const TrackerConfig& after) const {
  const ParameterValue old_value = getTrackerParameter(before, name), value = getTrackerParameter(after, name);
  if (old_value == value) return;
  std::ostringstream text;
  std::visit([&](const auto& held) { text << name << ": " << held; }, old_value);
  std::visit([&](const auto& held) { text << " -> " << held; }, value);
  ROS_INFO_STREAM(node_.getNamespace() << ": " << text.str());
}

void LiveReconfigure::onChange(const TrackerLiveConfig& live) {
  try {
    const TrackerConfig changed = fromLiveConfig(live, config_);
    for (const std::string& name : listLiveParameters()) logChange(name, config_, changed);
    config_ = changed;
    callback_(config_);
  } catch (const std::exception& error) {
    ROS_ERROR_STREAM(node_.getNamespace() << ": refused: " << error.what());
  }
}

}  // namespace depth_object_tracker
