// The measures that a case can request, and the rows of results that they produce.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "problem/region.h"

namespace springproof {

struct Experiment;

/// How the values of a measure are judged.
enum class MeasureKind {
  value,      ///< of one solution, judged by its difference from the reference's
  distance,   ///< from the reference: the best is 0
  deviation,  ///< from a solution in closed form: the best is 0
};

/// A measure.  A new one is a new row of measure_table() and the function that computes it (comparisons/judge/).
struct Measure {
  std::string name;  ///< as written in [compare] measures
  MeasureKind kind;
  std::vector<std::pair<std::string, std::string>> units;  ///< by row name, or its beginning before a dot
  std::string what;                                        ///< for `springproof list`
  std::string title, meaning;                              ///< for the report; if empty, the name and no explanation
  /// Names of its rows in results.csv, [[expect]] and [[published]], where they differ from its own name.
  std::vector<std::string> (*rows)(const Experiment&) = nullptr;
};

const std::vector<Measure>& measure_table();

/// What the measure `motion` measures of one model in time: HistoryRecord::measured, and the row "motion.NAME".
struct MotionMeasure {
  std::string name;      ///< "period"
  std::string heading;   ///< of a column of the report
  bool of_probe = true;  ///< of the displacement of the first probe, so that finite elements in time have it too
};
const std::vector<MotionMeasure>& motion_measures();

/// The measure that produces the row of this name, e.g. `reaction` for force.x_min.z; nullptr: none.
const Measure* measure_of(const std::string& row);

/// "volume_change", "mean_stress", "pressure", "displacement" or "energy" of a row of a region; of others "".
std::string quantity_of_region(const std::string& row);

/// "interface.REGION.OTHER.force", of numbers in Mesh::materials.
std::string interface_of(const std::vector<MaterialRegion>& regions, int region, int other);

/// "m", "Pa", "N", "N m", "J", "J/m2", "1/m" or "1".
std::string unit_of(const std::string& row);

/// True if the row is a distance from the reference, whose best value is 0.
bool is_distance(const std::string& row);

/// True if the row is a deviation from a solution in closed form: line.strain.xx and the like, but no order.
bool is_deviation(const std::string& row);

/// Whether a row belongs to one of these measures.
bool wanted(const std::string& row, const std::vector<std::string>& measures);

/// Names allowed in [compare] measures.
std::vector<std::string> measure_names();

/// Names of the rows that a measure gives for an experiment.  `mean_displacement` and `turn` have rows for each patch
/// of the body, known only from its mesh; here those for the patches named by loads and [[patch]].
std::vector<std::string> rows_of_measure(const std::string& measure, const Experiment& experiment);

/// Relative displacement [m] along x that the loads prescribe between x_min and x_max; empty: they do not.
std::optional<double> elongation_along_x(const Experiment& experiment);

/// Patches on which a load prescribes displacement, in the file's order, each once.
std::vector<std::string> supported_patches(const Experiment& experiment);

/// The supported patches that are moved: their prescribed displacement is not zero everywhere.
std::vector<std::string> moved_patches(const Experiment& experiment);

/// The patch of a row of mean_displacement or turn; empty for other rows.
std::string patch_of_row(const std::string& row);

}  // namespace springproof
