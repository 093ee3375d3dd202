// SPDX-License-Identifier: BSD-3-Clause
#include "depth_object_tracker/tracker/plane_finder.h"
#include "depth_object_tracker/filter/random.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <vector>

namespace depth_object_tracker {
namespace {

const PinholeCamera kCamera{320, 240, 285.0, 285.0, 159.5, 119.5};

/// The nearest of some planes along every beam, with the noise of a structured-light camera [mm].
class PlaneImage {
 public:
  explicit PlaneImage(const std::vector<ImagePlane>& planes) {
    const CounterRandom random(3);
    for (int row = 0; row < kCamera.height; ++row) {
      for (int col = 0; col < kCamera.width; ++col) {
        double nearest = 0.0;
        for (const ImagePlane& plane : planes) {
          const double z = plane.offset_m / plane.normal.dot(kCamera.ray(col, row));
          if (z > 0.0 && (nearest == 0.0 || z < nearest)) nearest = z;
        }
        const double noise =
            0.0015 * nearest * nearest * random.normal6(RandomPurpose::kSearch, depth_mm_.size(), 0)[0];
        depth_mm_.push_back(static_cast<std::uint16_t>(std::lround(1000.0 * std::max(0.0, nearest + noise))));
      }
    }
  }
  DepthImageView view() const {
    DepthImageView view;
    view.data = reinterpret_cast<const std::uint8_t*>(depth_mm_.data());
    view.width = kCamera.width;
    view.height = kCamera.height;
    view.step = 2 * static_cast<std::size_t>(kCamera.width);
    return view;
  }
  std::vector<std::uint16_t>& depth_mm() { return depth_mm_; }

 private:
  std::vector<std::uint16_t> depth_mm_;
};

ImagePlane makePlane(const Eigen::Vector3d& normal, double offset_m) {
  ImagePlane plane;
  plane.normal = normal.normalized();
  plane.offset_m = offset_m;
  return plane;
}

TEST(PlaneFinder, FindsTableAndWall) {
  const ImagePlane table = makePlane({0.0, -0.9, -0.45}, -0.5), wall = makePlane({0.1, 0.3, -0.95}, -1.6);
  const PlaneImage image({table, wall});
  const auto found = findPlanes(image.view(), kCamera, 3.0);
  ASSERT_EQ(found.size(), 2U);
  for (const ImagePlane& plane : {table, wall}) {
    const bool is_first = found[0].normal.dot(plane.normal) > found[1].normal.dot(plane.normal);
    const ImagePlane& match = found[is_first ? 0 : 1];
    EXPECT_GT(match.normal.dot(plane.normal), 0.9998);
    EXPECT_NEAR(match.offset_m, plane.offset_m, 0.004);
  }
  EXPECT_NEAR(found[0].share + found[1].share, 1.0, 0.05);
  EXPECT_GE(found[0].share, found[1].share);
}

TEST(PlaneFinder, APointsHeightIsTowardsTheCamera) {
  const PlaneImage image({makePlane({0.0, -0.9, -0.45}, -0.5)});
  const auto found = findPlanes(image.view(), kCamera, 3.0);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_NEAR(found[0].heightOf(Eigen::Vector3d::Zero()), 0.5, 0.004) << "the camera is above it";
}

TEST(PlaneFinder, FindsNoneInAnImageWithoutReadings) {
  PlaneImage image({makePlane({0.0, 0.0, -1.0}, -1.0)});
  image.depth_mm().assign(image.depth_mm().size(), 0);
  EXPECT_TRUE(findPlanes(image.view(), kCamera, 3.0).empty());
}

}  // namespace
}  // namespace depth_object_tracker
