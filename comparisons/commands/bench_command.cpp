#include <CLI/CLI.hpp>
#include <csignal>

#include "comparisons/commands/commands.h"
#include "problem/processes/child.h"

namespace springproof {
namespace {

/// `springproof bench ...`: its options are parsed by the program that it starts.
class BenchCommand {
 public:
  void add_options(CLI::App& command);
  /// @return the program's status.
  /// @throws std::runtime_error if it is not there or is killed.
  int run() const;

 private:
  const CLI::App* command_ = nullptr;
};

void BenchCommand::add_options(CLI::App& command) {
  command.set_help_flag();
  command.prefix_command();
  command_ = &command;
}

int BenchCommand::run() const {
  const std::filesystem::path program = find_program("springproof-bench", "SPRINGPROOF_BENCH_PROGRAM");
  if (program.empty())
    throw std::runtime_error(
        "the program springproof-bench is neither beside this one nor named by SPRINGPROOF_BENCH_PROGRAM");
  for (const int signal : {SIGINT, SIGTERM}) std::signal(signal, [](int) { interrupt_children(); });
  const ChildEnd end = run_child({program, command_->remaining(), {}, {}, {}});
  if (end.kind == ChildEnd::killed) throw std::runtime_error("springproof-bench " + words_for(end));
  return end.status;
}

}  // namespace

RunCommand bench_command(CLI::App& parser) { return made<BenchCommand>(parser); }

}  // namespace springproof
