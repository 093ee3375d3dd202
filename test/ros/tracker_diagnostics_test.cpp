// SPDX-License-Identifier: BSD-3-Clause
// Which level and which words the diagnostics have for what is going on.
#include "depth_object_tracker/ros/tracker_diagnostics.h"

#include "depth_object_tracker/ros/drop_watch.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace depth_object_tracker {
namespace {

using Level = diagnostic_msgs::DiagnosticStatus;
using Wrapper = diagnostic_updater::DiagnosticStatusWrapper;

DiagnosticSnapshot goodSnapshot() {
  DiagnosticSnapshot snapshot;
  snapshot.status.state = TrackerStatus::TRACKING;
  snapshot.status.valid_pixel_fraction = 0.9f;
  snapshot.status.input_rate_hz = 30.0f;
  snapshot.status.frame_time_s = 0.004f;
  snapshot.status.num_particles = 70;
  snapshot.status.effective_sample_size = 31.0f;
  snapshot.stamp_age_s = 0.03;
  return snapshot;
}

Wrapper describe(void (*task)(const DiagnosticSnapshot&, Wrapper&), const DiagnosticSnapshot& snapshot) {
  Wrapper status;
  task(snapshot, status);
  return status;
}

void expectMessage(const Wrapper& status, unsigned char level, const std::string& part) {
  EXPECT_EQ(static_cast<int>(status.level), static_cast<int>(level)) << status.message;
  EXPECT_NE(status.message.find(part), std::string::npos) << part << " is not in: " << status.message;
}

std::string valueOf(const Wrapper& status, const std::string& key) {
  const auto found =
      std::find_if(status.values.begin(), status.values.end(), [&](const auto& value) { return value.key == key; });
  return found == status.values.end() ? "no such key" : found->value;
}

TEST(TrackerDiagnostics, AllIsWell) {
  const DiagnosticSnapshot snapshot = goodSnapshot();
  expectMessage(describe(describeInput, snapshot), Level::OK, "30.0 images/s");
  expectMessage(describe(describeTracking, snapshot), Level::OK, "TRACKING");
  expectMessage(describe(describeLoad, snapshot), Level::OK, "4.0 ms");
  expectMessage(describe(describeSelfCheck, snapshot), Level::OK, "nothing suspicious");
}

TEST(TrackerDiagnostics, CarryTheNumbers) {
  DiagnosticSnapshot snapshot = goodSnapshot();
  snapshot.stage_times.proposal_s = 0.0021;
  snapshot.stage_times.render_likelihood_s = 0.0012;
  EXPECT_EQ(valueOf(describe(describeLoad, snapshot), "of it proposal [s]"), "0.0021");
  EXPECT_EQ(valueOf(describe(describeLoad, snapshot), "of it likelihood [s]"), "0.0012");
  EXPECT_EQ(valueOf(describe(describeInput, snapshot), "input rate [Hz]"), "30");
  EXPECT_EQ(valueOf(describe(describeInput, snapshot), "stamp age [s]"), "0.030");
  EXPECT_EQ(valueOf(describe(describeInput, snapshot), "valid pixel share"), "0.9");
  EXPECT_EQ(valueOf(describe(describeLoad, snapshot), "particles"), "70");
  EXPECT_EQ(valueOf(describe(describeLoad, snapshot), "effective sample size"), "31");
  EXPECT_EQ(valueOf(describe(describeTracking, snapshot), "state"), "TRACKING");
}

TEST(TrackerDiagnostics, NoImage) {
  DiagnosticSnapshot snapshot = goodSnapshot();
  snapshot.seconds_without_image = 7.0;
  expectMessage(describe(describeInput, snapshot), Level::ERROR, "no image for 7 s");
}

TEST(TrackerDiagnostics, OldAndFutureStamps) {
  DiagnosticSnapshot snapshot = goodSnapshot();
  snapshot.stamp_age_s = 15.0;
  expectMessage(describe(describeInput, snapshot), Level::WARN, "15.0 s behind the clock");
  snapshot.stamp_age_s = -2.0;
  expectMessage(describe(describeInput, snapshot), Level::WARN, "2.0 s ahead of the clock");
}

TEST(TrackerDiagnostics, FewValidPixels) {
  DiagnosticSnapshot snapshot = goodSnapshot();
  snapshot.status.valid_pixel_fraction = 0.0f;
  expectMessage(describe(describeInput, snapshot), Level::WARN, "0.0 % of the depth pixels are valid");
  snapshot.status.state = TrackerStatus::UNINITIALIZED;  // then nobody has looked
  expectMessage(describe(describeInput, snapshot), Level::OK, "images/s");
}

TEST(TrackerDiagnostics, StatesAndReasons) {
  DiagnosticSnapshot snapshot = goodSnapshot();
  snapshot.status.state = TrackerStatus::OCCLUDED;
  snapshot.status.reason = "the object is hidden";
  expectMessage(describe(describeTracking, snapshot), Level::WARN, "OCCLUDED: the object is hidden");
  snapshot.status.state = TrackerStatus::LOST;
  expectMessage(describe(describeTracking, snapshot), Level::ERROR, "LOST");
  snapshot.status.paused = true;
  expectMessage(describe(describeTracking, snapshot), Level::OK, "PAUSED");
}

TEST(TrackerDiagnostics, ManyDrops) {
  DiagnosticSnapshot snapshot = goodSnapshot();
  snapshot.dropped_share = 0.4;
  expectMessage(describe(describeLoad, snapshot), Level::WARN, "40 % of the images are dropped");
}

TEST(TrackerDiagnostics, Findings) {
  DiagnosticSnapshot snapshot = goodSnapshot();
  snapshot.findings = {"first", "second"};
  snapshot.frame_note = "no parent";
  const Wrapper status = describe(describeSelfCheck, snapshot);
  expectMessage(status, Level::WARN, "first");
  EXPECT_EQ(valueOf(status, "finding 2"), "second");
  EXPECT_EQ(valueOf(status, "note"), "no parent");
}

TEST(DropWatch, SpeaksAtTheEndOfAWindowWithManyDrops) {
  DropWatch watch;
  const DropWatch::Time begin{};
  const auto after = [&](int seconds) { return begin + std::chrono::seconds(seconds); };
  EXPECT_EQ(watch.update(0, 0, 0.0, begin), "");
  EXPECT_EQ(watch.update(60, 30, 0.06, after(2)), "") << "the window is not over";
  const std::string advice = watch.update(150, 60, 0.06, after(5));
  EXPECT_NE(advice.find("40 %"), std::string::npos) << advice;
  EXPECT_NE(advice.find("33.3 ms"), std::string::npos) << advice;
  EXPECT_NE(advice.find("60.0 ms. Lower"), std::string::npos) << advice;
  EXPECT_DOUBLE_EQ(watch.droppedShare(), 0.4);
  EXPECT_EQ(watch.update(300, 65, 0.03, after(10)), "");
  EXPECT_LT(watch.droppedShare(), 0.05);
}

TEST(DropWatch, BlamesOthersWhenTrackingIsFastEnough) {
  DropWatch watch;
  watch.update(0, 0, 0.0, DropWatch::Time{});
  const std::string advice = watch.update(150, 60, 0.004, DropWatch::Time{} + std::chrono::seconds(5));
  EXPECT_NE(advice.find("other work"), std::string::npos) << advice;
}

TEST(DropWatch, KeepsQuietWithoutImages) {
  DropWatch watch;
  watch.update(10, 5, 0.0, DropWatch::Time{});
  EXPECT_EQ(watch.update(10, 5, 0.0, DropWatch::Time{} + std::chrono::seconds(6)), "");
  EXPECT_EQ(watch.droppedShare(), 0.0);
}

}  // namespace
}  // namespace depth_object_tracker
