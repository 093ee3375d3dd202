// SPDX-License-Identifier: BSD-3-Clause
// Triangles as the fast renderer wants them: a structure of arrays, corners written out, nothing indexed.
#pragma once

#include "depth_object_tracker/geometry/aligned_vector.h"
#include "depth_object_tracker/geometry/triangle_mesh.h"

#include <array>
#include <cstdint>

namespace depth_object_tracker {

/// Arrays are padded with points that cover nothing, so that SIMD may read `padded` elements of each.
struct FaceSet {
  static constexpr std::size_t kPadding = 16;

  std::size_t count = 0;
  std::size_t padded = 0;                          ///< `count` rounded up to a multiple of kPadding
  bool faces_outward = false;                      ///< closed surface, counter-clockwise seen from outside
  std::array<AlignedVector<float>, 3> ax, bx, cx;  ///< x, y, z of the three corners [m], object frame
  std::array<AlignedVector<float>, 3> normal;      ///< unit, object frame
  AlignedVector<float> offset;                     ///< normal . corner [m]
  AlignedVector<std::int32_t> id;                  ///< index of the face in the set that it was taken from

  std::size_t capacity() const { return id.size(); }
};

/// All triangles of a mesh, in its order; those without area cover nothing. @param mesh indices must be valid.
FaceSet makeFaceSet(const TriangleMesh& mesh);

/// The faces that can be seen from somewhere within `radius_m` of a point; all of them when the surface has no outside.
/// @param eye_object [m] object frame. @param[out] visible reuses its memory; ids refer to `all`.
void selectFacing(const FaceSet& all, const Eigen::Vector3f& eye_object, float radius_m, FaceSet& visible);

}  // namespace depth_object_tracker
