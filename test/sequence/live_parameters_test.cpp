// SPDX-License-Identifier: BSD-3-Clause
// Every parameter that can change live, changed between two images, has the effect that its description promises.
#include "depth_object_tracker/tracker/live_parameters.h"

#include "scripted_scene.h"

#include "depth_object_tracker/tracker/tracker_parameters.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <set>

namespace depth_object_tracker {
namespace {

constexpr double kFrameS = 1.0 / 30.0;

/// Unweighted standard deviation of the particles: with the process proposal, how far they were thrown.
double positionSpread(const ObjectTracker& tracker) {
  const auto poses = tracker.particles().T_camera_object;
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const Pose& pose : poses) mean += pose.translation() / static_cast<double>(poses.size());
  double sum = 0.0;
  for (const Pose& pose : poses) sum += (pose.translation() - mean).squaredNorm();
  return std::sqrt(sum / static_cast<double>(poses.size()));
}

double rotationSpread(const ObjectTracker& tracker) {
  const auto poses = tracker.particles().T_camera_object;
  double sum = 0.0;
  for (const Pose& pose : poses) sum += logSo3(pose.linear() * poses.front().linear().transpose()).squaredNorm();
  return std::sqrt(sum / static_cast<double>(poses.size()));
}

/// A tracker that follows an object at rest, with one parameter changed on the way.
class LiveRun {
 public:
  explicit LiveRun(Proposal proposal = Proposal::kProcess)
      : scene_("bracket", 5), tracker_(scene_.object(), config(proposal)) {
    tracker_.initialise(restingPose());
    rest(3);
  }

  LiveRun& set(const std::string& name, const ParameterValue& value) {
    TrackerConfig changed = tracker_.config();
    setTrackerParameter(changed, name, value);
    tracker_.setLiveParameters(changed);
    return *this;
  }

  LiveRun& frame(const std::optional<Pose>& truth, const std::optional<Board>& board = std::nullopt,
                 const std::optional<ControlInput>& control = std::nullopt, double dt_s = kFrameS) {
    stamp_s_ += dt_s;
    const auto& image = scene_.render(truth, board);
    result_ = tracker_.update(scene_.view(image), scene_.camera(), stamp_s_, control);
    return *this;
  }
  LiveRun& rest(int frames) {
    for (int i = 0; i < frames; ++i) frame(restingPose());
    return *this;
  }
  LiveRun& hidden(int frames) {
    for (int i = 0; i < frames; ++i) frame(restingPose(), Board{0, scene_.camera().width, 0.4});
    return *this;
  }
  LiveRun& gone(int frames) {
    for (int i = 0; i < frames; ++i) frame(std::nullopt);
    return *this;
  }
  LiveRun& held(int frames) {
    ControlInput control;
    control.grasped = control.has_twist = true;
    for (int i = 0; i < frames; ++i) frame(restingPose(), std::nullopt, control);
    return *this;
  }
  LiveRun& halfHidden(int frames) {
    const auto [begin, end] = scene_.columnsOf(restingPose());
    for (int i = 0; i < frames; ++i) frame(restingPose(), Board{begin, (begin + end) / 2, 0.4});
    return *this;
  }
  LiveRun& moving(int frames) {
    for (int i = 0; i < frames; ++i) frame(movedBy(restingPose(), 0.008 * ++num_moves_, 0.0, 0.0));
    return *this;
  }

  ObjectTracker& tracker() { return tracker_; }
  const TrackerResult& result() const { return result_; }

 private:
  static TrackerConfig config(Proposal proposal) {
    TrackerConfig config;
    config.filter.proposal = proposal;
    config.filter.smooth_estimate = false;  // what the filter does is what is told
    config.filter.num_particles = 100;
    config.process.sudden_motion_share = 0.0;
    return config;
  }

  ScriptedScene scene_;
  ObjectTracker tracker_;
  double stamp_s_ = 100.0;
  int num_moves_ = 0;
  TrackerResult result_;
};

struct Effect {
  const char* name;
  ParameterValue less, more;  ///< the second makes the measured number larger
  double factor;              ///< by so much at least
  std::function<double(const std::string&, const ParameterValue&)> measure;
};

std::ostream& operator<<(std::ostream& out, const Effect& effect) {
  return out << effect.name;
}

using Name = const std::string&;
using Value = const ParameterValue&;

std::vector<Effect> effects() {
  const auto spreadAtRest = [](Name name, Value value) {
    return positionSpread(LiveRun().set(name, value).rest(2).tracker());
  };
  const auto spreadHeld = [](Name name, Value value) {
    return positionSpread(LiveRun().set(name, value).held(2).tracker());
  };
  const auto turnHeld = [](Name name, Value value) {
    return rotationSpread(LiveRun().set(name, value).held(2).tracker());
  };
  const auto spreadHidden = [](Name name, Value value) {
    return positionSpread(LiveRun().hidden(4).set(name, value).hidden(12).tracker());
  };
  const auto jumps = [](Name name, Value value) {
    LiveRun run;
    run.set("sudden_motion_share", 0.3).set("sudden_motion_scale", 10.0);
    return positionSpread(run.set(name, value).rest(2).tracker());
  };
  const auto spreadAtStart = [](Name name, Value value) {
    LiveRun run;
    run.set(name, value).tracker().initialise(restingPose());
    return positionSpread(run.rest(1).tracker());
  };
  const auto turnAtStart = [](Name name, Value value) {
    LiveRun run;
    run.set(name, value).tracker().initialise(restingPose());
    return rotationSpread(run.rest(1).tracker());
  };
  const auto framesUntilLost = [](Name name, Value value) {
    LiveRun run(Proposal::kInformed);
    run.set(name, value);
    for (int i = 0; i < 40; ++i) {
      if (run.gone(1).result().state == TrackerState::kLost) return i + 1.0;
    }
    return 100.0;
  };
  return {
      {"position_noise_m_per_sqrt_s", 0.01, 0.3, 5.0, spreadAtRest},
      {"rotation_noise_rad_per_sqrt_s", 0.05, 1.5, 5.0,
       [](Name name, Value value) { return rotationSpread(LiveRun().set(name, value).rest(2).tracker()); }},
      {"sudden_motion_share", 0.0, 0.5, 2.0, jumps},
      {"sudden_motion_scale", 1.0, 20.0, 2.0, jumps},
      // Without memory the twist is what one image says of the motion, which the filter believes in part.
      {"velocity_half_life_s", 0.0, 1.0, 1.2,
       [](Name name, Value value) {
         LiveRun run(Proposal::kInformed);
         return run.moving(8).set(name, value).moving(8).result().twist.head<3>().norm();
       }},
      {"grasped_position_noise_m_per_sqrt_s", 0.001, 0.1, 3.0, spreadHeld},
      {"grasped_rotation_noise_rad_per_sqrt_s", 0.01, 1.0, 3.0, turnHeld},
      {"grasped_position_bias_m_per_s", 0.0, 0.8, 3.0, spreadHeld},
      {"grasped_rotation_bias_rad_per_s", 0.0, 8.0, 3.0, turnHeld},
      // 0 = never held back
      {"diffusion_full_above_visible_fraction", 0.25, 0.0, 1.3, spreadHidden},
      {"hidden_diffusion_scale", 0.001, 1.0, 1.5, spreadHidden},
      {"max_gap_s", 0.03, 10.0, 3.0,
       [](Name name, Value value) {
         return positionSpread(LiveRun().set(name, value).frame(restingPose(), {}, {}, 10.0).tracker());
       }},
      {"num_particles", 30, 120, 3.9,
       [](Name name, Value value) { return LiveRun().set(name, value).rest(2).result().num_particles; }},
      {"likelihood_exponent", 1.0, 0.001, 2.0,
       [](Name name, Value value) { return LiveRun().set(name, value).rest(1).result().effective_sample_size; }},
      {"downsampling", 2, 7, 3.0,
       [](Name name, Value value) { return LiveRun().set(name, value).rest(1).result().downsampling; }},
      {"target_model_pixels", 100, 4000, 4.0,
       [](Name name, Value value) { return LiveRun().set(name, value).rest(2).result().pixels; }},
      {"initial_position_stddev_m", 0.001, 0.05, 5.0, spreadAtStart},
      {"initial_rotation_stddev_rad", 0.01, 0.5, 5.0, turnAtStart},
      {"occluded_below_visible_fraction", 0.1, 0.95, 1.5,
       [](Name name, Value value) {
         LiveRun run(Proposal::kInformed);
         return run.set(name, value).halfHidden(6).result().state == TrackerState::kOccluded ? 3.0 : 1.0;
       }},
      {"lost_below_score", 0.9, 0.0, 2.0, framesUntilLost},
      {"lost_after_s", 0.1, 0.8, 2.0, framesUntilLost},
      // The core takes no time itself: tested with the session, which does.
      {"frame_budget_s", 0.0, 0.05, 1.0,
       [](Name name, Value value) {
         return LiveRun().set(name, value).tracker().config().budget.frame_budget_s + 1.0;
       }},
  };
}

class LiveParameters : public testing::TestWithParam<Effect> {};
INSTANTIATE_TEST_SUITE_P(Each, LiveParameters, testing::ValuesIn(effects()),
                         [](const auto& test) { return std::string(test.param.name); });

TEST_P(LiveParameters, TakesEffect) {
  const Effect& effect = GetParam();
  const double less = effect.measure(effect.name, effect.less), more = effect.measure(effect.name, effect.more);
  EXPECT_GT(more, effect.factor * less) << effect.name;
}

TEST(LiveParameterList, EachHasATestOfItsEffect) {
  std::set<std::string> tested;
  for (const Effect& effect : effects()) tested.insert(effect.name);
  EXPECT_EQ(tested, std::set<std::string>(listLiveParameters().begin(), listLiveParameters().end()));
}

TEST(LiveParameterList, OthersStayAsTheyAre) {
  TrackerConfig changed;
  changed.pixel.tail_weight = 0.2;
  changed.filter.seed = 99;
  changed.filter.num_particles = 11;
  const TrackerConfig config = withLiveParameters(TrackerConfig(), changed);
  EXPECT_EQ(config.pixel.tail_weight, TrackerConfig().pixel.tail_weight);
  EXPECT_EQ(config.filter.seed, TrackerConfig().filter.seed);
  EXPECT_EQ(config.filter.num_particles, 11);
}

TEST(LiveParameterList, ABadValueChangesNothing) {
  LiveRun run;
  TrackerConfig changed = run.tracker().config();
  changed.process.position_noise_m_per_sqrt_s = 1.0;
  changed.status.lost_after_s = -1.0;
  EXPECT_THROW(run.tracker().setLiveParameters(changed), std::invalid_argument);
  EXPECT_EQ(run.tracker().config().process.position_noise_m_per_sqrt_s,
            TrackerConfig().process.position_noise_m_per_sqrt_s);
}

}  // namespace
}  // namespace depth_object_tracker
