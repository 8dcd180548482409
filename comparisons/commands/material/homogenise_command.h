// The subcommand that computes the effective moduli of the infinite periodic network of a model, its nodes relaxed.
#pragma once

#include <optional>
#include <string>

#include "problem/case_file/experiment.h"

namespace CLI {
class App;
}

namespace springproof {

class HomogeniseCommand {
 public:
  void add_options(CLI::App& command);

  /// Prints the table (or JSON).  @return 0.
  /// @throws InputError if the moduli or the model cannot be used; std::runtime_error if the network is unstable.
  int run() const;

 private:
  Moduli moduli_;
  std::optional<int> nodes_;
  ModelChoice choice_{"msm_random", {}, "msm_random", {}};
  bool json_ = false;
};

}  // namespace springproof
