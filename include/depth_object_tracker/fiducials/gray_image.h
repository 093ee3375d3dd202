// SPDX-License-Identifier: BSD-3-Clause
// Non-owning view of an 8-bit grey picture.
#pragma once

#include <cstddef>
#include <cstdint>

namespace depth_object_tracker {

/// The memory behind `data` must outlive the view.
struct GrayImageView {
  const std::uint8_t* data = nullptr;
  int width = 0;
  int height = 0;
  std::size_t step = 0;  ///< bytes from one row to the next, >= width

  /// No bounds check.
  std::uint8_t at(int row, int col) const {
    return data[static_cast<std::size_t>(row) * step + static_cast<std::size_t>(col)];
  }
};

}  // namespace depth_object_tracker
