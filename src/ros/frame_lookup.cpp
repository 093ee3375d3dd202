// SPDX-License-Identifier: BSD-3-Clause
#include "depth_object_tracker/ros/frame_lookup.h"

#include "depth_object_tracker/ros/message_conversions.h"

#include <tf2/exceptions.h>

#include <sstream>
#include <thread>

namespace depth_object_tracker {
namespace {

constexpr double kLiveTransformAgeS = 1.0;  // a stream of transforms that is older than this has ended
constexpr std::chrono::milliseconds kPollPeriod{1};

/// True when transforms between the frames come, only not up to the stamp yet.
bool isOnItsWay(const tf2::BufferCore& tf, const std::string& target, const std::string& source,
                const ros::Time& stamp) {
  try {
    const ros::Time newest = tf.lookupTransform(target, source, ros::Time(0)).header.stamp;
    return newest < stamp && (stamp - newest).toSec() < kLiveTransformAgeS;
  } catch (const tf2::TransformException&) {
    return false;
  }
}

}  // namespace

FrameLookup lookUpFrame(const tf2::BufferCore& tf, const std::string& target, const std::string& source,
                        const ros::Time& stamp, std::chrono::steady_clock::time_point deadline) {
  FrameLookup found;
  if (target == source) return found;
  while (!tf.canTransform(target, source, stamp) && std::chrono::steady_clock::now() < deadline &&
         isOnItsWay(tf, target, source, stamp)) {
    std::this_thread::sleep_for(kPollPeriod);
  }
  try {
    found.T_target_source = fromTransformMessage(tf.lookupTransform(target, source, stamp).transform);
  } catch (const tf2::TransformException& error) {
    std::ostringstream problem;
    problem << "tf cannot place '" << source << "' in '" << target << "' at the image's stamp " << stamp << ": "
            << error.what();
    found.problem = problem.str();
  }
  return found;
}

TrackerResult toFrame(TrackerResult result, const Pose& T_target_camera) {
  const Eigen::Matrix3d R_target_camera = T_target_camera.linear();
  result.T_camera_object = T_target_camera * result.T_camera_object;
  result.covariance = rotated(result.covariance, R_target_camera);
  result.twist = rotated(result.twist, R_target_camera);
  result.twist_covariance = rotated(result.twist_covariance, R_target_camera);
  return result;
}

}  // namespace depth_object_tracker
