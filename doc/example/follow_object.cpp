// SPDX-License-Identifier: BSD-3-Clause
// Tracks an object in depth images that are rendered here: all that a program needs of the library.
#include <depth_object_tracker/geometry/mesh_loader.h>
#include <depth_object_tracker/render/depth_renderer.h>
#include <depth_object_tracker/tracker/object_tracker.h>

#include <cstdio>
#include <vector>

namespace dot = depth_object_tracker;

int main(int argc, char** argv) {
  if (argc != 2) return std::fprintf(stderr, "usage: %s MESH\n", argv[0]), 2;
  const dot::PinholeCamera camera{640, 480, 525.0, 525.0, 319.5, 239.5};  // width, height, fx, fy, cx, cy
  dot::ObjectModel object;
  object.mesh = dot::loadMesh(argv[1]);  // metres; throws dot::MeshError
  dot::DepthRenderer renderer(object.mesh);
  dot::ObjectTracker tracker(object, dot::TrackerConfig());
  dot::Pose truth = dot::Pose::Identity();  // T_camera_object
  truth.translation() = Eigen::Vector3d(0.0, 0.0, 0.8);
  tracker.initialise(truth);
  double error_m = 0.0;
  for (int k = 0; k < 60; ++k) {
    truth.translation().x() += 0.003;
    std::vector<float> depth_m(640 * 480, 1.5f);  // a wall
    for (const dot::CoveredPixel& pixel : renderer.render(truth, camera)) depth_m[pixel.row * 640 + pixel.col] = pixel.depth;
    dot::DepthImageView image{reinterpret_cast<const std::uint8_t*>(depth_m.data()), 640, 480, 640 * sizeof(float),
                              dot::DepthImageView::PixelType::kFloat32, false, 1.0f};
    const dot::TrackerResult result = tracker.update(image, camera, k / 30.0);  // stamp in seconds
    error_m = (result.T_camera_object.translation() - truth.translation()).norm();
    std::printf("%-12s %.4f m off, %.0f %% visible\n", dot::stateName(result.state), error_m, 100.0 * result.visible_fraction);
  }
  return error_m < 0.003 ? 0 : 1;
}
