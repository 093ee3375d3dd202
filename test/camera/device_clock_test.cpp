// SPDX-License-Identifier: BSD-3-Clause
#include "depth_object_tracker/camera/device_clock.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace depth_object_tracker {
namespace {

constexpr double kFrameS = 1.0 / 30.0;
constexpr double kEpochS = 1.7e9;  // receivers count from 1970, devices from when they were switched on

TEST(DeviceClock, LateArrivalsDoNotMoveTheStamps) {
  DeviceClock clock;
  std::mt19937 random(1);
  std::exponential_distribution<double> delay_s(1.0 / 0.01);
  double previous_s = 0.0;
  for (int i = 0; i < 3000; ++i) {
    const double device_s = 5.0 + i * kFrameS;
    const double stamp_s = clock.toReceiverTime(device_s, kEpochS + device_s + 0.005 + delay_s(random));
    if (i > 300) {
      EXPECT_NEAR(stamp_s - kEpochS - device_s, 0.005, 0.002) << i;
      EXPECT_NEAR(stamp_s - previous_s, kFrameS, 0.0005) << i;
    }
    previous_s = stamp_s;
  }
}

TEST(DeviceClock, FollowsAClockThatRunsTooFast) {
  DeviceClock clock;
  for (int i = 0; i < 30 * 600; ++i) {
    const double true_s = i * kFrameS;
    const double device_s = true_s * (1.0 + 200e-6);
    const double stamp_s = clock.toReceiverTime(device_s, kEpochS + true_s + 0.01 + (i % 7) * 0.002);
    if (i > 1000) {
      EXPECT_NEAR(stamp_s - kEpochS - true_s, 0.01, 0.004) << i;
    }
  }
}

TEST(DeviceClock, FollowsAClockThatRunsTooSlowly) {
  DeviceClock clock;
  for (int i = 0; i < 30 * 600; ++i) {
    const double true_s = i * kFrameS;
    const double device_s = true_s * (1.0 - 200e-6);
    const double stamp_s = clock.toReceiverTime(device_s, kEpochS + true_s + 0.01 + (i % 7) * 0.002);
    if (i > 1000) {
      EXPECT_NEAR(stamp_s - kEpochS - true_s, 0.01, 0.004) << i;
    }
  }
}

TEST(DeviceClock, StampsIncreaseAndNeverLieInTheFuture) {
  DeviceClock clock;
  std::mt19937 random(2);
  std::uniform_real_distribution<double> delay_s(0.0, 0.2);
  double previous_s = 0.0, previous_arrival_s = 0.0;
  for (int i = 0; i < 2000; ++i) {
    const double device_s = i * kFrameS;
    const double arrival_s = std::max(kEpochS + device_s + delay_s(random), previous_arrival_s + 0.001);
    const double stamp_s = clock.toReceiverTime(device_s, arrival_s);
    EXPECT_GT(stamp_s, previous_s);
    EXPECT_LE(stamp_s, arrival_s + 1e-6);
    previous_s = stamp_s;
    previous_arrival_s = arrival_s;
  }
}

TEST(DeviceClock, StartsAnewAfterAJumpOfEitherClock) {
  DeviceClock clock;
  for (int i = 0; i < 100; ++i) clock.toReceiverTime(100.0 + i * kFrameS, 1000.0 + i * kFrameS);
  EXPECT_NEAR(clock.toReceiverTime(0.0, 1010.0), 1010.0, 1e-6);  // the device was plugged in again
  EXPECT_NEAR(clock.toReceiverTime(kFrameS, 2000.0), 2000.0, 1e-6);
  EXPECT_NEAR(clock.toReceiverTime(2 * kFrameS, 500.0), 500.0, 1e-6);  // simulated time of a bag that loops
}

TEST(RecordingClock, KeepsTheIntervalsOfTheRecording) {
  RecordingClock clock(true);
  const double first_s = clock.toReceiverTime(3.0, 1000.0);
  EXPECT_DOUBLE_EQ(first_s, 1000.0);
  EXPECT_NEAR(clock.toReceiverTime(3.033, 1000.05), 1000.033, 1e-9);
  EXPECT_NEAR(clock.toReceiverTime(3.133, 1000.12), 1000.133, 1e-9);
}

TEST(RecordingClock, GoesOnWhenTheRecordingStartsAgain) {
  RecordingClock clock(true);
  clock.toReceiverTime(3.0, 1000.0);
  clock.toReceiverTime(4.0, 1001.0);
  const double again_s = clock.toReceiverTime(3.0, 1001.034);
  EXPECT_NEAR(again_s, 1001.034, 1e-6);
  EXPECT_NEAR(clock.toReceiverTime(3.033, 1001.07), again_s + 0.033, 1e-9);
}

TEST(RecordingClock, FollowsAPauseOnlyWhenPlayedAtItsOwnPace) {
  RecordingClock real_time(true), fast(false);
  for (RecordingClock* clock : {&real_time, &fast}) clock->toReceiverTime(3.0, 1000.0);
  EXPECT_NEAR(real_time.toReceiverTime(3.033, 1010.0), 1010.0, 1e-9);
  EXPECT_NEAR(fast.toReceiverTime(3.033, 1010.0), 1000.033, 1e-9);
  EXPECT_NEAR(fast.toReceiverTime(3.0, 1010.1), 1000.033 + kFrameS, 1e-9);  // from the start, at another pace
}

}  // namespace
}  // namespace depth_object_tracker
