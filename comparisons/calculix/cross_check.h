// Cross-check: solves the same case with CalculiX and with our finite element reference, each with its uncertainty.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "comparisons/judge/reference_value.h"
#include "problem/case_file/experiment.h"

namespace springproof {

struct CrossCheckOptions {
  std::optional<double> poisson_ratio;  ///< empty: every one of the case
  Cells cells = {0, 0, 0};              ///< finest of CalculiX' three grids; {0,0,0} = chosen
  int modes = 0;                        ///< natural frequencies compared, instead of what the loads do; 0: none
  double time_limit = 600;              ///< per run of ccx [s]
};

/// One quantity by both programs.
struct SecondOpinion {
  std::string measure;
  std::string unit;
  ReferenceValue calculix, ours;
  double difference = 0;  ///< calculix - ours; for the displacement field its largest size over the nodes
  bool agrees = false;    ///< |difference| is within the sum of both uncertainties
};

/// The verdict from two values with uncertainty.
/// @param distance of two displacements [m], in place of the difference of their sizes
SecondOpinion second_opinion(const std::string& measure, const ReferenceValue& calculix, const ReferenceValue& ours,
                             std::optional<double> distance = {});

/// The case at one of its settings alone, or at its first.
/// @throws InputError listing those of the case.
Experiment at_wanted(const Experiment& experiment, std::optional<double> setting);

/// Exit statuses of cross_check.
enum CrossCheckStatus { all_agree = 0, some_differ = 1, no_program = 3 };

/// Runs both programs, on three grids each, and prints a table per Poisson's ratio; progress goes to stderr.
/// A program without a result counts as not agreeing.
/// @throws InputError for every error in the input, including a law that CalculiX lacks.
int cross_check(const std::filesystem::path& file, const CrossCheckOptions& options);

}  // namespace springproof
