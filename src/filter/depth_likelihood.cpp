// SPDX-License-Identifier: BSD-3-Clause
#include "depth_object_tracker/filter/depth_likelihood.h"

#include "depth_object_tracker/render/depth_renderer.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

namespace depth_object_tracker {
namespace {

/// Of the outline, in cells. On a coarse grid it is known to a fraction of a cell at best: cells are in or out as a
/// whole.
double edgeStddev(double edge_stddev_px, int factor) {
  constexpr double kCellStddev = 0.3;
  return edge_stddev_px > 0.0 ? std::hypot(kCellStddev, edge_stddev_px / factor) : 0.0;
}

Linearisation unpacked(const LinearisationSums& sums) {
  Linearisation result;
  std::size_t entry = 6;
  for (int i = 0; i < 6; ++i) {
    result.gradient[i] = sums[static_cast<std::size_t>(i)];
    for (int j = 0; j <= i; ++j) result.information(i, j) = result.information(j, i) = sums[entry++];
  }
  return result;
}

}  // namespace

DepthLikelihood::DepthLikelihood(const TriangleMesh& mesh, const Eigen::Vector3d& centre_object,
                                 const PixelModelConfig& pixel_config, const OcclusionChainConfig& occlusion_config,
                                 int num_particles, int num_threads, bool level_of_detail)
    : DepthLikelihood(ObjectShape(mesh, centre_object, level_of_detail), pixel_config, occlusion_config, num_particles,
                      std::make_shared<WorkerPool>(num_threads)) {}

DepthLikelihood::DepthLikelihood(const ObjectShape& shape, const PixelModelConfig& pixel_config,
                                 const OcclusionChainConfig& occlusion_config, int num_particles,
                                 std::shared_ptr<WorkerPool> pool)
    : shape_(shape),
      object_(&shape.levels->finest()),
      edge_stddev_px_(pixel_config.edge_stddev_px),
      image_(pixel_config),
      outline_(edgeStddev(edge_stddev_px_, 1)),
      pool_(std::move(pool)),
      memory_(occlusion_config, num_particles, pool_->numThreads()),
      weights_(static_cast<std::size_t>(num_particles), 1.0 / num_particles),
      scratch_(static_cast<std::size_t>(pool_->numThreads())) {}

void DepthLikelihood::setImage(const DepthImageView& view, const SamplingGrid& grid, double dt_s) {
  const SamplingGrid last = image_.grid();
  if (last.full != grid.full) {
    memory_.reset();
    memory_.setGrid(grid.camera.height, grid.camera.width);
  } else if (last.factor != grid.factor) {
    memory_.resampleGrid(last, grid);
  }
  image_.setImage(view, grid);
  outline_ = OutlineCoverage(edgeStddev(edge_stddev_px_, grid.factor));
  memory_.advance(dt_s);
  is_level_chosen_ = false;  // until it is known where the object may be
}

CellBox DepthLikelihood::boundingBox(const Pose& T_camera_centre) const {
  const PinholeCamera& camera = image_.grid().camera;
  const Eigen::Vector3d p = T_camera_centre.translation();
  const double nearest = p.z() - shape_.radius_m;
  if (!(p.allFinite())) return CellBox();
  if (nearest <= kNearPlaneM) return image_.imageBox();
  // The sphere's silhouette is inside of the projection of its bounding cube's front face and centre offsets.
  const auto bounds = [&](double x, double focal, double principal) {
    const double low = std::min((x - shape_.radius_m) / nearest, (x - shape_.radius_m) / (p.z() + shape_.radius_m));
    const double high = std::max((x + shape_.radius_m) / nearest, (x + shape_.radius_m) / (p.z() + shape_.radius_m));
    const double limit = 1e6;
    return std::pair<int, int>{static_cast<int>(std::floor(std::clamp(focal * low + principal, -limit, limit))),
                               static_cast<int>(std::ceil(std::clamp(focal * high + principal, -limit, limit))) + 1};
  };
  const auto [col_begin, col_end] = bounds(p.x(), camera.fx, camera.cx);
  const auto [row_begin, row_end] = bounds(p.y(), camera.fy, camera.cy);
  constexpr int kOutline = 3;  // cells beyond the outline that count
  return intersect({row_begin - kOutline, row_end + kOutline, col_begin - kOutline, col_end + kOutline},
                   image_.imageBox());
}

void DepthLikelihood::prepare(const std::vector<Pose>& T_camera_centre) {
  memory_.keepAround(prepareRegion(T_camera_centre));
  memory_.updateMean(weights_);
}

void DepthLikelihood::prepareWholeImage(double level_error_m) {
  is_level_chosen_ = true;
  object_ = &shape_.levels->choose(level_error_m);
  image_.prepare(image_.imageBox());
}

CellBox DepthLikelihood::prepareRegion(const std::vector<Pose>& T_camera_centre) {
  if (!is_level_chosen_) chooseLevel(T_camera_centre);
  CellBox box;
  for (const Pose& pose : T_camera_centre) {
    // The corners of the object's box, by which a pose is found to be prepared, may stick out of the sphere.
    box = unite(box, boundingBox(pose));
    if (pose.translation().allFinite()) {
      box = unite(box, TileRenderer::coveredBox(*object_, toObject(pose), image_.grid().camera));
    }
  }
  image_.prepare(box);
  return box;
}

void DepthLikelihood::chooseLevel(const std::vector<Pose>& T_camera_centre) {
  double nearest = std::numeric_limits<double>::infinity();
  for (const Pose& pose : T_camera_centre) nearest = std::min(nearest, std::max(pose.translation().z(), kNearPlaneM));
  const double allowed = allowedLevelError(nearest, nearest / image_.grid().camera.fx, image_.config());
  is_level_chosen_ = true;
  object_ = &shape_.levels->choose(allowed);
}

Pose DepthLikelihood::toObject(const Pose& T_camera_centre) const {
  Pose T_camera_object = T_camera_centre;
  T_camera_object.translation() -= T_camera_centre.linear() * shape_.centre_object;
  return T_camera_object;
}

const DepthTile& DepthLikelihood::render(const Pose& T_camera_centre, bool for_derivatives, int thread) {
  return scratch_[static_cast<std::size_t>(thread)].renderer.render(*object_, toObject(T_camera_centre),
                                                                    image_.grid().camera, outline_, for_derivatives);
}

bool DepthLikelihood::isPrepared(const Pose& T_camera_centre) const {
  return T_camera_centre.translation().allFinite() &&
         image_.isPrepared(TileRenderer::coveredBox(*object_, toObject(T_camera_centre), image_.grid().camera));
}

int DepthLikelihood::tileIndex(const DepthTile& tile, int index) const {
  const int row = tile.row_begin / kTileSize + index / tile.tile_cols;
  return row * memory_.tileCols() + tile.col_begin / kTileSize + index % tile.tile_cols;
}

const float* const* DepthLikelihood::meanBeliefs(const DepthTile& tile, int thread) {
  std::vector<const float*>& beliefs = scratch_[static_cast<std::size_t>(thread)].beliefs;
  beliefs.reserve(tile.touched.capacity());  // grows as seldom as the tile does
  beliefs.assign(tile.touched.size(), nullptr);
  for (std::size_t i = 0; i < beliefs.size(); ++i) {
    if (tile.touched[i] != 0) beliefs[i] = memory_.meanTile(tileIndex(tile, static_cast<int>(i)));
  }
  return beliefs.data();
}

float* const* DepthLikelihood::ownBeliefs(const DepthTile& tile, int particle, int thread) {
  std::vector<float*>& beliefs = scratch_[static_cast<std::size_t>(thread)].posteriors;
  beliefs.reserve(tile.touched.capacity());  // grows as seldom as the tile does
  beliefs.assign(tile.touched.size(), nullptr);
  for (std::size_t i = 0; i < beliefs.size(); ++i) {
    if (tile.touched[i] == 0) continue;
    beliefs[i] = memory_.writableTile(particle, tileIndex(tile, static_cast<int>(i)), thread);
  }
  return beliefs.data();
}

TileLikelihoodInput DepthLikelihood::input() const {
  const float stationary = memory_.probability(0.0f), scale = memory_.scale();
  return {image_.planes(), image_.model(), {stationary, scale, 1.0f / scale, memory_.unmeasured()}};
}

double DepthLikelihood::logLikelihood(const Pose& T_camera_centre, int thread) {
  return broadLogLikelihood(T_camera_centre, 0.0, thread);
}

double DepthLikelihood::broadLogLikelihood(const Pose& T_camera_centre, double extra_stddev_m, int thread) {
  if (!isPrepared(T_camera_centre)) return -std::numeric_limits<double>::infinity();
  const DepthTile& tile = render(T_camera_centre, false, thread);
  return tileLogLikelihood(tile, input(), meanBeliefs(tile, thread), static_cast<float>(extra_stddev_m));
}

Linearisation DepthLikelihood::linearise(const Pose& T_camera_centre, double extra_stddev_m, int thread) {
  if (!isPrepared(T_camera_centre)) return Linearisation();
  const DepthTile& tile = render(T_camera_centre, true, thread);
  return unpacked(lineariseTile(tile, input(), meanBeliefs(tile, thread), static_cast<float>(extra_stddev_m),
                                geometryOf(T_camera_centre, tile)));
}

TileGeometry DepthLikelihood::geometryOf(const Pose& T_camera_centre, const DepthTile& tile) const {
  return makeTileGeometry(T_camera_centre.linear(), T_camera_centre.translation(), image_.grid().camera, object_->faces,
                          outline_, tile);
}

ScoreScatter DepthLikelihood::scatterOfScores(const Pose& T_camera_centre, int thread) {
  ScoreScatter result;
  if (!isPrepared(T_camera_centre)) return result;
  const DepthTile& tile = render(T_camera_centre, true, thread);
  const TileGeometry geometry = geometryOf(T_camera_centre, tile);
  const float* const* beliefs = meanBeliefs(tile, thread);
  for (int block = 0; block < tile.tile_rows * tile.tile_cols; ++block) {
    if (tile.touched[static_cast<std::size_t>(block)] == 0) continue;
    result.add(unpacked(lineariseTile(tile, input(), beliefs, 0.0f, geometry, block)));
  }
  return result;
}

void DepthLikelihood::update(const std::vector<Pose>& T_camera_centre, std::vector<double>& log_likelihoods) {
  prepareRegion(T_camera_centre);
  log_likelihoods.assign(T_camera_centre.size(), 0.0);
  const auto task = [&](int index, int thread) {
    const auto i = static_cast<std::size_t>(index);
    log_likelihoods[i] = updateParticle(index, T_camera_centre[i], thread);
  };
  pool_->run(static_cast<int>(T_camera_centre.size()), std::cref(task));  // by reference: nothing is allocated
}

double DepthLikelihood::updateParticle(int index, const Pose& T_camera_centre, int thread) {
  const DepthTile& tile = render(T_camera_centre, false, thread);
  return updateTileBeliefs(tile, input(), ownBeliefs(tile, index, thread));
}

void DepthLikelihood::resample(const std::vector<int>& source) {
  memory_.resample(source);
  weights_.assign(source.size(), 1.0 / static_cast<double>(source.size()));
}

void DepthLikelihood::weighMissingReadings(const Pose& T_camera_centre) {
  constexpr double kUsualShare = 0.15, kTooLargeShare = 0.5;
  if (image_.missingRatio() >= 1.0f) return;
  image_.prepare(boundingBox(T_camera_centre));
  const TileFit fit = countFit(T_camera_centre, 0.0, 0);
  const double missing = fit.covered > 0 ? 1.0 - static_cast<double>(fit.measured()) / fit.covered : 0.0;
  const double silence = std::clamp((missing - kUsualShare) / (kTooLargeShare - kUsualShare), 0.0, 1.0);
  image_.setMissingRatio(image_.missingRatio() + static_cast<float>(silence) * (1.0f - image_.missingRatio()));
}

TileFit DepthLikelihood::countFit(const Pose& T_camera_centre, double tolerance_m, int thread) {
  constexpr double kNoiseStddevs = 3.0;
  if (!isPrepared(T_camera_centre)) return TileFit();
  return countTileFit(render(T_camera_centre, false, thread), image_.planes(), static_cast<float>(tolerance_m),
                      static_cast<float>(kNoiseStddevs * image_.config().depth_noise_per_m));
}

PoseAssessment DepthLikelihood::assess(const Pose& T_camera_centre, int thread, double extra_stddev_m) {
  image_.prepare(boundingBox(T_camera_centre));
  const DepthTile& tile = render(T_camera_centre, false, thread);
  return assessTile(tile, image_, input(), meanBeliefs(tile, thread), static_cast<float>(extra_stddev_m));
}

PoseAssessment DepthLikelihood::assessWithEdges(const Pose& T_camera_centre, int thread) {
  image_.prepare(boundingBox(T_camera_centre));
  const DepthTile& tile = render(T_camera_centre, false, thread);
  PoseAssessment assessment = assessTile(tile, image_, input(), meanBeliefs(tile, thread), 0.0f);
  assessHiddenEdges(tile, image_, assessment);
  return assessment;
}

bool DepthLikelihood::explains(const Pose& T_camera_centre) {
  constexpr double kOfWhatIsExpected = 0.85, kLeastVisible = 0.2;
  const PoseAssessment fit = assess(T_camera_centre, 0);
  // An edge of what hides the object can pass for the little that is seen of it.
  if (fit.visibleShare() < kLeastVisible) return true;
  return fit.achieved > kOfWhatIsExpected * fit.expected;
}

void DepthLikelihood::occlusionMap(const std::vector<Pose>& T_camera_centre, const std::vector<double>& weights,
                                   std::vector<float>& map) {
  const PinholeCamera& camera = image_.grid().camera;
  const std::size_t num_cells = static_cast<std::size_t>(camera.width) * static_cast<std::size_t>(camera.height);
  std::vector<float> covering(num_cells, 0.0f);
  map.assign(num_cells, 0.0f);
  for (std::size_t i = 0; i < T_camera_centre.size(); ++i) {
    const auto weight = static_cast<float>(weights[i]);
    if (weight <= 0.0f) continue;
    const DepthTile& tile = render(T_camera_centre[i], false, 0);
    for (int row = 0; row < tile.rows; ++row) {
      for (int col = 0; col < tile.cols; ++col) {
        if (!(tile.depth()[row * tile.stride + col] < std::numeric_limits<float>::infinity())) continue;
        const int index = row / kTileSize * tile.tile_cols + col / kTileSize;
        const float* beliefs = memory_.tile(static_cast<int>(i), tileIndex(tile, index));
        const float stored =
            beliefs != nullptr ? beliefs[row % kTileSize * kTileSize + col % kTileSize] : memory_.unmeasured();
        const std::size_t cell =
            static_cast<std::size_t>(tile.row_begin + row) * static_cast<std::size_t>(camera.width) +
            static_cast<std::size_t>(tile.col_begin + col);
        covering[cell] += weight;
        map[cell] += weight * memory_.probability(stored);
      }
    }
  }
  for (std::size_t i = 0; i < num_cells; ++i) {
    map[i] = covering[i] >= 0.5f ? map[i] / covering[i] : std::numeric_limits<float>::quiet_NaN();
  }
}

}  // namespace depth_object_tracker
