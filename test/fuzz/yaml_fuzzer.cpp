// SPDX-License-Identifier: BSD-3-Clause
// Object files and files of the tracker's parameters.
#include "depth_object_tracker/tracker/object_model.h"
#include "depth_object_tracker/tracker/tracker_parameters.h"
#include "fuzz_input.h"

#include <stdexcept>

namespace dot = depth_object_tracker;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const std::string text = dot::toText(data + 1, size - 1);
  try {
    if (data[0] % 2 == 0) {
      const dot::ObjectDescription description = dot::parseObjectDescription(text, "/objects/object.yaml");
      if (description.name.empty() || !(description.mesh_scale > 0.0)) __builtin_trap();
      for (const dot::SymmetryAxis& symmetry : description.symmetries.continuous) {
        if (!symmetry.axis.allFinite()) __builtin_trap();
      }
    } else {
      const dot::MemoryFileName file(text);
      dot::validateTrackerConfig(dot::loadTrackerConfig(file.path()));
    }
  } catch (const std::invalid_argument&) {
  }
  return 0;
}
