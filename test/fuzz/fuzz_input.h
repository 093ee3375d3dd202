// SPDX-License-Identifier: BSD-3-Clause
// What the fuzz targets share.
#pragma once

#include <fuzzer/FuzzedDataProvider.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>

namespace depth_object_tracker {

inline std::string toText(const std::uint8_t* data, std::size_t size) {
  return std::string(reinterpret_cast<const char*>(data), size);
}

/// A file in memory, for readers that want a path.
class MemoryFileName {
 public:
  explicit MemoryFileName(const std::string& content) : descriptor_(memfd_create("input", MFD_CLOEXEC)) {
    if (descriptor_ < 0) std::abort();
    std::size_t done = 0;
    while (done < content.size()) {
      const ssize_t count = write(descriptor_, content.data() + done, content.size() - done);
      if (count <= 0) std::abort();
      done += static_cast<std::size_t>(count);
    }
  }
  ~MemoryFileName() { close(descriptor_); }
  MemoryFileName(const MemoryFileName&) = delete;
  MemoryFileName& operator=(const MemoryFileName&) = delete;
  std::string path() const { return "/proc/self/fd/" + std::to_string(descriptor_); }

 private:
  int descriptor_;
};

}  // namespace depth_object_tracker
