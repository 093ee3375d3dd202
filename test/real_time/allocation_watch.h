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

 private:
  HeapUse begin_;
};

/// Every allocation prints its calls to standard error, for finding it.
void tellAllocations(bool wanted);

}  // namespace depth_object_tracker
