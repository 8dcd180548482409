// The subcommand `springproof cross-check`, which uses CalculiX.
#pragma once

#include <string>
#include <vector>

#include "comparisons/calculix/cross_check.h"

namespace CLI {
class App;
}

namespace springproof {

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
