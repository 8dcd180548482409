
#include <gtest/gtest.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <stdexcept>
#include <thread>

#include "problem/processes/child.h"

namespace springproof::in_child_test {
namespace {

/// How in_child() fails; empty: it does not.
std::string failure(const std::function<std::string()>& work) {
  try {
    in_child(work);
    return {};
  } catch (const std::runtime_error& e) {
    return e.what();
  }
}

TEST(InChild, ReturnsBytesThrowsAndSurvives) {
  std::string large(1 << 20, 'x');
  large[7] = '\0';
  EXPECT_EQ(in_child([&] { return large; }), large);
  EXPECT_EQ(in_child([] { return std::string(); }), "");
  EXPECT_EQ(failure([]() -> std::string { throw std::invalid_argument("no"); }), "no");
  EXPECT_EQ(failure([]() -> std::string { std::abort(); }), "was killed by signal 6 (out of memory?)");
  EXPECT_EQ(failure([]() -> std::string { _exit(0); }), "ended early");
  EXPECT_EQ(failure([]() -> std::string { _exit(3); }), "ended early");
}

TEST(InChild, HasAMemoryOfItsOwn) {
  int value = 1;
  EXPECT_EQ(in_child([&] { return std::to_string(++value); }), "2");
  EXPECT_EQ(value, 1);
}

TEST(InChild, IsInterrupted) {
  const auto usual = std::signal(SIGTERM, [](int) {});  // a handler of ours does not keep the child
  std::jthread other([] {
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
    interrupt_children();
  });
  EXPECT_EQ(failure([]() -> std::string {
              for (;;) pause();
            }),
            "was killed by signal 15 (out of memory?)");
  std::signal(SIGTERM, usual);
}

}  // namespace
}  // namespace springproof::in_child_test
