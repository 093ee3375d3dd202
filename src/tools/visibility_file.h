// SPDX-License-Identifier: BSD-3-Clause
// Visible share of the object per frame, where a scene says it.
#pragma once

#include "depth_object_tracker/tools/bop_scene.h"

namespace depth_object_tracker {

/// Fills visible_fraction from SCENE/visibility.csv (columns `frame` and `fraction_visible`, others ignored) when it is
/// there.
/// @throws InputError
void readVisibility(BopScene& scene);

}  // namespace depth_object_tracker
