// SPDX-License-Identifier: BSD-3-Clause
// Hands and grippers touch what they hold; rays and shapes they are made with.
#include "depth_object_tracker/simulator/hand_shapes.h"
#include "depth_object_tracker/geometry/shape_meshes.h"
#include "depth_object_tracker/simulator/ray_cast.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace depth_object_tracker {
namespace {

// Distance of a point from the surface of a box about the origin; negative inside.
double distanceToBox(const Eigen::Vector3d& point, const Eigen::Vector3d& size) {
  const Eigen::Vector3d beyond = point.cwiseAbs() - 0.5 * size;
  const double outside = beyond.cwiseMax(0.0).norm();
  return outside > 0.0 ? outside : beyond.maxCoeff();
}

double nearestTo(const TriangleMesh& hand, const Eigen::Vector3d& box_size) {
  double nearest = 1e9;
  for (const Eigen::Vector3f& vertex : hand.vertices) {
    nearest = std::min(nearest, distanceToBox(vertex.cast<double>(), box_size));
  }
  return nearest;
}

TEST(RayCast, MeetsTheNearestSide) {
  const TriangleMesh box = makeBox({0.2, 0.4, 0.6});
  const auto hit = castRay(box, {1.0, 0.05, 0.02}, {-1.0, 0.0, 0.0});
  ASSERT_TRUE(hit.has_value());
  EXPECT_NEAR(*hit, 0.9, 1e-6);
  EXPECT_FALSE(castRay(box, {1.0, 0.05, 0.02}, {1.0, 0.0, 0.0}).has_value());
  EXPECT_NEAR(castRay(box, {0.0, 0.0, 0.0}, {0.0, 2.0, 0.0}).value(), 0.1, 1e-6) << "in units of the direction";
}

TEST(ShapeMeshes, CapsuleReachesFromEndToEnd) {
  const TriangleMesh capsule = makeCapsule({0.1, 0.0, 0.0}, {0.1, 0.5, 0.0}, 0.02, 0.04, 24);
  const BoundingBox box = boundingBox(capsule);
  EXPECT_NEAR(box.min.y(), -0.02, 1e-6);
  EXPECT_NEAR(box.max.y(), 0.54, 1e-6);
  EXPECT_NEAR(box.max.x(), 0.14, 1e-3);
}

TEST(Gripper, FingersTouchBothSides) {
  const Eigen::Vector3d size(0.05, 0.04, 0.2);
  GraspFrame grasp;
  grasp.approach = Eigen::Vector3d::UnitX();
  grasp.closing = Eigen::Vector3d::UnitY();
  const auto hand = makeGripper(makeBox(size), grasp);
  ASSERT_TRUE(hand.has_value());
  EXPECT_NEAR(nearestTo(hand->mesh, size), 0.0, 1e-5);
  EXPECT_GT(hand->wrist.x(), 0.08) << "the arm is on the side it came from";
}

TEST(Gripper, RefusesWhatIsTooWide) {
  GraspFrame grasp;
  EXPECT_FALSE(makeGripper(makeBox({0.05, 0.16, 0.2}), grasp).has_value());
}

TEST(HumanHand, FingersLieOnTheObject) {
  const Eigen::Vector3d size(0.04, 0.05, 0.2);
  const auto hand = makeHumanHand(makeBox(size), GraspFrame());
  ASSERT_TRUE(hand.has_value());
  const double nearest = nearestTo(hand->mesh, size);
  EXPECT_LT(nearest, 0.002) << "touches";
  EXPECT_GT(nearest, -0.0095) << "no deeper in the object than a finger's radius";
  const BoundingBox box = boundingBox(hand->mesh);
  EXPECT_GT(box.max.y(), 0.025) << "fingers reach round one side";
  EXPECT_LT(box.min.y(), -0.025) << "the thumb round the other";
}

TEST(HumanHand, RefusesWhatIsTooThick) {
  EXPECT_FALSE(makeHumanHand(makeBox({0.3, 0.3, 0.3}), GraspFrame()).has_value());
}

}  // namespace
}  // namespace depth_object_tracker
