// Calibration of the reference's stated uncertainties against values that are exact, or known far more accurately.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "comparisons/results/records.h"

namespace springproof {

/// A quantity of one element of [reference], with its known value.
struct KnownQuantity {
  std::string case_name;
  double poisson_ratio = 0;
  std::string element;  ///< "q2", "p2", ...
  std::string measure;
  std::string unit;
  std::string kind;  ///< of reference (calibration_shares())
  double known = 0;
  double known_uncertainty = 0;  ///< of the known value itself; 0: exact
  std::string where;             ///< source of the known value: "Lame, closed form", "3 times finer"
  double value = 0;              ///< the reference's
  double uncertainty = 0;        ///< as stated
  std::string note;

  double error() const;  ///< |value - known|
  bool inside() const { return error() <= uncertainty; }
};

/// Those of the records that the table `known.csv` beside the case's file lists; none without that table.
/// Lines: case,poisson_ratio,element,measure,value,uncertainty,where.  Frequencies are measures "frequency.1", ...
/// [Hz]. Left out are values whose own uncertainty exceeds a quarter of both the stated uncertainty and the error.
/// @throws InputError with file and line for a line that cannot be read.
std::vector<KnownQuantity> known_quantities(const Experiment& experiment, const std::vector<ReferenceRecord>& records);

/// The same for the references of a case at rest, and those in time beside its models in motion.
std::vector<KnownQuantity> known_quantities(const CaseResult& result);

/// How many lie within their stated uncertainty, and how wide that is.
struct CalibrationShare {
  std::string kind;  ///< of reference; "all"
  int quantities = 0, inside = 0;
  double median_ratio = 0;  ///< of |error| / uncertainty
  double largest_ratio = 0;
};

/// One per kind that occurs, then "all"; nothing if there is no quantity.  Kinds: "frequencies", "in motion", "finite
/// strain", "near-incompressible" (nu of 0.45 and more), "bodies in files" (surfaces and solids: tetrahedra),
/// "hexahedra", "tetrahedra"; the first that holds.
std::vector<CalibrationShare> calibration_shares(const std::vector<KnownQuantity>& quantities);

/// {"shares": [...], "quantities": [...]} (docs/results.md); null if there is no quantity.
nlohmann::json calibration_json(const std::vector<KnownQuantity>& quantities);

/// The shares as a table, and each quantity outside; empty if there is no quantity.
std::string calibration_table(const std::vector<KnownQuantity>& quantities);

}  // namespace springproof
