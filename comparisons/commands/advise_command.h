// The subcommand `springproof advise`.
#pragma once

#include <filesystem>
#include <string>

#include "comparisons/advise/advice.h"

namespace CLI {
class App;
}

namespace springproof {

/// `springproof advise CASE`.
class AdviseCommand {
 public:
  void add_options(CLI::App& command);
  /// @return 0: a model reaches the error within the budget; 1: none does; with --check 0 if nine of ten predictions
  ///   are hits; with --measure-held-out 130 if interrupted.
  /// @throws InputError for unusable input.
  int run() const;

 private:
  Forecast forecast() const;
  int check() const;

  std::string case_, poisson_ratios_, check_name_;
  bool check_ = false, json_ = false;
  double pilot_cells_ = 1500;
  Wish wish_;
  std::filesystem::path measure_held_out_;
};

}  // namespace springproof
