// SPDX-License-Identifier: BSD-3-Clause
// Counts what the whole program asks the heap for, by operator new or by malloc, in any library and on any thread.
#pragma once

#include <cstdint>

namespace depth_object_tracker {

struct HeapUse {
  std::int64_t allocations = 0;
  std::int64_t bytes = 0;
};

/// Since the program began.
HeapUse heapUse();

/// From its construction on.
class AllocationWatch {
 public:
  AllocationWatch() : begin_(heapUse()) {}
  HeapUse sinceBegin() const {
    const HeapUse now = heapUse();
    return {now.allocations - begin_.allocations, now.bytes - begin_.bytes};
  }

  /// While this is alive the first allocation of its thread prints where it comes from. For finding them by hand.
  static void tellNext();

 private:
  HeapUse begin_;
};

}  // namespace depth_object_tracker
