// SPDX-License-Identifier: BSD-3-Clause
// Random search for a grasp.
#include "depth_object_tracker/simulator/grasp_chooser.h"

#include "depth_object_tracker/render/depth_renderer.h"
#include "depth_object_tracker/simulator/pixel_index.h"
#include "depth_object_tracker/simulator/random_source.h"
#include "depth_object_tracker/simulator/ray_cast.h"
#include "depth_object_tracker/simulator/shape_meshes.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace depth_object_tracker {
namespace {

constexpr std::uint64_t kStream = 103;
constexpr int kAttempts = 60;
constexpr int kWantedCandidates = 14;

// Nearest depth per pixel of the object, and how much of it other meshes hide.
class CoverageMeter {
 public:
  CoverageMeter(const TriangleMesh& object, const GraspRequest& request)
      : camera_(makeSamplingGrid(request.camera, 4).camera), request_(request), arm_(request.arm) {
    depth_.assign(static_cast<std::size_t>(camera_.width) * camera_.height, 0.0f);
    DepthRenderer renderer(object);
    for (const CoveredPixel& pixel : renderer.render(request.T_camera_object, camera_)) {
      depth_[pixelIndex(pixel, camera_)] = pixel.depth;
      ++object_pixels_;
    }
  }

  double coverage(const Hand& hand) const {
    std::vector<bool> hidden(depth_.size(), false);
    const Pose& T_camera_object = request_.T_camera_object;
    hide(hand.mesh, T_camera_object, hidden);
    const auto links = arm_.place(T_camera_object * hand.wrist, T_camera_object.linear() * hand.wrist_out);
    for (std::size_t k = 0; k < links.size(); ++k) hide(arm_.meshes()[k], links[k], hidden);
    const auto count = std::count(hidden.begin(), hidden.end(), true);
    return object_pixels_ == 0 ? 1.0 : static_cast<double>(count) / object_pixels_;
  }

 private:
  void hide(const TriangleMesh& mesh, const Pose& T_camera_mesh, std::vector<bool>& hidden) const {
    DepthRenderer renderer(mesh);
    for (const CoveredPixel& pixel : renderer.render(T_camera_mesh, camera_)) {
      const std::size_t index = pixelIndex(pixel, camera_);
      if (depth_[index] > pixel.depth) hidden[index] = true;
    }
  }

  PinholeCamera camera_;
  const GraspRequest& request_;
  Arm arm_;
  std::vector<float> depth_;
  int object_pixels_ = 0;
};

// A grasp of a random place, approached roughly from where the arm is.
std::optional<GraspFrame> randomGrasp(const TriangleMesh& object, const GraspRequest& request, RandomSource& random) {
  const Pose T_object_camera = request.T_camera_object.inverse();
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
  const Pose T_object_camera = request.T_camera_object.inverse();
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
  const CoverageMeter meter(object, request);
  std::optional<Hand> best;
  double best_error = std::numeric_limits<double>::infinity();
  for (int attempt = 0, candidates = 0; attempt < kAttempts && candidates < kWantedCandidates; ++attempt) {
    const auto grasp = randomGrasp(object, request, random);
    if (!grasp) continue;
    auto hand = request.kind == HandKind::kHuman ? makeHumanHand(object, *grasp) : makeGripper(object, *grasp);
    if (!hand) continue;
    ++candidates;
    const double error = std::abs(meter.coverage(*hand) - request.wanted_coverage);
    if (error >= best_error) continue;
    best_error = error;
    best = std::move(hand);
  }
  return best ? *best : flatHand(object, request);
}

}  // namespace depth_object_tracker
