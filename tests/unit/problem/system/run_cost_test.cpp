// Times of short runs are the least of several; memory is what was added.
#include "problem/system/run_cost.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <vector>

namespace springproof::run_cost_test {
namespace {

TEST(RunCost, ShortRunsAreRepeatedAndTheLeastCounts) {
  const std::vector<RunTimes> next = {{0.003, 0.02}, {0.001, 0.03}, {0.002, 0.01}, {0.004, 0.04}, {0, 0}};
  std::size_t calls = 0;
  const RunTimes least = least_times({0.005, 0.05}, [&] { return next.at(calls++); });
  EXPECT_EQ(calls, 4u);
  EXPECT_EQ(least.set_up, 0.001);
  EXPECT_EQ(least.solve, 0.01);
}

TEST(RunCost, LongRunsAreNotRepeated) {
  int calls = 0;
  const auto again = [&] {
    ++calls;
    return RunTimes{0.01, 0.06};
  };
  EXPECT_EQ(least_times({0.1, 0.1}, again).solve, 0.1);
  EXPECT_EQ(calls, 0);
  EXPECT_EQ(least_times({0, 0.1}, again).solve, 0.06);
  EXPECT_EQ(calls, 2);
}

TEST(RunCost, MemoryIsWhatWasAddedAndGivenBack) {
#ifdef __SANITIZE_ADDRESS__
  GTEST_SKIP() << "the address sanitizer keeps freed memory, and an eighth of all for itself";
#endif
  if (access("/proc/self/clear_refs", W_OK) != 0) GTEST_SKIP() << "the system does not tell";
  { std::vector<char> earlier(300 << 20, 1); }
  const MemoryGrowth growth;
  { std::vector<char> now(100 << 20, 1); }
  EXPECT_NEAR(growth.most_MiB(), 100, 3);
}

}  // namespace
}  // namespace springproof::run_cost_test
