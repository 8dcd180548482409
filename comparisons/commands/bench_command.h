// The subcommand that measures what things cost.
#pragma once

namespace CLI {
class App;
}

namespace springproof {

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

}  // namespace springproof
