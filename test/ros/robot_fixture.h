// SPDX-License-Identifier: BSD-3-Clause
// A running tracker and a robot whose joints and tf a test publishes.
#pragma once

#include "swinging_arm.h"
#include "tracker_harness.h"

#include <depth_object_tracker/SetGrasp.h>
#include <depth_object_tracker/Slip.h>
#include <gtest/gtest.h>
#include <tf2_ros/transform_broadcaster.h>

#include <fstream>
#include <iterator>
#include <memory>
#include <string>
#include <vector>

namespace depth_object_tracker {

constexpr double kBeginS = 1000.0;
constexpr double kJointPeriodS = 0.004;

class RobotFixture : public testing::Test {
 protected:
  RobotFixture() : arm_(kBeginS), joints_(node_.advertise<sensor_msgs::JointState>("/joint_states", 1000)) {}

  static std::string trackerName() {
    return std::string("/") + testing::UnitTest::GetInstance()->current_test_info()->name();
  }

  template <typename Value>
  static void setParameter(const std::string& key, const Value& value) {
    ros::param::set(trackerName() + "/" + key, value);
  }

  /// Every test has a tracker of its own: what one has heard is not what the other knows.
  void start(const std::string& urdf) {
    const std::string name = trackerName();
    setGoodParameters(name);
    ros::param::set(name + "/robot", true);
    ros::param::set(name + "/control_wait_s", 1.0);
    ros::param::set("/robot_description", urdf);
    harness_ = std::make_unique<TrackerHarness>(name);
    ASSERT_TRUE(harness_->isReady());
    slips_ = std::make_unique<Recorder<Slip>>(node_, name + "/slip");
    corrections_ =
        std::make_unique<Recorder<geometry_msgs::PoseWithCovarianceStamped>>(node_, name + "/kinematic_correction");
    ASSERT_TRUE(waitUntil(
        [&] { return slips_->isConnected() && corrections_->isConnected() && joints_.getNumSubscribers() > 0; }));
    harness_->setStamp(ros::Time(kBeginS));
    ASSERT_TRUE(harness_->initialise(arm_.T_camera_object(kBeginS)));
  }

  static std::string armText() {
    std::ifstream file(armFile());
    return {std::istreambuf_iterator<char>(file), {}};
  }

  SetGrasp::Response grasp(const std::string& link) {
    SetGrasp call;
    call.request.grasped = !link.empty();
    call.request.link = link;
    EXPECT_TRUE(ros::service::call(harness_->name() + "/set_grasp", call));
    return call.response;
  }

  double nextStamp() const { return harness_->stamp().toSec() + 1.0 / 30.0; }

  void publishJoints(double until_s, const std::string& prefix = "") {
    for (; joints_until_s_ < until_s + kJointPeriodS; joints_until_s_ += kJointPeriodS) {
      sensor_msgs::JointState message = arm_.jointStates(joints_until_s_);
      for (std::string& name : message.name) name = prefix + name;
      joints_.publish(message);
    }
  }

  /// @param T_camera_world the camera may have moved since the beginning.
  void publishTf(double stamp_s, const Pose& T_camera_world = Pose::Identity()) {
    geometry_msgs::TransformStamped transform = arm_.cameraTransform();
    transform.header.stamp = ros::Time(stamp_s);
    transform.transform = toTransformMessage((T_camera_world * arm_.T_camera_base()).inverse());
    broadcaster_.sendTransform(transform);
  }

  /// One image with its joints and tf. @return how far off the pose is.
  double step(const Pose& T_hand_slipped = Pose::Identity(), const Pose& T_camera_world = Pose::Identity()) {
    const double stamp_s = nextStamp();
    publishJoints(stamp_s);
    publishTf(stamp_s, T_camera_world);
    return stepImage(T_camera_world * arm_.T_camera_hand(stamp_s) * T_hand_slipped * arm_.T_hand_object());
  }

  double stepImage(const Pose& T_camera_object) {
    last_status_ = harness_->step(T_camera_object);
    if (!waitUntil([&] {
          return harness_->poses().newest() && harness_->poses().newest()->header.stamp == harness_->stamp();
        })) {
      ADD_FAILURE() << "no pose at " << harness_->stamp() << ": " << last_status_.reason;
      return 1.0;
    }
    const auto& p = harness_->poses().newest()->pose.pose.position;
    return (Eigen::Vector3d(p.x, p.y, p.z) - T_camera_object.translation()).norm();
  }

  /// The hand carries the object on, and nothing of it is seen. @return how far off the pose is in the end.
  double stepUnseen() {
    const Pose T_camera_object = arm_.T_camera_object(nextStamp());
    harness_->setStamp(ros::Time(nextStamp()));
    const std::vector<float> nothing(static_cast<std::size_t>(testCamera().width) * testCamera().height, 0.0f);
    last_status_ = harness_->send(makeUint16Image(nothing, testCamera().width, testCamera().height));
    if (!waitUntil([&] {
          return harness_->poses().newest() && harness_->poses().newest()->header.stamp == harness_->stamp();
        })) {
      ADD_FAILURE() << "no pose at " << harness_->stamp() << ": " << last_status_.reason;
      return 1.0;
    }
    const auto& p = harness_->poses().newest()->pose.pose.position;
    return (Eigen::Vector3d(p.x, p.y, p.z) - T_camera_object.translation()).norm();
  }

  double travelledM(double from_s, double to_s) const {
    return (arm_.T_camera_object(to_s).translation() - arm_.T_camera_object(from_s).translation()).norm();
  }

  void settle() {
    for (int k = 0; k < 10; ++k) step();
    EXPECT_LT(step(), 0.003);
  }

  ros::NodeHandle node_;
  SwingingArm arm_;
  ros::Publisher joints_;
  tf2_ros::TransformBroadcaster broadcaster_;
  std::unique_ptr<TrackerHarness> harness_;
  std::unique_ptr<Recorder<Slip>> slips_;
  std::unique_ptr<Recorder<geometry_msgs::PoseWithCovarianceStamped>> corrections_;
  TrackerStatus last_status_;
  double joints_until_s_ = kBeginS - 0.1;
};

}  // namespace depth_object_tracker
