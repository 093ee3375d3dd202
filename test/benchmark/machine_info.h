// SPDX-License-Identifier: BSD-3-Clause
// Under what conditions figures were taken.
#pragma once

#include <string>

namespace depth_object_tracker {

struct MachineInfo {
  std::string processor;
  int cores = 0;
  double load = 0.0;  ///< average of the last minute: others that used the machine
  std::string compiler, build_type, simd;
  std::string commit;  ///< of the source folder now; "" without git or a checkout
};

MachineInfo machineInfo();

}  // namespace depth_object_tracker
