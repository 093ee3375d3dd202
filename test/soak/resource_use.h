// SPDX-License-Identifier: BSD-3-Clause
// What this process holds of the system, from /proc.
#pragma once

#include <malloc.h>

#include <cstddef>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

namespace depth_object_tracker {

struct ResourceUse {
  std::size_t resident_kib = 0;  ///< without what malloc keeps of memory that was freed
  std::size_t peak_kib = 0;      ///< most resident memory since the start, with it
  std::size_t heap_kib = 0;      ///< allocated and not freed: grows with a leak, not with fragmentation
  std::size_t handles = 0;       ///< open file descriptors
  std::size_t threads = 0;
};

/// Returns freed memory to the system first: a search leaves some 20 MB with malloc, or does not, by chance.
inline ResourceUse readResourceUse() {
  ResourceUse use;
  malloc_trim(0);
  std::ifstream status("/proc/self/status");
  for (std::string word; status >> word;) {
    if (word == "VmRSS:") status >> use.resident_kib;
    if (word == "VmHWM:") status >> use.peak_kib;
    if (word == "Threads:") status >> use.threads;
  }
  const auto heap = mallinfo2();
  use.heap_kib = (heap.uordblks + heap.hblkhd) / 1024;
  const std::filesystem::directory_iterator handles("/proc/self/fd");
  use.handles = static_cast<std::size_t>(std::distance(begin(handles), end(handles)));
  return use;
}

}  // namespace depth_object_tracker
