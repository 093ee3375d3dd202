// SPDX-License-Identifier: BSD-3-Clause
#include "depth_object_tracker/robot/robot_model.h"

#include "random_pose.h"
#include "reference_kinematics.h"
#include "test_robots.h"

#include <gtest/gtest.h>

#include <functional>

namespace depth_object_tracker {
namespace {

TEST(RobotModel, LinksInACircleAreRefused) {
  EXPECT_THROW(RobotModel::fromText(R"(<robot name="r"><link name="base"/><link name="x"/><link name="y"/>
      <joint name="a" type="fixed"><parent link="x"/><child link="y"/></joint>
      <joint name="b" type="fixed"><parent link="y"/><child link="x"/></joint></robot>)",
                                    "test"),
               RobotModelError);
}

std::string problemOf(const std::function<void()>& action) {
  try {
    action();
  } catch (const RobotModelError& error) {
    return error.what();
  }
  return "";
}

bool names(const std::string& text, const std::string& word) {
  return text.find("'" + word + "'") != std::string::npos;
}

void compareWithReference(const std::string& urdf, int seed) {
  const RobotModel model = RobotModel::fromText(urdf, "test");
  const ReferenceKinematics reference(urdf);
  std::mt19937_64 engine(seed);
  for (const std::string& link : model.linkNames()) {
    const LinkChain chain = model.chainTo(link);
    for (int trial = 0; trial < 100; ++trial) {
      Eigen::VectorXd positions(static_cast<Eigen::Index>(chain.joints().size()));
      std::map<std::string, double> by_name;
      for (Eigen::Index k = 0; k < positions.size(); ++k) {
        positions[k] = by_name[chain.joints()[static_cast<std::size_t>(k)]] = randomVector(engine, 3.0).x();
      }
      const Pose pose = chain.pose(positions);
      ASSERT_LT((pose.matrix() - reference.pose(link, by_name)).cwiseAbs().maxCoeff(), 1e-9) << link;
    }
  }
}

TEST(RobotModel, ForwardKinematicsAgreeWithAnIndependentComputation) {
  compareWithReference(armText(), 1);
  compareWithReference(oddRobotText(), 2);
}

TEST(RobotModel, TheTwistIsTheDerivativeOfThePose) {
  const RobotModel model = RobotModel::fromText(oddRobotText(), "test");
  const LinkChain chain = model.chainTo("follower");
  ASSERT_EQ(chain.joints(), (std::vector<std::string>{"lift", "turn", "bend"}));
  std::mt19937_64 engine(4);
  for (int trial = 0; trial < 50; ++trial) {
    const Eigen::VectorXd q = randomVector(engine, 2.0), rate = randomVector(engine, 1.0);
    constexpr double kStep = 1e-6;
    const Vector6d numeric = difference(chain.pose(q + kStep * rate), chain.pose(q - kStep * rate)) / (2.0 * kStep);
    EXPECT_LT((chain.twist(q, rate) - numeric).norm(), 1e-7);
  }
}

TEST(RobotModel, TheShippedArmHasSevenJointsAndAHandOfThreeFingers) {
  const RobotModel arm = RobotModel::fromFile(armFile());
  EXPECT_EQ(arm.rootLink(), "base_link");
  EXPECT_EQ(arm.chainTo("hand_link").joints().size(), 7u);
  EXPECT_EQ(arm.continuousJoints(), std::set<std::string>{"joint_7"});
  // Base to hand with a stretched arm, as a WAM's: 0.346 + 0.55 + 0.3 + 0.06.
  EXPECT_NEAR(arm.chainTo("hand_link").pose(Eigen::VectorXd::Zero(7)).translation().z(), 1.256, 1e-12);
  for (const char* tip : {"finger_1_distal", "finger_2_distal", "finger_3_distal"}) EXPECT_TRUE(arm.hasLink(tip));
}

TEST(RobotModel, InverseKinematicsLeadBackToThePose) {
  const RobotModel arm = RobotModel::fromFile(armFile());
  const LinkChain chain = arm.chainTo("hand_link");
  ArmSolver solver = arm.solverFor("hand_link");
  const Eigen::VectorXd bent = (Eigen::VectorXd(7) << 0.3, 0.5, -0.2, 1.4, 0.3, 0.6, -0.4).finished();
  const auto solved = solver.solve(chain.pose(bent), bent + Eigen::VectorXd::Constant(7, 0.1));
  ASSERT_TRUE(solved);
  EXPECT_LT(largestDifference(chain.pose(*solved), chain.pose(bent)), 1e-3);
  EXPECT_FALSE(solver.solve(Pose(Eigen::Translation3d(3.0, 0.0, 0.0)), bent));
}

TEST(RobotModel, GravityPullsOnAStretchedArm) {
  ArmSolver solver = RobotModel::fromFile(armFile()).solverFor("hand_link");
  EXPECT_LT(solver.gravityTorques(Eigen::VectorXd::Zero(7)).cwiseAbs()[0], 1e-9);  // about the vertical axis
  Eigen::VectorXd stretched = Eigen::VectorXd::Zero(7);
  stretched[1] = M_PI_2;
  EXPECT_GT(std::abs(solver.gravityTorques(stretched)[1]), 15.0);
}

TEST(RobotModel, SaysWhatIsWrongWithItsDescription) {
  const auto problem = [](const std::string& text) {
    return problemOf([&] { RobotModel::fromText(text, "robot_description"); });
  };
  for (const char* text : {"", "  \n", "no xml at all", "<robot", "<robot name='x'></robot>", "<sdf/>"}) {
    EXPECT_TRUE(names(problem(text), "robot_description")) << text << ": " << problem(text);
  }
  const std::string lost_parent = problem(
      "<robot name='x'><link name='a'/><joint name='j' type='fixed'><parent link='gone'/><child "
      "link='a'/></joint></robot>");
  EXPECT_NE(lost_parent.find("gone"), std::string::npos) << lost_parent;
  const std::string two_roots = problem("<robot name='x'><link name='a'/><link name='b'/></robot>");
  EXPECT_NE(two_roots.find("root"), std::string::npos) << two_roots;
  std::string circle = oddRobotText();
  circle.replace(circle.find("mimic joint=\"bend\""), 18, "mimic joint=\"follow\"");
  EXPECT_NE(problem(circle).find("mimics itself"), std::string::npos) << problem(circle);
  circle.replace(circle.find("mimic joint=\"follow\""), 20, "mimic joint=\"nobody\"");
  EXPECT_TRUE(names(problem(circle), "nobody")) << problem(circle);
  EXPECT_NE(problem("<robot xmlns:xacro=\"http://www.ros.org/wiki/xacro\"><xacro:include/></robot>").find("xacro"),
            std::string::npos);
}

TEST(RobotModel, NamesMissingFilesAndLinks) {
  EXPECT_TRUE(names(problemOf([] { RobotModel::fromFile("/nowhere/arm.urdf"); }), "/nowhere/arm.urdf"));
  const RobotModel model = RobotModel::fromText(oddRobotText(), "test");
  const std::string problem = problemOf([&] { model.chainTo("hand"); });
  EXPECT_TRUE(names(problem, "hand")) << problem;
  EXPECT_TRUE(names(problem, "bracket")) << problem;
}

}  // namespace
}  // namespace depth_object_tracker
