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
      object_points_(objectPoints(mesh, shape.centre_object)),
      pairs_(object_points_, diameter_m),
      votes_(static_cast<std::size_t>(pool_->numThreads()), PairVotes(pairs_)),
      sparse_(object_points_, diameter_m),
      table_draws_(mesh, shape.centre_object, object_points_, seed),
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
  image_points_ = imagePoints(depth_, camera_, diameter_m_, kPatchReachPerSize * feature_m_, max_depth_m_, step_px_);
  const auto in_background = [this](const OrientedPoint& point) {
    return std::any_of(background_.begin(), background_.end(), [&](const ImagePlane& plane) {
      return std::abs(plane.heightOf(point.point)) < planeToleranceM(point.point.z());
    });
  };
  image_points_.erase(std::remove_if(image_points_.begin(), image_points_.end(), in_background), image_points_.end());
  if (image_points_.empty() || object_points_.empty()) return {};
  listNeighbours();
  std::vector<Pose> poses = drawVotes(effort.references);
  const std::vector<Pose> drawn = drawBest(effort, [this](std::uint64_t number) { return drawAnywhere(number); });
  poses.insert(poses.end(), drawn.begin(), drawn.end());
  return climbBest(poses, effort, true);
}

std::vector<FoundPose> PoseFinder::searchOnTable(const SearchEffort& effort) {
  findBackground();
  table_draws_.setImage(planes_, depth_, camera_, max_depth_m_, step_px_);
  if (!table_draws_.hasSomethingStanding() || object_points_.empty()) return {};
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
  const PoseAssessment assessment = fine_.assess(T_camera_centre, 0);
  return {T_camera_centre, assessment, findQuality(assessment), findEvidence(assessment)};
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

void PoseFinder::listNeighbours() {
  const int rows = depth_.height / step_px_ + 1, cols = depth_.width / step_px_ + 1;
  point_at_.assign(static_cast<std::size_t>(rows) * static_cast<std::size_t>(cols), -1);
  for (std::size_t i = 0; i < image_points_.size(); ++i) {
    const Eigen::Vector2d pixel = camera_.project(image_points_[i].point);
    const int row = static_cast<int>(pixel.y()) / step_px_, col = static_cast<int>(pixel.x()) / step_px_;
    if (row < 0 || row >= rows || col < 0 || col >= cols) continue;
    point_at_[static_cast<std::size_t>(row) * static_cast<std::size_t>(cols) + static_cast<std::size_t>(col)] =
        static_cast<int>(i);
  }
}

std::optional<Pose> PoseFinder::drawPair(std::uint64_t number) const {
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
double PoseFinder::reachPx(const OrientedPoint& point) const {
  return std::min(camera_.fx * pairs_.mostDistanceM() / point.point.z(),
                  static_cast<double>(depth_.width + depth_.height));
}

/// The image's point at a distance and in a direction from a pixel. @return null where there is none.
const OrientedPoint* PoseFinder::neighbourOf(const Eigen::Vector2d& pixel, double radius_px, double turn_rad) const {
  const int rows = depth_.height / step_px_ + 1, cols = depth_.width / step_px_ + 1;
  const int row = static_cast<int>(std::floor((pixel.y() + radius_px * std::sin(turn_rad)) / step_px_));
  const int col = static_cast<int>(std::floor((pixel.x() + radius_px * std::cos(turn_rad)) / step_px_));
  if (row < 0 || row >= rows || col < 0 || col >= cols) return nullptr;
  const int index =
      point_at_[static_cast<std::size_t>(row) * static_cast<std::size_t>(cols) + static_cast<std::size_t>(col)];
  return index < 0 ? nullptr : &image_points_[static_cast<std::size_t>(index)];
}

std::vector<Pose> PoseFinder::drawVotes(int references) {
  constexpr int kPosesPerReference = 5;
  voted_.resize(static_cast<std::size_t>(references));
  const auto task = [&](int index, int thread) {
    const auto i = static_cast<std::size_t>(index);
    PairVotes& votes = votes_[static_cast<std::size_t>(thread)];
    letNeighboursVote(drawn_ + i, votes);
    voted_[i].clear();
    votes.bestPoses(kPosesPerReference, voted_[i]);
  };
  pool_->run(references, std::cref(task));
  drawn_ += voted_.size();
  std::vector<Pose> poses;
  for (const std::vector<Pose>& some : voted_) poses.insert(poses.end(), some.begin(), some.end());
  return poses;
}

void PoseFinder::letNeighboursVote(std::uint64_t number, PairVotes& votes) const {
  const auto uniform = [&](std::uint32_t index) { return random_.uniform(RandomPurpose::kSearch, number, index); };
  const OrientedPoint& reference =
      image_points_[static_cast<std::size_t>(uniform(0) * static_cast<double>(image_points_.size()))];
  votes.start(reference);
  const Eigen::Vector2d pixel = camera_.project(reference.point) / step_px_;
  const int rows = depth_.height / step_px_ + 1, cols = depth_.width / step_px_ + 1;
  const int reach = static_cast<int>(reachPx(reference)) / step_px_;
  constexpr int kMostReach = 70;  // some 20,000 voters at most, however near the reference is
  const int stride = 1 + reach / (kMostReach + 1);
  const int row = static_cast<int>(pixel.y()), col = static_cast<int>(pixel.x());
  for (int r = std::max(0, row - reach); r <= std::min(rows - 1, row + reach); r += stride) {
    for (int c = std::max(0, col - reach); c <= std::min(cols - 1, col + reach); c += stride) {
      const int cell = r * cols + c;
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

Pose PoseFinder::drawAnywhere(std::uint64_t number) const {
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
  for (const Pose& pose : poses) found.push_back(judge(pose));
  std::stable_sort(found.begin(), found.end(), [by_evidence](const FoundPose& a, const FoundPose& b) {
    return by_evidence ? a.evidence > b.evidence : a.quality > b.quality;
  });
  return found;
}

}  // namespace depth_object_tracker
