// SPDX-License-Identifier: BSD-3-Clause
#include "depth_object_tracker/tracker/pose_finder.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

namespace depth_object_tracker {
namespace {

constexpr double kCoarsePixels = 250.0, kFinePixels = 800.0;  // that the object covers, about
constexpr double kCoarseLevelErrorM = 0.001, kFineLevelErrorM = 0.0005;
constexpr double kFarthestM = 3.0;
constexpr double kMatchToleranceM = 0.02;
constexpr int kFinalCandidates = 10;
constexpr double kRestsWithinM = 0.02;

int samplingFactor(const PinholeCamera& camera, double diameter_m, double distance_m, double pixels) {
  constexpr double kCoveredShare = 0.35;  // of the square of the diameter
  constexpr int kMaxFactor = 12;
  const double projected = camera.fx * diameter_m / distance_m;
  return std::clamp(static_cast<int>(std::lround(projected * std::sqrt(kCoveredShare / pixels))), 1, kMaxFactor);
}

/// 1 when all of the object is seen where it should be and stands out all around.
double fitQuality(const TileFit& fit) {
  constexpr int kLeastCells = 15;
  constexpr double kPerContinuedShare = 1.5;
  if (fit.measured() < kLeastCells) return -std::numeric_limits<double>::infinity();
  const double continued = static_cast<double>(fit.continued) / std::max(1, fit.beside);
  return static_cast<double>(fit.matching - fit.through) / fit.measured() - kPerContinuedShare * continued;
}

}  // namespace

double findQuality(const PoseAssessment& assessment) {
  constexpr int kLeastCells = 10;
  constexpr double kPerContinuedShare = 2.0;
  if (assessment.measured_pixels < kLeastCells || !(assessment.expected > 0.0)) return 0.0;
  const double visible = assessment.visible_pixels / assessment.measured_pixels;
  const double score = std::min(1.0, assessment.achieved / assessment.expected);
  const double continued =
      static_cast<double>(assessment.continued_pixels) / std::max(1, assessment.surrounding_pixels);
  return std::max(0.0, visible * score * std::abs(score)) * std::max(0.0, 1.0 - kPerContinuedShare * continued);
}

PoseFinder::PoseFinder(const ObjectShape& shape, const TriangleMesh& mesh, double diameter_m,
                       const PixelModelConfig& config, std::uint64_t seed, std::shared_ptr<WorkerPool> pool)
    : diameter_m_(diameter_m),
      radius_m_(shape.radius_m),
      max_depth_m_(std::min(config.max_depth_m, kFarthestM)),
      random_(seed),
      pool_(std::move(pool)),
      object_points_(objectPoints(mesh, shape.centre_object)),
      sparse_(object_points_, diameter_m),
      table_draws_(mesh, shape.centre_object, object_points_, seed),
      coarse_(shape, config, OcclusionChainConfig(), 1, pool_),
      fine_(shape, config, OcclusionChainConfig(), 1, pool_) {}

void PoseFinder::setImage(const DepthImageView& depth, const PinholeCamera& camera, double distance_m) {
  constexpr double kStepPerDiameter = 0.06;
  depth_ = depth;
  camera_ = camera;
  step_px_ = std::max(2, static_cast<int>(kStepPerDiameter * diameter_m_ * camera.fx / distance_m));
  coarse_.resetOcclusion();
  fine_.resetOcclusion();
  coarse_.setImage(depth, makeSamplingGrid(camera, samplingFactor(camera, diameter_m_, distance_m, kCoarsePixels)),
                   0.0);
  fine_.setImage(depth, makeSamplingGrid(camera, samplingFactor(camera, diameter_m_, distance_m, kFinePixels)), 0.0);
  coarse_.prepareWholeImage(kCoarseLevelErrorM);
  fine_.prepareWholeImage(kFineLevelErrorM);
  sparse_.setImage(depth, camera);
}

std::vector<FoundPose> PoseFinder::searchEverywhere(const SearchEffort& effort) {
  image_points_ = imagePoints(depth_, camera_, diameter_m_, max_depth_m_, step_px_);
  if (image_points_.empty() || object_points_.empty()) return {};
  return climbBest(drawBest(effort, [this](std::uint64_t number) { return drawAnywhere(number); }), effort);
}

std::vector<FoundPose> PoseFinder::searchOnTable(const SearchEffort& effort) {
  table_draws_.setImage(depth_, camera_, max_depth_m_, step_px_);
  if (!table_draws_.hasSomethingStanding() || object_points_.empty()) return {};
  std::vector<FoundPose> found =
      climbBest(drawBest(effort, [this](std::uint64_t number) { return table_draws_.draw(number); }), effort);
  found.erase(std::remove_if(found.begin(), found.end(),
                             [this](const FoundPose& one) {
                               return std::abs(table_draws_.heightOverTable(one.T_camera_centre)) > kRestsWithinM;
                             }),
              found.end());
  return found;
}

std::vector<FoundPose> PoseFinder::searchAround(const std::vector<Pose>& T_camera_centre, const Vector6d& variances,
                                                const SearchEffort& effort) {
  if (T_camera_centre.empty()) return {};
  const Vector6d stddevs = variances.cwiseSqrt();
  return climbBest(drawBest(effort,
                            [&](std::uint64_t number) {
                              const Pose& middle = T_camera_centre[number % T_camera_centre.size()];
                              return perturb(middle,
                                             stddevs.cwiseProduct(random_.normal6(RandomPurpose::kSearch, number, 0)));
                            }),
                   effort);
}

FoundPose PoseFinder::settle(const FoundPose& found, const Pose& T_camera_centre_prior, const Vector6d& variances) {
  constexpr double kExponent = 0.1, kQualityWorthMoving = 0.02;
  constexpr int kSteps = 12;
  const FoundPose settled =
      judge(climbPosterior(fine_, found.T_camera_centre, {T_camera_centre_prior, variances, kExponent}, kSteps, 0));
  return settled.quality > found.quality - kQualityWorthMoving ? settled : found;
}

FoundPose PoseFinder::judge(const Pose& T_camera_centre) {
  const PoseAssessment assessment = fine_.assess(T_camera_centre, 0);
  return {T_camera_centre, assessment, findQuality(assessment)};
}

Pose PoseFinder::drawAnywhere(std::uint64_t number) const {
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

template <typename Draw>
std::vector<Pose> PoseFinder::drawBest(const SearchEffort& effort, const Draw& draw) {
  draws_.resize(static_cast<std::size_t>(effort.drawn));
  const auto task = [&](int index, int) {
    Ranked& one = draws_[static_cast<std::size_t>(index)];
    one.pose = draw(drawn_ + static_cast<std::uint64_t>(index));
    one.quality = sparse_.match(one.pose);
  };
  pool_->run(effort.drawn, std::cref(task));
  drawn_ += draws_.size();
  const auto kept = draws_.begin() + std::min(effort.drawn, effort.rendered);
  std::nth_element(draws_.begin(), kept, draws_.end(),
                   [](const Ranked& a, const Ranked& b) { return a.quality > b.quality; });
  std::vector<Pose> poses;
  for (auto one = draws_.begin(); one != kept; ++one) poses.push_back(one->pose);
  return poses;
}

template <typename Judge>
std::vector<PoseFinder::Ranked> PoseFinder::rank(const std::vector<Pose>& poses, const Judge& judge) const {
  std::vector<Ranked> ranked(poses.size());
  const auto task = [&](int index, int thread) {
    const auto i = static_cast<std::size_t>(index);
    ranked[i] = {poses[i], judge(poses[i], thread)};
  };
  pool_->run(static_cast<int>(poses.size()), std::cref(task));
  std::stable_sort(ranked.begin(), ranked.end(),
                   [](const Ranked& a, const Ranked& b) { return a.quality > b.quality; });
  return ranked;
}

std::vector<Pose> PoseFinder::distinctBest(const std::vector<Ranked>& ranked, int count, double apart_m) const {
  std::vector<Pose> best;
  for (const Ranked& candidate : ranked) {
    if (static_cast<int>(best.size()) == count || !std::isfinite(candidate.quality)) break;
    const bool known =
        apart_m > 0.0 && std::any_of(best.begin(), best.end(), [&](const Pose& other) {
          const double turned = 3.0 - candidate.pose.linear().cwiseProduct(other.linear()).sum();  // angle^2, nearly
          return (candidate.pose.translation() - other.translation()).squaredNorm() + turned * radius_m_ * radius_m_ <
                 apart_m * apart_m;
        });
    if (!known) best.push_back(candidate.pose);
  }
  return best;
}

void PoseFinder::climbAll(DepthLikelihood& likelihood, const ClimbSchedule& schedule, std::vector<Pose>& poses) const {
  const auto task = [&](int index, int thread) {
    Pose& pose = poses[static_cast<std::size_t>(index)];
    pose = climbLikelihood(likelihood, pose, schedule, thread);
  };
  pool_->run(static_cast<int>(poses.size()), std::cref(task));
}

std::vector<FoundPose> PoseFinder::climbBest(const std::vector<Pose>& drawn, const SearchEffort& effort) {
  const auto quality = [](DepthLikelihood& likelihood, double width_m) {
    return [&likelihood, width_m](const Pose& pose, int thread) {
      return findQuality(likelihood.assess(pose, thread, width_m));
    };
  };
  std::vector<Pose> poses = distinctBest(
      rank(drawn, [this](const Pose& pose,
                         int thread) { return fitQuality(coarse_.countFit(pose, kMatchToleranceM, thread)); }),
      effort.climbed, 0.0);
  climbAll(coarse_, {0.02, 0.006, 0}, poses);
  poses = distinctBest(rank(poses, quality(coarse_, 0.008)), effort.refined * 4, 0.03);
  climbAll(coarse_, {0.012, 0.004, 3}, poses);
  poses = distinctBest(rank(poses, quality(coarse_, 0.004)), effort.refined, 0.02);
  climbAll(fine_, {0.006, 0.003, 2}, poses);
  poses = distinctBest(rank(poses, quality(fine_, 0.001)), kFinalCandidates, 0.005);
  climbAll(fine_, {0.002, 0.0015, 8}, poses);
  std::vector<FoundPose> found;
  for (const Pose& pose : poses) found.push_back(judge(pose));
  std::stable_sort(found.begin(), found.end(),
                   [](const FoundPose& a, const FoundPose& b) { return a.quality > b.quality; });
  return found;
}

}  // namespace depth_object_tracker
