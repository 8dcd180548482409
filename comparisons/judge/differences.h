// How the numbers of two results folders differ.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "comparisons/results/records.h"

namespace springproof {

/// What a folder that `springproof compare` wrote holds.
struct ResultsFolder {
  std::string version, generated;             ///< of the program; when
  std::vector<Row> rows;                      ///< case_name: as in `cases`
  std::vector<std::string> cases;             ///< in the order of the report, with their folders: "golec_2019/bending"
  std::map<std::string, std::string> listed;  ///< of cases that list a modulus of a region: "Poisson's ratio of tumour"
};

/// @throws InputError if FOLDER/results.json is missing or no document of results; the message names file and reason.
ResultsFolder read_results(const std::filesystem::path& folder);

/// @throws InputError that FOLDER/results.json is no document of results, and why.
[[noreturn]] void refuse_results(const std::filesystem::path& folder, const std::string& why);

/// One number that differs.
struct Difference {
  Row row;           ///< of the first folder
  std::string what;  ///< "value", "reference", "reference_uncertainty", or of numbers in two units "unit mm for m"
  double first, second;
  double relative;  ///< |second - first| over the size of the quantity; infinite if only one of the two is a number
  double of_uncertainty;  ///< |second - first| over the larger reference uncertainty of the two rows; NaN: none stated
};

/// A quantity's size is the largest of its two values and, for a component of a vector or tensor, of the other
/// components of the same run: round-off in a component that vanishes is no difference.
struct Differences {
  std::size_t in_both = 0;
  std::vector<Row> only_first, only_second;
  std::vector<Difference> changed;  ///< by more than the tolerance, the largest first
  double largest = 0;               ///< relative, of all that are in both

  bool none() const { return only_first.empty() && only_second.empty() && changed.empty(); }
};

/// Rows belong together if case, kinematics, model, Poisson's ratio, cells and measure are the same; of several that do
/// in one folder, the first with the first of the other.
Differences differences(const ResultsFolder& first, const ResultsFolder& second, double tolerance);

}  // namespace springproof
