// SPDX-License-Identifier: BSD-3-Clause
// For every mask of eight lanes, where the lanes of the packed vector come from.
#pragma once

#include <array>
#include <cstdint>

namespace depth_object_tracker {

constexpr std::array<std::array<std::int32_t, 8>, 256> makePackTable() {
  std::array<std::array<std::int32_t, 8>, 256> table{};
  for (std::size_t mask = 0; mask < table.size(); ++mask) {
    std::size_t count = 0;
    for (std::int32_t lane = 0; lane < 8; ++lane) {
      if ((mask >> lane & 1) != 0) table[mask][count++] = lane;
    }
  }
  return table;
}

/// 8 KiB. Highway 1.0's own table for AVX2 is copied to the stack at every use by gcc 12.
alignas(64) inline constexpr std::array<std::array<std::int32_t, 8>, 256> kPackTable = makePackTable();

}  // namespace depth_object_tracker
