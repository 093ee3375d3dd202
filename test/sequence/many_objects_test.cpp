// SPDX-License-Identifier: BSD-3-Clause
// Four objects that cross each other, two of the same mesh: every tracker stays with its own.
#include "millimetre_view.h"

#include "depth_object_tracker/geometry/mesh_loader.h"
#include "depth_object_tracker/simulator/crossing_scene.h"
#include "depth_object_tracker/tools/pose_error.h"
#include "depth_object_tracker/tracker/estimate_board.h"
#include "depth_object_tracker/tracker/object_tracker.h"

#include <gtest/gtest.h>
#include <time.h>

#include <algorithm>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

namespace depth_object_tracker {
namespace {

constexpr double kFrameS = 1.0 / 30.0;
const std::vector<std::string> kObjects = {"bracket", "mug", "mug", "drill"};  // the nearest first

double cpuSeconds() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

/// One object with its tracker, and how it went.
struct Player {
  Player(const std::string& name, const TrackerConfig& config) : mesh_name(name) {
    ObjectModel model;
    model.name = name;
    model.mesh = loadMesh(std::string(PROJECT_SOURCE_FOLDER) + "/meshes/" + name + ".obj");
    mesh = std::make_shared<TriangleMesh>(model.mesh);
    meter = std::make_unique<PoseErrorMeter>(model.mesh, model.symmetries);
    tracker = std::make_unique<ObjectTracker>(model, config);
  }
  std::string mesh_name;
  std::shared_ptr<const TriangleMesh> mesh;
  std::unique_ptr<PoseErrorMeter> meter;
  std::unique_ptr<ObjectTracker> tracker;
  std::unique_ptr<BoardMembership> membership;  // null: it knows nothing of the others
  OtherObjects others;
  TrackerResult result;
  std::vector<double> errors_m;                      // of frames with a pose to tell
  int lost = 0, hidden = 0, wrong = 0, swapped = 0;  // images
  double least_visible = 1.0;

  double median() {
    std::sort(errors_m.begin(), errors_m.end());
    return errors_m.empty() ? 1.0 : errors_m[errors_m.size() / 2];
  }
};

class ManyObjects {
 public:
  ManyObjects(const CrossingSceneConfig& config, bool sharing) : config_(config) {
    std::vector<TriangleMesh> meshes;
    for (const std::string& name : kObjects) {
      players_.push_back(std::make_unique<Player>(name, TrackerConfig()));
      meshes.push_back(*players_.back()->mesh);
      if (sharing) players_.back()->membership = std::make_unique<BoardMembership>(board_);
    }
    scene_ = std::make_unique<CrossingScene>(meshes, config);
  }

  void initialiseAll() {
    for (std::size_t k = 0; k < players_.size(); ++k) {
      Pose rough = scene_->truth(k, 0.0);
      rough.translation() += Eigen::Vector3d(0.003, -0.003, 0.004);
      players_[k]->tracker->initialise(rough);
    }
  }

  Pose truth(std::size_t k) const { return scene_->truth(k, num_frames_ * kFrameS); }

  void run(int frames) {
    for (int i = 0; i < frames; ++i) step();
  }

  /// Every tracker knows what the others said last: of this image or of the one before.
  void step() {
    const CrossingFrame& frame = scene_->render(num_frames_++ * kFrameS);
    const DepthImageView view = viewOf(frame.depth_mm, config_.camera);
    for (std::size_t k = 0; k < players_.size(); ++k) {
      Player& player = *players_[k];
      const double begin_s = cpuSeconds();
      const bool any = player.membership && player.others.place(player.membership->hear("camera"), frame.stamp_s) > 0;
      player.result =
          player.tracker->update(view, config_.camera, frame.stamp_s, std::nullopt, any ? &player.others : nullptr);
      cpu_s_ += cpuSeconds() - begin_s;
      if (player.membership) player.membership->tell("camera", player.result, player.mesh);
      judge(player, frame, k);
    }
  }

  void print(const char* what) {
    std::printf("%s: %.1f ms of processor time per object and image\n", what,
                1e3 * cpu_s_ / num_frames_ / static_cast<double>(players_.size()));
    for (auto& player : players_) {
      std::printf(
          "  %-8s ADD median %.2f mm; of %d images lost %d, hidden %d, wrong %d, swapped %d; at least %.0f %% "
          "visible\n",
          player->mesh_name.c_str(), 1e3 * player->median(), num_frames_, player->lost, player->hidden, player->wrong,
          player->swapped, 100.0 * player->least_visible);
    }
  }
  std::vector<std::unique_ptr<Player>>& players() { return players_; }

 private:
  void judge(Player& player, const CrossingFrame& frame, std::size_t k) const {
    constexpr double kWrongM = 0.03;
    player.least_visible = std::min(player.least_visible, frame.visible_fraction[k]);
    player.lost += player.result.state == TrackerState::kLost ? 1 : 0;
    player.hidden += player.result.state == TrackerState::kOccluded ? 1 : 0;
    if (player.result.state != TrackerState::kTracking) return;
    const Pose& estimate = player.result.T_camera_object;
    const double error_m = player.meter->measure(estimate, frame.T_camera_object[k]).add_m;
    player.errors_m.push_back(error_m);
    player.wrong += error_m > kWrongM ? 1 : 0;
    player.swapped += isAtTwin(player, estimate, frame, k) ? 1 : 0;
  }

  /// Nearer to another object of the same mesh than to its own.
  bool isAtTwin(const Player& player, const Pose& estimate, const CrossingFrame& frame, std::size_t k) const {
    const auto distance = [&](std::size_t i) {
      return (frame.T_camera_object[i].translation() - estimate.translation()).norm();
    };
    for (std::size_t other = 0; other < players_.size(); ++other) {
      const bool is_twin = other != k && players_[other]->mesh_name == player.mesh_name;
      if (is_twin && distance(other) < distance(k)) return true;
    }
    return false;
  }

  CrossingSceneConfig config_;
  std::shared_ptr<EstimateBoard> board_ = std::make_shared<EstimateBoard>();
  std::vector<std::unique_ptr<Player>> players_;
  std::unique_ptr<CrossingScene> scene_;
  int num_frames_ = 0;
  double cpu_s_ = 0.0;
};

TEST(ManyObjects, FollowsFourThatCrossOneAnother) {
  const CrossingSceneConfig config;
  ManyObjects alone(config, false), together(config, true);
  for (ManyObjects* run : {&alone, &together}) {
    run->initialiseAll();
    run->run(240);
  }
  alone.print("not knowing of one another");
  together.print("knowing of one another");
  for (std::size_t k = 0; k < kObjects.size(); ++k) {
    Player& player = *together.players()[k];
    EXPECT_TRUE(k == 0 || player.least_visible < 0.5) << "the scene is too easy for object " << k;
    EXPECT_EQ(player.lost, 0) << kObjects[k];
    EXPECT_EQ(player.wrong, 0) << kObjects[k];
    EXPECT_LT(player.median(), 0.0015) << kObjects[k];
    EXPECT_LT(player.median(), 1.2 * alone.players()[k]->median() + 0.0001) << kObjects[k];
  }
}

TEST(ManyObjects, IsNotTakenForItsTwinThatHidesItCompletely) {
  CrossingSceneConfig config;
  config.lane_rad = 0.0;
  ManyObjects alone(config, false), together(config, true);
  for (ManyObjects* run : {&alone, &together}) {
    run->initialiseAll();
    run->run(240);
  }
  alone.print("hidden, not knowing of one another");
  together.print("hidden, knowing of one another");
  EXPECT_LT(together.players()[2]->least_visible, 0.05);
  for (auto& player : together.players()) {
    EXPECT_EQ(player->swapped, 0) << player->mesh_name;
    EXPECT_EQ(player->lost, 0) << player->mesh_name;
  }
}

TEST(ManyObjects, IsNotFoundWhereItsTwinIsTracked) {
  CrossingSceneConfig config;
  config.amplitude_m = 0.1;
  config.period_s = 60.0;  // nearly at rest
  config.amplitude_rad = 0.0;
  ManyObjects run(config, true);
  run.players()[1]->tracker->initialise(run.truth(1));
  run.run(3);
  run.players()[2]->tracker->initialiseAnywhere();
  for (int i = 0; i < 60 && run.players()[2]->result.state != TrackerState::kTracking; ++i) run.step();
  run.run(5);
  run.print("searched while its twin is tracked");
  EXPECT_EQ(run.players()[2]->result.state, TrackerState::kTracking);
  EXPECT_EQ(run.players()[1]->swapped + run.players()[2]->swapped, 0);
}

}  // namespace
}  // namespace depth_object_tracker
