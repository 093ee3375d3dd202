// SPDX-License-Identifier: BSD-3-Clause
#include "benchmark_scene.h"

#include "depth_object_tracker/filter/random.h"
#include "depth_object_tracker/filter/resampling.h"
#include "depth_object_tracker/render/depth_renderer.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <stdexcept>
#include <string>

namespace depth_object_tracker {
namespace {

constexpr double kCoverageTolerance = 0.08;
constexpr double kOccludedShare = 0.2;
constexpr double kMissingShare = 0.03;

/// Columns up to the returned one hold kOccludedShare of the object's pixels.
int occludedUpTo(const std::vector<CoveredPixel>& covered) {
  std::vector<int> cols;
  for (const CoveredPixel& pixel : covered) cols.push_back(pixel.col);
  const auto quantile = cols.begin() + static_cast<std::ptrdiff_t>(kOccludedShare * static_cast<double>(cols.size()));
  std::nth_element(cols.begin(), quantile, cols.end());
  return *quantile;
}

/// What a perfect sensor sees [m]: a leaning wall, the object, a plate before its left part.
std::vector<double> drawDepth(const std::vector<CoveredPixel>& covered, const PinholeCamera& camera,
                              double distance_m) {
  std::vector<double> depth(static_cast<std::size_t>(camera.width * camera.height));
  for (std::size_t i = 0; i < depth.size(); ++i) {
    depth[i] = distance_m + 0.4 + 2e-4 * static_cast<double>(i % static_cast<std::size_t>(camera.width));
  }
  for (const CoveredPixel& pixel : covered) {
    depth[static_cast<std::size_t>(pixel.row * camera.width + pixel.col)] = static_cast<double>(pixel.depth);
  }
  const int last_col = occludedUpTo(covered);
  for (int row = covered.front().row; row <= covered.back().row; ++row) {
    for (int col = std::max(0, last_col - 100); col <= last_col; ++col) {
      depth[static_cast<std::size_t>(row * camera.width + col)] = 0.7 * distance_m;
    }
  }
  return depth;
}

/// What a depth camera makes of it [mm]; 0 = no reading.
std::vector<std::uint16_t> measure(const std::vector<double>& depth, std::uint64_t seed) {
  std::mt19937_64 generator(seed);
  std::normal_distribution<double> noise;
  std::uniform_real_distribution<double> uniform;
  const double noise_per_m = PixelModelConfig().depth_noise_per_m;
  std::vector<std::uint16_t> readings;
  readings.reserve(depth.size());
  for (const double z : depth) {
    const double reading = z + noise_per_m * z * z * noise(generator);
    const bool missing = uniform(generator) < kMissingShare;
    readings.push_back(missing ? std::uint16_t{0} : static_cast<std::uint16_t>(std::lround(1000.0 * reading)));
  }
  return readings;
}

}  // namespace

SamplingGrid benchmarkGrid(int factor) {
  return makeSamplingGrid({640, 480, 525.0, 525.0, 319.5, 239.5}, factor);
}

BenchmarkScene::BenchmarkScene(const TriangleMesh& mesh, int factor, int covered_pixels)
    : grid_(benchmarkGrid(factor)), centre_object_(surfaceCentroid(mesh)) {
  DepthRenderer renderer(mesh);
  double near_m = 0.05 + diameter(mesh), far_m = 100.0 * near_m;
  for (int step = 0; step < 30; ++step) {
    const double distance_m = std::sqrt(near_m * far_m);
    T_camera_centre_ = poseAt(distance_m);
    covered_pixels_ = static_cast<int>(renderer.render(toObject(T_camera_centre_), grid_.camera).size());
    (covered_pixels_ > covered_pixels ? near_m : far_m) = distance_m;
  }
  if (std::abs(covered_pixels_ - covered_pixels) > kCoverageTolerance * covered_pixels) {
    throw std::runtime_error("the object covers " + std::to_string(covered_pixels_) + " pixels instead of " +
                             std::to_string(covered_pixels));
  }
  drawFrames(mesh);
}

/// Turned so that the handle is seen from the side and before the body in part.
Pose BenchmarkScene::poseAt(double distance_m) const {
  Pose T_camera_centre = Pose::Identity();
  T_camera_centre.linear() = expSo3({1.2, 0.5, -0.3});
  T_camera_centre.translation() = distance_m * Eigen::Vector3d(0.031, -0.023, 1.0);
  return T_camera_centre;
}

Pose BenchmarkScene::toObject(const Pose& T_camera_centre) const {
  Pose T_camera_object = T_camera_centre;
  T_camera_object.translation() -= T_camera_centre.linear() * centre_object_;
  return T_camera_object;
}

void BenchmarkScene::drawFrames(const TriangleMesh& mesh) {
  DepthRenderer renderer(mesh);
  const std::vector<CoveredPixel>& covered = renderer.render(toObject(T_camera_centre_), grid_.full);
  const std::vector<double> depth = drawDepth(covered, grid_.full, T_camera_centre_.translation().z());
  for (int index = 0; index < kNumFrames; ++index) frames_.push_back(measure(depth, static_cast<std::uint64_t>(index)));
}

DepthImageView BenchmarkScene::frame(int index) const {
  DepthImageView view;
  view.data = reinterpret_cast<const std::uint8_t*>(frames_[static_cast<std::size_t>(index % kNumFrames)].data());
  view.width = grid_.full.width;
  view.height = grid_.full.height;
  view.step = sizeof(std::uint16_t) * static_cast<std::size_t>(view.width);
  return view;
}

std::vector<Pose> BenchmarkScene::drawPoses(int count, std::uint64_t seed) const {
  constexpr double kTranslationStddevM = 0.003, kRotationStddevRad = 1.5 * M_PI / 180.0;
  const CounterRandom random(seed);
  std::vector<Pose> poses;
  for (int i = 0; i < count; ++i) {
    Vector6d delta = random.normal6(RandomPurpose::kProposal, 0, static_cast<std::uint32_t>(i));
    delta.head<3>() *= kTranslationStddevM;
    delta.tail<3>() *= kRotationStddevRad;
    poses.push_back(perturb(T_camera_centre_, delta));
  }
  return poses;
}

std::vector<int> drawAncestry(int count, std::uint64_t seed) {
  std::mt19937_64 generator(seed);
  std::exponential_distribution<double> weight;
  std::vector<double> weights(static_cast<std::size_t>(count));
  double sum = 0.0;
  for (double& w : weights) sum += w = weight(generator);
  for (double& w : weights) w /= sum;
  return resampleSystematic(weights, 0.5);
}

OutlineCoverage outlineOn(const SamplingGrid& grid, double edge_stddev_px) {
  constexpr double kCellStddev = 0.3;  // as DepthLikelihood has it
  return OutlineCoverage(edge_stddev_px > 0.0 ? std::hypot(kCellStddev, edge_stddev_px / grid.factor) : 0.0);
}

}  // namespace depth_object_tracker
