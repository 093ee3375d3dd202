// SPDX-License-Identifier: BSD-3-Clause
#include "depth_object_tracker/robot/robot_state.h"

#include "random_pose.h"
#include "test_robots.h"

#include <gtest/gtest.h>

#include <cmath>

namespace depth_object_tracker {
namespace {

constexpr double kBeginS = 50.0;

// An arm that swings; joints 1 to 3 and 4 to 7 come from two publishers.
class RobotStateTest : public testing::Test {
 protected:
  static double angle(int joint, double t_s) { return 0.3 * joint + 0.4 * std::sin((1.0 + 0.3 * joint) * t_s); }
  static double rate(int joint, double t_s) { return 0.4 * (1.0 + 0.3 * joint) * std::cos((1.0 + 0.3 * joint) * t_s); }

  static JointReport report(int first, int last, double t_s, bool with_positions, bool with_velocities) {
    JointReport report;
    report.stamp_s = t_s;
    for (int joint = last; joint >= first; --joint) {
      report.names.push_back("joint_" + std::to_string(joint));
      if (with_positions) report.positions.push_back(angle(joint, t_s));
      if (with_velocities) report.velocities.push_back(rate(joint, t_s));
    }
    return report;
  }

  static void feed(RobotState& state, double until_s, bool with_velocities = true) {
    for (double t_s = kBeginS; t_s < until_s; t_s += 0.004) {
      EXPECT_EQ(state.addJointStates(report(1, 3, t_s, true, with_velocities)), "");
      EXPECT_EQ(state.addJointStates(report(4, 7, t_s + 0.001, true, with_velocities)), "");
    }
  }

  static RobotStateConfig configured(ControlSource source) {
    RobotStateConfig config;
    config.control_source = source;
    return config;
  }

  Pose truth(double t_s) const {
    Eigen::VectorXd positions(7);
    for (int joint = 1; joint <= 7; ++joint) positions[joint - 1] = angle(joint, t_s);
    return model_.chainTo("hand_link").pose(positions);
  }

  RobotModel model_ = RobotModel::fromFile(armFile());
};

TEST_F(RobotStateTest, KnowsTheHandsPoseAndMotionAtAnyTime) {
  for (const ControlSource source : {ControlSource::kMeasured, ControlSource::kVelocities}) {
    RobotState state(model_, configured(source));
    feed(state, kBeginS + 1.0);
    const double from_s = kBeginS + 0.5017, to_s = from_s + 0.0331;
    const LinkMotion motion = state.linkMotion("hand_link", from_s, to_s);
    ASSERT_EQ(motion.problem, "");
    EXPECT_LT(largestDifference(motion.T_root_link_from, truth(from_s)), 1e-8);
    EXPECT_LT(largestDifference(motion.T_root_link_to, truth(to_s)), 1e-6);
    EXPECT_LT(largestDifference(state.linkPose("hand_link", to_s).T_root_link, truth(to_s)), 1e-8);
  }
}

TEST_F(RobotStateTest, DifferentiatesPositionsWhereVelocitiesAreMissing) {
  RobotState state(model_, configured(ControlSource::kVelocities));
  feed(state, kBeginS + 1.0, false);
  const LinkMotion motion = state.linkMotion("hand_link", kBeginS + 0.5, kBeginS + 0.53);
  ASSERT_EQ(motion.problem, "");
  EXPECT_LT(largestDifference(motion.T_root_link_to, truth(kBeginS + 0.53)), 1e-5);
}

TEST_F(RobotStateTest, IntegratesCommands) {
  RobotState state(model_, configured(ControlSource::kCommands));
  feed(state, kBeginS + 1.0);
  const double from_s = kBeginS + 0.5, to_s = kBeginS + 0.53;
  const LinkMotion missing = state.linkMotion("hand_link", from_s, to_s);
  EXPECT_NE(missing.problem.find("joint_commands: joint 'joint_1' was never reported"), std::string::npos)
      << missing.problem;
  for (double t_s = from_s - 0.05; t_s < to_s; t_s += 0.004) {
    state.addCommands(report(1, 7, t_s, false, true));
  }
  const LinkMotion motion = state.linkMotion("hand_link", from_s, to_s);
  ASSERT_EQ(motion.problem, "");
  EXPECT_LT(largestDifference(motion.T_root_link_to, truth(to_s)), 2e-3);  // each holds for 4 ms
  EXPECT_LT(largestDifference(motion.T_root_link_from, truth(from_s)), 1e-8);
}

TEST_F(RobotStateTest, ReadsTheJointsAtTheirOwnClock) {
  RobotStateConfig config;
  config.joint_time_offset_s = 0.02;
  RobotState state(model_, config);
  feed(state, kBeginS + 1.0);
  EXPECT_LT(largestDifference(state.linkPose("hand_link", kBeginS + 0.5).T_root_link, truth(kBeginS + 0.52)), 1e-8);
}

TEST_F(RobotStateTest, NamesJointsThatAreMissingOrStale) {
  RobotState state(model_, RobotStateConfig());
  state.addJointStates(report(1, 3, kBeginS, true, true));
  state.addJointStates(report(5, 7, kBeginS + 0.7, true, true));
  const std::string problem = state.linkPose("hand_link", kBeginS + 0.7).problem;
  EXPECT_NE(problem.find("joint 'joint_4' was never reported"), std::string::npos) << problem;
  EXPECT_NE(problem.find("joint 'joint_2' was last reported 0.70 s before"), std::string::npos) << problem;
  EXPECT_EQ(problem.find("joint 'joint_6'"), std::string::npos) << problem;
  EXPECT_NE(problem.find("joint_states name 'joint_1'"), std::string::npos) << problem;  // for typing errors
  EXPECT_EQ(state.linkPose("base_link", kBeginS).problem, "");
}

TEST_F(RobotStateTest, WaitsForJointsThatAreComing) {
  RobotState state(model_, RobotStateConfig());
  EXPECT_FALSE(state.awaitsJoints("hand_link", kBeginS));  // nobody reports
  feed(state, kBeginS + 0.5);
  EXPECT_FALSE(state.awaitsJoints("hand_link", kBeginS + 0.49));
  EXPECT_TRUE(state.awaitsJoints("hand_link", kBeginS + 0.51));
  EXPECT_FALSE(state.awaitsJoints("hand_link", kBeginS + 1.0));  // the stream has ended
  state.forget();
  EXPECT_NE(state.linkPose("hand_link", kBeginS + 0.4).problem, "");
}

TEST(ControlSource, HasNames) {
  EXPECT_EQ(controlSourceFromName("commands"), ControlSource::kCommands);
  EXPECT_THROW(controlSourceFromName("guess"), std::invalid_argument);
}

}  // namespace
}  // namespace depth_object_tracker
