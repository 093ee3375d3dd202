// SPDX-License-Identifier: BSD-3-Clause
#include "depth_object_tracker/tracker/pose_finder.h"

#include "tracker/pose_evidence.h"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <array>
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

/// Larger than any face of an object of that diameter, and no chance collection of readings.
bool isLargerThan(const ImagePlane& plane, double diameter_m) {
  constexpr double kLeastShare = 0.06, kLongerThan = 1.5, kBroaderThan = 0.8;
  if (plane.share < kLeastShare) return false;
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
  for (const Eigen::Vector3d& point : plane.points) {
    mean += point;
    scatter += point * point.transpose();
  }
  const auto count = static_cast<double>(plane.points.size());
  mean /= count;
  scatter = scatter / count - mean * mean.transpose();
  const Eigen::Vector3d spread = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(scatter).eigenvalues().cwiseMax(0.0);
  const auto side = [&](int axis) { return std::sqrt(12.0 * spread[axis]); };  // of a rectangle
  return side(2) > kLongerThan * diameter_m && side(1) > kBroaderThan * diameter_m;
}

/// Poses are told apart by what is seen: the numbers of pose_evidence.cpp were found so.
PixelModelConfig readingsAlone(PixelModelConfig config) {
  config.no_reading_ratio = 1.0;
  return config;
}

}  // namespace

PoseFinder::PoseFinder(const ObjectShape& shape, const TriangleMesh& mesh, double diameter_m,
                       const PixelModelConfig& config, std::uint64_t seed, std::shared_ptr<WorkerPool> pool)
    : diameter_m_(diameter_m),
      feature_m_(featureSize(mesh, diameter_m)),
      radius_m_(shape.radius_m),
      max_depth_m_(std::min(config.max_depth_m, kFarthestM)),
      random_(seed),
      pool_(std::move(pool)),
      image_draws_(objectPoints(mesh, shape.centre_object), diameter_m, seed, pool_),
      sparse_(image_draws_.objectPoints(), diameter_m),
      table_draws_(mesh, shape.centre_object, image_draws_.objectPoints(), seed),
      sampler_(seed, *pool_),
      coarse_(shape, readingsAlone(config), OcclusionChainConfig(), 1, pool_),
      fine_(shape, readingsAlone(config), OcclusionChainConfig(), 1, pool_),
      pixel_config_(config) {}

/// Copies the image. What others hold is nothing to start a search from.
DepthImageView PoseFinder::withoutTaken(KnownOccluders& occluders) {
  const std::vector<float>& taken = occluders.renderSeen(camera_);
  if (taken.empty()) return depth_;
  free_depth_m_.resize(taken.size());
  for (std::size_t i = 0; i < taken.size(); ++i) {
    const float z = depth_.at(static_cast<int>(i) / camera_.width, static_cast<int>(i) % camera_.width);
    const bool is_taken = taken[i] > 0.0f && std::abs(z - taken[i]) < takenTolerance(taken[i], pixel_config_);
    free_depth_m_[i] = is_taken ? 0.0f : z;
  }
  DepthImageView view;
  view.data = reinterpret_cast<const std::uint8_t*>(free_depth_m_.data());
  view.width = camera_.width;
  view.height = camera_.height;
  view.step = sizeof(float) * static_cast<std::size_t>(camera_.width);
  view.pixel_type = DepthImageView::PixelType::kFloat32;
  view.unit_m = 1.0f;
  return view;
}

void PoseFinder::setImage(const DepthImageView& depth, const PinholeCamera& camera, double distance_m,
                          KnownOccluders* occluders) {
  constexpr double kStepPerSize = 0.06;
  depth_ = depth;
  camera_ = camera;
  step_px_ = static_cast<int>(std::clamp(kStepPerSize * feature_m_ * camera.fx / distance_m, 2.0,
                                         static_cast<double>(camera.width + camera.height)));
  coarse_.resetOcclusion();
  fine_.resetOcclusion();
  coarse_.setImage(depth, makeSamplingGrid(camera, samplingFactor(camera, feature_m_, distance_m, kCoarsePixels)), 0.0);
  fine_.setImage(depth, makeSamplingGrid(camera, samplingFactor(camera, feature_m_, distance_m, kFinePixels)), 0.0);
  if (occluders != nullptr) {
    coarse_.setTakenSurfaces(occluders->renderSeen(coarse_.image().grid().camera));
    fine_.setTakenSurfaces(occluders->renderSeen(fine_.image().grid().camera));
    depth_ = withoutTaken(*occluders);
  }
  coarse_.prepareWholeImage(kCoarseLevelErrorM);
  fine_.prepareWholeImage(kFineLevelErrorM);
  sparse_.setImage(depth_, camera);
  has_background_ = false;
}

std::vector<FoundPose> PoseFinder::searchEverywhere(const SearchEffort& effort) {
  findBackground();
  image_draws_.setPoints(pointsBesideBackground(), camera_, step_px_);
  if (!image_draws_.canDraw()) return {};
  std::vector<Pose> poses = image_draws_.drawVotes(drawn_, effort.references);
  drawn_ += static_cast<std::uint64_t>(effort.references);
  const std::vector<Pose> drawn = drawBest(effort, [this](std::uint64_t number) { return image_draws_.draw(number); });
  poses.insert(poses.end(), drawn.begin(), drawn.end());
  return climbBest(poses, effort, true);
}

std::vector<OrientedPoint> PoseFinder::pointsBesideBackground() const {
  std::vector<OrientedPoint> points =
      imagePoints(depth_, camera_, diameter_m_, kPatchReachPerSize * feature_m_, max_depth_m_, step_px_);
  const auto in_background = [this](const OrientedPoint& point) {
    return std::any_of(background_.begin(), background_.end(), [&](const ImagePlane& plane) {
      return std::abs(plane.heightOf(point.point)) < planeToleranceM(point.point.z());
    });
  };
  points.erase(std::remove_if(points.begin(), points.end(), in_background), points.end());
  return points;
}

std::vector<FoundPose> PoseFinder::searchOnTable(const SearchEffort& effort) {
  findBackground();
  table_draws_.setImage(planes_, depth_, camera_, max_depth_m_, step_px_);
  if (!table_draws_.hasSomethingStanding() || image_draws_.objectPoints().empty()) return {};
  std::vector<FoundPose> found =
      climbBest(drawBest(effort, [this](std::uint64_t number) { return table_draws_.draw(number); }), effort, true);
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
                              // Some near, some far: a thin object must be met more closely than a thick one.
                              constexpr std::array<double, 3> kScales = {1.0, 0.5, 0.25};
                              const double scale = kScales[number / T_camera_centre.size() % kScales.size()];
                              return perturb(middle, scale * stddevs.cwiseProduct(
                                                                 random_.normal6(RandomPurpose::kSearch, number, 0)));
                            }),
                   effort, false);
}

FoundPose PoseFinder::settle(const FoundPose& found, const Pose& T_camera_centre_prior, const Vector6d& variances) {
  constexpr double kExponent = 0.1, kQualityWorthMoving = 0.02;
  constexpr int kSteps = 12;
  const FoundPose settled =
      judge(climbPosterior(fine_, found.T_camera_centre, {T_camera_centre_prior, variances, kExponent}, kSteps, 0));
  return settled.quality > found.quality - kQualityWorthMoving ? settled : found;
}

FoundPose PoseFinder::judge(const Pose& T_camera_centre) {
  const PoseAssessment assessment = fine_.assessWithEdges(T_camera_centre, 0);
  return {T_camera_centre, assessment, findQuality(assessment), findEvidence(assessment)};
}

FoundPose PoseFinder::sampleAround(const Pose& T_camera_centre, const Vector6d& variances,
                                   const std::function<double(const FoundPose&)>& value) {
  constexpr ClimbSchedule kNarrow{0.002, 0.0015, 4};  // a broader view is drawn away by what is beside the object
  const auto value_at = [&](const Pose& pose, double width_m, int thread) {
    const PoseAssessment assessment = fine_.assess(pose, thread, width_m);
    return value({pose, assessment, findQuality(assessment), findEvidence(assessment)});
  };
  const auto climb = [&](const Pose& pose, int thread) { return climbLikelihood(fine_, pose, kNarrow, thread); };
  const Pose highest = sampler_.highest(T_camera_centre, variances, value_at, climb, drawn_);
  drawn_ += PoseSampler::numDraws();
  return judge(highest);
}

/// Large planes are there without the object, and say nothing for it where it would lie in them.
void PoseFinder::findBackground() {
  if (has_background_) return;
  has_background_ = true;
  planes_ = findPlanes(depth_, camera_, max_depth_m_);
  background_.clear();
  std::vector<BackgroundPlane> background;
  for (const ImagePlane& plane : planes_) {
    if (!isLargerThan(plane, diameter_m_)) continue;
    background_.push_back(plane);
    background.push_back({plane.normal, plane.offset_m});
  }
  coarse_.setBackground(background);
  fine_.setBackground(background);
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

std::vector<Pose> PoseFinder::bestOfPlaces(const std::vector<Ranked>& ranked, int count, double apart_m) {
  std::vector<Pose> best;
  for (const Ranked& candidate : ranked) {
    if (static_cast<int>(best.size()) == count || !std::isfinite(candidate.quality)) break;
    const bool known = std::any_of(best.begin(), best.end(), [&](const Pose& other) {
      return (candidate.pose.translation() - other.translation()).norm() < apart_m;
    });
    if (!known) best.push_back(candidate.pose);
  }
  return best;
}

void PoseFinder::climbAll(DepthLikelihood& likelihood, const ClimbSchedule& schedule, std::vector<Pose>& poses) const {
  const std::size_t count = poses.size();
  poses.resize(2 * count);
  const auto task = [&](int index, int thread) {
    const auto i = static_cast<std::size_t>(index);
    poses[count + i] = climbLikelihood(likelihood, poses[i], schedule, thread);
  };
  pool_->run(static_cast<int>(count), std::cref(task));
}

std::vector<FoundPose> PoseFinder::climbBest(const std::vector<Pose>& drawn, const SearchEffort& effort,
                                             bool by_evidence) {
  const auto value = [by_evidence](DepthLikelihood& likelihood, double width_m) {
    return [&likelihood, width_m, by_evidence](const Pose& pose, int thread) {
      const PoseAssessment assessment = likelihood.assess(pose, thread, width_m);
      return by_evidence ? findEvidence(assessment) : findQuality(assessment);
    };
  };
  const auto fit = [this, by_evidence](const Pose& pose, int thread) {
    const TileFit counted = coarse_.countFit(pose, kMatchToleranceM, thread);
    const double quality = fitQuality(counted);
    return by_evidence && quality > 0.0 ? quality * std::sqrt(counted.matching) : quality;
  };
  const auto distinct = [&](const std::vector<Ranked>& ranked, int count, double apart_m) {
    return effort.apart_m > 0.0 ? bestOfPlaces(ranked, count, effort.apart_m) : distinctBest(ranked, count, apart_m);
  };
  std::vector<Pose> poses = distinctBest(rank(drawn, fit), effort.climbed, 0.0);
  climbAll(coarse_, {0.02, 0.006, 0}, poses);
  poses = distinct(rank(poses, value(coarse_, 0.008)), effort.refined * 4, 0.03);
  climbAll(coarse_, {0.012, 0.004, 3}, poses);
  poses = distinct(rank(poses, value(coarse_, 0.004)), effort.refined, 0.02);
  climbAll(fine_, {0.006, 0.003, 2}, poses);
  poses = distinct(rank(poses, value(fine_, 0.001)), std::max(effort.refined / 2, kFinalCandidates), 0.005);
  climbAll(fine_, {0.002, 0.0015, 8}, poses);
  std::vector<FoundPose> found;
  found.reserve(poses.size());
  for (const Pose& pose : poses) found.push_back(judge(pose));
  std::stable_sort(found.begin(), found.end(), [by_evidence](const FoundPose& a, const FoundPose& b) {
    return by_evidence ? a.evidence > b.evidence : a.quality > b.quality;
  });
  return found;
}

}  // namespace depth_object_tracker
