// SPDX-License-Identifier: BSD-3-Clause
#include "depth_object_tracker/render/render_levels.h"

#include "depth_object_tracker/geometry/level_of_detail.h"

namespace depth_object_tracker {

RenderLevels::RenderLevels(const TriangleMesh& mesh, double max_error_m) {
  for (const MeshLevel& level : makeLevels(mesh, max_error_m)) levels_.emplace_back(level.mesh, level.error_m);
}

const RenderObject& RenderLevels::choose(double allowed_error_m) const {
  const RenderObject* chosen = &levels_.front();
  for (const RenderObject& level : levels_) {
    if (level.error_m <= allowed_error_m) chosen = &level;
  }
  return *chosen;
}

}  // namespace depth_object_tracker
