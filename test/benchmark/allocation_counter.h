// SPDX-License-Identifier: BSD-3-Clause
// Counts what the program and its libraries take from the heap.
#pragma once

#include <cstdint>

namespace depth_object_tracker {

/// Calls of operator new so far, by all threads.
std::int64_t heapAllocations();

}  // namespace depth_object_tracker
