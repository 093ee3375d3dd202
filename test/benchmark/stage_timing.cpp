// SPDX-License-Identifier: BSD-3-Clause
#include "stage_timing.h"

#include "stopwatch_statistics.h"

#include "depth_object_tracker/filter/depth_likelihood.h"
#include "depth_object_tracker/filter/occlusion_tiles.h"
#include "depth_object_tracker/filter/tile_likelihood.h"
#include "depth_object_tracker/geometry/level_of_detail.h"
#include "depth_object_tracker/render/tile_renderer.h"

#include <algorithm>

namespace depth_object_tracker {
namespace {

enum Stage { kImage, kResample, kMean, kBox, kFaces, kRasterise, kOutline, kBeliefs, kPosterior, kNumStages };

constexpr std::array<const char*, kNumStages> kNames = {"measured image",  "resample",     "update mean",
                                                        "box, clear tile", "select faces", "rasterise",
                                                        "outline",         "own beliefs",  "likelihood, posterior"};

using StageSeconds = std::array<double, kNumStages>;

/// Adds the time since the last call to a stage.
class LapClock {
 public:
  explicit LapClock(StageSeconds& seconds) : seconds_(seconds), last_(BenchmarkClock::now()) {}
  void lap(Stage stage) {
    const auto now = BenchmarkClock::now();
    seconds_[stage] += secondsBetween(last_, now);
    last_ = now;
  }

 private:
  StageSeconds& seconds_;
  BenchmarkClock::time_point last_;
};

/// What reading the clock takes: a stage of a microsecond would look some per cent slower than it is.
double clockSeconds() {
  constexpr int kReadings = 10000;
  StageSeconds seconds{};
  LapClock clock(seconds);
  for (int i = 0; i < kReadings; ++i) clock.lap(kImage);
  return seconds[kImage] / kReadings;
}

/// The level of detail that DepthLikelihood draws in this scene.
TriangleMesh drawnLevel(const BenchmarkScene& scene, const TriangleMesh& mesh) {
  constexpr double kCoarsestLevelErrorM = 0.002;  // as DepthLikelihood has it
  DepthLikelihood likelihood(mesh, scene.centreObject(), PixelModelConfig(), OcclusionChainConfig(), 1, 1);
  likelihood.setImage(scene.frame(0), scene.grid(), BenchmarkScene::kFrameTimeS);
  likelihood.prepare({scene.meanPose()});
  for (const MeshLevel& level : makeLevels(mesh, kCoarsestLevelErrorM)) {
    if (level.mesh.triangles.size() == likelihood.renderedTriangles()) return level.mesh;
  }
  return mesh;
}

/// DepthLikelihood::update() taken to pieces.
class StagedEngine {
 public:
  StagedEngine(const BenchmarkScene& scene, const TriangleMesh& mesh, double edge_stddev_px, int num_particles)
      : scene_(scene),
        object_(mesh),
        outline_(outlineOn(scene.grid(), edge_stddev_px)),
        image_(PixelModelConfig()),
        memory_(OcclusionChainConfig(), num_particles, 1),
        weights_(static_cast<std::size_t>(num_particles), 1.0 / num_particles) {
    memory_.setGrid(scene.grid().camera.height, scene.grid().camera.width);
  }

  StageSeconds runFrame(int index, const std::vector<Pose>& poses, const std::vector<int>& ancestry) {
    StageSeconds seconds{};
    CellBox box;
    for (const Pose& pose : poses) box = unite(box, coveredBox(pose));
    memory_.advance(BenchmarkScene::kFrameTimeS);
    LapClock clock(seconds);
    image_.setImage(scene_.frame(index), scene_.grid());
    image_.prepare(box);
    clock.lap(kImage);
    memory_.resample(ancestry);
    clock.lap(kResample);
    memory_.updateMean(weights_);
    clock.lap(kMean);
    selectFaces();
    clock.lap(kFaces);
    for (std::size_t i = 0; i < poses.size(); ++i) updateParticle(static_cast<int>(i), poses[i], clock);
    return seconds;
  }

 private:
  CellBox coveredBox(const Pose& pose) const {
    return TileRenderer::coveredBox(object_, scene_.toObject(pose), scene_.grid().camera);
  }

  /// As TileRenderer has it, but about the mean pose.
  void selectFaces() {
    constexpr float kSharedFacingAngle = 0.09f;
    const Pose T_camera_object = scene_.toObject(scene_.meanPose());
    facing_eye_ = (T_camera_object.inverse().translation()).cast<float>();
    facing_radius_ = kSharedFacingAngle * facing_eye_.norm();
    selectFacing(object_.faces, facing_eye_, facing_radius_, facing_);
  }

  const FaceSet& facesFor(const RasterTransform& transform) const {
    const Eigen::Vector3f eye(transform.eye[0], transform.eye[1], transform.eye[2]);
    return (eye - facing_eye_).norm() <= facing_radius_ ? facing_ : object_.faces;
  }

  void updateParticle(int particle, const Pose& pose, LapClock& clock) {
    const PinholeCamera& camera = scene_.grid().camera;
    const Pose T_camera_object = scene_.toObject(pose);
    tile_.clear(TileRenderer::coveredBox(object_, T_camera_object, camera), {0, camera.height, 0, camera.width});
    const RasterTransform transform(T_camera_object, camera, tile_);
    clock.lap(kBox);
    rasterize(facesFor(transform), transform, false, tile_, scratch_);
    clock.lap(kRasterise);
    softenOutline(outline_, false, tile_);
    clock.lap(kOutline);
    collectBeliefs(particle);
    clock.lap(kBeliefs);
    const float stationary = memory_.probability(0.0f), scale = memory_.scale();
    updateTileBeliefs(tile_, {image_.planes(), image_.model(), {stationary, scale, 1.0f / scale, memory_.unmeasured()}},
                      beliefs_.data());
    clock.lap(kPosterior);
  }

  void collectBeliefs(int particle) {
    beliefs_.assign(tile_.touched.size(), nullptr);
    for (std::size_t i = 0; i < beliefs_.size(); ++i) {
      if (tile_.touched[i] == 0) continue;
      const int row = tile_.row_begin / kTileSize + static_cast<int>(i) / tile_.tile_cols;
      const int col = tile_.col_begin / kTileSize + static_cast<int>(i) % tile_.tile_cols;
      beliefs_[i] = memory_.writableTile(particle, row * memory_.tileCols() + col, 0);
    }
  }

  const BenchmarkScene& scene_;
  RenderObject object_;
  OutlineCoverage outline_;
  MeasuredImage image_;
  OcclusionTiles memory_;
  std::vector<double> weights_;
  FaceSet facing_;
  Eigen::Vector3f facing_eye_ = Eigen::Vector3f::Zero();
  float facing_radius_ = 0.0f;
  DepthTile tile_;
  RasterScratch scratch_;
  std::vector<float*> beliefs_;
};

/// Laps of a stage within one frame.
int lapsPerFrame(int stage, int num_particles) {
  return stage < kBox || stage == kFaces ? 1 : num_particles;
}

}  // namespace

std::vector<StageTiming> timeStages(const BenchmarkScene& scene, const TriangleMesh& mesh, double edge_stddev_px,
                                    int num_particles, double min_seconds) {
  constexpr int kWarmUp = 20;
  StagedEngine engine(scene, drawnLevel(scene, mesh), edge_stddev_px, num_particles);
  std::array<std::vector<double>, kNumStages> frames;
  const auto begin = BenchmarkClock::now();
  for (int index = 0; index < 2 * kWarmUp || secondsBetween(begin, BenchmarkClock::now()) < min_seconds; ++index) {
    const auto seed = static_cast<std::uint64_t>(index);
    const StageSeconds seconds =
        engine.runFrame(index, scene.drawPoses(num_particles, seed), drawAncestry(num_particles, seed));
    for (std::size_t stage = 0; stage < kNumStages && index >= kWarmUp; ++stage) {
      frames[stage].push_back(seconds[stage]);
    }
  }
  const double clock_seconds = clockSeconds();
  std::vector<StageTiming> timings;
  for (int stage = 0; stage < kNumStages; ++stage) {
    const auto k = static_cast<std::size_t>(stage);
    const double seconds = medianOf(frames[k]) - lapsPerFrame(stage, num_particles) * clock_seconds;
    timings.push_back({kNames[k], 1e9 * std::max(0.0, seconds) / num_particles});
  }
  return timings;
}

}  // namespace depth_object_tracker
