// SPDX-License-Identifier: BSD-3-Clause
// A progress bar on a terminal, nothing in a pipe.
#include "depth_object_tracker/tools/progress_bar.h"

#include <unistd.h>

#include <cstdio>
#include <string>

namespace depth_object_tracker {
namespace {

constexpr std::size_t kWidth = 40;
constexpr auto kRedrawInterval = std::chrono::milliseconds(100);

}  // namespace

ProgressBar::ProgressBar(std::size_t total) : total_(total), on_terminal_(isatty(STDERR_FILENO) == 1) {}

ProgressBar::~ProgressBar() {
  if (on_terminal_) std::fputs("\r\033[K", stderr);
}

void ProgressBar::update(std::size_t done) {
  if (!on_terminal_ || total_ == 0) return;
  const auto now = std::chrono::steady_clock::now();
  if (done < total_ && now - last_drawn_ < kRedrawInterval) return;
  last_drawn_ = now;
  const std::size_t filled = kWidth * done / total_;
  std::fprintf(stderr, "\r[%s%s] %zu/%zu", std::string(filled, '#').c_str(), std::string(kWidth - filled, ' ').c_str(),
               done, total_);
  std::fflush(stderr);
}

}  // namespace depth_object_tracker
