// SPDX-License-Identifier: BSD-3-Clause
// Whether the process of another node is still the same.
#pragma once

#include <cstdint>
#include <string>

namespace depth_object_tracker {

/// Asks the node itself, so that it works without the master, too. Not thread-safe.
class ManagerWatch {
 public:
  /// @param node absolute name
  explicit ManagerWatch(const std::string& node) : node_(node) {}

  /// Remembers the process that the node has now. False when the node does not answer.
  bool begin();

  /// True once the process that was remembered is gone, or another one answers at its address.
  /// Asks anew at every call; a node that hangs keeps the caller waiting.
  bool isGone();

 private:
  /// 0 when it does not answer.
  int askProcess() const;

  std::string node_;
  std::string host_;
  std::uint32_t port_ = 0;
  int process_ = 0;
  int num_failures_ = 0;
};

}  // namespace depth_object_tracker
