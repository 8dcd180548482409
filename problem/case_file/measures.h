// The measures a case can ask for, and the rows they give.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace springproof {

struct Experiment;

/// What a number of a measure is.
enum class MeasureKind {
  value,      ///< of one solution, as good as its difference from the reference's
  distance,   ///< from the reference: the best is 0
  deviation,  ///< from a solution in closed form: the best is 0
};

/// A measure.  A new one is a new row of measure_table() and the function that computes it (comparisons/judge/).
struct Measure {
  std::string name;  ///< as [compare] measures writes it
  MeasureKind kind;
  std::vector<std::pair<std::string, std::string>> units;  ///< of rows of this name, or that begin with it and a dot
  std::string what;                                        ///< for `springproof list`
  std::string title, meaning;                              ///< for the report; empty: the name, nothing
  /// Names of its rows in results.csv, [[expect]] and [[published]], where they differ from its own name.
  std::vector<std::string> (*rows)(const Experiment&) = nullptr;
};

const std::vector<Measure>& measure_table();

/// The measure that gives a row of this name, e.g. `reaction` gives force.x_min.z; nullptr: none.
const Measure* measure_of(const std::string& row);

/// "m", "Pa", "N", "N m" or "1".
std::string unit_of(const std::string& row);

/// True if the row is a distance from the reference, whose best value is 0.
bool is_distance(const std::string& row);

/// True if the row is a deviation from a solution in closed form: line.strain.xx and the like, but no order.
bool is_deviation(const std::string& row);

/// Whether a row belongs to one of these measures.
bool wanted(const std::string& row, const std::vector<std::string>& measures);

/// Names allowed in [compare] measures.
std::vector<std::string> measure_names();

/// Names of the rows that a measure gives for an experiment.  Those of `mean_displacement` are for each patch of the
/// body, which only its mesh knows; here those that loads and [[patch]] name.
std::vector<std::string> rows_of_measure(const std::string& measure, const Experiment& experiment);

/// Relative displacement [m] along x that the loads prescribe between x_min and x_max; empty: they do not.
std::optional<double> elongation_along_x(const Experiment& experiment);

/// Patches on which a load prescribes displacement, in the file's order, each once.
std::vector<std::string> supported_patches(const Experiment& experiment);

/// Those of them that are moved: the displacement prescribed there is not zero everywhere.
std::vector<std::string> moved_patches(const Experiment& experiment);

/// The patch that a row of mean_displacement is of; empty: it is no such row.
std::string patch_of_mean_displacement(const std::string& row);

}  // namespace springproof
