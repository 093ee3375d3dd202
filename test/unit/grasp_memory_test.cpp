// SPDX-License-Identifier: BSD-3-Clause
// Where the hand had the object: what is remembered of it, and when an estimate is compared with it.
#include "depth_object_tracker/tracker/grasp_memory.h"

#include <gtest/gtest.h>

#include <vector>

namespace depth_object_tracker {
namespace {

constexpr double kFrameS = 1.0 / 30.0, kGood = 1.0, kPoor = 0.7;

Pose at(double x_m) {
  Pose pose = Pose::Identity();
  pose.translation() << x_m, 0.0, 1.0;
  return pose;
}

TEST(GraspMemoryOf, NothingComparesNothing) {
  GraspMemory memory;
  EXPECT_FALSE(memory.pose());
  EXPECT_FALSE(memory.isDue(at(0.1), kPoor));
}

TEST(GraspMemoryOf, AGoodFitIsThatFit) {
  GraspMemory memory;
  memory.given(at(0.0));
  memory.seen(at(0.01), kGood, kFrameS);
  EXPECT_TRUE(memory.pose()->isApprox(at(0.01)));
  EXPECT_FALSE(memory.isDue(at(0.05), kGood));
}

TEST(GraspMemoryOf, APoorFitIsWhatItWas) {
  GraspMemory memory;
  memory.given(at(0.0));
  memory.seen(at(0.05), kPoor, kFrameS);
  EXPECT_TRUE(memory.pose()->isApprox(at(0.0)));
  EXPECT_TRUE(memory.isDue(at(0.05), kPoor));
  EXPECT_FALSE(memory.isDue(at(0.001), kPoor)) << "where it is remembered";
}

TEST(GraspMemoryOf, AWorseFitThanBeforeIsWhatItWas) {
  GraspMemory memory;
  memory.seen(at(0.0), kGood, kFrameS);
  memory.seen(at(0.02), 0.9, kFrameS);
  EXPECT_TRUE(memory.pose()->isApprox(at(0.0)));
}

TEST(GraspMemoryOf, AMeshThatAlwaysFitsLessIsBelievedInTime) {
  constexpr double kLess = 0.85;
  GraspMemory memory;
  memory.given(at(0.0));
  int images = 0;
  while (!memory.pose()->isApprox(at(0.01)) && images < 1000) {
    memory.seen(at(0.01), kLess, kFrameS);
    ++images;
  }
  EXPECT_GT(images, 60);
  EXPECT_LT(images, 200);
}

TEST(GraspMemoryOf, APoorFitIsComparedEverMoreRarely) {
  GraspMemory memory;
  memory.given(at(0.0));
  std::vector<double> times;
  for (double time_s = 0.0; time_s < 10.0; time_s += kFrameS) {
    memory.seen(at(0.05), kPoor, kFrameS);
    if (!memory.isDue(at(0.05), kPoor)) continue;
    times.push_back(time_s);
    memory.compared();
  }
  ASSERT_GE(times.size(), 9u);
  EXPECT_LT(times.size(), 15u);
  EXPECT_LT(times[1] - times[0], 0.2);
  EXPECT_NEAR(times.back() - times[times.size() - 2], 1.0, 0.1);
}

}  // namespace
}  // namespace depth_object_tracker
