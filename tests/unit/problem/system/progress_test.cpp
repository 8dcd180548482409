#include "problem/system/progress.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <chrono>
#include <vector>

namespace springproof::progress_test {
namespace {

using Said = std::vector<std::string>;

progress::Listener note_in(Said& said) {
  return [&said](const std::string& phase, const std::string& detail) { said.push_back(phase + "|" + detail); };
}

TEST(Progress, IsHeardByTheThreadsListener) {
  Said said;
  progress::phase("before");
  {
    const progress::Listening listening(note_in(said));
    progress::phase("solving");
    progress::detail("step 1");
    std::thread([] { progress::phase("elsewhere"); }).join();
  }
  progress::phase("after");
  EXPECT_EQ(said, (Said{"solving|", "solving|step 1"}));
}

TEST(Progress, AnInnerListenerGivesWayAgain) {
  Said outer, inner;
  const progress::Listening first(note_in(outer));
  progress::phase("a");
  {
    const progress::Listening second(note_in(inner));
    progress::phase("b");
  }
  progress::detail("c");
  EXPECT_EQ(outer, (Said{"a|", "a|c"}));
  EXPECT_EQ(inner, (Said{"b|"}));
}

TEST(Progress, DetailsThatCannotBeReadAreNotEvenMade) {
  Said said;
  int made = 0;
  const auto describe = [&] { return std::to_string(++made); };
  progress::detail(describe);
  EXPECT_EQ(made, 0);  // nobody listens
  const progress::Listening listening(note_in(said));
  progress::phase("solving");
  for (int i = 0; i < 1000; ++i) progress::detail(describe);
  EXPECT_LT(made, 10);
  std::this_thread::sleep_for(std::chrono::milliseconds(120));
  progress::detail(describe);
  EXPECT_EQ(said.back(), "solving|" + std::to_string(made));
}

TEST(Progress, IsPassedOnFromAnotherProgramsFile) {
  const std::filesystem::path folder =
      std::filesystem::temp_directory_path() / ("progress_test-" + std::to_string(getpid()));
  std::filesystem::create_directories(folder);
  std::vector<std::string> said;
  {
    const progress::Listening listening(note_in(said));
    const progress::Relay relay(folder / "progress");
    // The other program: its own thread here.
    std::thread([&] {
      const progress::Listening writing(progress::into_file(folder / "progress"));
      progress::phase("grid 1");
      std::this_thread::sleep_for(std::chrono::milliseconds(600));
      progress::phase("grid 2");
      progress::detail("40 iterations");
      std::this_thread::sleep_for(std::chrono::milliseconds(600));
    }).join();
  }
  std::filesystem::remove_all(folder);
  std::erase(said, "grid 2|");  // read between the two lines, or not
  EXPECT_EQ(said, (Said{"grid 1|", "grid 2|40 iterations"}));
}

}  // namespace
}  // namespace springproof::progress_test
