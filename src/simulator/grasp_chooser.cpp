// SPDX-License-Identifier: BSD-3-Clause
// Random search for a grasp.
#include "depth_object_tracker/simulator/grasp_chooser.h"

#include "depth_object_tracker/geometry/shape_meshes.h"
#include "depth_object_tracker/render/depth_renderer.h"
#include "depth_object_tracker/simulator/pixel_index.h"
#include "depth_object_tracker/simulator/random_source.h"
#include "depth_object_tracker/simulator/ray_cast.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace depth_object_tracker {
namespace {

constexpr std::uint64_t kStream = 103;
constexpr int kAttempts = 60;
constexpr int kWantedCandidates = 14;

// How much of the object hand and arm hide at one pose.
class CoverageMeter {
 public:
  CoverageMeter(DepthRenderer& object, const Pose& T_camera_object, const PinholeCamera& camera)
      : camera_(camera), T_camera_object_(T_camera_object) {
    depth_.assign(static_cast<std::size_t>(camera_.width) * static_cast<std::size_t>(camera_.height), 0.0f);
    for (const CoveredPixel& pixel : object.render(T_camera_object, camera_)) {
      depth_[pixelIndex(pixel, camera_)] = pixel.depth;
      ++object_pixels_;
    }
  }

  double coverage(const Hand& hand, DepthRenderer& hand_renderer, const Arm& arm,
                  std::array<DepthRenderer, 2>& link_renderers) const {
    std::vector<bool> hidden(depth_.size(), false);
    hide(hand_renderer, T_camera_object_, hidden);
    const auto links = arm.place(T_camera_object_ * hand.wrist, T_camera_object_.linear() * hand.wrist_out);
    for (std::size_t k = 0; k < links.size(); ++k) hide(link_renderers[k], links[k], hidden);
    const auto count = std::count(hidden.begin(), hidden.end(), true);
    return object_pixels_ == 0 ? 1.0 : static_cast<double>(count) / object_pixels_;
  }

 private:
  void hide(DepthRenderer& renderer, const Pose& T_camera_mesh, std::vector<bool>& hidden) const {
    for (const CoveredPixel& pixel : renderer.render(T_camera_mesh, camera_)) {
      const std::size_t index = pixelIndex(pixel, camera_);
      if (depth_[index] > pixel.depth) hidden[index] = true;
    }
  }

  PinholeCamera camera_;
  Pose T_camera_object_;
  std::vector<float> depth_;
  int object_pixels_ = 0;
};

// Over all poses that the object goes through.
class GraspJudge {
 public:
  GraspJudge(const TriangleMesh& object, const GraspRequest& request)
      : wanted_(request.wanted_coverage),
        arm_(request.arm),
        link_renderers_{DepthRenderer(arm_.meshes()[0]), DepthRenderer(arm_.meshes()[1])} {
    DepthRenderer renderer(object);
    const PinholeCamera camera = makeSamplingGrid(request.camera, kSampling).camera;
    for (const Pose& pose : request.T_camera_object) meters_.emplace_back(renderer, pose, camera);
  }

  // 0 = as wanted.
  double error(const Hand& hand) {
    DepthRenderer hand_renderer(hand.mesh);
    double sum = 0.0, most = 0.0;
    for (const CoverageMeter& meter : meters_) {
      const double coverage = meter.coverage(hand, hand_renderer, arm_, link_renderers_);
      sum += coverage;
      most = std::max(most, coverage);
    }
    return std::abs(sum / static_cast<double>(meters_.size()) - wanted_) + std::max(0.0, most - kMostCoverage);
  }

 private:
  static constexpr int kSampling = 4;
  static constexpr double kMostCoverage = 0.4;
  double wanted_;
  Arm arm_;
  std::array<DepthRenderer, 2> link_renderers_;
  std::vector<CoverageMeter> meters_;
};

// A grasp of a random place, approached roughly from where the arm is.
std::optional<GraspFrame> randomGrasp(const TriangleMesh& object, const GraspRequest& request, RandomSource& random) {
  const Pose T_object_camera = request.T_camera_object.front().inverse();
  const auto& vertex = object.vertices[random.bits() % object.vertices.size()];
  const Eigen::Vector3d centroid = surfaceCentroid(object);
  const Eigen::Vector3d aim = centroid + random.uniform(0.0, 0.9) * (vertex.cast<double>() - centroid);
  const Eigen::Vector3d to_arm = (T_object_camera * request.arm.shoulder_camera - aim).normalized();
  GraspFrame grasp;
  grasp.approach = (to_arm + 0.9 * random.unitVector()).normalized();
  constexpr double kOutside = 0.5;
  const auto entry = castRay(object, aim + kOutside * grasp.approach, -grasp.approach);
  if (!entry) return std::nullopt;
  const Eigen::Vector3d surface = aim + (kOutside - *entry) * grasp.approach;
  const auto thickness = castRay(object, surface - 1e-4 * grasp.approach, -grasp.approach);
  if (!thickness) return std::nullopt;
  grasp.centre = surface - std::min(0.5 * *thickness, 0.03) * grasp.approach;
  grasp.closing = grasp.approach.cross(random.unitVector()).normalized();
  return grasp;
}

Hand flatHand(const TriangleMesh& object, const GraspRequest& request) {
  const Pose T_object_camera = request.T_camera_object.front().inverse();
  const Eigen::Vector3d centroid = surfaceCentroid(object);
  Hand hand;
  hand.wrist_out = (T_object_camera * request.arm.shoulder_camera - centroid).normalized();
  const Eigen::Vector3d outside = centroid + 3.0 * hand.wrist_out;
  const double distance = castRay(object, outside, -hand.wrist_out).value_or(3.0);
  const Eigen::Vector3d surface = outside - distance * hand.wrist_out;
  hand.wrist = surface + 0.09 * hand.wrist_out;
  hand.mesh = makeCapsule(surface + 0.02 * hand.wrist_out, hand.wrist, 0.02, 0.03, 20);
  return hand;
}

}  // namespace

Hand chooseGrasp(const TriangleMesh& object, const GraspRequest& request) {
  RandomSource random(request.seed, kStream);
  GraspJudge judge(object, request);
  std::optional<Hand> best;
  double best_error = std::numeric_limits<double>::infinity();
  for (int attempt = 0, candidates = 0; attempt < kAttempts && candidates < kWantedCandidates; ++attempt) {
    const auto grasp = randomGrasp(object, request, random);
    if (!grasp) continue;
    auto hand = request.kind == HandKind::kHuman ? makeHumanHand(object, *grasp) : makeGripper(object, *grasp);
    if (!hand) continue;
    ++candidates;
    const double error = judge.error(*hand);
    if (error >= best_error) continue;
    best_error = error;
    best = std::move(hand);
  }
  return best ? *best : flatHand(object, request);
}

}  // namespace depth_object_tracker
