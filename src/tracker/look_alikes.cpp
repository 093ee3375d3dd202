// SPDX-License-Identifier: BSD-3-Clause
#include "depth_object_tracker/tracker/look_alikes.h"

#include "depth_object_tracker/filter/likelihood_climb.h"
#include "tracker/pose_evidence.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace depth_object_tracker {
namespace {

constexpr std::size_t kRotations = 1500;  // looked at: some 20 degrees apart
constexpr std::size_t kMaxLookAlikes = 32;
constexpr std::size_t kSurfacePoints = 2000, kFewPoints = 60, kManyPoints = 250;
constexpr double kReachPerDiameter = 0.08;      // to the nearest of the surface's points
constexpr double kTolerancePerDiameter = 0.03;  // off the surface
constexpr double kApartRad = 0.3;
constexpr double kLeastOverlapAtFirst = 0.45, kLeastOverlap = 0.7;
constexpr double kSameNormalCosine = 0.7;
constexpr int kAlignments = 6;

constexpr double kBroadM = 0.012;
constexpr ClimbSchedule kClimb = {kBroadM, 0.002, 5};
constexpr double kNearbyNat = 3.0, kSurelyNat = 8.0;
constexpr double kPromisingNat = 5.0, kPerhapsPromisingNat = 30.0;
constexpr std::size_t kPerImage = 8, kClimbsWhenNew = 3;
constexpr double kImpossibleNat = 4.0;  // what was known speaks against a turn
constexpr double kMostNat = 4.0;
constexpr double kWorthFollowingNat = 1.5;  // less is chance, in every image
constexpr double kForgottenHalfLifeS = 0.25;
constexpr std::array<double, 4> kSmallTurnsRad = {-0.2, -0.1, 0.1, 0.2};

using Triangle = std::array<std::uint32_t, 3>;

double angle(const Eigen::Matrix3d& R) {
  return std::acos(std::clamp(0.5 * (R.trace() - 1.0), -1.0, 1.0));
}

/// Points spread evenly over the surface.
std::vector<OrientedPoint> surfacePoints(const TriangleMesh& mesh, const Eigen::Vector3d& centre) {
  const auto corner = [&](const Triangle& triangle, int k) -> Eigen::Vector3d {
    return mesh.vertices[static_cast<std::size_t>(triangle[static_cast<std::size_t>(k)])].cast<double>() - centre;
  };
  const auto double_area = [&](const Triangle& t) -> Eigen::Vector3d {
    return (corner(t, 1) - corner(t, 0)).cross(corner(t, 2) - corner(t, 0));
  };
  double area = 0.0;
  for (const Triangle& triangle : mesh.triangles) area += double_area(triangle).norm();
  std::vector<OrientedPoint> points;
  double passed = 0.0;
  for (const Triangle& triangle : mesh.triangles) {
    const Eigen::Vector3d normal = double_area(triangle);
    passed += normal.norm() / area * static_cast<double>(kSurfacePoints);
    while (static_cast<double>(points.size()) + 0.5 < passed) {
      // Additive recurrence, folded into the triangle.
      const double n = static_cast<double>(points.size());
      double u = n * 0.7548776662466927, v = n * 0.5698402909980532;
      u -= std::floor(u);
      v -= std::floor(v);
      if (u + v > 1.0) {
        u = 1.0 - u;
        v = 1.0 - v;
      }
      const Eigen::Vector3d origin = corner(triangle, 0);
      points.push_back(
          {origin + u * (corner(triangle, 1) - origin) + v * (corner(triangle, 2) - origin), normal.normalized()});
    }
  }
  return points;
}

/// Nearest point with about the same normal; meshes may be wound either way.
const OrientedPoint* nearest(const std::vector<OrientedPoint>& points, const Eigen::Vector3d& point,
                             const Eigen::Vector3d& normal, double reach_m) {
  const OrientedPoint* best = nullptr;
  double least = reach_m * reach_m;
  for (const OrientedPoint& other : points) {
    const double squared = (other.point - point).squaredNorm();
    if (squared >= least || std::abs(other.normal.dot(normal)) < kSameNormalCosine) continue;
    least = squared;
    best = &other;
  }
  return best;
}

/// How an object lies on itself when it is moved.
struct Overlap {
  double share = 0.0;              ///< of its surface that lies on its surface
  Pose better = Pose::Identity();  ///< lays the parts that do on one another better
};

/// @param queries points of the surface that are looked at.
Overlap overlapAt(const std::vector<OrientedPoint>& surface, std::size_t queries, const Pose& T, double diameter_m) {
  Overlap result;
  result.better = T;
  Matrix6d information = 1e-6 * Matrix6d::Identity();
  Vector6d gradient = Vector6d::Zero();
  const std::size_t count = std::min(queries, surface.size());
  for (std::size_t i = 0; i < count; ++i) {
    const OrientedPoint& point = surface[i * surface.size() / count];
    const Eigen::Vector3d moved = T * point.point;
    const OrientedPoint* other = nearest(surface, moved, T.linear() * point.normal, kReachPerDiameter * diameter_m);
    if (other == nullptr) continue;
    const double off = other->normal.dot(other->point - moved);
    result.share += std::abs(off) < kTolerancePerDiameter * diameter_m ? 1.0 / static_cast<double>(count) : 0.0;
    Vector6d jacobian;
    jacobian << other->normal, (moved - T.translation()).cross(other->normal);
    information += jacobian * jacobian.transpose();
    gradient += off * jacobian;
  }
  information.diagonal().tail<3>().array() += 1e-3 * diameter_m * diameter_m;
  information.diagonal().head<3>().array() += 1e-3;
  result.better = perturb(T, information.ldlt().solve(gradient));
  return result;
}

/// Evidence [nat] that a turn needs: the farther, the surer.
double needed(const Pose& from, const Pose& to, const TurnPrior& prior) {
  const double turned = angle(from.linear().transpose() * to.linear()) / prior.stddev_rad;
  return kSurelyNat + 0.5 * turned * turned;
}

bool isNearAny(const Pose& T, const std::vector<Pose>& others, const Symmetries& symmetries) {
  const auto near = [&](const Pose& other) {
    return angle(foldOntoReference(T, other, symmetries).linear().transpose() * other.linear()) < kApartRad;
  };
  return near(Pose::Identity()) || std::any_of(others.begin(), others.end(), near);
}

/// Turns about the axis all the way instead of those that happened to be found.
void spaceEvenly(const ScrewAxis& axis, std::vector<Pose>& turns) {
  constexpr int kTurns = 20;
  turns.erase(std::remove_if(turns.begin(), turns.end(), [&](const Pose& T) { return isSame(axisOf(T), axis); }),
              turns.end());
  for (int k = 1; k < kTurns; ++k) turns.push_back(turnAbout(axis, 2.0 * M_PI * k / kTurns));
}

}  // namespace

LookAlikes findLookAlikes(const TriangleMesh& mesh, const Eigen::Vector3d& centre_object,
                          const Symmetries& symmetries) {
  const std::vector<OrientedPoint> surface = surfacePoints(mesh, centre_object);
  const double diameter_m = diameter(mesh);
  std::vector<std::pair<double, Pose>> found;
  for (std::size_t k = 0; k < kRotations && !surface.empty(); ++k) {
    Pose T = Pose::Identity();
    T.linear() = evenlySpreadRotation(k);
    Overlap overlap = overlapAt(surface, kFewPoints, T, diameter_m);
    if (overlap.share < kLeastOverlapAtFirst) continue;
    for (int i = 0; i < kAlignments; ++i) overlap = overlapAt(surface, kFewPoints, overlap.better, diameter_m);
    const double share = overlapAt(surface, kManyPoints, overlap.better, diameter_m).share;
    if (share >= kLeastOverlap) found.emplace_back(share, overlap.better);
  }
  std::stable_sort(found.begin(), found.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
  LookAlikes look_alikes;
  for (const auto& [share, T] : found) {
    if (look_alikes.far.size() < kMaxLookAlikes && !isNearAny(T, look_alikes.far, symmetries)) {
      look_alikes.far.push_back(T);
    }
  }
  look_alikes.axes = commonAxes(look_alikes.far);
  for (const ScrewAxis& axis : look_alikes.axes) spaceEvenly(axis, look_alikes.far);
  return look_alikes;
}

void LookAlikeCheck::rankCandidates(DepthLikelihood& likelihood, const Pose& T_camera_centre) {
  const std::size_t count = std::min(kPerImage, look_alikes_.far.size());
  poses_.clear();
  for (std::size_t i = 0; i < count; ++i) {
    poses_.push_back(T_camera_centre * look_alikes_.far[(next_ + i) % look_alikes_.far.size()]);
  }
  next_ = (next_ + count) % look_alikes_.far.size();
  if (pending_) poses_.push_back(T_camera_centre * pending_->T_centre_centre);
  poses_.push_back(T_camera_centre);
  likelihood.prepare(poses_);
  poses_.resize(count);
  candidates_.clear();
  for (const Pose& pose : poses_) candidates_.push_back({likelihood.broadLogLikelihood(pose, kBroadM, 0), pose});
  std::sort(candidates_.begin(), candidates_.end(),
            [](const Candidate& a, const Candidate& b) { return a.broad > b.broad; });
}

std::optional<Pose> LookAlikeCheck::findBetter(DepthLikelihood& likelihood, const Pose& T_camera_centre,
                                               double exponent, const TurnPrior& prior, double dt_s) {
  if (look_alikes_.far.empty()) return std::nullopt;
  illusions_.age(dt_s);
  if (std::optional<Pose> nearby = findNearby(likelihood, T_camera_centre, exponent)) return nearby;
  if (prior.was_followed) pending_.reset();
  rankCandidates(likelihood, T_camera_centre);
  const double now = likelihood.logLikelihood(T_camera_centre, 0);
  const auto evidence = [&](const Pose& pose) {
    const double nat = exponent * (likelihood.logLikelihood(pose, 0) - now);
    return std::abs(nat) > kWorthFollowingNat ? nat + outlineEvidence(likelihood, pose, T_camera_centre) : nat;
  };

  // Of a pose that was followed only what is as good already is worth the climb.
  const double least = likelihood.broadLogLikelihood(T_camera_centre, kBroadM, 0) -
                       (prior.was_followed ? kPromisingNat : kPerhapsPromisingNat) / exponent;
  const std::size_t climbs = prior.was_followed ? 1 : kClimbsWhenNew;
  std::optional<Pose> best;
  double found = -std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < std::min(climbs, candidates_.size()) && candidates_[i].broad > least; ++i) {
    const Pose climbed = climbLikelihood(likelihood, candidates_[i].pose, kClimb, 0);
    const double value = evidence(climbed);
    if (!(value > found)) continue;
    found = value;
    best = climbed;
  }
  if (best && found - illusions_.known(T_camera_centre.inverse() * *best) > needed(T_camera_centre, *best, prior)) {
    pending_.reset();
    return best;
  }
  if (best) learnIllusion(T_camera_centre.inverse() * *best, found, prior, dt_s);
  if (prior.was_followed) return std::nullopt;
  if (!pending_ && best && found > kWorthFollowingNat) pending_ = Pending{T_camera_centre.inverse() * *best, 0.0};
  return followPending(likelihood, T_camera_centre, prior, evidence, dt_s);
}

void LookAlikeCheck::learnIllusion(const Pose& T_centre_centre, double nat, const TurnPrior& prior, double dt_s) {
  const double turned = angle(T_centre_centre.linear()) / prior.stddev_rad;
  const double images = static_cast<double>(look_alikes_.far.size()) / static_cast<double>(kPerImage);
  const double since_last_s = dt_s * std::max(1.0, images);
  if (0.5 * turned * turned > kImpossibleNat) {
    illusions_.learn(T_centre_centre, nat, since_last_s);
  } else {
    illusions_.fade(T_centre_centre, nat, since_last_s);
  }
}

std::optional<Pose> LookAlikeCheck::findNearby(DepthLikelihood& likelihood, const Pose& T_camera_centre,
                                               double exponent) {
  constexpr ClimbSchedule kClimbNear = {0.004, 0.002, 5};
  const Pose* best = nullptr;
  poses_.clear();
  for (const ScrewAxis& axis : look_alikes_.axes) {
    for (const double turn : kSmallTurnsRad) poses_.push_back(T_camera_centre * turnAbout(axis, turn));
  }
  if (poses_.empty()) return std::nullopt;
  poses_.push_back(T_camera_centre);
  likelihood.prepare(poses_);
  poses_.pop_back();
  const double now = likelihood.logLikelihood(T_camera_centre, 0);
  double highest = now - kPromisingNat / exponent;
  for (const Pose& pose : poses_) {
    const double value = likelihood.logLikelihood(pose, 0);
    if (!(value > highest)) continue;
    highest = value;
    best = &pose;
  }
  if (best == nullptr) return std::nullopt;
  const Pose climbed = climbLikelihood(likelihood, *best, kClimbNear, 0);
  if (exponent * (likelihood.logLikelihood(climbed, 0) - now) < kNearbyNat) return std::nullopt;
  return climbed;
}

std::optional<Pose> LookAlikeCheck::followPending(DepthLikelihood& likelihood, const Pose& T_camera_centre,
                                                  const TurnPrior& prior,
                                                  const std::function<double(const Pose&)>& evidence, double dt_s) {
  if (!pending_) return std::nullopt;
  const Pose climbed = climbLikelihood(likelihood, T_camera_centre * pending_->T_centre_centre, kClimb, 0);
  pending_->T_centre_centre = T_camera_centre.inverse() * climbed;
  // Images in a row are wrong in the same way: none counts for much, and none for long.
  pending_->evidence = pending_->evidence * std::exp2(-dt_s / kForgottenHalfLifeS) +
                       std::clamp(evidence(climbed), -kMostNat, kMostNat) - kWorthFollowingNat;
  const bool is_other = angle(pending_->T_centre_centre.linear()) > 0.5 * kApartRad;
  const bool is_better = pending_->evidence > needed(T_camera_centre, climbed, prior);
  if (is_better || !is_other || pending_->evidence <= 0.0) pending_.reset();
  if (!is_better) return std::nullopt;
  return climbed;
}

}  // namespace depth_object_tracker
