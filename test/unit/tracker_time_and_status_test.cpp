// SPDX-License-Identifier: BSD-3-Clause
// Stamps into time steps, object size into resolution, fit into status.
#include "depth_object_tracker/tracker/frame_clock.h"
#include "depth_object_tracker/tracker/resolution.h"
#include "depth_object_tracker/tracker/status_monitor.h"

#include <gtest/gtest.h>

namespace depth_object_tracker {
namespace {

TEST(FrameClock, TellsFirstForwardDuplicateAndBackwardApart) {
  FrameClock clock;
  EXPECT_EQ(clock.advance(100.0).event, FrameClock::Event::kFirst);
  const FrameClock::Step forward = clock.advance(100.25);
  EXPECT_EQ(forward.event, FrameClock::Event::kForward);
  EXPECT_DOUBLE_EQ(forward.dt_s, 0.25);
  EXPECT_EQ(clock.advance(100.25).event, FrameClock::Event::kDuplicate);
  EXPECT_DOUBLE_EQ(clock.advance(100.5).dt_s, 0.25) << "a duplicate leaves the clock alone";
  const FrameClock::Step back = clock.advance(50.0);
  EXPECT_EQ(back.event, FrameClock::Event::kBackward);
  EXPECT_EQ(back.dt_s, 0.0);
  EXPECT_DOUBLE_EQ(clock.advance(50.5).dt_s, 0.5) << "after a jump back time runs from there";
  clock.reset();
  EXPECT_EQ(clock.advance(50.5).event, FrameClock::Event::kFirst);
}

TEST(FrameClock, KeepsMicrosecondsOfTodaysStamps) {
  FrameClock clock;
  clock.advance(1.7e9);
  EXPECT_NEAR(clock.advance(1.7e9 + 1.0 / 30.0).dt_s, 1.0 / 30.0, 1e-6);
}

TEST(ResolutionChooser, AimsAtTheTargetPixelCount) {
  ResolutionConfig config;
  for (const double pixels : {2e3, 2e4, 6e4}) {
    ResolutionChooser chooser(config);
    const int factor = chooser.choose(pixels);
    const double covered = pixels / (factor * factor);
    EXPECT_GT(covered, 0.4 * config.target_model_pixels) << pixels;
    EXPECT_LT(covered, 2.5 * config.target_model_pixels) << pixels;
  }
  ResolutionChooser chooser(config);
  EXPECT_EQ(chooser.choose(300.0), 1) << "a small object keeps every pixel";
}

TEST(ResolutionChooser, DoesNotFlipToAndFro) {
  ResolutionChooser chooser{ResolutionConfig()};
  int last = chooser.choose(24000.0), changes = 0;
  for (int k = 0; k < 200; ++k) {
    const int factor = chooser.choose(24000.0 * (k % 2 == 0 ? 1.25 : 0.8));
    changes += factor != last ? 1 : 0;
    last = factor;
  }
  EXPECT_EQ(changes, 0);
}

TEST(ResolutionChooser, AFixedFactorIsKept) {
  ResolutionConfig config;
  config.downsampling = 5;
  ResolutionChooser chooser(config);
  for (const double pixels : {0.0, 10.0, 1e6}) EXPECT_EQ(chooser.choose(pixels), 5);
}

TEST(ResolutionChooser, AnUnknownSizeKeepsTheFactor) {
  ResolutionChooser chooser{ResolutionConfig()};
  const int factor = chooser.choose(40000.0);
  EXPECT_EQ(chooser.choose(0.0), factor);
  chooser.reset();
  EXPECT_GE(chooser.choose(0.0), 1);
}

TEST(LikelihoodExponent, IsTheConfiguredOneOrGrowsWithTheFactorUpToOne) {
  FilterConfig config;
  config.likelihood_exponent = 0.37;
  EXPECT_EQ(likelihoodExponent(config, 1), 0.37);
  EXPECT_EQ(likelihoodExponent(config, 9), 0.37);
  config.likelihood_exponent = 0.0;
  double last = 0.0;
  for (int factor = 1; factor <= 12; ++factor) {
    const double exponent = likelihoodExponent(config, factor);
    EXPECT_GE(exponent, last);
    EXPECT_LE(exponent, 1.0);
    last = exponent;
  }
  EXPECT_GT(last, likelihoodExponent(config, 1));
}

class StatusMonitorTest : public testing::Test {
 protected:
  static PoseAssessment fitting() {
    PoseAssessment assessment;
    assessment.covered_pixels = 1000;
    assessment.measured_pixels = 950;
    assessment.visible_pixels = 900.0;
    assessment.log_likelihood = 4000.0;
    assessment.achieved = 3900.0;
    assessment.expected = 4000.0;
    return assessment;
  }
  static PoseAssessment hidden() {
    PoseAssessment assessment = fitting();
    assessment.visible_pixels = 5.0;
    assessment.log_likelihood = -10.0;
    assessment.achieved = 15.0;
    assessment.expected = 20.0;
    return assessment;
  }
  static PoseAssessment seenThrough() {
    PoseAssessment assessment = fitting();
    assessment.visible_pixels = 20.0;
    assessment.through_pixels = 900;
    assessment.log_likelihood = -4000.0;
    assessment.achieved = -3500.0;
    assessment.expected = 3000.0;
    return assessment;
  }
  static PoseAssessment unmeasured() {
    PoseAssessment assessment;
    assessment.covered_pixels = 1000;
    return assessment;
  }

  /// As many 30 Hz frames.
  void feed(const PoseAssessment& assessment, int frames) {
    for (int k = 0; k < frames; ++k) monitor_.update(assessment, 1.0 / 30.0);
  }

  StatusMonitor monitor_{StatusConfig()};
};

TEST_F(StatusMonitorTest, StartsUninitializedAndInitialisesUntilThePoseFits) {
  EXPECT_EQ(monitor_.state(), TrackerState::kUninitialized);
  monitor_.restart();
  EXPECT_EQ(monitor_.state(), TrackerState::kInitializing);
  EXPECT_FALSE(monitor_.reason().empty());
  feed(fitting(), 1);
  EXPECT_EQ(monitor_.state(), TrackerState::kTracking);
  EXPECT_TRUE(monitor_.reason().empty());
  EXPECT_GT(monitor_.visibleFraction(), 0.9);
  EXPECT_NEAR(monitor_.score(), 0.975, 1e-9);
  monitor_.reset();
  EXPECT_EQ(monitor_.state(), TrackerState::kUninitialized);
}

TEST_F(StatusMonitorTest, HiddenIsOccludedHoweverLong) {
  monitor_.restart();
  feed(fitting(), 3);
  feed(hidden(), 300);
  EXPECT_EQ(monitor_.state(), TrackerState::kOccluded);
  EXPECT_FALSE(monitor_.reason().empty());
  feed(fitting(), 1);
  EXPECT_EQ(monitor_.state(), TrackerState::kTracking);
  EXPECT_TRUE(monitor_.reason().empty());
}

TEST_F(StatusMonitorTest, SeenThroughIsLostAfterAWhileAndComesBack) {
  monitor_.restart();
  feed(fitting(), 3);
  feed(seenThrough(), 5);
  EXPECT_NE(monitor_.state(), TrackerState::kLost) << "one bad frame is no loss";
  feed(seenThrough(), 10);
  EXPECT_EQ(monitor_.state(), TrackerState::kLost);
  EXPECT_FALSE(monitor_.reason().empty());
  feed(fitting(), 5);
  EXPECT_EQ(monitor_.state(), TrackerState::kTracking);
}

TEST_F(StatusMonitorTest, NoReadingsAreAnOcclusionNotALoss) {
  monitor_.restart();
  feed(fitting(), 3);
  feed(unmeasured(), 300);
  EXPECT_EQ(monitor_.state(), TrackerState::kOccluded);
  EXPECT_EQ(monitor_.visibleFraction(), 0.0);
}

TEST_F(StatusMonitorTest, OutsideOfTheImageIsALoss) {
  monitor_.restart();
  feed(fitting(), 3);
  feed(PoseAssessment(), 15);
  EXPECT_EQ(monitor_.state(), TrackerState::kLost);
}

TEST_F(StatusMonitorTest, AnInitialPoseThatNeverFitsIsLost) {
  monitor_.restart();
  feed(seenThrough(), 15);
  EXPECT_EQ(monitor_.state(), TrackerState::kLost);
}

}  // namespace
}  // namespace depth_object_tracker
