// SPDX-License-Identifier: BSD-3-Clause
#include "depth_object_tracker/ros/camera_info_matcher.h"

#include <gtest/gtest.h>
#include <boost/make_shared.hpp>

#include <vector>

namespace depth_object_tracker {
namespace {

class CameraInfoMatcherTest : public testing::Test {
 protected:
  void image(double stamp_s) {
    auto message = boost::make_shared<sensor_msgs::Image>();
    message->header.stamp = ros::Time(stamp_s);
    matcher_.addImage(message);
  }
  void info(double stamp_s) {
    auto message = boost::make_shared<sensor_msgs::CameraInfo>();
    message->header.stamp = ros::Time(stamp_s);
    matcher_.addInfo(message);
  }
  double imageStamp(std::size_t i) const { return frames_.at(i).image->header.stamp.toSec(); }
  double infoStamp(std::size_t i) const { return frames_.at(i).info ? frames_.at(i).info->header.stamp.toSec() : -1.0; }

  std::vector<CameraFrame> frames_;
  CameraInfoMatcher matcher_{[this](CameraFrame frame) { frames_.push_back(std::move(frame)); }};
};

TEST_F(CameraInfoMatcherTest, PairsByStampInEitherOrder) {
  image(1.0);
  EXPECT_TRUE(frames_.empty());
  info(1.0);
  info(2.0);
  image(2.0);
  ASSERT_EQ(frames_.size(), 2u);
  EXPECT_EQ(infoStamp(0), 1.0);
  EXPECT_EQ(infoStamp(1), 2.0);
}

TEST_F(CameraInfoMatcherTest, AnInfoThatCameOnceServesAllImages) {
  info(0.0);
  for (int i = 1; i <= 4; ++i) image(i);
  ASSERT_EQ(frames_.size(), 4u);  // the first waited for the second, after that none waits
  for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(infoStamp(i), 0.0);
}

TEST_F(CameraInfoMatcherTest, WithoutAnyInfoImagesGoOutWithoutOne) {
  image(1.0);
  image(2.0);
  ASSERT_EQ(frames_.size(), 2u);
  EXPECT_FALSE(frames_[0].info);
  EXPECT_FALSE(frames_[1].info);
}

TEST_F(CameraInfoMatcherTest, GoesBackToExactPairsWhenStampsMatchAgain) {
  info(0.0);
  image(1.0);
  image(2.0);  // gives up on exact stamps
  info(2.0);   // late, but it matches
  image(3.0);
  EXPECT_EQ(frames_.size(), 2u);  // waits again
  info(3.0);
  ASSERT_EQ(frames_.size(), 3u);
  EXPECT_EQ(infoStamp(2), 3.0);
}

TEST_F(CameraInfoMatcherTest, KeepsImagesInOrderAndSendsEachOnce) {
  for (int i = 1; i <= 5; ++i) {
    image(i);
    if (i != 3) info(i);
  }
  ASSERT_EQ(frames_.size(), 5u);
  for (std::size_t i = 0; i < 5; ++i) EXPECT_EQ(imageStamp(i), static_cast<double>(i + 1));
  EXPECT_EQ(infoStamp(2), 2.0);
}

}  // namespace
}  // namespace depth_object_tracker
