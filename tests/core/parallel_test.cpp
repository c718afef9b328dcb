#include "core/parallel.h"

#include <gtest/gtest.h>

#include <atomic>
#include <mutex>
#include <set>
#include <utility>
#include <vector>

#include "tests/support/expect_error.h"

namespace waretwin {
namespace {

std::set<std::pair<std::size_t, std::size_t>> pieces(std::size_t count, std::size_t grain) {
  std::mutex mutex;
  std::set<std::pair<std::size_t, std::size_t>> out;
  parallel_for(count, grain, [&](std::size_t begin, std::size_t end) {
    const std::lock_guard lock(mutex);
    EXPECT_TRUE(out.emplace(begin, end).second);
  });
  return out;
}

class Parallel : public ::testing::Test {
 protected:
  void TearDown() override { set_thread_count(0); }
};

TEST_F(Parallel, PiecesAreTheSameAtAnyThreadCount) {
  const std::set<std::pair<std::size_t, std::size_t>> expected = {{0, 3}, {3, 6}, {6, 9}, {9, 10}};
  for (const int threads : {1, 2, 4, 0}) {
    set_thread_count(threads);
    EXPECT_EQ(pieces(10, 3), expected) << threads;
    EXPECT_TRUE(pieces(0, 3).empty());
    EXPECT_EQ(pieces(3, 3).size(), 1u);
    EXPECT_EQ(pieces(1, 100).size(), 1u);
    EXPECT_EQ(pieces(1000, 7).size(), 143u);
  }
}

TEST_F(Parallel, EveryElementIsVisitedOnce) {
  std::vector<int> visits(100000, 0);
  parallel_for(visits.size(), 64, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) ++visits[i];
  });
  for (const int v : visits) ASSERT_EQ(v, 1);
}

TEST_F(Parallel, ExceptionsReachTheCaller) {
  for (const int threads : {1, 4}) {
    set_thread_count(threads);
    EXPECT_ERROR(parallel_for(100, 1,
                              [](std::size_t begin, std::size_t) {
                                if (begin == 37) throw Error("piece 37");
                              }),
                 "piece 37");
  }
}

TEST_F(Parallel, LoopsMayNest) {
  std::atomic<int> sum{0};
  parallel_for(
      10, 1, [&](std::size_t, std::size_t) { parallel_for(10, 3, [&](std::size_t b, std::size_t e) { sum += static_cast<int>(e - b); }); });
  EXPECT_EQ(sum, 100);
}

TEST_F(Parallel, ThreadCountIsLimitedAndGivenBack) {
  set_thread_count(3);
  EXPECT_EQ(thread_count(), 3);
  set_thread_count(1);
  EXPECT_EQ(thread_count(), 1);
  set_thread_count(0);
  EXPECT_GE(thread_count(), 1);
  EXPECT_ERROR(set_thread_count(-1), "-1", "expected 0");
}

}  // namespace
}  // namespace waretwin
