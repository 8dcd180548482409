// Programs that are started once and fork for every run.
#include "problem/processes/fork_server.h"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <fstream>
#include <functional>
#include <thread>

namespace springproof::fork_server_test {
namespace {

namespace fs = std::filesystem;

const fs::path program = fs::path(SPRINGPROOF_BINARY_DIR) / "forking_program";

struct Processes {
  int server = 0, own = 0;
};

/// What the program wrote.
Processes processes_in(const fs::path& file) {
  Processes p;
  std::ifstream(file) >> p.server >> p.own;
  return p;
}

bool within(double seconds, const std::function<bool()>& happens) {
  for (int i = 0; i < 100 * seconds; ++i) {
    if (happens()) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  return happens();
}

bool lives(pid_t process) { return kill(process, 0) == 0; }

struct ForkServer : ::testing::Test {
  TemporaryFolder folder;
  int runs = 0;

  ChildEnd run(const std::vector<std::string>& arguments, Processes* processes = nullptr) {
    const fs::path output = folder.path / std::to_string(runs++);
    const ChildEnd end = run_forked(program, arguments, output, folder.path / "errors");
    if (processes) *processes = processes_in(output);
    return end;
  }
};

TEST_F(ForkServer, StartsTheProgramOnce) {
  Processes first, second;
  EXPECT_TRUE(run({"exit", "0"}, &first).ok());
  EXPECT_TRUE(run({"exit", "0"}, &second).ok());
  EXPECT_EQ(first.server, second.server);
  EXPECT_NE(first.own, second.own);
  EXPECT_NE(first.server, getpid());
}

TEST_F(ForkServer, SaysHowTheRunEndedAndGoesOn) {
  Processes before, after;
  EXPECT_EQ(run({"exit", "3"}, &before).status, 3);
  const ChildEnd crash = run({"crash"});
  EXPECT_EQ(crash.kind, ChildEnd::killed);
  EXPECT_EQ(crash.status, SIGSEGV);
  EXPECT_TRUE(run({"exit", "0"}, &after).ok());
  EXPECT_EQ(before.server, after.server);
}

TEST_F(ForkServer, SaysThatThereIsNoSuchProgram) {
  EXPECT_EQ(run_forked(folder.path / "none", {"exit"}, folder.path / "output", folder.path / "errors").status,
            not_started);
}

TEST_F(ForkServer, AnInterruptEndsTheRun) {
  const fs::path output = folder.path / "output";
  ChildEnd end;
  std::thread running([&] { end = run_forked(program, {"sleep"}, output, folder.path / "errors"); });
  EXPECT_TRUE(within(20, [&] { return processes_in(output).own > 0; }));
  interrupt_children();
  running.join();
  EXPECT_EQ(end.kind, ChildEnd::killed);
  EXPECT_EQ(end.status, SIGTERM);
  EXPECT_TRUE(within(20, [&] { return !lives(processes_in(output).own); }));
  EXPECT_TRUE(run({"exit", "0"}).ok());
}

TEST_F(ForkServer, NothingOutlivesAKilledCaller) {
  const fs::path output = folder.path / "output";
  const std::string errors = folder.path / "errors";
  const pid_t caller = fork();
  if (caller == 0) {
    execl(program.c_str(), program.c_str(), "call", output.c_str(), errors.c_str(), nullptr);
    _exit(not_started);
  }
  ASSERT_TRUE(within(20, [&] { return processes_in(output).own > 0; }));
  const Processes left = processes_in(output);
  ASSERT_TRUE(lives(left.server) && lives(left.own));
  kill(caller, SIGKILL);
  waitpid(caller, nullptr, 0);
  EXPECT_TRUE(within(20, [&] { return !lives(left.server) && !lives(left.own); }));
}

}  // namespace
}  // namespace springproof::fork_server_test
