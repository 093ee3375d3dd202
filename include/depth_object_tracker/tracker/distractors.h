// SPDX-License-Identifier: BSD-3-Clause
// What else in the scene looks like the object: the arm that holds a bottle, for one.
#pragma once

#include "depth_object_tracker/geometry/depth_image.h"
#include "depth_object_tracker/geometry/pinhole_camera.h"
#include "depth_object_tracker/geometry/pose.h"
#include "depth_object_tracker/geometry/triangle_mesh.h"
#include "depth_object_tracker/render/depth_renderer.h"

#include <cstdint>
#include <optional>
#include <vector>

namespace depth_object_tracker {

/// While the object is seen for sure, everything else is surely not the object. Such an image is kept; once the object
/// is out of sight, the poses at which it seems to be in that image, but is not, are what not to find it at.
class Distractors {
 public:
  /// The image and the poses in it; both without the object.
  struct Scene {
    DepthImageView depth;  ///< valid until the next remember()
    PinholeCamera camera;
    Pose T_camera_centre;  ///< of the object itself
  };

  Distractors(const TriangleMesh& mesh, const Eigen::Vector3d& centre_object)
      : renderer_(mesh), centre_object_(centre_object) {}

  /// Images of this size are to be expected: remember() then asks for no memory.
  void expectImages(const PinholeCamera& camera);
  /// Copies an image in which the object is seen. Cheap.
  void remember(const DepthImageView& depth, const PinholeCamera& camera, const Pose& T_camera_centre);
  /// What was followed until now may not have been the object.
  void forget() {
    is_unsearched_ = false;
    places_.clear();
  }
  /// The camera's own motion since the last image.
  void moveCamera(const Pose& T_now_before) { T_now_remembered_ = T_now_before * T_now_remembered_; }

  /// The scene that is remembered, if its distractors were not looked for yet.
  std::optional<Scene> unsearched();
  /// Poses of the object's centre found in that scene. Those at the object itself are left out.
  void found(const std::vector<Pose>& T_camera_centre);

  /// Log odds [nat, >= 0] that what is seen at a pose is a distractor which moved there, rather than the object, which
  /// was last where it was remembered and then expected elsewhere.
  /// @param T_camera_expected of the object now. @param age_s of what is remembered.
  double against(const Pose& T_camera_centre, const Pose& T_camera_expected, double age_s) const;

 private:
  void readDepths();
  void blankObject();

  DepthRenderer renderer_;
  Eigen::Vector3d centre_object_;
  std::vector<std::uint8_t> bytes_;  ///< the remembered image as it came
  DepthImageView remembered_;
  std::vector<float> depth_m_;
  PinholeCamera camera_;
  Pose T_camera_centre_ = Pose::Identity(), T_now_remembered_ = Pose::Identity();
  bool is_unsearched_ = false;
  std::vector<Eigen::Vector3d> places_;
};

}  // namespace depth_object_tracker
