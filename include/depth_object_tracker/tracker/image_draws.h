// SPDX-License-Identifier: BSD-3-Clause
// Poses that lay points of the object on points of an image: one on one, pairs on pairs, and those that most pairs
// around one point vote for.
#pragma once

#include "depth_object_tracker/filter/random.h"
#include "depth_object_tracker/filter/worker_pool.h"
#include "depth_object_tracker/tracker/oriented_points.h"
#include "depth_object_tracker/tracker/pair_votes.h"
#include "depth_object_tracker/tracker/point_pairs.h"

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

namespace depth_object_tracker {

class ImageDraws {
 public:
  /// @param object_points as objectPoints() has them. @param diameter_m > 0, of the object.
  ImageDraws(std::vector<OrientedPoint> object_points, double diameter_m, std::uint64_t seed,
             std::shared_ptr<WorkerPool> pool);
  ImageDraws(const ImageDraws&) = delete;  // the votes know the pairs
  ImageDraws& operator=(const ImageDraws&) = delete;

  /// Points of a new image, found on the grid of every step_px pixels; see imagePoints().
  void setPoints(std::vector<OrientedPoint> image_points, const PinholeCamera& camera, int step_px);

  /// False when the image or the object has no point.
  bool canDraw() const { return !image_points_.empty() && !object_points_.empty(); }

  /// Draw `number` of an endless sequence. canDraw() must hold. Thread-safe.
  Pose draw(std::uint64_t number) const;

  /// The few poses that each of `references` points gets most votes for. canDraw() must hold.
  /// @param number of the first reference in an endless sequence.
  std::vector<Pose> drawVotes(std::uint64_t number, int references);

  const std::vector<OrientedPoint>& objectPoints() const { return object_points_; }

 private:
  std::optional<Pose> drawPair(std::uint64_t number) const;
  void letNeighboursVote(std::uint64_t number, PairVotes& votes) const;
  double reachPx(const OrientedPoint& point) const;
  const OrientedPoint* neighbourOf(const Eigen::Vector2d& pixel, double radius_px, double turn_rad) const;

  CounterRandom random_;
  std::shared_ptr<WorkerPool> pool_;
  std::vector<OrientedPoint> object_points_, image_points_;
  PointPairs pairs_;
  std::vector<PairVotes> votes_;          // one for each thread
  std::vector<std::vector<Pose>> voted_;  // by each reference
  PinholeCamera camera_;
  int step_px_ = 1;
  int rows_ = 0, cols_ = 0;    // of the grid
  std::vector<int> point_at_;  // of image_points_, by cell of the grid; -1: none
};

}  // namespace depth_object_tracker
