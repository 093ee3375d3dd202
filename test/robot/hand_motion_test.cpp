// SPDX-License-Identifier: BSD-3-Clause
#include "depth_object_tracker/robot/hand_motion.h"

#include "depth_object_tracker/model/process_model.h"
#include "random_pose.h"

#include <gtest/gtest.h>

namespace depth_object_tracker {
namespace {

// The process model must take the object exactly to where the hand takes it, whatever point the filter turns it about.
TEST(HandMotion, TheProcessCarriesTheObjectWithTheHand) {
  std::mt19937_64 engine(3);
  for (int trial = 0; trial < 50; ++trial) {
    const Pose T_camera_hand_from = randomPose(engine, 1.0), T_camera_object = randomPose(engine, 1.0);
    Vector6d moved;
    moved << randomVector(engine, 0.1), randomVector(engine, 0.3);
    const Pose T_camera_hand_to = perturb(T_camera_hand_from, moved);
    const Eigen::Translation3d centre_object(randomVector(engine, 0.2));
    const double dt_s = 1.0 / 30.0;
    const ControlInput control = carryWithHand(T_camera_hand_from, T_camera_hand_to, T_camera_object, dt_s);
    const ProcessStep step(ProcessConfig(), dt_s, control, centre_object.vector(), 1.0);
    const Pose T_hand_object = T_camera_hand_from.inverse() * T_camera_object;
    const Pose T_camera_centre = step.predict(T_camera_object * centre_object, Vector6d::Zero());
    EXPECT_LT(largestDifference(T_camera_centre, T_camera_hand_to * T_hand_object * centre_object), 1e-9);
  }
}

TEST(HandMotion, NoTimeNoMotion) {
  Pose away = Pose::Identity();
  away.translation().x() = 1.0;
  const ControlInput control = carryWithHand(Pose::Identity(), away, Pose::Identity(), 0.0);
  EXPECT_TRUE(control.grasped);
  EXPECT_TRUE(control.has_twist);
  EXPECT_EQ(control.linear_m_s.norm(), 0.0);
}

}  // namespace
}  // namespace depth_object_tracker
