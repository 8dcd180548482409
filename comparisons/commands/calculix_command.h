// The subcommands that use CalculiX: export and cross-check.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "comparisons/calculix/cross_check.h"

namespace CLI {
class App;
}

namespace springproof {

/// `springproof export CASE --to calculix`: the case as an input deck.
class ExportCommand {
 public:
  void add_options(CLI::App& command);
  /// @return 0.  @throws InputError, std::runtime_error if the file cannot be written.
  int run() const;

 private:
  std::string case_, to_, out_;
  std::optional<double> poisson_ratio_;
  std::vector<int> cells_;
};

/// `springproof cross-check CASE`.
class CrossCheckCommand {
 public:
  void add_options(CLI::App& command);
  /// @return the worst CrossCheckStatus of the cases.
  int run() const;

 private:
  std::vector<std::string> cases_;
  std::vector<int> cells_;
  CrossCheckOptions options_;
};

}  // namespace springproof
