// SPDX-License-Identifier: BSD-3-Clause
#include "depth_object_tracker/render/tile_outline.h"

#include <algorithm>
#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/tile_outline_simd.cpp"
#include "simd/foreach_target.h"

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace depth_object_tracker::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using D = hn::CappedTag<float, kTileSize>;
using V = hn::Vec<D>;
constexpr int kLanes = static_cast<int>(hn::MaxLanes(D()));

struct RowPointers {
  HWY_INLINE RowPointers(const float* plane, int row, const DepthTile& tile)
      : here(plane + tile.rowOffset(row)),
        above(row > 0 ? here - tile.stride : here),
        below(row + 1 < tile.rows ? here + tile.stride : here) {}
  const float *here, *above, *below;
};

struct Neighbours {
  HWY_INLINE Neighbours(const RowPointers& rows, int col)
      : here(hn::LoadU(D(), rows.here + col)),
        above(hn::LoadU(D(), rows.above + col)),
        below(hn::LoadU(D(), rows.below + col)),
        left(hn::LoadU(D(), rows.here + col - 1)),
        right(hn::LoadU(D(), rows.here + col + 1)) {}
  HWY_INLINE V least() const { return hn::Min(here, hn::Min(hn::Min(above, below), hn::Min(left, right))); }
  HWY_INLINE V largest() const { return hn::Max(here, hn::Max(hn::Max(above, below), hn::Max(left, right))); }
  V here, above, below, left, right;
};

/// Rings of a few cells; depth by how far outside of the outline a cell lies.
struct Rings {
  V depth, dilated, eroded, dilated_twice, eroded_twice;
};

template <bool kWithDistance>
HWY_INLINE V writeCells(const Rings& rings, const OutlineCoverage& outline, int col, int offset, DepthTile& tile) {
  const D d;
  const V empty = hn::Set(d, std::numeric_limits<float>::infinity()), zero = hn::Zero(d);
  const auto covered = hn::Lt(rings.depth, empty), beside = hn::Lt(rings.dilated, empty);
  const auto near = hn::Lt(rings.dilated_twice, empty);
  const auto inner = hn::Lt(rings.eroded, empty), innermost = hn::Lt(rings.eroded_twice, empty);
  V coverage = hn::IfThenElseZero(near, hn::Set(d, outline.outside[1]));
  coverage = hn::IfThenElse(beside, hn::Set(d, outline.outside[0]), coverage);
  coverage = hn::IfThenElse(covered, hn::Set(d, outline.inside[0]), coverage);
  coverage = hn::IfThenElse(inner, hn::Set(d, outline.inside[1]), coverage);
  coverage = hn::IfThenElse(innermost, hn::Set(d, 1.0f), coverage);
  const V cols = hn::Iota(d, static_cast<float>(col));
  coverage = hn::IfThenElse(hn::Lt(cols, hn::Set(d, static_cast<float>(tile.cols))), coverage, zero);
  hn::StoreU(coverage, d, tile.coverage() + offset);
  V depth = hn::IfThenElse(beside, rings.dilated, rings.dilated_twice);
  depth = hn::IfThenElse(covered, rings.depth, depth);
  hn::StoreU(depth, d, tile.softDepth() + offset);
  if (kWithDistance) {
    V distance = hn::IfThenElse(near, hn::Set(d, -1.5f), hn::Set(d, -2.5f));
    distance = hn::IfThenElse(beside, hn::Set(d, -0.5f), distance);
    distance = hn::IfThenElse(covered, hn::Set(d, 0.5f), distance);
    distance = hn::IfThenElse(inner, hn::Set(d, 1.5f), distance);
    distance = hn::IfThenElse(innermost, hn::Set(d, 2.5f), distance);
    hn::StoreU(distance, d, tile.distance() + offset);
  }
  return coverage;
}

/// All cells, tile by tile; `ringsAt(row, col)` tells about those from a column on.
template <bool kWithDistance, typename RingsAt>
HWY_INLINE void writeTiles(const OutlineCoverage& outline, DepthTile& tile, const RingsAt& ringsAt) {
  const D d;
  for (int index = 0; index < tile.tile_rows * tile.tile_cols; ++index) {
    const int first_row = index / tile.tile_cols * kTileSize, first_col = index % tile.tile_cols * kTileSize;
    V most = hn::Zero(d);
    for (int row = first_row; row < std::min(first_row + kTileSize, tile.rows); ++row) {
      for (int col = first_col; col < first_col + kTileSize; col += kLanes) {
        most = hn::Max(most, writeCells<kWithDistance>(ringsAt(row, col), outline, col, row * tile.stride + col, tile));
      }
    }
    tile.touched[static_cast<std::size_t>(index)] =
        static_cast<std::uint8_t>(!hn::AllFalse(d, hn::Gt(most, hn::Zero(d))));
  }
}

void writeHard(const OutlineCoverage& outline, DepthTile& tile) {
  writeTiles<false>(outline, tile, [&](int row, int col) HWY_ATTR {
    const V here = hn::LoadU(D(), tile.depth() + tile.rowOffset(row) + col);
    const V nothing = hn::Set(D(), std::numeric_limits<float>::infinity());
    return Rings{here, nothing, here, nothing, here};
  });
}

void writeOneRing(const OutlineCoverage& outline, DepthTile& tile) {
  padRows(tile.depth(), tile);
  writeTiles<false>(outline, tile, [&](int row, int col) HWY_ATTR {
    const Neighbours cells(RowPointers(tile.depth(), row, tile), col);
    const V dilated = cells.least(), eroded = cells.largest();
    return Rings{cells.here, dilated, eroded, dilated, eroded};
  });
}

template <bool kWithDistance>
void writeTwoRings(const OutlineCoverage& outline, DepthTile& tile) {
  padRows(tile.depth(), tile);
  for (int row = 0; row < tile.rows; ++row) {
    const RowPointers rows(tile.depth(), row, tile);
    for (int col = 0; col < tile.tile_cols * kTileSize; col += kLanes) {
      const Neighbours cells(rows, col);
      hn::StoreU(cells.least(), D(), tile.dilated() + tile.rowOffset(row) + col);
      hn::StoreU(cells.largest(), D(), tile.eroded() + tile.rowOffset(row) + col);
    }
  }
  padRows(tile.dilated(), tile);
  padRows(tile.eroded(), tile);
  writeTiles<kWithDistance>(outline, tile, [&](int row, int col) HWY_ATTR {
    const Neighbours outer(RowPointers(tile.dilated(), row, tile), col);
    const Neighbours inner(RowPointers(tile.eroded(), row, tile), col);
    return Rings{hn::LoadU(D(), tile.depth() + tile.rowOffset(row) + col), outer.here, inner.here, outer.least(),
                 inner.largest()};
  });
  if (kWithDistance) padRows(tile.distance(), tile);
}

void softenTile(const OutlineCoverage& outline, bool with_distance, DepthTile& tile) {
  clearRowsBeyondImage(tile);
  if (with_distance) return writeTwoRings<true>(outline, tile);
  if (outline.reach == 2) return writeTwoRings<false>(outline, tile);
  if (outline.reach == 1) return writeOneRing(outline, tile);
  writeHard(outline, tile);
}

}  // namespace depth_object_tracker::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace depth_object_tracker {

HWY_EXPORT(softenTile);

void softenOutlineSimd(const OutlineCoverage& outline, bool with_distance, DepthTile& tile) {
  HWY_DYNAMIC_DISPATCH(softenTile)(outline, with_distance, tile);
}

}  // namespace depth_object_tracker
#endif  // HWY_ONCE
