// SPDX-License-Identifier: BSD-3-Clause
#include "depth_object_tracker/render/face_set.h"

#include "depth_object_tracker/geometry/mesh_orientation.h"

#include <Eigen/Geometry>

#include <limits>

namespace depth_object_tracker {
namespace {

std::size_t roundUp(std::size_t count) {
  return (count + FaceSet::kPadding - 1) / FaceSet::kPadding * FaceSet::kPadding;
}

template <typename Function>
void forEachArray(FaceSet& faces, const Function& function) {
  for (auto* corner : {&faces.ax, &faces.bx, &faces.cx, &faces.normal}) {
    for (auto& array : *corner) function(array);
  }
  function(faces.offset);
  function(faces.id);
}

void resize(FaceSet& faces, std::size_t count) {
  faces.count = count;
  faces.padded = roundUp(count);
  forEachArray(faces, [&](auto& array) { array.resize(faces.padded, 0); });
}

/// Padding: a point at the object's origin projects to no area wherever the object is.
void clearPadding(FaceSet& faces) {
  forEachArray(faces, [&](auto& array) {
    for (std::size_t i = faces.count; i < faces.padded; ++i) array[i] = 0;
  });
}

}  // namespace

FaceSet makeFaceSet(const TriangleMesh& mesh) {
  FaceSet faces;
  auto triangles = mesh.triangles;
  faces.faces_outward = orientOutward(mesh, triangles);
  resize(faces, triangles.size());
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    const auto& [a, b, c] = triangles[i];
    const Eigen::Vector3f& pa = mesh.vertices[a];
    Eigen::Vector3f pb = mesh.vertices[b], pc = mesh.vertices[c];
    Eigen::Vector3d normal = (pb - pa).cast<double>().cross((pc - pa).cast<double>());
    if (normal.norm() > 0.0) {
      normal.normalize();
    } else {
      pb = pc = pa;  // covers nothing, but keeps its index
    }
    for (int axis = 0; axis < 3; ++axis) {
      const auto k = static_cast<std::size_t>(axis);
      faces.ax[k][i] = pa[axis];
      faces.bx[k][i] = pb[axis];
      faces.cx[k][i] = pc[axis];
      faces.normal[k][i] = static_cast<float>(normal[axis]);
    }
    // The centroid's offset: no corner is favoured by rounding.
    faces.offset[i] = static_cast<float>(normal.dot((pa + pb + pc).cast<double>()) / 3.0);
    faces.id[i] = static_cast<std::int32_t>(i);
  }
  clearPadding(faces);
  return faces;
}

void selectFacing(const FaceSet& all, const Eigen::Vector3f& eye_object, float radius_m, FaceSet& visible) {
  visible.faces_outward = all.faces_outward;
  if (visible.capacity() < all.padded) resize(visible, all.padded);
  // A surface seen at no angle at all may still touch a pixel through rounding.
  const float least = all.faces_outward ? -radius_m - 1e-4f : -std::numeric_limits<float>::infinity();
  std::size_t count = 0;
  for (std::size_t i = 0; i < all.count; ++i) {
    // Written before it is known whether the face stays: no branch.
    const float height = all.normal[0][i] * eye_object.x() + all.normal[1][i] * eye_object.y() +
                         all.normal[2][i] * eye_object.z() - all.offset[i];
    for (std::size_t k = 0; k < 3; ++k) {
      visible.ax[k][count] = all.ax[k][i];
      visible.bx[k][count] = all.bx[k][i];
      visible.cx[k][count] = all.cx[k][i];
      visible.normal[k][count] = all.normal[k][i];
    }
    visible.offset[count] = all.offset[i];
    visible.id[count] = all.id[i];
    count += height > least ? 1 : 0;
  }
  visible.count = count;
  visible.padded = roundUp(count);
  clearPadding(visible);
}

}  // namespace depth_object_tracker
