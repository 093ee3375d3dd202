// SPDX-License-Identifier: BSD-3-Clause
// The rasteriser in three stages: faces are projected many at a time; those that cover a few pixels are filled many at
// a time, every lane walking over its own face's bounding box; larger ones row by row. No fused multiply-add anywhere
// and exact integers for coverage: the same bytes as the reference.
#include "depth_object_tracker/render/tile_rasterizer.h"

#include "render/raster_face.h"
#include "simd/pack_table.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/tile_rasterizer_simd.cpp"
#include "simd/foreach_target.h"

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace depth_object_tracker::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Floats = hn::ScalableTag<float>;
using Ints = hn::RebindToSigned<Floats>;
using F = hn::Vec<Floats>;
using I = hn::Vec<Ints>;

constexpr std::size_t kLanes = hn::MaxLanes(Floats());
// Lanes walk together, as long as the face with the largest bounding box takes: faces are sorted by its size. Those
// with more cells, or a longer side (also for the range of 32-bit edge functions), are filled row by row.
constexpr int kMostCells[RasterScratch::kSizes] = {2, 6, 24, 300};
constexpr int kLongestSide = 32;

/// Camera coordinates and snapped pixel coordinates of one corner of every lane's face.
struct Corner {
  F depth;
  I x, y;
};

HWY_INLINE F affine(const float (&m)[4], F px, F py, F pz) {
  const Floats d;
  const F xy = hn::Add(hn::Mul(hn::Set(d, m[0]), px), hn::Mul(hn::Set(d, m[1]), py));
  return hn::Add(hn::Add(xy, hn::Mul(hn::Set(d, m[2]), pz)), hn::Set(d, m[3]));
}

HWY_INLINE F dot(const float (&m)[3], F nx, F ny, F nz) {
  const Floats d;
  const F xy = hn::Add(hn::Mul(nx, hn::Set(d, m[0])), hn::Mul(ny, hn::Set(d, m[1])));
  return hn::Add(xy, hn::Mul(nz, hn::Set(d, m[2])));
}

HWY_INLINE Corner project(const std::array<AlignedVector<float>, 3>& points, std::size_t i,
                          const RasterTransform& transform) {
  const Floats d;
  const F px = hn::Load(d, &points[0][i]), py = hn::Load(d, &points[1][i]), pz = hn::Load(d, &points[2][i]);
  Corner corner;
  corner.depth = affine(transform.z, px, py, pz);
  const F inverse = hn::Div(hn::Set(d, 1.0f), corner.depth);
  const F limit = hn::Set(d, kMaxSubpixel);
  const auto snap = [&](F value) { return hn::NearestInt(hn::Min(hn::Max(value, hn::Neg(limit)), limit)); };
  corner.x = snap(hn::Mul(affine(transform.u, px, py, pz), inverse));
  corner.y = snap(hn::Mul(affine(transform.v, px, py, pz), inverse));
  return corner;
}

HWY_INLINE auto notNegative(I value) {
  return hn::Gt(value, hn::Set(Ints(), -1));
}

HWY_INLINE I firstPixel(I subpixels) {
  return hn::ShiftRight<RasterTransform::kSubpixelBits>(hn::Add(subpixels, hn::Set(Ints(), kSubpixels - 1)));
}
HWY_INLINE I lastPixel(I subpixels) {
  return hn::ShiftRight<RasterTransform::kSubpixelBits>(subpixels);
}
template <typename V>
HWY_INLINE V min3(V a, V b, V c) {
  return hn::Min(hn::Min(a, b), c);
}
template <typename V>
HWY_INLINE V max3(V a, V b, V c) {
  return hn::Max(hn::Max(a, b), c);
}

/// Packs the lanes of `mask` and writes whole vectors: masked stores are slow on some processors.
template <class D, class V, class M>
HWY_INLINE void packTo(D d, V value, M mask, hn::TFromD<D>* to) {
#if HWY_TARGET == HWY_AVX2
  std::uint8_t bits = 0;
  hn::StoreMaskBits(d, mask, &bits);
  hn::StoreU(hn::TableLookupLanes(value, hn::SetTableIndices(d, kPackTable[bits].data())), d, to);
#else
  hn::StoreU(hn::Compress(value, mask), d, to);
#endif
}

/// Some lanes' faces.
struct ProjectedFaces {
  I corner[6];
  F plane[6];
  I id;
};

HWY_INLINE void append(const ProjectedFaces& faces, hn::Mask<Ints> mask, PendingFaces& pending) {
  const Floats d;
  const Ints di;
  if (hn::AllFalse(di, mask)) return;
  const auto float_mask = hn::RebindMask(d, mask);
  for (int k = 0; k < 6; ++k) packTo(di, faces.corner[k], mask, &pending.corner[k][pending.count]);
  for (int k = 0; k < 6; ++k) packTo(d, faces.plane[k], float_mask, &pending.plane[k][pending.count]);
  packTo(di, faces.id, mask, &pending.id[pending.count]);
  pending.count += hn::CountTrue(di, mask);
}

/// First stage: faces that may cover a pixel centre of the tile, sorted by size.
void selectFaces(const FaceSet& faces, const RasterTransform& transform, const DepthTile& tile,
                 RasterScratch& scratch) {
  const Floats d;
  const Ints di;
  const I zero = hn::Zero(di), one = hn::Set(di, 1);
  const I last_col = hn::Set(di, tile.cols - 1), last_row = hn::Set(di, tile.rows - 1);
  for (PendingFaces& pending : scratch.pending) pending.count = 0;
  scratch.num_large = 0;
  for (std::size_t i = 0; i < faces.padded; i += kLanes) {
    const F nx = hn::Load(d, &faces.normal[0][i]), ny = hn::Load(d, &faces.normal[1][i]),
            nz = hn::Load(d, &faces.normal[2][i]);
    const F numerator = hn::Sub(hn::Load(d, &faces.offset[i]), dot(transform.eye, nx, ny, nz));
    const Corner a = project(faces.ax, i, transform), b = project(faces.bx, i, transform),
                 c = project(faces.cx, i, transform);
    const I low_x = min3(a.x, b.x, c.x), high_x = max3(a.x, b.x, c.x);
    const I low_y = min3(a.y, b.y, c.y), high_y = max3(a.y, b.y, c.y);
    const I col_span = hn::Sub(hn::Min(lastPixel(high_x), last_col), hn::Max(firstPixel(low_x), zero));
    const I row_span = hn::Sub(hn::Min(lastPixel(high_y), last_row), hn::Max(firstPixel(low_y), zero));
    // Negative where the box holds no pixel centre.
    auto alive = notNegative(hn::Min(col_span, row_span));
    if (faces.faces_outward) alive = hn::And(alive, hn::RebindMask(di, hn::Lt(numerator, hn::Zero(d))));
    if (hn::AllFalse(di, alive)) continue;
    const I longest = hn::Set(di, kLongestSide * kSubpixels);
    const auto is_short = hn::Lt(hn::Max(hn::Sub(high_x, low_x), hn::Sub(high_y, low_y)), longest);
    const I cells = hn::Mul(hn::Add(col_span, one), hn::Add(row_span, one));
    const auto small = hn::And(is_short, hn::Lt(cells, hn::Set(di, kMostCells[RasterScratch::kSizes - 1] + 1)));
    const auto large = hn::AndNot(small, alive);
    if (!hn::AllFalse(di, large)) {
      packTo(di, hn::Iota(di, static_cast<std::int32_t>(i)), large, &scratch.large[scratch.num_large]);
      scratch.num_large += hn::CountTrue(di, large);
    }
    // Twice the signed area; exact for small faces. Counter-clockwise from outside is negative in an image whose y axis
    // points down.
    const I area =
        hn::Sub(hn::Mul(hn::Sub(b.x, a.x), hn::Sub(c.y, a.y)), hn::Mul(hn::Sub(b.y, a.y), hn::Sub(c.x, a.x)));
    const auto turned = hn::Gt(area, zero);
    const auto has_area = faces.faces_outward ? hn::Lt(area, zero) : hn::Ne(area, zero);
    const auto fill = hn::And(hn::And(alive, small), has_area);
    if (hn::AllFalse(di, fill)) continue;
    const ProjectedFaces projected = {
        {a.x, a.y, hn::IfThenElse(turned, c.x, b.x), hn::IfThenElse(turned, c.y, b.y), hn::IfThenElse(turned, b.x, c.x),
         hn::IfThenElse(turned, b.y, c.y)},
        {numerator, dot(transform.by_col, nx, ny, nz), dot(transform.by_row, nx, ny, nz),
         dot(transform.at_origin, nx, ny, nz), min3(a.depth, b.depth, c.depth), max3(a.depth, b.depth, c.depth)},
        hn::Load(di, &faces.id[i])};
    auto left = fill;
    for (std::size_t size = 0; size < RasterScratch::kSizes; ++size) {
      const auto fits = hn::And(left, hn::Lt(cells, hn::Set(di, kMostCells[size] + 1)));
      append(projected, fits, scratch.pending[size]);
      left = hn::AndNot(fits, left);
    }
  }
}

template <bool kWithFaces>
void flushHits(std::size_t count, DepthTile& tile, const RasterScratch& scratch) {
  float* depth = tile.depth();
  std::int32_t* face = tile.face();
  for (std::size_t k = 0; k < count; ++k) {
    const std::int32_t cell = scratch.hit_cell[k];
    const float value = scratch.hit_depth[k], old = depth[cell];
    const bool nearer = value < old;
    depth[cell] = nearer ? value : old;
    if (kWithFaces) face[cell] = nearer ? scratch.hit_id[k] : face[cell];
  }
}

struct LaneEdge {
  I value, step_x, step_y;
};

/// At the centre of cell (col, row).
HWY_INLINE LaneEdge makeEdge(I xa, I ya, I xb, I yb, I col, I row) {
  const Ints di;
  const I dx = hn::Sub(xb, xa), dy = hn::Sub(yb, ya), zero = hn::Zero(di);
  const auto owns_line = hn::Or(hn::Gt(dy, zero), hn::And(hn::Eq(dy, zero), hn::Lt(dx, zero)));
  const I x = hn::Sub(hn::ShiftLeft<RasterTransform::kSubpixelBits>(col), xa);
  const I y = hn::Sub(hn::ShiftLeft<RasterTransform::kSubpixelBits>(row), ya);
  const I value = hn::Sub(hn::Mul(dy, x), hn::Mul(dx, y));
  return {hn::Add(value, hn::IfThenZeroElse(owns_line, hn::Set(di, -1))),
          hn::ShiftLeft<RasterTransform::kSubpixelBits>(dy),
          hn::Neg(hn::ShiftLeft<RasterTransform::kSubpixelBits>(dx))};
}

/// Second stage: every lane walks over the bounding box of its own face.
template <bool kWithFaces>
void fillSmall(const PendingFaces& faces, DepthTile& tile, RasterScratch& scratch) {
  const Floats d;
  const Ints di;
  const I zero = hn::Zero(di), one = hn::Set(di, 1), stride = hn::Set(di, tile.stride);
  const I last_col = hn::Set(di, tile.cols - 1), last_row = hn::Set(di, tile.rows - 1);
  const std::size_t num_faces = faces.count;
  std::size_t hits = 0;
  for (std::size_t i = 0; i < num_faces; i += kLanes) {
    const auto corner = [&](int k) { return hn::Load(di, &faces.corner[k][i]); };
    const I xa = corner(0), ya = corner(1), xb = corner(2), yb = corner(3), xc = corner(4), yc = corner(5);
    const I col0 = hn::Max(firstPixel(min3(xa, xb, xc)), zero), row0 = hn::Max(firstPixel(min3(ya, yb, yc)), zero);
    const I present = hn::Sub(hn::Set(di, static_cast<std::int32_t>(num_faces - i - 1)), hn::Iota(di, 0));
    const auto here = notNegative(present);
    const I nothing = hn::Set(di, -1);
    const I width = hn::IfThenElse(here, hn::Sub(hn::Min(lastPixel(max3(xa, xb, xc)), last_col), col0), nothing);
    const I height = hn::IfThenElse(here, hn::Sub(hn::Min(lastPixel(max3(ya, yb, yc)), last_row), row0), nothing);
    LaneEdge ab = makeEdge(xa, ya, xb, yb, col0, row0), bc = makeEdge(xb, yb, xc, yc, col0, row0),
             ca = makeEdge(xc, yc, xa, ya, col0, row0);
    const auto plane = [&](int k) { return hn::Load(d, &faces.plane[k][i]); };
    const F numerator = plane(0), by_col = plane(1), by_row = plane(2), at_origin = plane(3), least = plane(4),
            largest = plane(5);
    const I id = kWithFaces ? hn::Load(di, &faces.id[i]) : zero;
    // Cells left in this row and rows left: negative beyond the lane's own box.
    I rows_left = height, row = row0;
    while (!hn::AllFalse(di, notNegative(rows_left))) {
      I at_ab = ab.value, at_bc = bc.value, at_ca = ca.value, cols_left = width, col = col0;
      const F row_part = hn::Add(at_origin, hn::Mul(hn::ConvertTo(d, row), by_row));
      const I row_cell = hn::Mul(row, stride);
      while (!hn::AllFalse(di, notNegative(hn::Or(cols_left, rows_left)))) {
        const I outside = hn::Or(hn::Or(hn::Or(at_ab, at_bc), at_ca), hn::Or(cols_left, rows_left));
        const auto inside = notNegative(outside);
        if (!hn::AllFalse(di, inside)) {
          const F slope = hn::Add(row_part, hn::Mul(hn::ConvertTo(d, col), by_col));
          const F depth = hn::Min(hn::Max(hn::Div(numerator, slope), least), largest);
          packTo(d, depth, hn::RebindMask(d, inside), &scratch.hit_depth[hits]);
          if (kWithFaces) packTo(di, id, inside, &scratch.hit_id[hits]);
          packTo(di, hn::Add(row_cell, col), inside, &scratch.hit_cell[hits]);
          hits += hn::CountTrue(di, inside);
          if (hits >= RasterScratch::kHitCapacity) {
            flushHits<kWithFaces>(hits, tile, scratch);
            hits = 0;
          }
        }
        at_ab = hn::Add(at_ab, ab.step_x);
        at_bc = hn::Add(at_bc, bc.step_x);
        at_ca = hn::Add(at_ca, ca.step_x);
        cols_left = hn::Sub(cols_left, one);
        col = hn::Add(col, one);
      }
      ab.value = hn::Add(ab.value, ab.step_y);
      bc.value = hn::Add(bc.value, bc.step_y);
      ca.value = hn::Add(ca.value, ca.step_y);
      rows_left = hn::Sub(rows_left, one);
      row = hn::Add(row, one);
    }
  }
  flushHits<kWithFaces>(hits, tile, scratch);
}

template <bool kWithFaces>
HWY_INLINE void fillSpan(const RasterFace& face, std::int32_t id, int row, int first, int last, DepthTile& tile) {
  const hn::CappedTag<float, 8> d;
  const hn::RebindToSigned<decltype(d)> di;
  const int lanes = static_cast<int>(hn::MaxLanes(d));
  float* depth = tile.depth() + tile.rowOffset(row);
  std::int32_t* ids = tile.face() + tile.rowOffset(row);
  const auto row_part = hn::Set(d, face.at_origin + static_cast<float>(row) * face.by_row);
  const auto by_col = hn::Set(d, face.by_col), numerator = hn::Set(d, face.numerator);
  const auto least = hn::Set(d, face.least_depth), largest = hn::Set(d, face.largest_depth);
  for (int col = first; col <= last; col += lanes) {
    const auto cols = hn::Iota(di, col);
    const auto slope = hn::Add(row_part, hn::Mul(hn::ConvertTo(d, cols), by_col));
    const auto value = hn::Min(hn::Max(hn::Div(numerator, slope), least), largest);
    const auto old = hn::LoadU(d, depth + col);
    const auto nearer = hn::And(hn::Lt(value, old), hn::RebindMask(d, hn::Lt(cols, hn::Set(di, last + 1))));
    hn::StoreU(hn::IfThenElse(nearer, value, old), d, depth + col);
    if (kWithFaces) {
      const auto old_ids = hn::LoadU(di, ids + col);
      hn::StoreU(hn::IfThenElse(hn::RebindMask(di, nearer), hn::Set(di, id), old_ids), di, ids + col);
    }
  }
}

/// Third stage: faces with more than a few pixels.
template <bool kWithFaces>
void fillLarge(const FaceSet& faces, const RasterTransform& transform, DepthTile& tile, const RasterScratch& scratch) {
  for (std::size_t k = 0; k < scratch.num_large; ++k) {
    const auto i = static_cast<std::size_t>(scratch.large[k]);
    if (i >= faces.count) continue;
    const RasterFace face = makeRasterFace(faces, i, transform, tile);
    for (int row = face.first_row; row <= face.last_row; ++row) {
      int first, last;
      face.span(row, first, last);
      fillSpan<kWithFaces>(face, faces.id[i], row, first, last, tile);
    }
  }
}

void rasterizeFaces(const FaceSet& faces, const RasterTransform& transform, bool with_faces, DepthTile& tile,
                    RasterScratch& scratch) {
  scratch.reserve(faces.padded);
  selectFaces(faces, transform, tile, scratch);
  if (with_faces) {
    for (const PendingFaces& pending : scratch.pending) fillSmall<true>(pending, tile, scratch);
    fillLarge<true>(faces, transform, tile, scratch);
  } else {
    for (const PendingFaces& pending : scratch.pending) fillSmall<false>(pending, tile, scratch);
    fillLarge<false>(faces, transform, tile, scratch);
  }
}

}  // namespace depth_object_tracker::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace depth_object_tracker {

HWY_EXPORT(rasterizeFaces);

void rasterizeSimd(const FaceSet& faces, const RasterTransform& transform, bool with_faces, DepthTile& tile,
                   RasterScratch& scratch) {
  HWY_DYNAMIC_DISPATCH(rasterizeFaces)(faces, transform, with_faces, tile, scratch);
}

}  // namespace depth_object_tracker
#endif  // HWY_ONCE
