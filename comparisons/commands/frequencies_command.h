// The subcommand `springproof frequencies`.
#pragma once

#include <string>
#include <vector>

#include "comparisons/models/frequencies.h"

namespace CLI {
class App;
}

namespace springproof {

/// `springproof frequencies CASE`.
class FrequenciesCommand {
 public:
  void add_options(CLI::App& command);
  /// @return 0, or 1 if the reference or a model has no result; 130 if interrupted.
  int run() const;

 private:
  std::string case_, out_;
  std::vector<double> poisson_ratios_;
  FrequencyOptions options_;
  bool vtu_ = false;
};

}  // namespace springproof
