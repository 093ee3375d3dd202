// SPDX-License-Identifier: BSD-3-Clause
// AprilTags painted into a rendered grey picture.
#pragma once

#include "depth_object_tracker/fiducials/fiducial_map.h"
#include "depth_object_tracker/fiducials/tag_detector.h"
#include "depth_object_tracker/geometry/pinhole_camera.h"

#include <vector>

namespace depth_object_tracker {

/// Printed cards, as thin as paper.
class TagTexture {
 public:
  explicit TagTexture(const FiducialMap& map);

  /// Paints the cards where nothing stands before them, with smooth borders between their modules.
  /// @param depth_m nearest surface of every pixel, row-major. @param gray row-major, brightness in [0, 1].
  void paint(const Pose& T_view_object, const PinholeCamera& camera, const std::vector<float>& depth_m,
             std::vector<float>& gray) const;

 private:
  struct Card {
    Fiducial tag;
    TagPicture picture;
  };
  struct Box {
    int row_begin, row_end, col_begin, col_end;
  };
  Box boxOf(const Card& card, const Pose& T_view_tag, const PinholeCamera& camera) const;
  void paintCard(const Card& card, const Pose& T_view_object, const PinholeCamera& camera,
                 const std::vector<float>& depth_m, std::vector<float>& gray) const;

  std::vector<Card> cards_;
};

}  // namespace depth_object_tracker
