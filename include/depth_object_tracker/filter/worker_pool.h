// SPDX-License-Identifier: BSD-3-Clause
// Threads that share out independent pieces of work; the caller works along.
#pragma once

#include <atomic>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace depth_object_tracker {

/// One caller at a time. With one thread everything runs in the caller and nothing is locked.
class WorkerPool {
 public:
  /// @param num_threads >= 1, the caller included.
  explicit WorkerPool(int num_threads);
  ~WorkerPool();
  WorkerPool(const WorkerPool&) = delete;
  WorkerPool& operator=(const WorkerPool&) = delete;

  int numThreads() const { return static_cast<int>(workers_.size()) + 1; }

  /// Calls task(index, thread) for every index in [0, count), each once, and returns when all are done.
  /// `thread` in [0, numThreads()) picks scratch memory. Which thread gets which index is not defined, so results may
  /// only depend on the index. The task must not throw.
  using Task = std::function<void(int index, int thread)>;
  void run(int count, const Task& task);

 private:
  void workerLoop(int thread);
  void takeIndices(int thread);

  std::vector<std::thread> workers_;
  std::mutex mutex_;
  std::condition_variable start_, done_;
  const Task* task_ = nullptr;  // guarded by mutex_ when changed; stable while busy_ > 0
  int count_ = 0;
  std::atomic<int> next_{0};
  int busy_ = 0;             // guarded by mutex_
  unsigned generation_ = 0;  // guarded by mutex_
  bool stopping_ = false;    // guarded by mutex_
};

}  // namespace depth_object_tracker
