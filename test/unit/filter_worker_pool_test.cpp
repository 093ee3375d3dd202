// SPDX-License-Identifier: BSD-3-Clause
// Every index once, on any number of threads, run after run. Meant to be run under the thread sanitizer too.
#include "depth_object_tracker/filter/worker_pool.h"

#include <gtest/gtest.h>

#include <memory>
#include <numeric>

namespace depth_object_tracker {
namespace {

class WithThreads : public testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(WorkerPool, WithThreads, testing::Values(1, 2, 3, 8));

TEST_P(WithThreads, CallsEveryIndexOnce) {
  WorkerPool pool(GetParam());
  ASSERT_EQ(pool.numThreads(), GetParam());
  for (const int count : {0, 1, 2, 7, 1000}) {
    std::vector<int> calls(static_cast<std::size_t>(count), 0);  // plain ints: each is touched by one call alone
    pool.run(count, [&](int index, int) { ++calls.at(static_cast<std::size_t>(index)); });
    EXPECT_EQ(std::accumulate(calls.begin(), calls.end(), 0), count);
    for (const int n : calls) EXPECT_EQ(n, 1);
  }
}

TEST_P(WithThreads, ScratchMemoryPerThreadIsNeverShared) {
  WorkerPool pool(GetParam());
  std::vector<long> scratch(static_cast<std::size_t>(GetParam()), 0);  // not atomic on purpose
  for (int run = 0; run < 200; ++run) {
    pool.run(50, [&](int index, int thread) {
      ASSERT_GE(thread, 0);
      ASSERT_LT(thread, GetParam());
      scratch[static_cast<std::size_t>(thread)] += index;
    });
  }
  EXPECT_EQ(std::accumulate(scratch.begin(), scratch.end(), 0L), 200L * 49 * 50 / 2);
}

TEST_P(WithThreads, ResultsAreCompleteWhenRunReturns) {
  WorkerPool pool(GetParam());
  std::vector<double> values(64, 0.0);
  for (int run = 1; run <= 500; ++run) {
    const double addend = run;
    pool.run(64, [&](int index, int) { values[static_cast<std::size_t>(index)] += addend; });
    ASSERT_EQ(values.front(), run * (run + 1) / 2.0);
    ASSERT_EQ(values.back(), run * (run + 1) / 2.0);
  }
}

TEST_P(WithThreads, CanBeMadeAndDestroyedIdle) {
  for (int k = 0; k < 50; ++k) {
    WorkerPool pool(GetParam());
    if (k % 2 == 0) pool.run(3, [](int, int) {});
  }
}

TEST(WorkerPool, FewerThanOneThreadMeansTheCallerAlone) {
  EXPECT_EQ(WorkerPool(0).numThreads(), 1);
  EXPECT_EQ(WorkerPool(-3).numThreads(), 1);
}

}  // namespace
}  // namespace depth_object_tracker
