// SPDX-License-Identifier: BSD-3-Clause
#include "depth_object_tracker/geometry/pinhole_camera.h"

#include <algorithm>
#include <cmath>
#include <sstream>

namespace depth_object_tracker {
namespace {

int gridSize(int full_size, int factor) {
  const int offset = factor / 2;
  return full_size > offset ? (full_size - offset - 1) / factor + 1 : 0;
}

}  // namespace

std::string PinholeCamera::findProblem() const {
  std::ostringstream problem;
  const auto focal_ok = [](double f) { return std::isfinite(f) && f > 0.0; };
  if (width <= 0 || height <= 0) {
    problem << "camera image size is " << width << "x" << height << "; both must be positive";
  } else if (!focal_ok(fx) || !focal_ok(fy)) {
    problem << "camera focal lengths are fx=" << fx << ", fy=" << fy
            << "; both must be finite and positive (0 means that the camera is not calibrated)";
  } else if (!std::isfinite(cx) || !std::isfinite(cy)) {
    problem << "camera principal point is (" << cx << ", " << cy << "); both must be finite";
  }
  return problem.str();
}

bool operator==(const PinholeCamera& a, const PinholeCamera& b) {
  return a.width == b.width && a.height == b.height && a.fx == b.fx && a.fy == b.fy && a.cx == b.cx && a.cy == b.cy;
}

SamplingGrid makeSamplingGrid(const PinholeCamera& full, int factor) {
  SamplingGrid grid;
  grid.full = full;
  grid.factor = std::max(1, factor);
  const double offset = grid.offset();
  grid.camera.width = gridSize(full.width, grid.factor);
  grid.camera.height = gridSize(full.height, grid.factor);
  grid.camera.fx = full.fx / grid.factor;
  grid.camera.fy = full.fy / grid.factor;
  grid.camera.cx = (full.cx - offset) / grid.factor;
  grid.camera.cy = (full.cy - offset) / grid.factor;
  return grid;
}

}  // namespace depth_object_tracker
