// SPDX-License-Identifier: BSD-3-Clause
// The paper's image likelihood over a softened depth tile, its occlusion posterior and its derivatives: the hot loops.
#pragma once

#include "depth_object_tracker/model/measured_image.h"
#include "depth_object_tracker/render/depth_tile.h"
#include "depth_object_tracker/render/face_set.h"
#include "depth_object_tracker/render/tile_outline.h"

#include <array>

namespace depth_object_tracker {

/// How stored beliefs become probabilities: p = stationary + scale * stored.
struct BeliefScale {
  float stationary, scale, inverse_scale;
  float unmeasured;  ///< stored value of a pixel that was never measured
};

/// One frame's data for the loops. `tile_beliefs` arguments below hold one pointer per tile of the depth tile,
/// row-major, to kTileCells stored beliefs.
struct TileLikelihoodInput {
  PixelPlanes planes;
  PixelModel model;
  BeliefScale belief;
};

/// Sum [nat] over the pixels of log(p(z | pose) / p(z | no object)); beliefs stay as they are.
/// @param tile_beliefs null where nothing was measured yet. @param extra_stddev_m >= 0 widens the surface noise.
double tileLogLikelihood(const DepthTile& tile, const TileLikelihoodInput& input, const float* const* tile_beliefs,
                         float extra_stddev_m);
double tileLogLikelihoodScalar(const DepthTile& tile, const TileLikelihoodInput& input,
                               const float* const* tile_beliefs, float extra_stddev_m);
double tileLogLikelihoodSimd(const DepthTile& tile, const TileLikelihoodInput& input, const float* const* tile_beliefs,
                             float extra_stddev_m);

/// The same; beliefs move on to their posterior. @param tile_beliefs not null where the tile is touched.
double updateTileBeliefs(const DepthTile& tile, const TileLikelihoodInput& input, float* const* tile_beliefs);
double updateTileBeliefsScalar(const DepthTile& tile, const TileLikelihoodInput& input, float* const* tile_beliefs);
double updateTileBeliefsSimd(const DepthTile& tile, const TileLikelihoodInput& input, float* const* tile_beliefs);

/// What the derivatives need of the pose. Single precision.
struct TileGeometry {
  const FaceSet* faces;          ///< ids of the tile's faces refer to it
  float rotation[9];             ///< R of T_camera_object, row-major
  float centre[3];               ///< [m] point that the pose is about, camera frame
  float fx, fy;                  ///< [px]
  float inverse_fx, inverse_fy;  ///< [1/px]
  float cx, cy;                  ///< principal point, counted from the tile's first cell [px]
  float edge_density[2];         ///< [1/px] density of the outline's place, half a pixel and one and a half from it
};

TileGeometry makeTileGeometry(const Eigen::Matrix3d& rotation, const Eigen::Vector3d& centre,
                              const PinholeCamera& camera, const FaceSet& faces, const OutlineCoverage& outline,
                              const DepthTile& tile);

/// Gradient (6 numbers) and lower triangle, row by row, of the information matrix (21).
/// order: translation, rotation about the centre; camera axes.
using LinearisationSums = std::array<double, 27>;

constexpr int kAllBlocks = -1;

/// Second-order model of tileLogLikelihood about the pose; needs faces, distance and soft outline in the tile.
/// @param block index of the only block of 8x8 cells that counts, or kAllBlocks.
LinearisationSums lineariseTile(const DepthTile& tile, const TileLikelihoodInput& input,
                                const float* const* tile_beliefs, float extra_stddev_m, const TileGeometry& geometry,
                                int block = kAllBlocks);
LinearisationSums lineariseTileScalar(const DepthTile& tile, const TileLikelihoodInput& input,
                                      const float* const* tile_beliefs, float extra_stddev_m,
                                      const TileGeometry& geometry, int block = kAllBlocks);
LinearisationSums lineariseTileSimd(const DepthTile& tile, const TileLikelihoodInput& input,
                                    const float* const* tile_beliefs, float extra_stddev_m,
                                    const TileGeometry& geometry, int block = kAllBlocks);

/// Constants that the scalar and the SIMD loops share.
namespace tile_likelihood {
/// Factors are kept above this, so that the product of four of them stays within single precision.
constexpr float kLeastFactor = 1e-9f;
/// Pixels seen flatter than this (squared cosine) tell more about the mesh's edges than about the pose.
constexpr float kMinIncidenceSquared = 0.12f * 0.12f;
constexpr float kLeastResponsibility = 1e-4f;
constexpr float kLeastGradient = 1e-6f;  // squared; below, the outline has no direction
}  // namespace tile_likelihood

}  // namespace depth_object_tracker
