// SPDX-License-Identifier: BSD-3-Clause
// The part of an image that an object covers at one pose: rendered depth, then coverage, as dense SIMD-friendly planes.
#pragma once

#include "depth_object_tracker/geometry/aligned_vector.h"

#include <cstdint>
#include <vector>

namespace depth_object_tracker {

constexpr int kTileSize = 8;  ///< planes are cut into blocks of 8x8 cells that are aligned with the image
constexpr int kTileCells = kTileSize * kTileSize;

/// Rectangle of grid cells, upper ends exclusive.
struct CellBox {
  int row_begin = 0, row_end = 0, col_begin = 0, col_end = 0;
  bool empty() const { return row_begin >= row_end || col_begin >= col_end; }
  bool contains(const CellBox& other) const;
  int rows() const { return row_end - row_begin; }
  int cols() const { return col_end - col_begin; }
};

/// Smallest box that holds both; an empty box does not count.
CellBox unite(const CellBox& a, const CellBox& b);
CellBox intersect(const CellBox& a, const CellBox& b);

/// Planes over a box of whole tiles. Cell (row, col) of the image is element (row - row_begin) * stride + col -
/// col_begin of every plane; each row has kPad further cells on either side, so that neighbours can be read. Reuses its
/// memory.
class DepthTile {
 public:
  static constexpr int kPad = 8;

  /// Empties the tile. @param box cells of interest; grown to whole tiles. @param image bounds `rows` and `cols`.
  void clear(const CellBox& box, const CellBox& image);

  int row_begin = 0, col_begin = 0;  ///< multiples of kTileSize
  int rows = 0, cols = 0;            ///< cells inside of the image
  int tile_rows = 0, tile_cols = 0;  ///< tiles of kTileSize x kTileSize cells
  int stride = 0;                    ///< cells from row to row

  /// Elements from a plane's beginning to the row's first cell. @param row counted from row_begin.
  std::ptrdiff_t rowOffset(int row) const { return static_cast<std::ptrdiff_t>(row) * stride; }

  float* depth() { return plane(depth_); }  ///< [m], infinity where nothing was drawn
  const float* depth() const { return plane(depth_); }
  std::int32_t* face() { return face_.data() + kPad; }  ///< id of the face drawn, where depth is finite
  const std::int32_t* face() const { return face_.data() + kPad; }
  float* softDepth() { return plane(soft_depth_); }  ///< [m] the same with the outline's surroundings
  const float* softDepth() const { return plane(soft_depth_); }
  float* coverage() { return plane(coverage_); }  ///< [0, 1]
  const float* coverage() const { return plane(coverage_); }
  float* distance() { return plane(distance_); }  ///< [px] to the outline, positive inside
  const float* distance() const { return plane(distance_); }
  float* dilated() { return plane(dilated_); }  ///< scratch of the outline
  float* eroded() { return plane(eroded_); }

  /// One flag a tile, row-major: not 0 where any cell has coverage. Cells of other tiles are not to be read.
  std::vector<std::uint8_t> touched;

 private:
  void reserve(std::size_t cells, std::size_t tiles);
  static float* plane(AlignedVector<float>& values) { return values.data() + kPad; }
  static const float* plane(const AlignedVector<float>& values) { return values.data() + kPad; }

  AlignedVector<float> depth_, soft_depth_, coverage_, distance_, dilated_, eroded_;
  AlignedVector<std::int32_t> face_;
};

}  // namespace depth_object_tracker
