// SPDX-License-Identifier: BSD-3-Clause
// The nearest point found by cells against the one found by looking at all.
#include "depth_object_tracker/tracker/oriented_point_grid.h"

#include <gtest/gtest.h>

#include <random>
#include <vector>

namespace depth_object_tracker {
namespace {

constexpr double kLeastCosine = 0.7;

Eigen::Vector3d randomVector(std::mt19937_64& engine) {
  std::normal_distribution<double> normal;
  return {normal(engine), normal(engine), normal(engine)};
}

/// On an ellipsoid of this size [m].
std::vector<OrientedPoint> randomSurface(std::mt19937_64& engine, const Eigen::Vector3d& radii_m, std::size_t count) {
  std::vector<OrientedPoint> points;
  while (points.size() < count) {
    const Eigen::Vector3d direction = randomVector(engine).normalized();
    points.push_back({direction.cwiseProduct(radii_m), direction.cwiseQuotient(radii_m).normalized()});
  }
  return points;
}

const OrientedPoint* nearestOfAll(const std::vector<OrientedPoint>& points, const Eigen::Vector3d& point,
                                  const Eigen::Vector3d& normal, double reach_m) {
  const OrientedPoint* best = nullptr;
  double least = reach_m * reach_m;
  for (const OrientedPoint& other : points) {
    const double squared = (other.point - point).squaredNorm();
    if (squared >= least || std::abs(other.normal.dot(normal)) < kLeastCosine) continue;
    least = squared;
    best = &other;
  }
  return best;
}

class OrientedPointGridOf : public testing::TestWithParam<Eigen::Vector3d> {};

TEST_P(OrientedPointGridOf, FindsWhatALookAtAllFinds) {
  std::mt19937_64 engine(3);
  for (const double reach_m : {0.001, 0.02, 0.1, 1.0}) {
    const OrientedPointGrid grid(randomSurface(engine, GetParam(), 500), reach_m);
    int found = 0;
    for (int i = 0; i < 500; ++i) {
      const OrientedPoint& near = grid.points()[static_cast<std::size_t>(i)];
      const Eigen::Vector3d point = near.point + 0.5 * reach_m * randomVector(engine);
      const Eigen::Vector3d normal = randomVector(engine).normalized();
      const OrientedPoint* expected = nearestOfAll(grid.points(), point, normal, reach_m);
      ASSERT_EQ(grid.nearest(point, normal, kLeastCosine), expected) << "reach " << reach_m << ", query " << i;
      found += expected != nullptr ? 1 : 0;
    }
    EXPECT_GT(found, 50);
    EXPECT_LT(found, 500);
  }
}

// The third is cut into the most cells that there may be; the last is a plane.
INSTANTIATE_TEST_SUITE_P(RadiiM, OrientedPointGridOf,
                         testing::Values(Eigen::Vector3d(0.05, 0.05, 0.05), Eigen::Vector3d(0.1, 0.002, 0.03),
                                         Eigen::Vector3d(5.0, 0.1, 0.1), Eigen::Vector3d(0.1, 0.1, 1e-12)));

TEST(OrientedPointGrid, OfEquallyNearPointsTheFirst) {
  const Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
  const OrientedPointGrid grid({{{0.9, 0.0, 0.0}, up}, {{-0.9, 0.0, 0.0}, -up}, {{0.0, 0.9, 0.0}, up}}, 1.0);
  EXPECT_EQ(grid.nearest(Eigen::Vector3d::Zero(), up, kLeastCosine), &grid.points()[0]);
}

TEST(OrientedPointGrid, FarAwayAndWithoutPointsThereIsNone) {
  const Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
  const OrientedPointGrid one({{Eigen::Vector3d::Zero(), up}}, 0.1);
  EXPECT_EQ(one.nearest(Eigen::Vector3d::Constant(1e30), up, kLeastCosine), nullptr);
  EXPECT_EQ(one.nearest(Eigen::Vector3d::Constant(-1e30), up, kLeastCosine), nullptr);
  EXPECT_EQ(one.nearest(Eigen::Vector3d(0.099, 0.0, 0.0), up, kLeastCosine), &one.points()[0]);
  EXPECT_EQ(OrientedPointGrid({}, 0.1).nearest(Eigen::Vector3d::Zero(), up, kLeastCosine), nullptr);
}

}  // namespace
}  // namespace depth_object_tracker
