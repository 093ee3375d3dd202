// SPDX-License-Identifier: BSD-3-Clause
#include "depth_object_tracker/robot/link_meshes.h"

#include "depth_object_tracker/robot/robot_occluder.h"

#include "test_robots.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace depth_object_tracker {
namespace {

std::string shapedRobot(const std::string& geometry) {
  return "<robot name='r'><link name='a'><visual><origin xyz='1 2 3' rpy='0 0 1.5707963267948966'/><geometry>" +
         geometry +
         "</geometry></visual></link><link name='bare'/><joint name='j' type='fixed'><parent link='a'/><child "
         "link='bare'/>"
         "</joint></robot>";
}

BoundingBox boxOf(const std::string& geometry) {
  const LinkMeshes meshes = loadLinkMeshes(RobotModel::fromText(shapedRobot(geometry), "test"), LinkShapes::kCollision);
  EXPECT_EQ(meshes.problems, std::vector<std::string>());
  EXPECT_EQ(meshes.links.size(), 1u);  // visual stands in for collision; the bare link has neither
  return boundingBox(meshes.links.at(0).mesh);
}

TEST(LinkMeshes, PrimitivesHaveTheirSizeAndPlace) {
  const BoundingBox box = boxOf("<box size='0.2 0.4 0.6'/>");
  EXPECT_LT((box.size() - Eigen::Vector3d(0.4, 0.2, 0.6)).norm(), 1e-6);  // turned by 90 degrees
  EXPECT_LT((0.5 * (box.min + box.max) - Eigen::Vector3d(1, 2, 3)).norm(), 1e-6);
  EXPECT_LT((boxOf("<sphere radius='0.1'/>").size() - Eigen::Vector3d(0.2, 0.2, 0.2)).norm(), 0.01);
  EXPECT_LT((boxOf("<cylinder radius='0.1' length='0.5'/>").size() - Eigen::Vector3d(0.2, 0.2, 0.5)).norm(), 0.01);
}

TEST(LinkMeshes, MeshesAreReadAndScaled) {
  const std::string file = std::string(PROJECT_SOURCE_FOLDER) + "/meshes/box.obj";
  const BoundingBox once = boxOf("<mesh filename='file://" + file + "'/>");
  const BoundingBox thrice = boxOf("<mesh filename='file://" + file + "' scale='1 3 1'/>");
  EXPECT_NEAR(thrice.size().x(), 3.0 * once.size().x(), 1e-6);  // turned: y became x
  EXPECT_NEAR(thrice.size().z(), once.size().z(), 1e-6);
}

TEST(LinkMeshes, AShapeThatCannotBeReadIsNamed) {
  const LinkMeshes meshes = loadLinkMeshes(
      RobotModel::fromText(shapedRobot("<mesh filename='/nowhere/a.stl'/>"), "test"), LinkShapes::kVisual);
  ASSERT_EQ(meshes.problems.size(), 1u);
  EXPECT_NE(meshes.problems[0].find("'a'"), std::string::npos) << meshes.problems[0];
  EXPECT_NE(meshes.problems[0].find("/nowhere/a.stl"), std::string::npos) << meshes.problems[0];
  EXPECT_TRUE(meshes.links.empty());
}

TEST(RobotOccluder, DrawsItsLinksWhereTheJointsHaveThem) {
  const RobotModel model = RobotModel::fromText(shapedRobot("<box size='0.2 0.4 0.6'/>"), "test");
  RobotState state(model, RobotStateConfig());
  RobotOccluder occluder(model, loadLinkMeshes(model, LinkShapes::kVisual));
  const PinholeCamera camera{64, 48, 60.0, 60.0, 31.5, 23.5};
  const auto numDrawn = [&] {
    const std::vector<float>& depth = occluder.render(camera);
    EXPECT_EQ(depth.size(), 64u * 48u);
    return std::count_if(depth.begin(), depth.end(), [](float d) { return d > 0.0f; });
  };
  EXPECT_EQ(numDrawn(), 0) << "nobody has said where the links are";
  EXPECT_EQ(occluder.place(state, Pose(Eigen::Translation3d(-1.0, -2.0, -1.0)), 10.0), 1u);
  EXPECT_GT(numDrawn(), 50);
  EXPECT_NEAR(occluder.render(camera)[24 * 64 + 32], 2.0f - 0.3f, 1e-5f);
}

TEST(LinkMeshes, EveryLinkOfTheShippedArmHasAShape) {
  const RobotModel arm = RobotModel::fromFile(armFile());
  EXPECT_EQ(loadLinkMeshes(arm, LinkShapes::kVisual).links.size(), arm.linkNames().size());
}

}  // namespace
}  // namespace depth_object_tracker
