// The subcommand that compares two results folders.
#pragma once

#include <filesystem>

namespace CLI {
class App;
}

namespace springproof {

/// `springproof diff FIRST SECOND`.
class DiffCommand {
 public:
  void add_options(CLI::App& command);
  /// @return 0: no number differs by more than the tolerance, and both have the same ones; 1: else.
  /// @throws InputError if a folder holds no results.
  int run() const;

 private:
  std::filesystem::path first_, second_;
  double tolerance_ = 1e-9;
};

}  // namespace springproof
