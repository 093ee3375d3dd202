// SPDX-License-Identifier: BSD-3-Clause
#include "result_bag.h"

#include "depth_object_tracker/ros/pose_messages.h"
#include "depth_object_tracker/ros/status_builder.h"
#include "depth_object_tracker/tools/input_error.h"

#include <tf2_msgs/TFMessage.h>

namespace depth_object_tracker {
namespace {

/// "/tf" wants a stamp after 0, as do bags.
ros::Time afterZero(const ros::Time& time) {
  return std::max(time, ros::TIME_MIN);
}

}  // namespace

ResultBag::ResultBag(const std::string& path) : path_(path) {
  try {
    bag_.open(path_, rosbag::bagmode::Write);
    bag_.setCompression(rosbag::compression::LZ4);
  } catch (const rosbag::BagException& error) {
    throw InputError("cannot write " + path_ + ": " + error.what());
  }
}

void ResultBag::write(const FrameOutcome& outcome, const TrackerSession& session, const ros::Time& recorded_at) {
  ++num_received_;
  if (outcome.processed) ++num_processed_;
  if (outcome.output.problem.empty() && outcome.is_new_estimate && hasPoseToTell(outcome.result)) {
    writePose(outcome, session.object().name, afterZero(recorded_at));
  }
  StatusContext context;
  context.header = session.lastHeader();
  context.object_name = session.object().name;
  context.grasped = session.grasped();
  FrameStatistics statistics;
  statistics.processed = num_processed_;
  TrackerResult result = outcome.result;
  result.time.total_s = 0.0;
  bag_.write("/tracker/status", afterZero(recorded_at), buildStatus(result, context, statistics, {num_received_, 0}));
}

void ResultBag::writePose(const FrameOutcome& outcome, const std::string& object_name, const ros::Time& recorded_at) {
  std_msgs::Header header = outcome.header;
  header.frame_id = outcome.output_frame;
  const TrackerResult result = toFrame(outcome.result, outcome.output.T_target_source);
  bag_.write("/tracker/pose", recorded_at, toPoseStamped(result, header));
  if (hasTwistToTell(result)) bag_.write("/tracker/twist", recorded_at, toTwistStamped(result, header));
  if (header.frame_id.empty()) return;
  tf2_msgs::TFMessage tf;
  tf.transforms.push_back(toTransformStamped(result, header, object_name));
  bag_.write("/tf", recorded_at, tf);
}

void ResultBag::close() {
  try {
    bag_.close();
  } catch (const rosbag::BagException& error) {
    throw InputError("could not write all of " + path_ + " (is the disk full?): " + error.what());
  }
}

}  // namespace depth_object_tracker
