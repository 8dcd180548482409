// A program for the tests of run_forked(): does what its first argument says.
#include <sys/types.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <string_view>

#include "problem/processes/fork_server.h"

namespace {

int run(int argc, char** argv) {
  const std::string_view what = argc > 1 ? argv[1] : "";
  std::printf("%d %d\n", static_cast<int>(getppid()), static_cast<int>(getpid()));
  std::fflush(stdout);
  if (what == "exit") return std::atoi(argv[2]);
  if (what == "crash") raise(SIGSEGV);
  if (what == "sleep") sleep(60);
  if (what == "call") springproof::run_forked(argv[0], {"sleep"}, argv[2], argv[3]);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc == 2 && std::string_view(argv[1]) == springproof::fork_server_argument) return springproof::serve_forks(run);
  return run(argc, argv);
}
