// The subcommand that redoes the figures and tables of a paper.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "comparisons/sweep/suite.h"

namespace CLI {
class App;
}

namespace springproof {

/// `springproof reproduce PAPER`.
class ReproduceCommand {
 public:
  void add_options(CLI::App& command);

  /// @return as `springproof compare`; with --from 0.
  /// @throws InputError if there is no such paper or figure, or --from holds results of none of its figures.
  int run();

 private:
  std::string paper_;
  std::vector<std::string> figures_;
  std::vector<std::filesystem::path> from_;
  SuiteOptions options_;
};

}  // namespace springproof
