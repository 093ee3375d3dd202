// SPDX-License-Identifier: BSD-3-Clause
// Where a hidden object may be: how far, and behind what.
#include "depth_object_tracker/tracker/search_region.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <vector>

namespace depth_object_tracker {
namespace {

Pose at(double x, double y, double z) {
  Pose T = Pose::Identity();
  T.translation() << x, y, z;
  return T;
}

SearchRegion regionOf(double stddev_m) {
  SearchRegion region;
  region.T_camera_centre = at(0.0, 0.0, 0.8);
  region.variances.head<3>().setConstant(stddev_m * stddev_m);
  region.variances.tail<3>().setConstant(0.1);
  return region;
}

TEST(SearchRegion, DistancesAreInStandardDeviations) {
  SearchRegion region = regionOf(0.05);
  EXPECT_NEAR(squaredDistance(at(0.1, 0.0, 0.8), region), 4.0, 1e-9);
  region.moved_on.head<3>() << std::sqrt(3.0) * 0.05, 0.0, 0.0;
  EXPECT_NEAR(squaredDistance(at(0.1, 0.0, 0.8), region), 1.0, 1e-9);
  EXPECT_EQ(remoteness(region.T_camera_centre, region), 0.0);
  EXPECT_EQ(remoteness(at(1.0, 0.0, 0.8), region), 1.0);
}

TEST(SearchRegion, AnObjectIsNotHalfAMetreAwayAtOnceButInTime) {
  SearchRegion region = regionOf(0.05);
  region.unseen_s = 0.25;
  EXPECT_EQ(outOfReach(at(0.08, 0.0, 0.8), region), 0.0) << "near enough";
  EXPECT_EQ(outOfReach(at(0.5, 0.0, 0.8), region), 4.0);
  region.unseen_s = 2.0;
  EXPECT_LT(outOfReach(at(0.5, 0.0, 0.8), region), 1.0);
}

/// A wall, and a board before the left half of the image.
class HidingPlaces : public testing::Test {
 protected:
  double shareHidden(double board_m, double object_x_m) {
    std::vector<float> depth_m(64 * 48, 1.5f);
    for (std::size_t i = 0; i < depth_m.size(); ++i) {
      if (i % 64 < 32) depth_m[i] = static_cast<float>(board_m);
    }
    DepthImageView view;
    view.data = reinterpret_cast<const std::uint8_t*>(depth_m.data());
    view.width = 64;
    view.height = 48;
    view.step = sizeof(float) * 64;
    view.pixel_type = DepthImageView::PixelType::kFloat32;
    view.unit_m = 1.0f;
    SearchRegion region = regionOf(0.05);
    region.T_camera_centre.translation().x() = object_x_m;
    return hiddenShare(region, view, {64, 48, 60.0, 60.0, 31.5, 23.5});
  }
};

TEST_F(HidingPlaces, AreBehindWhatStandsBeforeTheObject) {
  EXPECT_NEAR(shareHidden(0.5, 0.0), 0.5, 0.15);
  EXPECT_GT(shareHidden(0.5, -0.2), 0.95);
  EXPECT_LT(shareHidden(0.5, 0.2), 0.05);
  EXPECT_EQ(shareHidden(1.4, 0.0), 0.0) << "a board behind the object hides nothing";
  EXPECT_EQ(shareHidden(0.0, 0.0), 0.0) << "no reading, nothing in front";
  EXPECT_EQ(shareHidden(0.5, -3.0), 0.0) << "outside of the image nothing is known";
}

}  // namespace
}  // namespace depth_object_tracker
