// SPDX-License-Identifier: BSD-3-Clause
#include "depth_object_tracker/geometry/stable_poses.h"
#include "depth_object_tracker/geometry/shape_meshes.h"

#include <gtest/gtest.h>

#include <cmath>

namespace depth_object_tracker {
namespace {

/// Of all poses in which the object stands on its side with this outward normal.
double probabilityOn(const std::vector<StablePose>& poses, const Eigen::Vector3d& down) {
  double sum = 0.0;
  for (const StablePose& pose : poses) {
    if (pose.up.dot(-down) > 0.99) sum += pose.probability;
  }
  return sum;
}

TEST(StablePoses, ABoxRestsOnItsSixSidesMostlyOnTheLargest) {
  const auto poses = stablePoses(makeBox({0.2, 0.1, 0.04}), Eigen::Vector3d::Zero());
  const double flat = probabilityOn(poses, -Eigen::Vector3d::UnitZ()),
               side = probabilityOn(poses, Eigen::Vector3d::UnitY()),
               upright = probabilityOn(poses, Eigen::Vector3d::UnitX());
  EXPECT_GT(flat, side);
  EXPECT_GT(side, upright);
  EXPECT_GT(upright, 0.0);
  EXPECT_NEAR(2.0 * (flat + side + upright), 1.0, 1e-4);
  for (const StablePose& pose : poses) {
    const Eigen::Vector3d half(0.1, 0.05, 0.02);
    EXPECT_NEAR(pose.height_m, pose.up.cwiseAbs().dot(half), 1e-4);
  }
}

TEST(StablePoses, ACubeHasAThirdOfTheProbabilityOnEachAxis) {
  const auto poses = stablePoses(makeBox({0.1, 0.1, 0.1}), Eigen::Vector3d::Zero());
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_NEAR(probabilityOn(poses, Eigen::Vector3d::Unit(axis)), 1.0 / 6.0, 1e-3);
  }
}

TEST(StablePoses, ATallCylinderRollsButSeldomStands) {
  const auto poses = stablePoses(makeCylinder(0.02, 0.2, 48), Eigen::Vector3d::Zero());
  const double standing =
      probabilityOn(poses, Eigen::Vector3d::UnitZ()) + probabilityOn(poses, -Eigen::Vector3d::UnitZ());
  EXPECT_GT(standing, 0.0);
  EXPECT_LT(standing, 0.1);
  double lying = 0.0;
  for (const StablePose& pose : poses) lying += std::abs(pose.up.z()) < 0.01 ? pose.probability : 0.0;
  EXPECT_NEAR(standing + lying, 1.0, 1e-6);
}

TEST(StablePoses, AnObjectTipsFromAFaceThatItsCentreIsNotAbove) {
  TriangleMesh leaning = makeBox({0.05, 0.05, 0.1});
  for (Eigen::Vector3f& vertex : leaning.vertices) vertex.x() += vertex.z();
  const auto poses = stablePoses(leaning, Eigen::Vector3d::Zero());
  EXPECT_EQ(probabilityOn(poses, -Eigen::Vector3d::UnitZ()), 0.0);
  EXPECT_EQ(probabilityOn(poses, Eigen::Vector3d::UnitZ()), 0.0);
  EXPECT_GT(probabilityOn(poses, Eigen::Vector3d(1.0, 0.0, -1.0).normalized()), 0.3);
}

TEST(StablePoses, AFlatSheetHasNone) {
  TriangleMesh sheet;
  sheet.vertices = {{0, 0, 0}, {0.1f, 0, 0}, {0, 0.1f, 0}, {0.1f, 0.1f, 0}};
  sheet.triangles = {{0, 1, 2}, {1, 3, 2}};
  EXPECT_TRUE(stablePoses(sheet, Eigen::Vector3d(0.05, 0.05, 0.0)).empty());
}

}  // namespace
}  // namespace depth_object_tracker
