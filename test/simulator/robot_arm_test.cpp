// SPDX-License-Identifier: BSD-3-Clause
// The simulated robot: what it does, and what it believes.
#include "depth_object_tracker/simulator/robot_arm.h"

#include "depth_object_tracker/geometry/mesh_loader.h"
#include "depth_object_tracker/robot/robot_model.h"
#include "depth_object_tracker/simulator/scene_simulator.h"
#include "depth_object_tracker/simulator/static_world.h"
#include "random_pose.h"

#include <gtest/gtest.h>

namespace depth_object_tracker {
namespace {

SimulationConfig armConfig(Scenario scenario) {
  SimulationConfig config;
  config.scenario = scenario;
  config.seed = 5;
  config.robot_urdf = std::string(PROJECT_SOURCE_FOLDER) + "/config/robots/arm.urdf";
  return config;
}

TriangleMesh mug() {
  return loadMesh(std::string(PROJECT_SOURCE_FOLDER) + "/meshes/mug.obj");
}

TEST(SimulatedRobot, BelievesItsEncodersAndIsWrongByCentimetres) {
  SceneSimulator simulator(mug(), armConfig(Scenario::kRobot));
  ASSERT_NE(simulator.robot(), nullptr);
  RobotArm& robot = *simulator.robot();
  double sum = 0.0, changed = 0.0;
  int count = 0;
  const auto errorAt = [&](double t_s) {
    return Eigen::Vector3d(robot.believed(t_s).translation() - robot.held(t_s).translation());
  };
  for (double t_s = 0.0; t_s < 10.0; t_s += 0.1, ++count) {
    sum += errorAt(t_s).norm();
    changed = std::max(changed, (errorAt(t_s) - errorAt(0.0)).norm());
  }
  EXPECT_GT(sum / count, 0.010);
  EXPECT_LT(sum / count, 0.025);
  EXPECT_GT(changed, 0.005);  // not just an offset that a grasp would hide
}

TEST(SimulatedRobot, PublishedJointsAreThoseItBelieves) {
  const SimulationConfig config = armConfig(Scenario::kSlip);
  SceneSimulator simulator(mug(), config);
  RobotArm& robot = *simulator.robot();
  const LinkChain hand = RobotModel::fromFile(config.robot_urdf).chainTo(RobotArm::kHandLink);
  const auto handAt = [&](double t_s) {
    const SimulatedJoints joints = robot.joints(t_s);
    EXPECT_EQ(joints.names.size(), 11u);  // seven of the arm, four of the hand
    EXPECT_EQ(joints.positions.size(), joints.names.size());
    EXPECT_EQ(joints.velocities.size(), joints.names.size());
    return hand.pose(Eigen::Map<const Eigen::VectorXd>(joints.positions.data(), 7));
  };
  // The object moves with the believed hand as if it were part of it.
  const Pose T_camera_base = makeCameraMount(config).T_world_camera().inverse() * robot.T_world_base();
  const Pose T_hand_object = (T_camera_base * handAt(0.0)).inverse() * robot.believed(0.0);
  for (const double t_s : {0.5, 1.7, 3.1}) {
    EXPECT_LT(largestDifference(T_camera_base * handAt(t_s) * T_hand_object, robot.believed(t_s)), 1e-9);
    const SimulatedJoints before = robot.joints(t_s - 1e-3), at = robot.joints(t_s), after = robot.joints(t_s + 1e-3);
    for (std::size_t k = 0; k < at.names.size(); ++k) {
      EXPECT_NEAR((after.positions[k] - before.positions[k]) / 2e-3, at.velocities[k], 1e-6) << at.names[k];
    }
  }
}

TEST(SimulatedRobot, IsTheSameForTheSameSeedInWhateverOrderItIsAsked) {
  SceneSimulator one(mug(), armConfig(Scenario::kRobot)), other(mug(), armConfig(Scenario::kRobot));
  const Pose late = one.robot()->held(4.0);
  EXPECT_EQ(largestDifference(one.robot()->held(1.0), other.robot()->held(1.0)), 0.0);
  EXPECT_EQ(largestDifference(late, other.robot()->held(4.0)), 0.0);
  for (const double t_s : {0.0, 0.1, 0.2}) {
    EXPECT_EQ(one.render(t_s).depth_mm, other.render(t_s).depth_mm);
  }
}

TEST(SimulatedRobot, TheControlIsTheBelievedMotionAndTheObjectIsSeen) {
  SceneSimulator simulator(mug(), armConfig(Scenario::kRobot));
  Pose previous = Pose::Identity();
  for (int k = 0; k < 30; ++k) {
    const SimulatedFrame& frame = simulator.render(k / 30.0);
    ASSERT_TRUE(frame.control);
    EXPECT_GT(frame.visibleFraction(), 0.2);
    EXPECT_LT(largestDifference(frame.T_camera_object, simulator.truth(k / 30.0)), 1e-12);
    if (k > 0) {
      Vector6d moved;
      moved << frame.control->linear_m_s / 30.0, frame.control->angular_rad_s / 30.0;
      EXPECT_LT(largestDifference(perturb(previous, moved), frame.T_camera_object), 0.002);
    }
    previous = frame.T_camera_object;
  }
}

TEST(SimulatedRobot, SaysWhenItsUrdfCannotBeUsed) {
  SimulationConfig config = armConfig(Scenario::kRobot);
  config.robot_urdf = "/nowhere/arm.urdf";
  EXPECT_THROW(SceneSimulator(mug(), config), std::runtime_error);
}

}  // namespace
}  // namespace depth_object_tracker
