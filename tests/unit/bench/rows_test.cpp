#include "comparisons/bench/rows.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <thread>

#include "comparisons/bench/machine.h"
#include "comparisons/bench/timer.h"

namespace springproof::bench::rows_test {
namespace {

BenchRow row(double value, double baseline, Target target) {
  return {"dynamics", "a", "10^3", "ns", value, baseline > 0 ? "b" : "", baseline, target};
}

TEST(BenchRows, SpeedUpsAreBaselineOverOurs) {
  EXPECT_DOUBLE_EQ(row(2, 10, at_least(5)).judged(), 5);
  EXPECT_EQ(outcome(row(2, 10, at_least(5))), "met");
  EXPECT_EQ(outcome(row(2, 9.9, at_least(5))), "missed");
}

TEST(BenchRows, OverheadsAreOursOverBaseline) {
  EXPECT_DOUBLE_EQ(row(3, 2, at_most(1.6)).judged(), 1.5);
  EXPECT_EQ(outcome(row(3, 2, at_most(1.6))), "met");
  EXPECT_EQ(outcome(row(3, 2, at_most(1.4))), "missed");
}

TEST(BenchRows, WithoutBaselineTheValueIsJudged) {
  EXPECT_EQ(outcome(row(13, 0, at_most(13))), "met");
  EXPECT_EQ(outcome(row(14, 0, at_most(13))), "missed");
  EXPECT_EQ(outcome(row(14, 0, {})), "");
}

TEST(BenchRows, WhatIsNoNumberIsNoResult) {
  EXPECT_EQ(outcome(row(std::nan(""), 0, at_most(13))), "no result");
  EXPECT_EQ(outcome(row(0, 10, at_least(5))), "no result");
  EXPECT_FALSE(complete({{row(1, 0, {}), row(std::nan(""), 0, {})}, {}}));
}

TEST(BenchTimer, SamplesHaveTheStepsThatThreadsNeedToTakeThemInTurn) {
  long least = 1000;
  const Advance slow = [&](long steps) {
    least = std::min(least, steps);
    std::this_thread::sleep_for(steps * std::chrono::milliseconds(1));
  };
  least_seconds({slow}, {.sample = 1e-3, .budget = 0.02, .clock = Clock::wall, .least_steps = 8});
  EXPECT_EQ(least, 8);
}

TEST(BenchTable, MissedTargetsAreNotHidden) {
  const Findings findings{{row(2, 9, at_least(5)), row(2, 11, at_least(5))}, {"a remark"}};
  const std::string text = table_text({"a processor", 2, {}, {{"L1", 32768}}}, findings);
  EXPECT_NE(text.find("MISSED"), std::string::npos);
  EXPECT_NE(text.find("1 of 2 targets met"), std::string::npos);
  EXPECT_NE(text.find("a remark"), std::string::npos);
}

}  // namespace
}  // namespace springproof::bench::rows_test
