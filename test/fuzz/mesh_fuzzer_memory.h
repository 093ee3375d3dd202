// SPDX-License-Identifier: BSD-3-Clause
// assimp takes and clears 16 MiB for every OBJ and PLY file, whatever its size. Mapping that anew for each takes nine
// tenths of the time: one such buffer stays mapped, between pages that nobody may touch, nor itself once given back.
// assimp is not compiled with a sanitizer: these stop it where the sanitizer's own zones would not. All other memory is
// the sanitizer's.
#pragma once

#include <sys/mman.h>

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <new>

namespace depth_object_tracker {

class FileBuffer {
 public:
  static constexpr std::size_t kBytes = 4096 * 4096;

  /// nullptr when it is in use or `size` is not its own.
  void* take(std::size_t size) {
    if (size != kBytes || is_taken_) return nullptr;
    if (memory_ == nullptr) map();
    protect(PROT_READ | PROT_WRITE);
    is_taken_ = true;
    return memory_;
  }
  /// @return false when that is other memory.
  bool giveBack(void* memory) {
    if (memory == nullptr || memory != memory_) return false;
    if (!is_taken_) std::abort();  // freed twice
    protect(PROT_NONE);
    is_taken_ = false;
    return true;
  }

 private:
  /// On huge pages, as far as there are any: protecting thousands of small ones takes as long as assimp.
  void map() {
    constexpr std::size_t kHugePage = 1 << 21;
    void* all = mmap(nullptr, kBytes + 2 * kHugePage, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (all == MAP_FAILED) std::abort();
    memory_ = reinterpret_cast<void*>((reinterpret_cast<std::uintptr_t>(all) / kHugePage + 1) * kHugePage);
    madvise(memory_, kBytes, MADV_HUGEPAGE);
  }
  void protect(int access) {
    if (mprotect(memory_, kBytes, access) != 0) std::abort();
  }

  void* memory_ = nullptr;
  bool is_taken_ = false;
};

inline FileBuffer file_buffer;

}  // namespace depth_object_tracker

void* operator new(std::size_t size) {
  if (void* memory = depth_object_tracker::file_buffer.take(size)) return memory;
  if (void* memory = std::malloc(size)) return memory;
  throw std::bad_alloc();
}
void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
  return std::malloc(size);
}
void operator delete(void* memory) noexcept {
  if (!depth_object_tracker::file_buffer.giveBack(memory)) std::free(memory);
}
void operator delete(void* memory, std::size_t) noexcept {
  operator delete(memory);
}
void operator delete(void* memory, const std::nothrow_t&) noexcept {
  operator delete(memory);
}
