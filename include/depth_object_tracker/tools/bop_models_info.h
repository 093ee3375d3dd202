// SPDX-License-Identifier: BSD-3-Clause
// Reads an object's symmetries from BOP's models_info.json.
#pragma once

#include "depth_object_tracker/geometry/symmetry.h"

#include <optional>
#include <string>

namespace depth_object_tracker {

/// @param mesh_scale metres per unit of the file (the mesh file's unit).
/// @return nullopt when the file has no entry for the object.
/// @throws InputError naming file, key and what is wrong.
std::optional<Symmetries> loadBopSymmetries(const std::string& json_file, int object_id, double mesh_scale);

}  // namespace depth_object_tracker
