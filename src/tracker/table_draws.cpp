// SPDX-License-Identifier: BSD-3-Clause
#include "depth_object_tracker/tracker/table_draws.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <utility>

namespace depth_object_tracker {
namespace {

constexpr double kHorizontalEnough = 0.3;  // share of a normal in the plane that tells a direction

/// Where a plane was seen, in squares on it; what stands on it hides some of it.
class SeenArea {
 public:
  SeenArea(const ImagePlane& plane, double square_m)
      : along_(plane.normal.unitOrthogonal()), across_(plane.normal.cross(along_)), square_m_(square_m) {
    for (const Eigen::Vector3d& point : plane.points) {
      const auto [i, j] = squareOf(point);
      for (int di = -1; di <= 1; ++di) {
        for (int dj = -1; dj <= 1; ++dj) squares_.emplace(i + di, j + dj);
      }
    }
  }
  bool isAbove(const Eigen::Vector3d& point) const { return squares_.count(squareOf(point)) > 0; }

 private:
  std::pair<int, int> squareOf(const Eigen::Vector3d& point) const {
    return {static_cast<int>(std::floor(along_.dot(point) / square_m_)),
            static_cast<int>(std::floor(across_.dot(point) / square_m_))};
  }

  Eigen::Vector3d along_, across_;
  double square_m_;
  std::set<std::pair<int, int>> squares_;
};

std::vector<double> summedUp(std::vector<double> weights) {
  double sum = 0.0;
  for (double& weight : weights) sum = weight += sum;
  for (double& weight : weights) weight /= sum;
  return weights;
}

std::size_t indexAt(const std::vector<double>& summed, double uniform) {
  const auto found = std::lower_bound(summed.begin(), summed.end(), uniform);
  return std::min(static_cast<std::size_t>(found - summed.begin()), summed.size() - 1);
}

Eigen::Vector3d inPlane(const Eigen::Vector3d& vector, const Eigen::Vector3d& normal) {
  return vector - vector.dot(normal) * normal;
}

}  // namespace

TableDraws::TableDraws(const TriangleMesh& mesh, const Eigen::Vector3d& centre_object,
                       const std::vector<OrientedPoint>& object_points, std::uint64_t seed)
    : diameter_m_(diameter(mesh)),
      feature_m_(featureSize(mesh, diameter_m_)),
      random_(seed),
      object_points_(object_points),
      rests_(stablePoses(mesh, centre_object)) {
  // What is unlikely by chance may have been put so by hand: a bottle is stood up.
  std::vector<double> weights;
  for (const StablePose& rest : rests_) weights.push_back(std::sqrt(rest.probability));
  if (!weights.empty()) rest_weights_ = summedUp(weights);
}

void TableDraws::setImage(const std::vector<ImagePlane>& planes, const DepthImageView& depth,
                          const PinholeCamera& camera, double max_depth_m, int step_px) {
  constexpr double kSquarePerDiameter = 0.5, kTallestPerDiameter = 1.05, kAboveTolerances = 1.3;
  constexpr std::size_t kLeastPoints = 3;
  tables_.clear();
  planes_ = planes;
  const std::vector<OrientedPoint> points =
      allImagePoints(depth, camera, kPatchReachPerSize * feature_m_, max_depth_m, step_px);
  std::vector<double> weights;
  for (const ImagePlane& plane : planes_) {
    const SeenArea area(plane, kSquarePerDiameter * diameter_m_);
    Table table{plane, {}};
    for (const OrientedPoint& point : points) {
      const double height = plane.heightOf(point.point);
      const bool stands =
          height > kAboveTolerances * planeToleranceM(point.point.z()) && height < kTallestPerDiameter * diameter_m_;
      if (stands && area.isAbove(point.point)) table.standing.push_back(point);
    }
    if (table.standing.size() < kLeastPoints) continue;
    weights.push_back(std::sqrt(static_cast<double>(table.standing.size()) * plane.share));
    tables_.push_back(std::move(table));
  }
  if (!tables_.empty()) table_weights_ = summedUp(weights);
}

Pose TableDraws::draw(std::uint64_t number) const {
  constexpr std::uint64_t kLeaningEvery = 5;
  const Table& table = chooseTable(random_.uniform(RandomPurpose::kSearch, number, 0));
  return rests_.empty() || number % kLeaningEvery == 0 ? drawLeaning(table, number) : drawResting(table, number);
}

Pose TableDraws::drawResting(const Table& table, std::uint64_t number) const {
  constexpr std::uint32_t kTries = 12;
  constexpr double kHeightPerDiameter = 0.04, kSameTilt = 0.3;
  const auto uniform = [&](std::uint32_t index) { return random_.uniform(RandomPurpose::kSearch, number, index); };
  const StablePose& rest = chooseRest(uniform(1));
  const Eigen::Vector3d& up = table.plane.normal;
  const Eigen::Matrix3d R_upright = Eigen::Quaterniond::FromTwoVectors(rest.up, up).toRotationMatrix();
  const OrientedPoint *seen = nullptr, *own = nullptr;
  for (std::uint32_t k = 0; k < kTries; ++k) {
    const auto pick = [&](std::uint32_t index, const std::vector<OrientedPoint>& points) {
      return &points[static_cast<std::size_t>(uniform(index) * static_cast<double>(points.size()))];
    };
    seen = pick(3 + 2 * k, table.standing);
    own = pick(4 + 2 * k, object_points_);
    const double height = rest.height_m + rest.up.dot(own->point);
    const bool same_height = std::abs(height - table.plane.heightOf(seen->point)) <
                             kHeightPerDiameter * diameter_m_ + planeToleranceM(seen->point.z());
    if (same_height && std::abs(rest.up.dot(own->normal) - up.dot(seen->normal)) < kSameTilt) break;
  }
  const Eigen::Vector3d from = inPlane(R_upright * own->normal, up), to = inPlane(seen->normal, up);
  double yaw = 2.0 * M_PI * uniform(2);
  if (from.norm() > kHorizontalEnough && to.norm() > kHorizontalEnough) {
    yaw = std::atan2(up.dot(from.cross(to)), from.dot(to));
  }
  Pose pose = Pose::Identity();
  pose.linear() = Eigen::AngleAxisd(yaw, up).toRotationMatrix() * R_upright;
  pose.translation() = seen->point - pose.linear() * own->point;
  pose.translation() += (rest.height_m - table.plane.heightOf(pose.translation())) * up;
  return pose;
}

/// Any orientation: leaning against something. What does not touch the plane is left out after the search.
Pose TableDraws::drawLeaning(const Table& table, std::uint64_t number) const {
  const auto uniform = [&](std::uint32_t index) { return random_.uniform(RandomPurpose::kSearch, number, index); };
  const auto pick = [&](std::uint32_t index, const std::vector<OrientedPoint>& points) -> const OrientedPoint& {
    return points[static_cast<std::size_t>(uniform(index) * static_cast<double>(points.size()))];
  };
  return layOn(pick(1, table.standing), pick(2, object_points_), 2.0 * M_PI * uniform(3));
}

double TableDraws::lowestOver(const ImagePlane& plane, const Pose& T_camera_centre) const {
  double lowest = std::numeric_limits<double>::infinity();
  for (const OrientedPoint& point : object_points_) {
    lowest = std::min(lowest, plane.heightOf(T_camera_centre * point.point));
  }
  return lowest;
}

double TableDraws::heightOverTable(const Pose& T_camera_centre) const {
  double least = std::numeric_limits<double>::infinity();
  for (const Table& table : tables_) {
    const double height = lowestOver(table.plane, T_camera_centre);
    if (std::abs(height) < std::abs(least)) least = height;
  }
  return least;
}

std::optional<ImagePlane> TableDraws::table() const {
  if (planes_.empty()) return std::nullopt;
  const auto fuller = [](const Table& a, const Table& b) { return a.standing.size() < b.standing.size(); };
  const auto fullest = std::max_element(tables_.begin(), tables_.end(), fuller);
  return fullest == tables_.end() ? planes_.front() : fullest->plane;
}

const TableDraws::Table& TableDraws::chooseTable(double uniform) const {
  return tables_[indexAt(table_weights_, uniform)];
}

const StablePose& TableDraws::chooseRest(double uniform) const {
  return rests_[indexAt(rest_weights_, uniform)];
}

}  // namespace depth_object_tracker
