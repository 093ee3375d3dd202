// SPDX-License-Identifier: BSD-3-Clause
// One face in fixed point: what the scalar rasteriser and the large faces of the SIMD one share.
#pragma once

#include "depth_object_tracker/render/tile_rasterizer.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace depth_object_tracker {

constexpr int kSubpixels = 1 << RasterTransform::kSubpixelBits;
// Keeps coordinates of what lies far outside of the image within integer range.
constexpr float kMaxSubpixel = 67108864.0f;  // 2^26

/// E(x, y) = step_x x + step_y y + at_origin >= 0 for pixel centres on the inside of an edge.
struct RasterEdge {
  std::int64_t step_x, step_y, at_origin;
};

inline RasterEdge makeRasterEdge(std::int64_t xa, std::int64_t ya, std::int64_t xb, std::int64_t yb) {
  const std::int64_t dx = xb - xa, dy = yb - ya;
  // Of the two faces at an edge, which run along it in opposite directions, one owns the centres that lie on it.
  const bool owns_line = dy > 0 || (dy == 0 && dx < 0);
  return {dy * kSubpixels, -dx * kSubpixels, dx * ya - dy * xa - (owns_line ? 0 : 1)};
}

inline std::int64_t floorDivide(std::int64_t a, std::int64_t positive) {
  return a >= 0 ? a / positive : -((-a + positive - 1) / positive);
}

/// A face ready to be filled; invisible when `first_row > last_row`.
struct RasterFace {
  RasterEdge edges[3];
  int first_row = 0, last_row = -1, first_col = 0, last_col = -1;
  float numerator, by_col, by_row, at_origin, least_depth, largest_depth;

  /// Columns [first, last] whose centres lie inside of the face in a row.
  void span(int row, int& first, int& last) const {
    std::int64_t low = first_col, high = last_col;
    for (const RasterEdge& edge : edges) {
      const std::int64_t at = edge.at_origin + edge.step_y * row;
      if (edge.step_x > 0) {
        low = std::max(low, -floorDivide(at, edge.step_x));  // x >= -at / step
      } else if (edge.step_x < 0) {
        high = std::min(high, floorDivide(at, -edge.step_x));
      } else if (at < 0) {
        high = low - 1;
      }
    }
    first = static_cast<int>(low);
    last = static_cast<int>(high);
  }

  float depth(int row, int col) const {
    const float slope = (at_origin + static_cast<float>(row) * by_row) + static_cast<float>(col) * by_col;
    // Snapping moves an edge by a fraction of a pixel: a face seen edge-on must not reach beyond its corners. Written
    // so that not-a-number becomes least_depth, as the SIMD instructions have it.
    const float value = numerator / slope;
    const float above = value > least_depth ? value : least_depth;
    return above < largest_depth ? above : largest_depth;
  }
};

inline RasterFace makeRasterFace(const FaceSet& faces, std::size_t i, const RasterTransform& transform,
                                 const DepthTile& tile) {
  RasterFace face;
  const float nx = faces.normal[0][i], ny = faces.normal[1][i], nz = faces.normal[2][i];
  face.numerator = faces.offset[i] - ((nx * transform.eye[0] + ny * transform.eye[1]) + nz * transform.eye[2]);
  if (faces.faces_outward && !(face.numerator < 0.0f)) return face;
  std::int32_t x[3], y[3];
  float z[3];
  const std::array<AlignedVector<float>, 3>* corners[3] = {&faces.ax, &faces.bx, &faces.cx};
  for (int k = 0; k < 3; ++k) {
    const float px = (*corners[k])[0][i], py = (*corners[k])[1][i], pz = (*corners[k])[2][i];
    const auto row = [&](const float(&m)[4]) { return ((m[0] * px + m[1] * py) + m[2] * pz) + m[3]; };
    z[k] = row(transform.z);
    const float inverse = 1.0f / z[k];
    const auto snap = [](float value) {
      return static_cast<std::int32_t>(std::lrintf(std::min(std::max(value, -kMaxSubpixel), kMaxSubpixel)));
    };
    x[k] = snap(row(transform.u) * inverse);
    y[k] = snap(row(transform.v) * inverse);
  }
  const std::int64_t area =
      static_cast<std::int64_t>(x[1] - x[0]) * (y[2] - y[0]) - static_cast<std::int64_t>(y[1] - y[0]) * (x[2] - x[0]);
  if (area == 0 || (faces.faces_outward && area > 0)) return face;
  // Counter-clockwise from outside is a negative area in an image whose y axis points down.
  const int b = area < 0 ? 1 : 2, c = 3 - b;
  face.edges[0] = makeRasterEdge(x[0], y[0], x[b], y[b]);
  face.edges[1] = makeRasterEdge(x[b], y[b], x[c], y[c]);
  face.edges[2] = makeRasterEdge(x[c], y[c], x[0], y[0]);
  const auto first_pixel = [](std::int32_t value) {
    return (value + kSubpixels - 1) >> RasterTransform::kSubpixelBits;
  };
  const auto last_pixel = [](std::int32_t value) { return value >> RasterTransform::kSubpixelBits; };
  face.first_col = std::max(first_pixel(std::min({x[0], x[1], x[2]})), 0);
  face.last_col = std::min(last_pixel(std::max({x[0], x[1], x[2]})), tile.cols - 1);
  face.first_row = std::max(first_pixel(std::min({y[0], y[1], y[2]})), 0);
  face.last_row = std::min(last_pixel(std::max({y[0], y[1], y[2]})), tile.rows - 1);
  const auto dot = [&](const float(&m)[3]) { return (nx * m[0] + ny * m[1]) + nz * m[2]; };
  face.by_col = dot(transform.by_col);
  face.by_row = dot(transform.by_row);
  face.at_origin = dot(transform.at_origin);
  face.least_depth = std::min(std::min(z[0], z[1]), z[2]);
  face.largest_depth = std::max(std::max(z[0], z[1]), z[2]);
  return face;
}

}  // namespace depth_object_tracker
