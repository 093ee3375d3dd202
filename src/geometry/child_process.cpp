// SPDX-License-Identifier: BSD-3-Clause
#include "child_process.h"

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <thread>

namespace depth_object_tracker {
namespace {

using Clock = std::chrono::steady_clock;

/// The files that a child begins with.
class ChildFiles {
 public:
  ChildFiles(int input, int output) {
    posix_spawn_file_actions_init(&actions_);
    posix_spawn_file_actions_adddup2(&actions_, input, STDIN_FILENO);
    posix_spawn_file_actions_adddup2(&actions_, output, STDOUT_FILENO);
    posix_spawn_file_actions_addopen(&actions_, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
#if __GLIBC_PREREQ(2, 34)
    posix_spawn_file_actions_addclosefrom_np(&actions_, STDERR_FILENO + 1);
#endif
  }
  ~ChildFiles() {
    posix_spawn_file_actions_destroy(&actions_);
  }
  ChildFiles(const ChildFiles&) = delete;
  ChildFiles& operator=(const ChildFiles&) = delete;
  const posix_spawn_file_actions_t* actions() const {
    return &actions_;
  }

 private:
  posix_spawn_file_actions_t actions_;
};

/// The signal mask of this thread is the child's too, unless told otherwise: it must get its limits' signals.
class ChildSignals {
 public:
  ChildSignals() {
    sigset_t none;
    sigemptyset(&none);
    posix_spawnattr_init(&attributes_);
    posix_spawnattr_setsigmask(&attributes_, &none);
    posix_spawnattr_setflags(&attributes_, POSIX_SPAWN_SETSIGMASK);
  }
  ~ChildSignals() { posix_spawnattr_destroy(&attributes_); }
  ChildSignals(const ChildSignals&) = delete;
  ChildSignals& operator=(const ChildSignals&) = delete;
  const posix_spawnattr_t* attributes() const { return &attributes_; }

 private:
  posix_spawnattr_t attributes_;
};

/// Reads until the child closes its end, the deadline, or too much.
void readOutput(int pipe, Clock::time_point deadline, std::size_t max_output, ChildOutcome& outcome) {
  std::vector<char> buffer(1 << 16);
  while (true) {
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(deadline - Clock::now()).count();
    outcome.timed_out = left <= 0;
    if (outcome.timed_out) return;
    pollfd ready{pipe, POLLIN, 0};
    if (::poll(&ready, 1, static_cast<int>(std::min<long long>(left, 1000))) <= 0) continue;
    const ssize_t count = ::read(pipe, buffer.data(), buffer.size());
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return;
    outcome.wrote_too_much = outcome.output.size() + static_cast<std::size_t>(count) > max_output;
    if (outcome.wrote_too_much) return;
    outcome.output.append(buffer.data(), static_cast<std::size_t>(count));
  }
}

/// Its end. A child that has closed its output but stays is killed after a moment.
int awaitEnd(pid_t child, bool is_wanted) {
  constexpr std::chrono::seconds kPatience{2};
  constexpr std::chrono::milliseconds kPollPeriod{2};
  const auto deadline = Clock::now() + kPatience;
  int status = 0;
  for (pid_t ended = 0; is_wanted && Clock::now() < deadline; std::this_thread::sleep_for(kPollPeriod)) {
    ended = ::waitpid(child, &status, WNOHANG);
    if (ended == child) return status;
    if (ended < 0 && errno != EINTR) return 0;  // this process leaves its children to the system
  }
  ::kill(child, SIGKILL);
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  return status;
}

}  // namespace

ChildOutcome runChild(const std::vector<std::string>& command, int input, double timeout_s, std::size_t max_output) {
  ChildOutcome outcome;
  const auto deadline =
      Clock::now() + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(timeout_s));
  int ends[2];
  if (::pipe2(ends, O_CLOEXEC) != 0) {
    outcome.status = errno;
    return outcome;
  }
  std::vector<char*> arguments;
  arguments.reserve(command.size() + 1);
  for (const std::string& word : command) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  pid_t child = 0;
  outcome.status = ::posix_spawn(&child, arguments[0], ChildFiles(input, ends[1]).actions(),
                                 ChildSignals().attributes(), arguments.data(), environ);
  ::close(ends[1]);
  outcome.started = outcome.status == 0;
  if (outcome.started) {
    readOutput(ends[0], deadline, max_output, outcome);
    outcome.status = awaitEnd(child, !outcome.timed_out && !outcome.wrote_too_much);
  }
  ::close(ends[0]);
  return outcome;
}

}  // namespace depth_object_tracker
