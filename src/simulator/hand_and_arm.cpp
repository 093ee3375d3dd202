// SPDX-License-Identifier: BSD-3-Clause
#include "depth_object_tracker/simulator/hand_and_arm.h"

namespace depth_object_tracker {
namespace {

constexpr float kSkin = 0.65f, kMetal = 0.3f, kSleeve = 0.4f;

}  // namespace

HandAndArm::HandAndArm(const TriangleMesh& object, const GraspRequest& request)
    : hand_(chooseGrasp(object, request)),
      arm_(request.arm),
      reflectance_(request.kind == HandKind::kHuman ? kSkin : kMetal),
      hand_renderer_(hand_.mesh),
      link_renderers_{DepthRenderer(arm_.meshes()[0]), DepthRenderer(arm_.meshes()[1])} {}

void HandAndArm::draw(const Pose& T_camera_object, const View& view, const DrawSurface& surface) {
  surface(hand_renderer_.render(view.T_view_camera * T_camera_object, view.camera), reflectance_);
  const auto links = arm_.place(T_camera_object * hand_.wrist, T_camera_object.linear() * hand_.wrist_out);
  for (std::size_t k = 0; k < links.size(); ++k) {
    surface(link_renderers_[k].render(view.T_view_camera * links[k], view.camera), kSleeve);
  }
}

}  // namespace depth_object_tracker
