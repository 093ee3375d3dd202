// SPDX-License-Identifier: BSD-3-Clause
// Replaces the global operators: the array and nothrow forms of the standard library call these.
#include "allocation_counter.h"

#include <atomic>
#include <cstdlib>
#include <new>

namespace {

std::atomic<std::int64_t> num_allocations{0};

void* checked(void* memory) {
  if (memory == nullptr) throw std::bad_alloc();
  num_allocations.fetch_add(1, std::memory_order_relaxed);
  return memory;
}

}  // namespace

void* operator new(std::size_t size) {
  return checked(std::malloc(size > 0 ? size : 1));
}

void* operator new(std::size_t size, std::align_val_t alignment) {
  void* memory = nullptr;
  const int failed = posix_memalign(&memory, static_cast<std::size_t>(alignment), size > 0 ? size : 1);
  return checked(failed == 0 ? memory : nullptr);
}

void operator delete(void* memory) noexcept {
  std::free(memory);
}
void operator delete(void* memory, std::size_t) noexcept {
  std::free(memory);
}
void operator delete(void* memory, std::align_val_t) noexcept {
  std::free(memory);
}
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept {
  std::free(memory);
}

namespace depth_object_tracker {

std::int64_t heapAllocations() {
  return num_allocations.load(std::memory_order_relaxed);
}

}  // namespace depth_object_tracker
