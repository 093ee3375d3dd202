// SPDX-License-Identifier: BSD-3-Clause
// Folding of equivalent poses.
#include "depth_object_tracker/geometry/symmetry.h"

#include "random_pose.h"

#include <gtest/gtest.h>

#include <cmath>

namespace depth_object_tracker {
namespace {

double angleBetween(const Pose& a, const Pose& b) {
  return logSo3(a.linear() * b.linear().transpose()).norm();
}

Pose turnAboutLine(const SymmetryAxis& line, double angle) {
  Pose pose = Pose::Identity();
  pose.linear() = expSo3(angle * line.axis);
  pose.translation() = line.offset - pose.linear() * line.offset;
  return pose;
}

Symmetries halfTurns() {
  Symmetries symmetries;
  for (const Eigen::Vector3d& axis : {Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(0, 1, 0), Eigen::Vector3d(0, 0, 1)}) {
    symmetries.discrete.push_back(turnAboutLine({axis, Eigen::Vector3d(0.01, 0.02, 0.03)}, M_PI));
  }
  return symmetries;
}

TEST(Symmetry, WithoutSymmetryThePoseStaysAsItIs) {
  std::mt19937_64 engine(1);
  const Pose pose = randomPose(engine, 1.0), reference = randomPose(engine, 1.0);
  EXPECT_EQ(foldOntoReference(pose, reference, {}).matrix(), pose.matrix());
  EXPECT_TRUE(Symmetries().empty());
}

TEST(Symmetry, DiscreteFoldFindsTheEquivalentNearTheReference) {
  std::mt19937_64 engine(2);
  const Symmetries symmetries = halfTurns();
  for (int i = 0; i < 50; ++i) {
    const Pose reference = randomPose(engine, 1.0);
    Vector6d small;
    small << randomVector(engine, 0.01), randomVector(engine, 0.2);
    const Pose near = perturb(reference, small);
    EXPECT_EQ(foldOntoReference(near, reference, symmetries).matrix(), near.matrix());
    for (const Pose& T_object_object : symmetries.discrete) {
      EXPECT_LT(largestDifference(foldOntoReference(near * T_object_object, reference, symmetries), near), 1e-12);
    }
  }
}

TEST(Symmetry, DiscreteFoldIsNeverFartherThanAnyEquivalent) {
  std::mt19937_64 engine(3);
  const Symmetries symmetries = halfTurns();
  for (int i = 0; i < 100; ++i) {
    const Pose reference = randomPose(engine, 1.0), pose = randomPose(engine, 1.0);
    const double folded = angleBetween(foldOntoReference(pose, reference, symmetries), reference);
    EXPECT_LE(folded, angleBetween(pose, reference) + 1e-9);
    for (const Pose& T_object_object : symmetries.discrete) {
      EXPECT_LE(folded, angleBetween(pose * T_object_object, reference) + 1e-9);
    }
  }
}

TEST(Symmetry, ContinuousFoldRemovesTheSpinAndNothingElse) {
  std::mt19937_64 engine(4);
  Symmetries symmetries;
  symmetries.continuous.push_back({Eigen::Vector3d(1.0, 2.0, -0.5).normalized(), Eigen::Vector3d(0.02, -0.01, 0.05)});
  for (int i = 0; i < 100; ++i) {
    const Pose reference = randomPose(engine, 1.0), pose = randomPose(engine, 1.0);
    const Pose folded = foldOntoReference(pose, reference, symmetries);
    // Points on the axis do not move, and the result is one of the equivalents.
    for (const double along : {-0.3, 0.0, 0.7}) {
      const Eigen::Vector3d p_object = symmetries.continuous[0].offset + along * symmetries.continuous[0].axis;
      EXPECT_LT((folded * p_object - pose * p_object).norm(), 1e-12);
    }
    double nearest = 10.0;
    for (int step = 0; step < 3600; ++step) {
      const Pose equivalent = pose * turnAboutLine(symmetries.continuous[0], 2.0 * M_PI * step / 3600.0);
      nearest = std::min(nearest, angleBetween(equivalent, reference));
    }
    EXPECT_LE(angleBetween(folded, reference), nearest + 1e-9);
    EXPECT_GE(angleBetween(folded, reference), nearest - 2e-3);
    // A spun copy of a pose folds onto the same representative.
    const Pose spun = pose * turnAboutLine(symmetries.continuous[0], 1.234);
    EXPECT_LT(largestDifference(foldOntoReference(spun, reference, symmetries), folded), 1e-9);
  }
}

TEST(Symmetry, ContinuousAndDiscreteTogether) {
  // A cylinder: spin about z, and upside down.
  std::mt19937_64 engine(5);
  Symmetries symmetries;
  symmetries.continuous.push_back({Eigen::Vector3d::UnitZ(), Eigen::Vector3d::Zero()});
  symmetries.discrete.push_back(turnAboutLine({Eigen::Vector3d::UnitX(), Eigen::Vector3d(0.0, 0.0, 0.1)}, M_PI));
  for (int i = 0; i < 50; ++i) {
    const Pose reference = randomPose(engine, 1.0);
    Vector6d small;
    small << randomVector(engine, 0.01), 0.1 * randomVector(engine, 1.0);
    const Pose flipped =
        perturb(reference, small) * symmetries.discrete[0] * turnAboutLine(symmetries.continuous[0], 2.0);
    const Pose folded = foldOntoReference(flipped, reference, symmetries);
    EXPECT_LT(angleBetween(folded, reference), 0.2);
    EXPECT_LT((folded.translation() - reference.translation()).norm(), 0.05);
  }
}

TEST(Symmetry, TwoAxesMakeABall) {
  std::mt19937_64 engine(6);
  Symmetries symmetries;
  const Eigen::Vector3d centre(0.1, -0.2, 0.3);
  symmetries.continuous.push_back({Eigen::Vector3d::UnitX(), centre + 0.5 * Eigen::Vector3d::UnitX()});
  symmetries.continuous.push_back({Eigen::Vector3d::UnitZ(), centre - 0.7 * Eigen::Vector3d::UnitZ()});
  const Pose reference = randomPose(engine, 1.0), pose = randomPose(engine, 1.0);
  const Pose folded = foldOntoReference(pose, reference, symmetries);
  EXPECT_LT(angleBetween(folded, reference), 1e-9);
  EXPECT_LT((folded * centre - pose * centre).norm(), 1e-12);
  EXPECT_FALSE(freeAxisInCamera(pose, symmetries).has_value());
}

TEST(Symmetry, TheSameAxisTwiceIsStillOneAxis) {
  std::mt19937_64 engine(7);
  Symmetries once, twice;
  once.continuous.push_back({Eigen::Vector3d::UnitZ(), Eigen::Vector3d::Zero()});
  twice.continuous = {once.continuous[0], {-Eigen::Vector3d::UnitZ(), Eigen::Vector3d(0.0, 0.0, 1.0)}};
  const Pose reference = randomPose(engine, 1.0), pose = randomPose(engine, 1.0);
  EXPECT_EQ(foldOntoReference(pose, reference, once).matrix(), foldOntoReference(pose, reference, twice).matrix());
}

TEST(Symmetry, FreeAxisIsTurnedIntoTheCamera) {
  std::mt19937_64 engine(8);
  Symmetries symmetries;
  EXPECT_FALSE(freeAxisInCamera(Pose::Identity(), symmetries).has_value());
  symmetries.continuous.push_back({Eigen::Vector3d::UnitY(), Eigen::Vector3d::Zero()});
  const Pose pose = randomPose(engine, 1.0);
  const std::optional<Eigen::Vector3d> axis_camera = freeAxisInCamera(pose, symmetries);
  ASSERT_TRUE(axis_camera.has_value());
  EXPECT_LT((*axis_camera - pose.linear().col(1)).norm(), 1e-14);
}

}  // namespace
}  // namespace depth_object_tracker
