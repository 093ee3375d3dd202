// SPDX-License-Identifier: BSD-3-Clause
// dynamic_reconfigure of the parameters that may change while the tracker runs, at `~tracker/set_parameters`.
#pragma once

#include "depth_object_tracker/tracker/tracker_config.h"

#include <depth_object_tracker/TrackerLiveConfig.h>
#include <dynamic_reconfigure/server.h>
#include <ros/node_handle.h>

#include <functional>
#include <memory>
#include <string>

namespace depth_object_tracker {

/// The live parameters of a configuration, as dynamic_reconfigure has them.
TrackerLiveConfig toLiveConfig(const TrackerConfig& config);

/// `config` with the values that were set. @throws std::invalid_argument when a value is out of range.
TrackerConfig fromLiveConfig(const TrackerLiveConfig& live, const TrackerConfig& config);

class LiveReconfigure {
 public:
  using Callback = std::function<void(const TrackerConfig&)>;

  /// Offers the service; the parameter server then holds the present values, below the same names as in tracker.yaml.
  /// @param callback is told every change, on a callback thread of `private_node`.
  LiveReconfigure(const ros::NodeHandle& private_node, const TrackerConfig& config, Callback callback);

 private:
  void logChange(const std::string& name, const TrackerConfig& before, const TrackerConfig& after) const;
  void onChange(const TrackerLiveConfig& live);

  TrackerConfig config_;
  Callback callback_;
  ros::NodeHandle node_;
  std::unique_ptr<dynamic_reconfigure::Server<TrackerLiveConfig>> server_;
};

}  // namespace depth_object_tracker
