#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <string>
#include <vector>

#include "comparisons/calculix/cross_check.h"
#include "comparisons/commands/commands.h"
#include "comparisons/sweep/find_cases.h"
#include "problem/system/number_checks.h"

namespace springproof {
namespace {

/// `springproof cross-check CASE`.
class CrossCheckCommand {
 public:
  void add_options(CLI::App& command);
  /// @return the worst CrossCheckStatus of the cases.
  int run() const;

 private:
  std::vector<std::string> cases_;
  CrossCheckOptions options_;
};

void CrossCheckCommand::add_options(CLI::App& command) {
  command.add_option("CASE", cases_, "case files (*.toml), folders of them, or built-in names (springproof list)")
      ->required();
  command.add_option("--poisson-ratio", options_.poisson_ratio, "one of the case's (default: all)");
  command
      .add_option_function<std::vector<int>>(
          "--cells",
          [this](const std::vector<int>& n) {
            options_.cells = {n[0], n[1], n[2]};
          },
          "CalculiX' finest grid, divisible by 4 (default: about 1728 elements, 512 at finite strain)")
      ->expected(3)
      ->check(CLI::Range(4, 1000));
  command
      .add_option("--modes", options_.modes,
                  "natural frequencies compared, instead of what the loads do (default: none)")
      ->check(CLI::Range(1, 100));
  command.add_option("--time-limit", options_.time_limit, "per run of ccx [s]")
      ->check(positive())
      ->capture_default_str();
  command.footer(
      "Exit status: 0 every quantity agrees within the two uncertainties, 1 one does not or has no answer, 2 "
      "the input is\n"
      "unusable, 3 ccx (apt-get install calculix-ccx) or springproof-fem is not here, 130 interrupted.");
}

int CrossCheckCommand::run() const {
  int worst = 0;
  for (const auto& file : find_cases(cases_)) {
    const int status = cross_check(file, options_);
    if (status > some_differ) return status;
    worst = std::max(worst, status);
  }
  return worst;
}

}  // namespace

RunCommand cross_check_command(CLI::App& parser) { return made<CrossCheckCommand>(parser); }

}  // namespace springproof
