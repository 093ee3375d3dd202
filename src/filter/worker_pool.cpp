// SPDX-License-Identifier: BSD-3-Clause
#include "depth_object_tracker/filter/worker_pool.h"

#include <algorithm>

namespace depth_object_tracker {

WorkerPool::WorkerPool(int num_threads) {
  for (int thread = 1; thread < std::max(1, num_threads); ++thread) {
    workers_.emplace_back([this, thread] { workerLoop(thread); });
  }
}

WorkerPool::~WorkerPool() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    stopping_ = true;
  }
  start_.notify_all();
  for (std::thread& worker : workers_) worker.join();
}

void WorkerPool::run(int count, const Task& task) {
  if (workers_.empty()) {
    for (int index = 0; index < count; ++index) task(index, 0);
    return;
  }
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    task_ = &task;
    count_ = count;
    next_ = 0;
    busy_ = static_cast<int>(workers_.size());
    ++generation_;
  }
  start_.notify_all();
  takeIndices(0);
  std::unique_lock<std::mutex> lock(mutex_);
  done_.wait(lock, [this] { return busy_ == 0; });
}

void WorkerPool::workerLoop(int thread) {
  unsigned seen = 0;
  std::unique_lock<std::mutex> lock(mutex_);
  while (true) {
    start_.wait(lock, [&] { return stopping_ || generation_ != seen; });
    if (stopping_) return;
    seen = generation_;
    lock.unlock();
    takeIndices(thread);
    lock.lock();
    if (--busy_ == 0) done_.notify_one();
  }
}

void WorkerPool::takeIndices(int thread) {
  for (int index = next_++; index < count_; index = next_++) (*task_)(index, thread);
}

}  // namespace depth_object_tracker
