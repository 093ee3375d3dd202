// SPDX-License-Identifier: BSD-3-Clause
#include "depth_object_tracker/simulator/tag_placement.h"

#include "depth_object_tracker/geometry/shape_meshes.h"
#include "depth_object_tracker/simulator/random_source.h"
#include "depth_object_tracker/simulator/ray_cast.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <stdexcept>

namespace depth_object_tracker {
namespace {

constexpr std::uint64_t kStream = 121;
constexpr int kCandidates = 1500;
constexpr int kProbes = 5;             // per edge of the card
constexpr double kCardShare = 1.25;    // edge of the card per edge of the black square
constexpr double kOutsideM = 0.05;     // probes start so far above the surface
constexpr double kTurnWeightM = 0.03;  // a right angle between two cards is worth so many metres between them

/// Surface heights below a square card, seen along its normal.
std::optional<Fiducial> layDown(const TriangleMesh& object, const Eigen::Vector3d& point,
                                const Eigen::Vector3d& outward, double spin, const TagPlacementConfig& config) {
  Fiducial tag;
  tag.size_m = config.size_m;
  tag.T_object_tag.linear() = rotationWithZ(-outward) * expSo3(spin * Eigen::Vector3d::UnitZ());
  const double edge = kCardShare * config.size_m;
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (int probe = 0; probe < kProbes * kProbes; ++probe) {
    const Eigen::Vector2d at = Eigen::Vector2d(probe % kProbes, probe / kProbes) * (edge / (kProbes - 1)) -
                               Eigen::Vector2d::Constant(0.5 * edge);
    const Eigen::Vector3d above = point + tag.T_object_tag.linear() * Eigen::Vector3d(at.x(), at.y(), -kOutsideM);
    const auto distance = castRay(object, above, -outward);
    if (!distance) return std::nullopt;
    low = std::min(low, kOutsideM - *distance);
    high = std::max(high, kOutsideM - *distance);
  }
  if (high - low > config.max_unevenness_m) return std::nullopt;
  tag.T_object_tag.translation() = point + high * outward;
  return tag;
}

std::optional<Fiducial> candidate(const TriangleMesh& object, const Eigen::Vector3d& centre, double reach_m,
                                  const TagPlacementConfig& config, RandomSource& random) {
  // A ray from outside to a random point near the middle meets the surface where a person could stick something.
  const Eigen::Vector3d direction = random.unitVector();
  const Eigen::Vector3d aim = centre + 0.6 * reach_m * random.uniform() * random.unitVector();
  const Eigen::Vector3d origin = aim + 2.0 * reach_m * direction;
  const auto distance = castRay(object, origin, -direction);
  if (!distance) return std::nullopt;
  const Eigen::Vector3d point = origin - *distance * direction;
  // The surface's own direction, from three rays beside one another.
  const Eigen::Vector3d x = direction.unitOrthogonal(), y = direction.cross(x);
  const double step = 0.25 * config.size_m;
  const auto at_x = castRay(object, origin + step * x, -direction),
             at_y = castRay(object, origin + step * y, -direction);
  if (!at_x || !at_y) return std::nullopt;
  const Eigen::Vector3d to_x = origin + step * x - *at_x * direction - point,
                        to_y = origin + step * y - *at_y * direction - point;
  Eigen::Vector3d outward = to_x.cross(to_y).normalized();
  if (outward.dot(direction) < 0.0) outward = -outward;
  return layDown(object, point, outward, random.uniform(0.0, 2.0 * M_PI), config);
}

double separation(const Fiducial& a, const Fiducial& b) {
  const double turn = 1.0 - a.T_object_tag.linear().col(2).dot(b.T_object_tag.linear().col(2));
  return (a.T_object_tag.translation() - b.T_object_tag.translation()).norm() + kTurnWeightM * turn;
}

bool overlaps(const Fiducial& a, const Fiducial& b) {
  const bool same_side = a.T_object_tag.linear().col(2).dot(b.T_object_tag.linear().col(2)) > 0.0;
  const double apart = (a.T_object_tag.translation() - b.T_object_tag.translation()).norm();
  return same_side && apart < M_SQRT2 * kCardShare * a.size_m;
}

}  // namespace

FiducialMap placeTags(const TriangleMesh& object, const TagPlacementConfig& config) {
  RandomSource random(config.seed, kStream);
  const BoundingBox box = boundingBox(object);
  const Eigen::Vector3d centre = 0.5 * (box.min + box.max);
  std::vector<Fiducial> candidates;
  for (int k = 0; k < kCandidates; ++k) {
    const auto tag = candidate(object, centre, 0.5 * box.size().norm(), config, random);
    if (tag) candidates.push_back(*tag);
  }
  FiducialMap map;
  while (static_cast<int>(map.tags.size()) < config.num_tags) {
    // The candidate farthest from all cards so far.
    const Fiducial* best = nullptr;
    double best_separation = -1.0;
    for (const Fiducial& tag : candidates) {
      double nearest = std::numeric_limits<double>::max();
      bool fits = true;
      for (const Fiducial& placed : map.tags) {
        nearest = std::min(nearest, separation(tag, placed));
        fits = fits && !overlaps(tag, placed);
      }
      if (fits && nearest > best_separation) {
        best = &tag;
        best_separation = nearest;
      }
    }
    if (best == nullptr) break;
    map.tags.push_back(*best);
    map.tags.back().id = static_cast<int>(map.tags.size()) - 1;
  }
  if (map.tags.empty()) {
    throw std::invalid_argument("the object has no place flat enough for a tag of " + std::to_string(config.size_m) +
                                " m; take a smaller one or allow more unevenness");
  }
  return map;
}

}  // namespace depth_object_tracker
