// SPDX-License-Identifier: BSD-3-Clause
#include "depth_object_tracker/robot/robot_occluder.h"

#include <algorithm>

namespace depth_object_tracker {

RobotOccluder::RobotOccluder(const RobotModel& model, const LinkMeshes& meshes) {
  for (const LinkMesh& link : meshes.links) {
    if (model.hasLink(link.link)) links_.push_back({link.link, DepthRenderer(link.mesh)});
  }
}

std::size_t RobotOccluder::place(RobotState& state, const Pose& T_camera_root, double stamp_s) {
  std::size_t num_placed = 0;
  for (Link& link : links_) {
    const LinkPose pose = state.linkPose(link.name, stamp_s);
    link.is_placed = pose.problem.empty();
    link.T_camera_link = T_camera_root * pose.T_root_link;
    num_placed += link.is_placed ? 1 : 0;
  }
  return num_placed;
}

const std::vector<float>& RobotOccluder::render(const PinholeCamera& camera) {
  depth_.assign(static_cast<std::size_t>(camera.width) * static_cast<std::size_t>(camera.height), 0.0f);
  for (Link& link : links_) {
    if (!link.is_placed) continue;
    for (const CoveredPixel& pixel : link.renderer.render(link.T_camera_link, camera)) {
      const std::size_t index = static_cast<std::size_t>(pixel.row) * static_cast<std::size_t>(camera.width) +
                                static_cast<std::size_t>(pixel.col);
      float& depth = depth_[index];
      depth = depth > 0.0f ? std::min(depth, pixel.depth) : pixel.depth;
    }
  }
  return depth_;
}

}  // namespace depth_object_tracker
