// The subcommand that runs cases.
#pragma once

#include <string>
#include <vector>

#include "comparisons/sweep/suite.h"

namespace CLI {
class App;
}

namespace springproof {

/// `springproof compare CASE...`.
class CompareCommand {
 public:
  void add_options(CLI::App& command);
  /// @return as compare().
  int run() const;

 private:
  std::vector<std::string> names_;
  SuiteOptions options_;
};

}  // namespace springproof
