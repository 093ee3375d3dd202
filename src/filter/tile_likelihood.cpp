// SPDX-License-Identifier: BSD-3-Clause
// The reference: one pixel at a time. Sums run in the order of the SIMD code: apart for even and odd rows and for the
// columns of the tiles, one logarithm for the four factors of a tile.
#include "depth_object_tracker/filter/tile_likelihood.h"

#include "depth_object_tracker/geometry/simd_target.h"
#include "depth_object_tracker/model/fast_math.h"

#include <algorithm>
#include <cmath>

namespace depth_object_tracker {
namespace {

using tile_likelihood::kLeastFactor;

/// One pixel with a reading that the object may cover.
struct CoveredCell {
  float coverage, depth;
  MeasuredPixel pixel;
};

/// What the model says of it.
struct CellTerms {
  float p_occluded;
  PixelRatios ratios;
  float hit;    ///< ratio if the beam meets the object, occlusion marginalised
  float total;  ///< ... and if it is not known whether it does
};

/// Surface noise widened by an extra standard deviation [m].
void widen(MeasuredPixel& pixel, float extra_stddev_m) {
  const float widened =
      1.0f / std::sqrt(1.0f / (pixel.inverse_stddev * pixel.inverse_stddev) + extra_stddev_m * extra_stddev_m);
  pixel.visible_peak = pixel.visible_peak * (widened / pixel.inverse_stddev);
  pixel.inverse_stddev = widened;
}

/// False where there is nothing to be said.
bool readCell(const DepthTile& tile, const PixelPlanes& planes, int row, int col, CoveredCell& cell) {
  const int in_tile = row * tile.stride + col;
  const int in_image = (tile.row_begin + row) * planes.stride + tile.col_begin + col;
  cell.coverage = tile.coverage()[in_tile];
  cell.depth = tile.softDepth()[in_tile];
  cell.pixel = {planes.depth[in_image],
                planes.inverse_stddev[in_image],
                planes.visible_peak[in_image],
                planes.tail[in_image],
                planes.occluded_shift[in_image],
                planes.occluded_floor[in_image],
                planes.occluder_limit != nullptr ? planes.occluder_limit[in_image] : kNoOccluder};
  return cell.coverage > 0.0f && cell.pixel.depth > 0.0f;
}

/// Ratio when the beam meets the object with a probability; exact for 1, also where the ratio is tiny.
float mixWithMiss(float coverage, float ratio) {
  return (1.0f - coverage) + coverage * ratio;
}

CellTerms cellTerms(const CoveredCell& cell, const TileLikelihoodInput& input, float stored) {
  CellTerms terms;
  terms.ratios = pixelRatios(input.model, cell.pixel, cell.depth);
  terms.p_occluded =
      believedOcclusion(input.model, input.belief.stationary + input.belief.scale * stored, cell.pixel, cell.depth);
  terms.hit = (1.0f - terms.p_occluded) * terms.ratios.visible + terms.p_occluded * terms.ratios.occluded;
  const float total = mixWithMiss(cell.coverage, terms.hit);
  terms.total = total > kLeastFactor ? total : kLeastFactor;
  return terms;
}

/// Calls visit(first row, rows, first column, index) for every touched tile.
template <typename Visit>
void forEachTouchedTile(const DepthTile& tile, const Visit& visit) {
  for (int tile_row = 0; tile_row < tile.tile_rows; ++tile_row) {
    for (int tile_col = 0; tile_col < tile.tile_cols; ++tile_col) {
      const int index = tile_row * tile.tile_cols + tile_col;
      if (tile.touched[static_cast<std::size_t>(index)] == 0) continue;
      const int first_row = tile_row * kTileSize;
      visit(first_row, std::min(kTileSize, tile.rows - first_row), tile_col * kTileSize, index);
    }
  }
}

/// Sums per lane: even rows of the tiles' eight columns, then odd rows.
constexpr std::size_t kSumLanes = 2 * std::size_t{kTileSize};
using LaneSums = std::array<float, kSumLanes>;

std::size_t sumLane(int row, int col) {
  const int lane = row % 2 * kTileSize + col % kTileSize;
  return static_cast<std::size_t>(lane);
}

double sumOf(const LaneSums& lanes) {
  double sum = 0.0;
  for (const float value : lanes) sum += static_cast<double>(value);
  return sum;
}

/// visitCell(row, col, cell in tile, index of the tile) returns the factor of a pixel.
template <typename VisitCell>
double sumLogarithms(const DepthTile& tile, const VisitCell& visitCell) {
  LaneSums sums{};
  forEachTouchedTile(tile, [&](int first_row, int rows, int first_col, int index) {
    LaneSums products;
    products.fill(1.0f);
    for (int row = 0; row < rows; ++row) {
      for (int col = 0; col < kTileSize; ++col) {
        products[sumLane(row, col)] *= visitCell(first_row + row, first_col + col, row * kTileSize + col, index);
      }
    }
    for (std::size_t lane = 0; lane < kSumLanes; ++lane) sums[lane] += fastLog(products[lane]);
  });
  return sumOf(sums);
}

struct Vector3f {
  float x, y, z;
};

Vector3f rotate(const float (&m)[9], float x, float y, float z) {
  return {(m[0] * x + m[1] * y) + m[2] * z, (m[3] * x + m[4] * y) + m[5] * z, (m[6] * x + m[7] * y) + m[8] * z};
}

Vector3f cross(const Vector3f& a, const Vector3f& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

using LaneSumsOfEntries = std::array<LaneSums, 27>;

/// gradient += slope * jacobian, information += weight * jacobian * jacobian^T
void accumulate(const std::array<float, 6>& jacobian, float slope, float weight, std::size_t lane,
                LaneSumsOfEntries& sums) {
  std::size_t entry = 6;
  for (std::size_t i = 0; i < 6; ++i) {
    sums[i][lane] += slope * jacobian[i];
    const float weighted = weight * jacobian[i];
    for (std::size_t j = 0; j <= i; ++j) sums[entry++][lane] += weighted * jacobian[j];
  }
}

/// What a reading of the surface says: the depth along the beam changes by n.(dt + dtheta x (p - c)) / n.ray.
void addSurfaceTerm(const CoveredCell& cell, const CellTerms& terms, const Vector3f& ray, const Vector3f& from_centre,
                    std::int32_t face, const TileGeometry& geometry, std::size_t lane, LaneSumsOfEntries& sums) {
  const FaceSet& faces = *geometry.faces;
  const auto id = static_cast<std::size_t>(face);
  const Vector3f n = rotate(geometry.rotation, faces.normal[0][id], faces.normal[1][id], faces.normal[2][id]);
  const float slope = (n.x * ray.x + n.y * ray.y) + n.z;
  const float ray_squared = (ray.x * ray.x + ray.y * ray.y) + 1.0f;
  const float responsibility = ((cell.coverage * (1.0f - terms.p_occluded)) * terms.ratios.surface) / terms.total;
  if (!(responsibility > tile_likelihood::kLeastResponsibility)) return;
  if (!(slope * slope > tile_likelihood::kMinIncidenceSquared * ray_squared)) return;
  const float inverse = 1.0f / slope;
  const Vector3f turned = cross(from_centre, n);
  const float weight = (responsibility * cell.pixel.inverse_stddev) * cell.pixel.inverse_stddev;
  accumulate({n.x * inverse, n.y * inverse, n.z * inverse, turned.x * inverse, turned.y * inverse, turned.z * inverse},
             weight * (cell.pixel.depth - cell.depth), weight, lane, sums);
}

/// What a pixel near the outline says: moving the object along the outward image normal covers it more. The square of
/// d log L / d distance stands for the information (Fisher's identity).
void addOutlineTerm(const DepthTile& tile, int row, int col, const CoveredCell& cell, const CellTerms& terms,
                    const Vector3f& ray, const Vector3f& from_centre, const TileGeometry& geometry, std::size_t lane,
                    LaneSumsOfEntries& sums) {
  const float* here = tile.distance() + tile.rowOffset(row) + col;
  const float* above = row > 0 ? here - tile.stride : here;
  const float* below = row + 1 < tile.rows ? here + tile.stride : here;
  // Sobel operator on the distance, which falls towards the outside.
  const float du = ((above[-1] - above[1]) + (below[-1] - below[1])) + 2.0f * (here[-1] - here[1]);
  const float dv = ((above[-1] - below[-1]) + (above[1] - below[1])) + 2.0f * (above[0] - below[0]);
  const float squared = du * du + dv * dv;
  if (!(squared > tile_likelihood::kLeastGradient)) return;
  const float inverse = 1.0f / std::sqrt(squared);
  const float density = std::fabs(here[0]) < 1.0f ? geometry.edge_density[0] : geometry.edge_density[1];
  const float slope = (density * (terms.hit - 1.0f)) / terms.total;
  const float inverse_depth = 1.0f / cell.depth;
  const float u = (geometry.fx * (du * inverse)) * inverse_depth, v = (geometry.fy * (dv * inverse)) * inverse_depth;
  const Vector3f motion = {u, v, 0.0f - (u * ray.x + v * ray.y)};
  const Vector3f turned = cross(from_centre, motion);
  accumulate({motion.x, motion.y, motion.z, turned.x, turned.y, turned.z}, slope, slope * slope, lane, sums);
}

}  // namespace

double tileLogLikelihoodScalar(const DepthTile& tile, const TileLikelihoodInput& input,
                               const float* const* tile_beliefs, float extra_stddev_m) {
  return sumLogarithms(tile, [&](int row, int col, int in_tile, int index) {
    CoveredCell cell;
    if (!readCell(tile, input.planes, row, col, cell)) return 1.0f;
    if (extra_stddev_m > 0.0f) widen(cell.pixel, extra_stddev_m);
    const float* beliefs = tile_beliefs[index];
    return cellTerms(cell, input, beliefs != nullptr ? beliefs[in_tile] : input.belief.unmeasured).total;
  });
}

double updateTileBeliefsScalar(const DepthTile& tile, const TileLikelihoodInput& input, float* const* tile_beliefs) {
  return sumLogarithms(tile, [&](int row, int col, int in_tile, int index) {
    CoveredCell cell;
    if (!readCell(tile, input.planes, row, col, cell)) return 1.0f;
    float& stored = tile_beliefs[index][in_tile];
    const CellTerms terms = cellTerms(cell, input, stored);
    // A beam that misses the object says nothing about occlusion: that share of the belief stays.
    const float occluded = terms.p_occluded * mixWithMiss(cell.coverage, terms.ratios.occluded);
    stored = (occluded / terms.total - input.belief.stationary) * input.belief.inverse_scale;
    return terms.total;
  });
}

LinearisationSums lineariseTileScalar(const DepthTile& tile, const TileLikelihoodInput& input,
                                      const float* const* tile_beliefs, float extra_stddev_m,
                                      const TileGeometry& geometry, int block) {
  LaneSumsOfEntries sums{};
  forEachTouchedTile(tile, [&](int first_row, int rows, int first_col, int index) {
    if (block != kAllBlocks && block != index) return;
    for (int row = first_row; row < first_row + rows; ++row) {
      for (int column = 0; column < kTileSize; ++column) {
        const int col = first_col + column;
        CoveredCell cell;
        if (!readCell(tile, input.planes, row, col, cell)) continue;
        if (extra_stddev_m > 0.0f) widen(cell.pixel, extra_stddev_m);
        const float* beliefs = tile_beliefs[index];
        const CellTerms terms =
            cellTerms(cell, input,
                      beliefs != nullptr ? beliefs[(row - first_row) * kTileSize + column] : input.belief.unmeasured);
        const Vector3f ray = {(static_cast<float>(col) - geometry.cx) * geometry.inverse_fx,
                              (static_cast<float>(row) - geometry.cy) * geometry.inverse_fy, 1.0f};
        const Vector3f from_centre = {ray.x * cell.depth - geometry.centre[0], ray.y * cell.depth - geometry.centre[1],
                                      cell.depth - geometry.centre[2]};
        const std::size_t lane = sumLane(row, column);
        if (cell.coverage >= 0.5f) {
          addSurfaceTerm(cell, terms, ray, from_centre, tile.face()[row * tile.stride + col], geometry, lane, sums);
        }
        if (cell.coverage < 1.0f) {
          addOutlineTerm(tile, row, col, cell, terms, ray, from_centre, geometry, lane, sums);
        }
      }
    }
  });
  LinearisationSums result{};
  for (std::size_t entry = 0; entry < result.size(); ++entry) result[entry] = sumOf(sums[entry]);
  return result;
}

TileGeometry makeTileGeometry(const Eigen::Matrix3d& rotation, const Eigen::Vector3d& centre,
                              const PinholeCamera& camera, const FaceSet& faces, const OutlineCoverage& outline,
                              const DepthTile& tile) {
  TileGeometry geometry;
  geometry.faces = &faces;
  for (int k = 0; k < 9; ++k) geometry.rotation[k] = static_cast<float>(rotation(k / 3, k % 3));
  for (int k = 0; k < 3; ++k) geometry.centre[k] = static_cast<float>(centre[k]);
  geometry.fx = static_cast<float>(camera.fx);
  geometry.fy = static_cast<float>(camera.fy);
  geometry.inverse_fx = static_cast<float>(1.0 / camera.fx);
  geometry.inverse_fy = static_cast<float>(1.0 / camera.fy);
  geometry.cx = static_cast<float>(camera.cx - tile.col_begin);
  geometry.cy = static_cast<float>(camera.cy - tile.row_begin);
  for (int ring = 0; ring < 2; ++ring) {
    const float stddev = outline.edge_stddev_px, t = (0.5f + static_cast<float>(ring)) / stddev;
    geometry.edge_density[ring] = stddev > 0.0f ? fastExp(-0.5f * t * t) * fast_math::kInverseSqrt2Pi / stddev : 0.0f;
  }
  return geometry;
}

double tileLogLikelihood(const DepthTile& tile, const TileLikelihoodInput& input, const float* const* tile_beliefs,
                         float extra_stddev_m) {
#ifdef DEPTH_OBJECT_TRACKER_HAVE_HIGHWAY
  if (!simdIsScalar()) return tileLogLikelihoodSimd(tile, input, tile_beliefs, extra_stddev_m);
#endif
  return tileLogLikelihoodScalar(tile, input, tile_beliefs, extra_stddev_m);
}

double updateTileBeliefs(const DepthTile& tile, const TileLikelihoodInput& input, float* const* tile_beliefs) {
#ifdef DEPTH_OBJECT_TRACKER_HAVE_HIGHWAY
  if (!simdIsScalar()) return updateTileBeliefsSimd(tile, input, tile_beliefs);
#endif
  return updateTileBeliefsScalar(tile, input, tile_beliefs);
}

LinearisationSums lineariseTile(const DepthTile& tile, const TileLikelihoodInput& input,
                                const float* const* tile_beliefs, float extra_stddev_m, const TileGeometry& geometry,
                                int block) {
#ifdef DEPTH_OBJECT_TRACKER_HAVE_HIGHWAY
  if (!simdIsScalar()) return lineariseTileSimd(tile, input, tile_beliefs, extra_stddev_m, geometry, block);
#endif
  return lineariseTileScalar(tile, input, tile_beliefs, extra_stddev_m, geometry, block);
}

}  // namespace depth_object_tracker
