// SPDX-License-Identifier: BSD-3-Clause
#include "depth_object_tracker/render/depth_tile.h"

#include <algorithm>
#include <limits>

namespace depth_object_tracker {

bool CellBox::contains(const CellBox& other) const {
  return other.empty() || (row_begin <= other.row_begin && other.row_end <= row_end && col_begin <= other.col_begin &&
                           other.col_end <= col_end);
}

CellBox unite(const CellBox& a, const CellBox& b) {
  if (a.empty()) return b;
  if (b.empty()) return a;
  return {std::min(a.row_begin, b.row_begin), std::max(a.row_end, b.row_end), std::min(a.col_begin, b.col_begin),
          std::max(a.col_end, b.col_end)};
}

CellBox intersect(const CellBox& a, const CellBox& b) {
  return {std::max(a.row_begin, b.row_begin), std::min(a.row_end, b.row_end), std::max(a.col_begin, b.col_begin),
          std::min(a.col_end, b.col_end)};
}

void DepthTile::clear(const CellBox& box, const CellBox& image) {
  const CellBox inside = intersect(box, image);
  const bool empty = inside.empty();
  row_begin = empty ? 0 : inside.row_begin / kTileSize * kTileSize;
  col_begin = empty ? 0 : inside.col_begin / kTileSize * kTileSize;
  tile_rows = empty ? 0 : (inside.row_end - row_begin + kTileSize - 1) / kTileSize;
  tile_cols = empty ? 0 : (inside.col_end - col_begin + kTileSize - 1) / kTileSize;
  rows = std::min(tile_rows * kTileSize, image.row_end - row_begin);
  cols = std::min(tile_cols * kTileSize, image.col_end - col_begin);
  stride = tile_cols * kTileSize + 2 * kPad;
  const auto cells = static_cast<std::size_t>(rowOffset(tile_rows * kTileSize));
  const auto tiles = static_cast<std::size_t>(tile_rows) * static_cast<std::size_t>(tile_cols);
  if (depth_.size() < cells + kPad || touched.capacity() < tiles) reserve(4 * (cells + kPad), 4 * tiles);
  std::fill_n(depth_.begin(), cells + kPad, std::numeric_limits<float>::infinity());
  touched.assign(tiles, 0);
}

/// Four times what is needed now: an object that comes a little nearer shall not make a frame ask the heap.
void DepthTile::reserve(std::size_t cells, std::size_t tiles) {
  for (auto* values : {&depth_, &soft_depth_, &coverage_, &distance_, &dilated_, &eroded_}) values->resize(cells);
  face_.resize(cells);
  touched.reserve(tiles);
}

}  // namespace depth_object_tracker
