// SPDX-License-Identifier: BSD-3-Clause
#include "depth_object_tracker/tracker/search_region.h"

#include "depth_object_tracker/filter/random.h"

#include <algorithm>
#include <cmath>

namespace depth_object_tracker {

double squaredDistance(const Pose& pose, const SearchRegion& region) {
  const Vector6d variances = region.variances + region.moved_on.cwiseAbs2();
  return difference(pose, region.T_camera_centre).cwiseAbs2().cwiseQuotient(variances).sum();
}

double remoteness(const Pose& pose, const SearchRegion& region) {
  constexpr double kFarSquared = 12.0;
  return std::min(1.0, squaredDistance(pose, region) / kFarSquared);
}

double outOfReach(const Pose& pose, const SearchRegion& region) {
  constexpr double kMostNat = 4.0, kUsualNat = 2.0;
  constexpr double kCarriedMps = 0.15;  // by somebody whom one does not see
  const Eigen::Vector3d moved = pose.translation() - region.T_camera_centre.translation();
  Eigen::Vector3d variances = (region.variances + region.moved_on.cwiseAbs2()).head<3>();
  variances.array() += std::pow(kCarriedMps * region.unseen_s, 2.0);
  return std::clamp(0.5 * moved.cwiseAbs2().cwiseQuotient(variances).sum() - kUsualNat, 0.0, kMostNat);
}

double hiddenShare(const SearchRegion& region, const DepthImageView& depth, const PinholeCamera& camera) {
  constexpr int kPlaces = 100;
  constexpr double kInFrontM = 0.04;
  const CounterRandom random(1);
  const Eigen::Vector3d stddevs = (region.variances + region.moved_on.cwiseAbs2()).head<3>().cwiseSqrt();
  int hidden = 0;
  for (int i = 0; i < kPlaces; ++i) {
    const Vector6d normal = random.normal6(RandomPurpose::kSearch, 0, static_cast<std::uint32_t>(i));
    const Eigen::Vector3d place = region.T_camera_centre.translation() + stddevs.cwiseProduct(normal.head<3>());
    if (!(place.z() > kInFrontM)) continue;
    const Eigen::Vector2d pixel = camera.project(place);
    const int row = static_cast<int>(std::floor(pixel.y())), col = static_cast<int>(std::floor(pixel.x()));
    if (row < 0 || row >= depth.height || col < 0 || col >= depth.width) continue;
    const auto reading = static_cast<double>(depth.at(row, col));
    hidden += reading > 0.0 && reading < place.z() - kInFrontM ? 1 : 0;
  }
  return static_cast<double>(hidden) / kPlaces;
}

}  // namespace depth_object_tracker
