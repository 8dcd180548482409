#include "problem/processes/child.h"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <thread>
#include <vector>

namespace springproof::child_test {
namespace {

namespace fs = std::filesystem;

Child shell(const std::string& command, double time_limit = 0) {
  return {"/bin/sh", {"-c", command}, {}, {}, {}, time_limit};
}

double seconds_since(std::chrono::steady_clock::time_point begin) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

TEST(Child, TellsStatusSignalAndTimeOutApart) {
  EXPECT_TRUE(run_child(shell("exit 0")).ok());
  const ChildEnd failed = run_child(shell("exit 3"));
  EXPECT_EQ(failed.kind, ChildEnd::exited);
  EXPECT_EQ(failed.status, 3);
  EXPECT_EQ(words_for(failed), "failed with status 3");
  const ChildEnd killed = run_child(shell("kill -SEGV $$"));
  EXPECT_EQ(killed.kind, ChildEnd::killed);
  EXPECT_EQ(killed.status, SIGSEGV);
  EXPECT_EQ(words_for(killed), "was killed by signal 11 (Segmentation fault)");
  const auto begin = std::chrono::steady_clock::now();
  const ChildEnd late = run_child(shell("exec sleep 60", 0.2));
  EXPECT_EQ(late.kind, ChildEnd::out_of_time);
  EXPECT_FALSE(late.ok());
  EXPECT_EQ(words_for(late, 0.2), "took longer than 0.2 s and was ended");
  EXPECT_GE(seconds_since(begin), 0.2);
  EXPECT_LT(seconds_since(begin), 10);
}

TEST(Child, IgnoresNoTimeLimitItMeets) {
  EXPECT_TRUE(run_child(shell("exit 0", 60)).ok());
  EXPECT_EQ(run_child(shell("exit 5", 60)).status, 5);
}

TEST(Child, WritesWhereItIsTold) {
  const TemporaryFolder folder;
  const fs::path both = folder.path / "both";
  EXPECT_TRUE(run_child({"/bin/sh", {"-c", "echo one; echo two >&2; pwd"}, folder.path, both, both}).ok());
  EXPECT_EQ(trimmed(text_of_file(both)), "one\ntwo\n" + fs::canonical(folder.path).string());
  EXPECT_EQ(text_of_file(folder.path / "none"), "");
}

TEST(Child, ThatIsNotThereSaysSo) {
  const ChildEnd end = run_child({"/nowhere/program", {}, {}, {}, {}});
  EXPECT_EQ(end.status, not_started);
  EXPECT_EQ(words_for(end), "could not be started");
}

TEST(Child, IsInterrupted) {
  std::jthread other([] {
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
    interrupt_children();
  });
  const auto begin = std::chrono::steady_clock::now();
  const ChildEnd end = run_child(shell("exec sleep 60"));
  EXPECT_EQ(end.kind, ChildEnd::killed);
  EXPECT_EQ(end.status, SIGTERM);
  EXPECT_LT(seconds_since(begin), 30);
}

TEST(Child, AreAllInterruptedHoweverMany) {
  constexpr int count = 200;
  std::atomic<int> ended = 0, terminated = 0;
  const auto begin = std::chrono::steady_clock::now();
  {
    std::vector<std::jthread> others;
    for (int i = 0; i < count; ++i)
      others.emplace_back([&] {
        const ChildEnd end = run_child(shell("exec sleep 20"));
        terminated += end.kind == ChildEnd::killed && end.status == SIGTERM;
        ++ended;
      });
    std::this_thread::sleep_for(std::chrono::milliseconds(500));
    interrupt_children();  // some have not been started yet
    while (ended < count && seconds_since(begin) < 19) {
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
      interrupt_children();
    }
  }
  EXPECT_EQ(terminated, count);
}

TEST(Child, UsesProcessorTimeThatIsCounted) {
  const ChildEnd end = run_child(shell("i=0; while [ $i -lt 100000 ]; do i=$((i+1)); done"));
  EXPECT_GT(end.seconds, 0.001);
  EXPECT_LT(end.seconds, 60);
}

TEST(TemporaryFolder, IsGoneAfterwards) {
  fs::path path;
  {
    const TemporaryFolder folder;
    path = folder.path;
    std::ofstream(path / "file") << "text";
    EXPECT_EQ(text_of_file(path / "file"), "text");
  }
  EXPECT_FALSE(fs::exists(path));
}

std::size_t folders_in(const fs::path& place) {
  return static_cast<std::size_t>(
      std::count_if(fs::directory_iterator(place), {}, [](const auto& entry) { return entry.is_directory(); }));
}

class Temporary : public testing::Test {
 protected:
  void SetUp() override { setenv("TMPDIR", place_.path.c_str(), 1); }
  void TearDown() override { unsetenv("TMPDIR"); }
  TemporaryFolder place_;
};

TEST_F(Temporary, FoldersOfTheKilledAreClearedAndThoseOfTheLivingAreNot) {
  fs::create_directory(place_.path / "springproof-report");
  const TemporaryFolder living;
  std::ofstream(living.path / "file") << "text";
  const pid_t killed = fork();
  if (killed == 0) {
    const TemporaryFolder folder;
    std::ofstream(folder.path / "file") << "text";
    raise(SIGKILL);
  }
  waitpid(killed, nullptr, 0);
  fs::create_directory(place_.path / ".springproof-aBcDeF");  // of one that was killed before it had a name
  EXPECT_EQ(folders_in(place_.path), 4u);
  remove_orphans();
  EXPECT_EQ(folders_in(place_.path), 2u);
  EXPECT_EQ(text_of_file(living.path / "file"), "text");
  EXPECT_TRUE(fs::exists(place_.path / "springproof-report"));
}

TEST_F(Temporary, FoldersOfOthersStayWhateverTheirNames) {
  const char* const full[] = {".springproof-notes", ".springproof-photos", "springproof-temporary-copy",
                              "springproof-temporary-17-abcdef", "springproof-temporary-17-abcdefg"};
  for (const char* name : full) {
    fs::create_directory(place_.path / name);
    std::ofstream(place_.path / name / "mine") << "text";
  }
  fs::create_directory(place_.path / ".springproof-empty-too");
  std::ofstream(place_.path / "springproof-temporary-17-ghijkl") << "a file";
  fs::create_directory_symlink(place_.path / ".springproof-notes", place_.path / "springproof-temporary-17-mnopqr");
  remove_orphans();
  for (const char* name : full) EXPECT_EQ(text_of_file(place_.path / name / "mine"), "text");
  for (const char* name :
       {".springproof-empty-too", "springproof-temporary-17-ghijkl", "springproof-temporary-17-mnopqr"})
    EXPECT_TRUE(fs::exists(place_.path / name)) << name;
}

TEST_F(Temporary, APlaceThatIsNotThereIsNamed) {
  setenv("TMPDIR", "/nowhere/at/all", 1);
  try {
    const TemporaryFolder folder;
    FAIL() << "made";
  } catch (const NoRoom& e) {
    EXPECT_EQ(std::string(e.what()).rfind("TMPDIR: cannot write /nowhere/at/all", 0), 0u) << e.what();
  }
}

}  // namespace
}  // namespace springproof::child_test
