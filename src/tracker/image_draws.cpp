// SPDX-License-Identifier: BSD-3-Clause
#include "depth_object_tracker/tracker/image_draws.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

namespace depth_object_tracker {

ImageDraws::ImageDraws(std::vector<OrientedPoint> object_points, double diameter_m, std::uint64_t seed,
                       std::shared_ptr<WorkerPool> pool)
    : random_(seed),
      pool_(std::move(pool)),
      object_points_(std::move(object_points)),
      pairs_(object_points_, diameter_m),
      votes_(static_cast<std::size_t>(pool_->numThreads()), PairVotes(pairs_)) {}

void ImageDraws::setPoints(std::vector<OrientedPoint> image_points, const PinholeCamera& camera, int step_px) {
  image_points_ = std::move(image_points);
  camera_ = camera;
  step_px_ = step_px;
  rows_ = camera.height / step_px + 1;
  cols_ = camera.width / step_px + 1;
  point_at_.assign(static_cast<std::size_t>(rows_) * static_cast<std::size_t>(cols_), -1);
  for (std::size_t i = 0; i < image_points_.size(); ++i) {
    const Eigen::Vector2d pixel = camera_.project(image_points_[i].point);
    const int row = static_cast<int>(pixel.y()) / step_px_, col = static_cast<int>(pixel.x()) / step_px_;
    if (row < 0 || row >= rows_ || col < 0 || col >= cols_) continue;
    point_at_[static_cast<std::size_t>(row) * static_cast<std::size_t>(cols_) + static_cast<std::size_t>(col)] =
        static_cast<int>(i);
  }
}

Pose ImageDraws::draw(std::uint64_t number) const {
  constexpr std::uint64_t kSingleEvery = 8;  // of one point: an object may show hardly more
  if (number % kSingleEvery != 0) {
    if (const auto pose = drawPair(number)) return *pose;
  }
  // Additive recurrences: all pairs of points with all turns, evenly however many are taken.
  const auto fraction = [&](double step) {
    const double value = static_cast<double>(number) * step;
    return value - std::floor(value);
  };
  const auto pick = [&](double step, const std::vector<OrientedPoint>& points) -> const OrientedPoint& {
    return points[static_cast<std::size_t>(fraction(step) * static_cast<double>(points.size()))];
  };
  return layOn(pick(0.8191725133961645, image_points_), pick(0.6710436067037893, object_points_),
               2.0 * M_PI * fraction(0.5497004779019703));
}

std::optional<Pose> ImageDraws::drawPair(std::uint64_t number) const {
  constexpr std::uint32_t kTries = 4;
  const auto uniform = [&](std::uint32_t index) { return random_.uniform(RandomPurpose::kSearch, number, index); };
  const OrientedPoint& first =
      image_points_[static_cast<std::size_t>(uniform(0) * static_cast<double>(image_points_.size()))];
  const Eigen::Vector2d pixel = camera_.project(first.point);
  const double reach_px = reachPx(first);
  for (std::uint32_t k = 0; k < kTries; ++k) {
    const auto at = [&](std::uint32_t index) { return uniform(1 + 7 * k + index); };
    const OrientedPoint* second = neighbourOf(pixel, reach_px * at(1), 2.0 * M_PI * at(0));
    if (second == nullptr) continue;
    auto pose = pairs_.layOn(first, *second, {at(2), at(3), at(4), at(5)}, at(6));
    if (pose) return pose;
  }
  return std::nullopt;
}

/// How far from a point of the object another may be seen; right before the lens not beyond the image.
double ImageDraws::reachPx(const OrientedPoint& point) const {
  return std::min(camera_.fx * pairs_.mostDistanceM() / point.point.z(),
                  static_cast<double>(camera_.width + camera_.height));
}

/// The image's point at a distance and in a direction from a pixel. @return null where there is none.
const OrientedPoint* ImageDraws::neighbourOf(const Eigen::Vector2d& pixel, double radius_px, double turn_rad) const {
  const int row = static_cast<int>(std::floor((pixel.y() + radius_px * std::sin(turn_rad)) / step_px_));
  const int col = static_cast<int>(std::floor((pixel.x() + radius_px * std::cos(turn_rad)) / step_px_));
  if (row < 0 || row >= rows_ || col < 0 || col >= cols_) return nullptr;
  const int index =
      point_at_[static_cast<std::size_t>(row) * static_cast<std::size_t>(cols_) + static_cast<std::size_t>(col)];
  return index < 0 ? nullptr : &image_points_[static_cast<std::size_t>(index)];
}

std::vector<Pose> ImageDraws::drawVotes(std::uint64_t number, int references) {
  constexpr int kPosesPerReference = 5;
  voted_.resize(static_cast<std::size_t>(references));
  const auto task = [&](int index, int thread) {
    const auto i = static_cast<std::size_t>(index);
    PairVotes& votes = votes_[static_cast<std::size_t>(thread)];
    letNeighboursVote(number + i, votes);
    voted_[i].clear();
    votes.bestPoses(kPosesPerReference, voted_[i]);
  };
  pool_->run(references, std::cref(task));
  std::vector<Pose> poses;
  for (const std::vector<Pose>& some : voted_) poses.insert(poses.end(), some.begin(), some.end());
  return poses;
}

void ImageDraws::letNeighboursVote(std::uint64_t number, PairVotes& votes) const {
  const auto uniform = [&](std::uint32_t index) { return random_.uniform(RandomPurpose::kSearch, number, index); };
  const OrientedPoint& reference =
      image_points_[static_cast<std::size_t>(uniform(0) * static_cast<double>(image_points_.size()))];
  votes.start(reference);
  const Eigen::Vector2d pixel = camera_.project(reference.point) / step_px_;
  const int reach = static_cast<int>(reachPx(reference)) / step_px_;
  constexpr int kMostReach = 70;  // some 20,000 voters at most, however near the reference is
  const int stride = 1 + reach / (kMostReach + 1);
  const int row = static_cast<int>(pixel.y()), col = static_cast<int>(pixel.x());
  for (int r = std::max(0, row - reach); r <= std::min(rows_ - 1, row + reach); r += stride) {
    for (int c = std::max(0, col - reach); c <= std::min(cols_ - 1, col + reach); c += stride) {
      const int cell = r * cols_ + c;
      const int other = point_at_[static_cast<std::size_t>(cell)];
      if (other < 0) continue;
      constexpr std::uint32_t kNumbers = 5;
      const auto at = [&](std::uint32_t index) {
        return uniform(1 + kNumbers * static_cast<std::uint32_t>(other) + index);
      };
      votes.vote(image_points_[static_cast<std::size_t>(other)], {at(0), at(1), at(2), at(3)}, at(4));
    }
  }
}

}  // namespace depth_object_tracker
