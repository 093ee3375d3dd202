// SPDX-License-Identifier: BSD-3-Clause
// The reference, one or two rows of a tile at a time. Same operations in the same order: the same bytes.
#include "depth_object_tracker/filter/tile_likelihood.h"

#include "depth_object_tracker/model/fast_math.h"

#include <algorithm>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "filter/tile_likelihood_simd.cpp"
#include "simd/foreach_target.h"

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace depth_object_tracker::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

constexpr std::size_t kTwoRows = 2 * std::size_t{kTileSize};  // cells

using D = hn::CappedTag<float, kTwoRows>;
using DI = hn::RebindToSigned<D>;
using V = hn::Vec<D>;
using I = hn::Vec<DI>;
using M = hn::Mask<D>;
constexpr std::size_t kLanes = hn::MaxLanes(D());
constexpr int kRows = kLanes > kTileSize ? 2 : 1;                        // rows of a tile in a vector
constexpr std::size_t kParts = kRows == 2 ? 1 : kTileSize / kLanes;      // vectors per row of a tile
constexpr std::size_t kSumVectors = kRows == 2 ? 1 : kTwoRows / kLanes;  // for even and for odd rows

/// Even rows first, as the reference has it.
HWY_INLINE std::size_t sumVector(int row, std::size_t part) {
  return static_cast<std::size_t>(row % 2) * kParts + part;
}

HWY_INLINE V set(float value) {
  return hn::Set(D(), value);
}

/// Cells of one row, or of two that lie `stride` apart.
template <typename T>
HWY_INLINE auto loadRows(const T* first, const T* second) {
  const hn::CappedTag<T, kTwoRows> d;
#if HWY_MAX_BYTES >= 64
  if (kRows == 2) {
    const hn::Half<decltype(d)> half;
    return hn::Combine(d, hn::LoadU(half, second), hn::LoadU(half, first));
  }
#else
  (void)second;
#endif
  return hn::LoadU(d, first);
}
template <typename T>
HWY_INLINE auto loadRows(const T* first, int stride) {
  return loadRows(first, first + stride);
}

/// Number of each lane's column, and of its row, counted from the first.
HWY_INLINE V laneColumns() {
  if (kRows == 1) return hn::Iota(D(), 0.0f);
  alignas(64) static constexpr float kColumns[16] = {0, 1, 2, 3, 4, 5, 6, 7, 0, 1, 2, 3, 4, 5, 6, 7};
  return hn::Load(D(), kColumns);
}
HWY_INLINE V laneRows() {
  if (kRows == 1) return hn::Zero(D());
  alignas(64) static constexpr float kRowNumbers[16] = {0, 0, 0, 0, 0, 0, 0, 0, 1, 1, 1, 1, 1, 1, 1, 1};
  return hn::Load(D(), kRowNumbers);
}

HWY_INLINE V vectorExp(V x) {
  using namespace fast_math;
  x = hn::Max(x, set(kLeastExponent));
  const V n = hn::Sub(hn::Add(hn::Mul(x, set(kLog2E)), set(kRounder)), set(kRounder));
  const V r = hn::Sub(hn::Sub(x, hn::Mul(n, set(kLn2High))), hn::Mul(n, set(kLn2Low)));
  V p = set(kExp[0]);
  for (int k = 1; k < 6; ++k) p = hn::Add(hn::Mul(p, r), set(kExp[k]));
  const V mantissa = hn::Add(hn::Add(hn::Mul(p, hn::Mul(r, r)), r), set(1.0f));
  const I bits = hn::ShiftLeft<23>(hn::Add(hn::ConvertTo(DI(), n), hn::Set(DI(), 127)));
  return hn::Mul(mantissa, hn::BitCast(D(), bits));
}

HWY_INLINE V vectorLog(V x) {
  using namespace fast_math;
  const DI di;
  const I bits = hn::BitCast(di, x);
  V exponent = hn::ConvertTo(D(), hn::Sub(hn::ShiftRight<23>(bits), hn::Set(di, 126)));
  V m = hn::BitCast(D(), hn::Or(hn::And(bits, hn::Set(di, 0x007fffff)), hn::Set(di, 0x3f000000)));
  const M low = hn::Lt(m, set(kSqrtHalf));
  exponent = hn::IfThenElse(low, hn::Sub(exponent, set(1.0f)), exponent);
  m = hn::Sub(hn::IfThenElse(low, hn::Add(m, m), m), set(1.0f));
  const V z = hn::Mul(m, m);
  V p = set(kLog[0]);
  for (int k = 1; k < 9; ++k) p = hn::Add(hn::Mul(p, m), set(kLog[k]));
  const V y = hn::Sub(hn::Add(hn::Mul(hn::Mul(p, m), z), hn::Mul(exponent, set(kLn2Low))), hn::Mul(set(0.5f), z));
  return hn::Add(hn::Add(m, y), hn::Mul(exponent, set(kLn2High)));
}

HWY_INLINE V vectorNormalTail(V x, V bell) {
  using namespace fast_math;
  const V k = hn::Div(set(1.0f), hn::Add(set(1.0f), hn::Mul(set(kTailScale), x)));
  V p = set(kTail[0]);
  for (int i = 1; i < 5; ++i) p = hn::Add(hn::Mul(p, k), set(kTail[i]));
  return hn::Mul(hn::Mul(p, k), hn::Mul(bell, set(kInverseSqrt2Pi)));
}

/// Pixels of which the mask's have a reading and may be covered by the object.
struct Cells {
  M valid;
  V coverage, depth;
  V z, inverse_stddev, visible_peak, tail, shift, floor, occluder_limit;
};

struct Terms {
  V p_occluded, visible, occluded, surface, hit, total;
};

HWY_INLINE Cells readCells(const DepthTile& tile, const PixelPlanes& planes, int row, int col) {
  const D d;
  const int in_tile = row * tile.stride + col;
  const int in_image = (tile.row_begin + row) * planes.stride + tile.col_begin + col;
  const auto read = [&](const float* plane) HWY_ATTR { return loadRows(plane + in_image, planes.stride); };
  Cells cells;
  cells.coverage = loadRows(tile.coverage() + in_tile, tile.stride);
  cells.z = read(planes.depth);
  cells.valid = hn::And(hn::Gt(cells.coverage, hn::Zero(d)), hn::Gt(cells.z, hn::Zero(d)));
  // Elsewhere the depth may be infinite: any finite number keeps the lanes quiet.
  cells.depth = hn::IfThenElse(cells.valid, loadRows(tile.softDepth() + in_tile, tile.stride), set(1.0f));
  cells.inverse_stddev = read(planes.inverse_stddev);
  cells.visible_peak = read(planes.visible_peak);
  cells.tail = read(planes.tail);
  cells.shift = read(planes.occluded_shift);
  cells.occluder_limit = planes.occluder_limit != nullptr ? read(planes.occluder_limit) : set(kNoOccluder);
  return cells;
}

HWY_INLINE void readFloor(const PixelPlanes& planes, const DepthTile& tile, int row, int col, Cells& cells) {
  const int in_image = (tile.row_begin + row) * planes.stride + tile.col_begin + col;
  cells.floor = loadRows(planes.occluded_floor + in_image, planes.stride);
}

HWY_INLINE void widen(Cells& cells, float extra_stddev_m) {
  const V one = set(1.0f);
  const V variance = hn::Div(one, hn::Mul(cells.inverse_stddev, cells.inverse_stddev));
  const V widened = hn::Div(one, hn::Sqrt(hn::Add(variance, set(extra_stddev_m * extra_stddev_m))));
  cells.visible_peak = hn::Mul(cells.visible_peak, hn::Div(widened, cells.inverse_stddev));
  cells.inverse_stddev = widened;
}

HWY_INLINE V mixWithMiss(V coverage, V ratio) {
  return hn::Add(hn::Sub(set(1.0f), coverage), hn::Mul(coverage, ratio));
}

template <bool kPaper>
HWY_INLINE Terms cellTerms(const Cells& cells, const TileLikelihoodInput& input, V stored) {
  const D d;
  const V zero = hn::Zero(d), one = set(1.0f), half = set(0.5f);
  const V t = hn::Mul(hn::Sub(cells.depth, cells.z), cells.inverse_stddev);
  const V bell = vectorExp(hn::Mul(hn::Mul(set(-0.5f), t), t));
  const V tail = vectorNormalTail(hn::Abs(t), bell);
  const V step = hn::IfThenElse(hn::Lt(t, zero), tail, hn::Sub(one, tail));
  V in_front = hn::Add(step, hn::Mul(hn::Mul(hn::Mul(cells.shift, bell), set(fast_math::kInverseSqrt2Pi)),
                                     hn::Sub(one, hn::Mul(hn::Mul(half, t), cells.shift))));
  if (kPaper) {
    const V range = hn::Sub(one, vectorExp(hn::Mul(set(-input.model.occluder_rate), cells.depth)));
    in_front = hn::Div(hn::Max(hn::Sub(in_front, cells.floor), zero), range);
  }
  Terms terms;
  terms.surface = hn::Mul(cells.visible_peak, bell);
  terms.visible = hn::Add(terms.surface, cells.tail);
  terms.occluded = hn::Add(hn::Mul(hn::Sub(one, cells.tail), in_front), cells.tail);

  const V believed = hn::Add(set(input.belief.stationary), hn::Mul(set(input.belief.scale), stored));
  const V ramp = hn::Mul(hn::Sub(t, set(kInFrontBegin)), set(1.0f / (kInFrontEnd - kInFrontBegin)));
  const V share = hn::Min(hn::Max(ramp, zero), one);
  V least = hn::Mul(set(input.model.min_p_occluded_in_front),
                    hn::Mul(hn::Mul(share, share), hn::Sub(set(3.0f), hn::Add(share, share))));
  if (input.planes.occluder_limit != nullptr) {
    const M is_behind = hn::Gt(cells.depth, cells.occluder_limit);
    least = hn::Max(least, hn::IfThenElse(is_behind, set(input.model.known_occluder_p_occluded), zero));
  }
  terms.p_occluded = hn::Max(believed, least);
  terms.hit =
      hn::Add(hn::Mul(hn::Sub(one, terms.p_occluded), terms.visible), hn::Mul(terms.p_occluded, terms.occluded));
  terms.total = hn::Max(mixWithMiss(cells.coverage, terms.hit), set(tile_likelihood::kLeastFactor));
  return terms;
}

double sumOfLanes(const float (&lanes)[2 * kTileSize]) {
  double sum = 0.0;
  for (const float value : lanes) sum += static_cast<double>(value);
  return sum;
}

/// One tile: adds its log-likelihood per lane to `sums`; writes the posterior to `beliefs` when kUpdate.
template <bool kPaper, bool kUpdate, bool kWiden>
HWY_INLINE void visitTile(const DepthTile& tile, const TileLikelihoodInput& input, int first_row, int first_col,
                          const float* beliefs, float* posterior, float extra_stddev_m, V (&sums)[kSumVectors]) {
  const D d;
  const V one = set(1.0f);
  V products[kSumVectors];
  for (V& product : products) product = one;
  for (int row = 0; row < kTileSize; row += kRows) {
    for (std::size_t part = 0; part < kParts; ++part) {
      const int column = static_cast<int>(part * kLanes);
      Cells cells = readCells(tile, input.planes, first_row + row, first_col + column);
      if (hn::AllFalse(d, cells.valid)) continue;
      if (kPaper) readFloor(input.planes, tile, first_row + row, first_col + column, cells);
      if (kWiden) widen(cells, extra_stddev_m);
      const int in_tile = row * kTileSize + column;
      const V stored = beliefs != nullptr ? hn::Load(d, beliefs + in_tile) : set(input.belief.unmeasured);
      const Terms terms = cellTerms<kPaper>(cells, input, stored);
      V& product = products[sumVector(row, part)];
      product = hn::Mul(product, hn::IfThenElse(cells.valid, terms.total, one));
      if (kUpdate) {
        const V occluded = hn::Mul(terms.p_occluded, mixWithMiss(cells.coverage, terms.occluded));
        const V moved = hn::Mul(hn::Sub(hn::Div(occluded, terms.total), set(input.belief.stationary)),
                                set(input.belief.inverse_scale));
        hn::Store(hn::IfThenElse(cells.valid, moved, stored), d, posterior + in_tile);
      }
    }
  }
  for (std::size_t k = 0; k < kSumVectors; ++k) sums[k] = hn::Add(sums[k], vectorLog(products[k]));
}

template <bool kPaper, bool kUpdate, bool kWiden>
double visitTiles(const DepthTile& tile, const TileLikelihoodInput& input, const float* const* beliefs,
                  float* const* posteriors, float extra_stddev_m) {
  V sums[kSumVectors];
  for (V& sum : sums) sum = hn::Zero(D());
  for (int tile_row = 0; tile_row < tile.tile_rows; ++tile_row) {
    for (int tile_col = 0; tile_col < tile.tile_cols; ++tile_col) {
      const int index = tile_row * tile.tile_cols + tile_col;
      if (tile.touched[static_cast<std::size_t>(index)] == 0) continue;
      visitTile<kPaper, kUpdate, kWiden>(tile, input, tile_row * kTileSize, tile_col * kTileSize,
                                         kUpdate ? posteriors[index] : beliefs[index],
                                         kUpdate ? posteriors[index] : nullptr, extra_stddev_m, sums);
    }
  }
  alignas(64) float lanes[2 * kTileSize];
  for (std::size_t k = 0; k < kSumVectors; ++k) hn::Store(sums[k], D(), lanes + k * kLanes);
  return sumOfLanes(lanes);
}

double logLikelihoodOfTile(const DepthTile& tile, const TileLikelihoodInput& input, const float* const* beliefs,
                           float extra_stddev_m) {
  const bool wide = extra_stddev_m > 0.0f;
  if (input.model.paper_occluder) {
    return wide ? visitTiles<true, false, true>(tile, input, beliefs, nullptr, extra_stddev_m)
                : visitTiles<true, false, false>(tile, input, beliefs, nullptr, 0.0f);
  }
  return wide ? visitTiles<false, false, true>(tile, input, beliefs, nullptr, extra_stddev_m)
              : visitTiles<false, false, false>(tile, input, beliefs, nullptr, 0.0f);
}

double updateBeliefsOfTile(const DepthTile& tile, const TileLikelihoodInput& input, float* const* beliefs) {
  return input.model.paper_occluder ? visitTiles<true, true, false>(tile, input, nullptr, beliefs, 0.0f)
                                    : visitTiles<false, true, false>(tile, input, nullptr, beliefs, 0.0f);
}

struct Vectors {
  V x, y, z;
};

HWY_INLINE Vectors rotate(const float (&m)[9], const Vectors& v) {
  const auto row = [&](int k) HWY_ATTR {
    return hn::Add(hn::Add(hn::Mul(set(m[k]), v.x), hn::Mul(set(m[k + 1]), v.y)), hn::Mul(set(m[k + 2]), v.z));
  };
  return {row(0), row(3), row(6)};
}

HWY_INLINE Vectors cross(const Vectors& a, const Vectors& b) {
  return {hn::Sub(hn::Mul(a.y, b.z), hn::Mul(a.z, b.y)), hn::Sub(hn::Mul(a.z, b.x), hn::Mul(a.x, b.z)),
          hn::Sub(hn::Mul(a.x, b.y), hn::Mul(a.y, b.x))};
}

struct Jacobian {
  V entry[6];
};

/// In memory: 27 vectors do not fit into the registers anyway.
struct EntrySums {
  alignas(64) float lanes[27][2 * kTileSize];
};

HWY_INLINE void accumulate(const Jacobian& jacobian, V slope, V weight, std::size_t vector, EntrySums& sums) {
  const D d;
  std::size_t entry = 6;
  const auto add = [&](std::size_t index, V value) HWY_ATTR {
    float* sum = sums.lanes[index] + vector * kLanes;
    hn::Store(hn::Add(hn::Load(d, sum), value), d, sum);
  };
  for (std::size_t i = 0; i < 6; ++i) {
    add(i, hn::Mul(slope, jacobian.entry[i]));
    const V weighted = hn::Mul(weight, jacobian.entry[i]);
    for (std::size_t j = 0; j <= i; ++j) add(entry++, hn::Mul(weighted, jacobian.entry[j]));
  }
}

HWY_INLINE void addSurfaceTerm(const Cells& cells, const Terms& terms, const Vectors& ray, const Vectors& from_centre,
                               I face, const TileGeometry& geometry, std::size_t vector, EntrySums& sums) {
  const D d;
  const DI di;
  const V zero = hn::Zero(d), one = set(1.0f);
  const V responsibility =
      hn::Div(hn::Mul(hn::Mul(cells.coverage, hn::Sub(one, terms.p_occluded)), terms.surface), terms.total);
  M used = hn::And(cells.valid, hn::Ge(cells.coverage, set(0.5f)));
  used = hn::And(used, hn::Gt(responsibility, set(tile_likelihood::kLeastResponsibility)));
  if (hn::AllFalse(d, used)) return;
  const I id = hn::IfThenElseZero(hn::RebindMask(di, used), face);
  const FaceSet& faces = *geometry.faces;
  const Vectors n = rotate(geometry.rotation, {hn::GatherIndex(d, faces.normal[0].data(), id),
                                               hn::GatherIndex(d, faces.normal[1].data(), id),
                                               hn::GatherIndex(d, faces.normal[2].data(), id)});
  const V slope = hn::Add(hn::Add(hn::Mul(n.x, ray.x), hn::Mul(n.y, ray.y)), n.z);
  const V ray_squared = hn::Add(hn::Add(hn::Mul(ray.x, ray.x), hn::Mul(ray.y, ray.y)), one);
  used = hn::And(used, hn::Gt(hn::Mul(slope, slope), hn::Mul(set(tile_likelihood::kMinIncidenceSquared), ray_squared)));
  if (hn::AllFalse(d, used)) return;
  const V inverse = hn::IfThenElseZero(used, hn::Div(one, slope));
  const Vectors turned = cross(from_centre, n);
  const V weight =
      hn::IfThenElseZero(used, hn::Mul(hn::Mul(responsibility, cells.inverse_stddev), cells.inverse_stddev));
  const Jacobian jacobian = {hn::Mul(n.x, inverse),      hn::Mul(n.y, inverse),      hn::Mul(n.z, inverse),
                             hn::Mul(turned.x, inverse), hn::Mul(turned.y, inverse), hn::Mul(turned.z, inverse)};
  const V residual = hn::IfThenElse(used, hn::Sub(cells.z, cells.depth), zero);
  accumulate(jacobian, hn::Mul(weight, residual), weight, vector, sums);
}

HWY_INLINE void addOutlineTerm(const DepthTile& tile, int row, int col, const Cells& cells, const Terms& terms,
                               const Vectors& ray, const Vectors& from_centre, const TileGeometry& geometry,
                               std::size_t vector, EntrySums& sums) {
  const D d;
  const V zero = hn::Zero(d), one = set(1.0f), two = set(2.0f);
  M used = hn::And(cells.valid, hn::Lt(cells.coverage, one));
  if (hn::AllFalse(d, used)) return;
  // Rows beyond the image count like its last.
  const auto at = [&](int row_offset, int col_offset) HWY_ATTR {
    const auto line = [&](int r) HWY_ATTR {
      return tile.distance() + tile.rowOffset(std::clamp(r, 0, tile.rows - 1)) + col + col_offset;
    };
    return loadRows(line(row + row_offset), line(row + 1 + row_offset));
  };
  const V above_left = at(-1, -1), above_right = at(-1, 1), below_left = at(1, -1), below_right = at(1, 1);
  const V here = at(0, 0);
  const V du = hn::Add(hn::Add(hn::Sub(above_left, above_right), hn::Sub(below_left, below_right)),
                       hn::Mul(two, hn::Sub(at(0, -1), at(0, 1))));
  const V dv = hn::Add(hn::Add(hn::Sub(above_left, below_left), hn::Sub(above_right, below_right)),
                       hn::Mul(two, hn::Sub(at(-1, 0), at(1, 0))));
  const V squared = hn::Add(hn::Mul(du, du), hn::Mul(dv, dv));
  used = hn::And(used, hn::Gt(squared, set(tile_likelihood::kLeastGradient)));
  if (hn::AllFalse(d, used)) return;
  const V inverse = hn::IfThenElseZero(used, hn::Div(one, hn::Sqrt(squared)));
  const V density =
      hn::IfThenElse(hn::Lt(hn::Abs(here), one), set(geometry.edge_density[0]), set(geometry.edge_density[1]));
  const V slope = hn::IfThenElseZero(used, hn::Div(hn::Mul(density, hn::Sub(terms.hit, one)), terms.total));
  const V inverse_depth = hn::Div(one, cells.depth);
  const V u = hn::Mul(hn::Mul(set(geometry.fx), hn::IfThenElseZero(used, hn::Mul(du, inverse))), inverse_depth);
  const V v = hn::Mul(hn::Mul(set(geometry.fy), hn::IfThenElseZero(used, hn::Mul(dv, inverse))), inverse_depth);
  const Vectors motion = {u, v, hn::Sub(zero, hn::Add(hn::Mul(u, ray.x), hn::Mul(v, ray.y)))};
  const Vectors turned = cross(from_centre, motion);
  accumulate({motion.x, motion.y, motion.z, turned.x, turned.y, turned.z}, slope, hn::Mul(slope, slope), vector, sums);
}

template <bool kPaper, bool kWiden>
void lineariseRow(const DepthTile& tile, const TileLikelihoodInput& input, int row, int first_col, const float* beliefs,
                  float extra_stddev_m, const TileGeometry& geometry, EntrySums& sums) {
  const D d;
  for (std::size_t part = 0; part < kParts; ++part) {
    const int col = first_col + static_cast<int>(part * kLanes);
    Cells cells = readCells(tile, input.planes, row, col);
    if (hn::AllFalse(d, cells.valid)) continue;
    if (kPaper) readFloor(input.planes, tile, row, col, cells);
    if (kWiden) widen(cells, extra_stddev_m);
    const V stored = beliefs != nullptr ? hn::Load(d, beliefs + part * kLanes) : set(input.belief.unmeasured);
    const Terms terms = cellTerms<kPaper>(cells, input, stored);
    const V cols = hn::Add(set(static_cast<float>(col)), laneColumns());
    const V rows = hn::Add(set(static_cast<float>(row)), laneRows());
    const Vectors ray = {hn::Mul(hn::Sub(cols, set(geometry.cx)), set(geometry.inverse_fx)),
                         hn::Mul(hn::Sub(rows, set(geometry.cy)), set(geometry.inverse_fy)), set(1.0f)};
    const Vectors from_centre = {hn::Sub(hn::Mul(ray.x, cells.depth), set(geometry.centre[0])),
                                 hn::Sub(hn::Mul(ray.y, cells.depth), set(geometry.centre[1])),
                                 hn::Sub(cells.depth, set(geometry.centre[2]))};
    const std::size_t vector = sumVector(row, part);
    const I face = loadRows(tile.face() + tile.rowOffset(row) + col, tile.stride);
    addSurfaceTerm(cells, terms, ray, from_centre, face, geometry, vector, sums);
    addOutlineTerm(tile, row, col, cells, terms, ray, from_centre, geometry, vector, sums);
  }
}

template <bool kPaper, bool kWiden>
LinearisationSums lineariseTiles(const DepthTile& tile, const TileLikelihoodInput& input, const float* const* beliefs,
                                 float extra_stddev_m, const TileGeometry& geometry, int block) {
  EntrySums sums{};
  for (int tile_row = 0; tile_row < tile.tile_rows; ++tile_row) {
    for (int tile_col = 0; tile_col < tile.tile_cols; ++tile_col) {
      const int index = tile_row * tile.tile_cols + tile_col;
      if (tile.touched[static_cast<std::size_t>(index)] == 0) continue;
      if (block != kAllBlocks && block != index) continue;
      const int first_row = tile_row * kTileSize;
      for (int row = first_row; row < first_row + kTileSize; row += kRows) {
        const std::ptrdiff_t first_cell = std::ptrdiff_t{kTileSize} * (row - first_row);
        const float* row_beliefs = beliefs[index] != nullptr ? beliefs[index] + first_cell : nullptr;
        lineariseRow<kPaper, kWiden>(tile, input, row, tile_col * kTileSize, row_beliefs, extra_stddev_m, geometry,
                                     sums);
      }
    }
  }
  LinearisationSums result{};
  for (std::size_t entry = 0; entry < result.size(); ++entry) result[entry] = sumOfLanes(sums.lanes[entry]);
  return result;
}

LinearisationSums linearisationOfTile(const DepthTile& tile, const TileLikelihoodInput& input,
                                      const float* const* beliefs, float extra_stddev_m, const TileGeometry& geometry,
                                      int block) {
  const bool wide = extra_stddev_m > 0.0f;
  if (input.model.paper_occluder) {
    return wide ? lineariseTiles<true, true>(tile, input, beliefs, extra_stddev_m, geometry, block)
                : lineariseTiles<true, false>(tile, input, beliefs, 0.0f, geometry, block);
  }
  return wide ? lineariseTiles<false, true>(tile, input, beliefs, extra_stddev_m, geometry, block)
              : lineariseTiles<false, false>(tile, input, beliefs, 0.0f, geometry, block);
}

}  // namespace depth_object_tracker::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace depth_object_tracker {

HWY_EXPORT(logLikelihoodOfTile);
HWY_EXPORT(updateBeliefsOfTile);
HWY_EXPORT(linearisationOfTile);

double tileLogLikelihoodSimd(const DepthTile& tile, const TileLikelihoodInput& input, const float* const* tile_beliefs,
                             float extra_stddev_m) {
  return HWY_DYNAMIC_DISPATCH(logLikelihoodOfTile)(tile, input, tile_beliefs, extra_stddev_m);
}

double updateTileBeliefsSimd(const DepthTile& tile, const TileLikelihoodInput& input, float* const* tile_beliefs) {
  return HWY_DYNAMIC_DISPATCH(updateBeliefsOfTile)(tile, input, tile_beliefs);
}

LinearisationSums lineariseTileSimd(const DepthTile& tile, const TileLikelihoodInput& input,
                                    const float* const* tile_beliefs, float extra_stddev_m,
                                    const TileGeometry& geometry, int block) {
  return HWY_DYNAMIC_DISPATCH(linearisationOfTile)(tile, input, tile_beliefs, extra_stddev_m, geometry, block);
}

}  // namespace depth_object_tracker
#endif  // HWY_ONCE
