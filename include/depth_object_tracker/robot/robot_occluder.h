// SPDX-License-Identifier: BSD-3-Clause
// The robot's own links, where its joints say that they are, as known occluders.
#pragma once

#include "depth_object_tracker/render/depth_renderer.h"
#include "depth_object_tracker/render/known_occluders.h"
#include "depth_object_tracker/robot/link_meshes.h"
#include "depth_object_tracker/robot/robot_state.h"

#include <string>
#include <vector>

namespace depth_object_tracker {

/// Not thread-safe.
class RobotOccluder : public KnownOccluders {
 public:
  RobotOccluder(const RobotModel& model, const LinkMeshes& meshes);

  /// For the image of this stamp. Links whose joints are not known are left out.
  /// @return number of links that are placed.
  std::size_t place(RobotState& state, const Pose& T_camera_root, double stamp_s);

  const std::vector<float>& render(const PinholeCamera& camera) override;

 private:
  struct Link {
    std::string name;
    DepthRenderer renderer;
    Pose T_camera_link = Pose::Identity();
    bool is_placed = false;
  };
  std::vector<Link> links_;
  std::vector<float> depth_;
};

}  // namespace depth_object_tracker
