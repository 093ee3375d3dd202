// SPDX-License-Identifier: BSD-3-Clause
// Pinhole camera: intrinsics, projection, and sub-sampled versions that see exactly the same beams.
#pragma once

#include <Eigen/Core>

#include <string>

namespace depth_object_tracker {

/// Intrinsics in pixels; integer coordinates are pixel centres: u = fx x/z + cx, v = fy y/z + cy.
struct PinholeCamera {
  int width = 0;
  int height = 0;
  double fx = 0.0;
  double fy = 0.0;
  double cx = 0.0;
  double cy = 0.0;

  /// Point on the beam of pixel coordinates (u, v) at unit depth (z = 1), optical frame.
  Eigen::Vector3d ray(double u, double v) const { return {(u - cx) / fx, (v - cy) / fy, 1.0}; }

  /// Pixel coordinates of a point in the optical frame; p_camera.z() must not be 0.
  Eigen::Vector2d project(const Eigen::Vector3d& p_camera) const {
    return {fx * p_camera.x() / p_camera.z() + cx, fy * p_camera.y() / p_camera.z() + cy};
  }

  /// Empty when usable; otherwise a sentence that names the field, its value and the valid range.
  std::string findProblem() const;
};

bool operator==(const PinholeCamera& a, const PinholeCamera& b);
inline bool operator!=(const PinholeCamera& a, const PinholeCamera& b) {
  return !(a == b);
}

/// Nearest-neighbour sub-sampling by an integer factor: cell (row, col) is the beam of the full-resolution pixel
/// (offset + factor * row, offset + factor * col) with offset = factor / 2 (integer division). No pixel is averaged, so
/// beams and principal point stay exact for even and odd factors alike.
struct SamplingGrid {
  PinholeCamera full;    ///< camera of the input image
  PinholeCamera camera;  ///< camera of the grid: same beams, fewer of them
  int factor = 1;        ///< >= 1

  int offset() const { return factor / 2; }
  int fullRow(int row) const { return offset() + factor * row; }
  int fullCol(int col) const { return offset() + factor * col; }
};

/// @param factor >= 1; cells whose full-resolution pixel lies outside of the image do not exist.
SamplingGrid makeSamplingGrid(const PinholeCamera& full, int factor);

}  // namespace depth_object_tracker
