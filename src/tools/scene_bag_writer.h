// SPDX-License-Identifier: BSD-3-Clause
// Writes a BOP scene as a rosbag, as a depth camera and a robot would have sent it.
#pragma once

#include "depth_object_tracker/tools/bop_scene.h"
#include "depth_object_tracker/tools/depth_picture.h"

#include <rosbag/bag.h>

#include <cstdint>
#include <optional>
#include <string>

namespace depth_object_tracker {

/// What the conversion to whole millimetres cost.
struct RoundingLoss {
  std::uint64_t readings = 0;
  std::uint64_t out_of_range = 0;  ///< below 0.5 mm or above 65.535 m: written as "no reading"
  double sum_mm = 0.0;
  double max_mm = 0.0;
};

class SceneBagWriter {
 public:
  static constexpr const char* kFrame = "camera_depth_optical_frame";
  /// ROS takes stamp 0 for "no stamp": scenes that count from 0 are moved here [s].
  static constexpr std::int64_t kEpochS = 1000000000;

  /// Creates the bag with lz4 chunks. @throws rosbag::BagException
  SceneBagWriter(const std::string& path, double first_stamp_s);

  /// Messages of one frame, in the order in which a robot and its camera send them.
  void write(const SceneFrame& frame, const DepthPicture& picture, const PinholeCamera& camera);

  void close() { bag_.close(); }
  const RoundingLoss& loss() const { return loss_; }

 private:
  ros::Time toTime(double stamp_s) const;
  void writeGrasp(const SceneFrame& frame, const ros::Time& stamp);
  void writeTwist(const SceneFrame& frame, const ros::Time& stamp);
  void writeImage(const SceneFrame& frame, const DepthPicture& picture, const ros::Time& stamp);
  std::uint16_t toMillimetres(std::uint16_t count, double unit_mm);

  rosbag::Bag bag_;
  std::int64_t epoch_s_;
  std::optional<bool> last_grasped_;
  RoundingLoss loss_;
};

}  // namespace depth_object_tracker
