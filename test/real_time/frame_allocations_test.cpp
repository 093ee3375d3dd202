// SPDX-License-Identifier: BSD-3-Clause
// An ordinary frame asks the heap for nothing once the tracker is warm: its time does not depend on other threads' use
// of the heap. A frame that searches may, within a bound.
#include "../sequence/scripted_scene.h"
#include "allocation_watch.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <string>

namespace depth_object_tracker {
namespace {

constexpr double kFrameS = 1.0 / 30.0;
constexpr int kPeriod = 45;  // frames, after which the motion repeats

/// One tracker on one scene; counts around update() alone.
class WatchedRun {
 public:
  explicit WatchedRun(const std::string& mesh, const TrackerConfig& config = TrackerConfig())
      : scene_(mesh, 3), tracker_(scene_.object(), config), truth_(restingPose()) {
    tracker_.initialise(truth_);
  }

  HeapUse step(const std::optional<ControlInput>& control = std::nullopt,
               const std::optional<Board>& board = std::nullopt) {
    const double phase = 2.0 * M_PI * static_cast<double>(num_steps_++) / kPeriod;
    truth_ =
        movedBy(restingPose(), 0.03 * std::sin(phase), 0.01 * std::cos(phase), 0.0, {0.0, 0.1 * std::sin(phase), 0.0});
    const std::vector<std::uint16_t>& image = scene_.render(truth_, board);
    stamp_s_ += kFrameS;
    depth_object_tracker::tellAllocations(tells_);
    const AllocationWatch watch;
    TrackerResult result = tracker_.update(scene_.view(image), scene_.camera(), stamp_s_, control);
    const HeapUse used = watch.sinceBegin();
    depth_object_tracker::tellAllocations(false);
    state_ = result.state;
    is_resampled_ = result.downsampling != downsampling_;
    downsampling_ = result.downsampling;
    return used;
  }

  TrackerState state() const { return state_; }
  bool isResampled() const { return is_resampled_; }  ///< the last frame changed the resolution
  void tellAllocations() { tells_ = true; }

 private:
  ScriptedScene scene_;
  ObjectTracker tracker_;
  Pose truth_;
  double stamp_s_ = 100.0;
  int num_steps_ = 0, downsampling_ = 0;
  bool is_resampled_ = false;
  TrackerState state_ = TrackerState::kUninitialized;
  bool tells_ = false;
};

constexpr int kWarmUp = 2 * kPeriod, kFrames = kPeriod;

struct Case {
  std::string mesh;
  int num_threads;
  bool held;
};
std::ostream& operator<<(std::ostream& out, const Case& c) {
  return out << c.mesh << ", " << c.num_threads << " threads" << (c.held ? ", held" : "");
}

class FrameAllocations : public testing::TestWithParam<Case> {};
INSTANTIATE_TEST_SUITE_P(Objects, FrameAllocations,
                         testing::Values(Case{"drill", 1, false}, Case{"drill", 2, false}, Case{"box", 1, false},
                                         Case{"bottle", 1, false}, Case{"bracket", 1, true}));

TEST_P(FrameAllocations, NoneInOrdinaryFrames) {
  TrackerConfig config;
  config.filter.num_threads = GetParam().num_threads;
  WatchedRun run(GetParam().mesh, config);
  std::optional<ControlInput> control;
  if (GetParam().held) {
    control.emplace();
    control->grasped = control->has_twist = true;
  }
  HeapUse warm_up;
  for (int k = 0; k < kWarmUp; ++k) warm_up.allocations += run.step(control).allocations;
  ASSERT_GT(warm_up.allocations, 0) << "allocations are not counted";
  ASSERT_EQ(run.state(), TrackerState::kTracking);
  run.tellAllocations();
  int frames_with_any = 0;
  for (int k = 0; k < kFrames; ++k) {
    const HeapUse used = run.step(control);
    ASSERT_EQ(run.state(), TrackerState::kTracking);
    if (run.isResampled()) continue;
    frames_with_any += used.allocations > 0 ? 1 : 0;
  }
  EXPECT_EQ(frames_with_any, 0) << "of " << kFrames << "; standard error tells where";
}

TEST(FrameAllocationsOfTheUnusual, AreBounded) {
  constexpr std::int64_t kMostBytes = 64 << 20;  // a whole search, its copies of the image included
  WatchedRun run("drill");
  for (int k = 0; k < kWarmUp; ++k) run.step();
  HeapUse most;
  const Board all{0, 640, 0.4};
  for (int k = 0; k < 60; ++k) {
    const HeapUse used = run.step(std::nullopt, k < 40 ? std::make_optional(all) : std::nullopt);
    most.allocations = std::max(most.allocations, used.allocations);
    most.bytes = std::max(most.bytes, used.bytes);
  }
  RecordProperty("most_allocations", std::to_string(most.allocations));
  std::printf("most in one frame: %lld allocations, %lld bytes\n", static_cast<long long>(most.allocations),
              static_cast<long long>(most.bytes));
  EXPECT_LT(most.bytes, kMostBytes);
}

}  // namespace
}  // namespace depth_object_tracker
