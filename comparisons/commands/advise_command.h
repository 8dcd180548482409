// The subcommand `springproof advise`.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "comparisons/advise/advice.h"

namespace CLI {
class App;
}

namespace springproof {

/// `springproof advise [CASE]`.
class AdviseCommand {
 public:
  void add_options(CLI::App& command);
  /// @return 0: a model reaches the error within the budget; 1: none does; with --check 0 if nine of ten predictions
  ///   are hits; with --measure 130 if interrupted.
  /// @throws InputError for unusable input.
  int run() const;

 private:
  Forecast of_case() const;
  Forecast of_table() const;
  int check() const;

  std::string case_, poisson_ratios_, check_name_;
  bool check_ = false, json_ = false;
  double youngs_modulus_ = 1e4, density_ = 1000, thickness_ = 1, pilot_cells_ = 1500;
  std::optional<double> slenderness_;
  Loading loading_;
  Wish wish_;
  std::filesystem::path measure_, measure_held_out_;
};

}  // namespace springproof
