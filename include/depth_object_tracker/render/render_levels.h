// SPDX-License-Identifier: BSD-3-Clause
// One object's mesh at several levels of detail, prepared for rendering; shared by everything that renders the object.
#pragma once

#include "depth_object_tracker/render/tile_renderer.h"

#include <vector>

namespace depth_object_tracker {

class RenderLevels {
 public:
  /// @param max_error_m [m] of the coarsest level; 0 = only the mesh itself.
  RenderLevels(const TriangleMesh& mesh, double max_error_m);

  /// The coarsest level whose error is at most `allowed_error_m` [m]; the mesh itself when none is.
  const RenderObject& choose(double allowed_error_m) const;
  const RenderObject& finest() const { return levels_.front(); }

 private:
  std::vector<RenderObject> levels_;  // from fine to coarse
};

}  // namespace depth_object_tracker
