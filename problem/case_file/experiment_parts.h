// The readers of the longer parts of a case file, one .cpp each.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "problem/case_file/experiment.h"
#include "problem/case_file/toml_reader.h"

namespace springproof {

/// One [[load]]: one load for each patch named by `on`, or a single one without `on`.
std::vector<Load> read_load(const TomlValue& value);

/// [material.relaxation]; [dynamics] must have been read.
void read_relaxation(const TomlTable& document, Experiment& experiment);

/// The [[mass]] tables, and their weight among the loads, which must have been read.
void read_masses(const TomlTable& document, Experiment& experiment);

/// The [[patch]] tables, in order.
std::vector<PatchRule> read_patch_rules(const TomlTable& document);

/// Two moduli of a table, each a number or a list; a single number is kept fixed while the other runs through its list,
/// and two lists of the same length are read in pairs.
/// @param density [kg/m^3] where the table has none
std::vector<IsotropicMaterial> read_moduli(const TomlTable& table, double density);

/// The [[region]] tables, in order; the materials must have been read.
std::vector<MaterialRegion> read_regions(const TomlTable& document, const Experiment& experiment);

/// The one list among their moduli and those of [material].
/// @throws InputError at a second list, naming both.
ListedModuli read_listed(const TomlTable& document, const Experiment& experiment);

/// @throws InputError at what is not computed of a body with regions; all else must have been read.
void check_regions(const Experiment& experiment);
/// @throws InputError at [material.relaxation] beside an exact solution
void check_relaxation(const Experiment& experiment);

/// A box by two corners.
PatchRule::Box read_box(const TomlValue& value);
/// One side of a plane.
PatchRule::Beyond read_beyond(const TomlValue& value);
/// What is near to a point.
PatchRule::Near read_near(const TomlValue& value);

/// A name that none of the others has.
/// @param kind of thing, " probe"
template <class Named>
std::string read_own_name(const TomlValue& value, const std::vector<Named>& others, const std::string& kind = "") {
  std::string name = as_text(value);
  for (const Named& other : others)
    if (other.name == name) refuse(value, "'" + name + "' is the name of another" + kind, "a name of its own");
  return name;
}

/// A list of elements, each once.
std::vector<std::string> read_elements(const TomlValue& value, const std::vector<std::string>& allowed);

/// Refuses a label, which also serves as the name of files, that is taken by one of the others or by finite elements.
void refuse_label(const TomlValue& item, const std::string& label, const std::vector<ModelChoice>& others);

/// The Poisson's ratio of a material of the case: its own value, so that results are found by exact comparison.
double read_poisson_ratio(const TomlValue& value, const Experiment& experiment);

/// The [[external]] tables, as models; the rest of the models and [fracture] must have been read.
void read_externals(const TomlTable& document, Experiment& experiment);

/// [line]; loads, materials and kinematics must have been read.
void read_line(const TomlTable& document, Experiment& experiment);

/// [dynamics]; the kinematics must have been read.
void read_dynamics(const TomlTable& document, Experiment& experiment);

/// [fracture]; loads and kinematics must have been read.  A drying body has no finite element reference.
void read_fracture(const TomlTable& document, Experiment& experiment);

/// Sets the solution of the loads with the field "kelvin".
/// @throws InputError at such a load if the case has no such solution.
void settle_kelvin(Experiment& experiment);

/// Checks the loads against each other, before the body is meshed; loads, kinematics and models must have been read.
/// @throws InputError at a load that cannot be applied, or contradicts another one.
void check_loads(const Experiment& experiment);

/// Checks that the reference's grid can be halved twice and fits into this machine's memory; `value` is [reference].
void check_reference_cells(const TomlValue& value, const Experiment& experiment);

/// [compare], and [[expect]] and [[published]], which are checked against it.  Body, materials, loads, probes, section
/// and reference of the experiment must have been read.
void read_compare(const TomlTable& document, Experiment& experiment);
void read_expectations(const TomlTable& document, Experiment& experiment);
void read_published(const TomlTable& document, Experiment& experiment);

/// The name of a row that the case's measures give.
std::string read_row_name(const TomlValue& value, const Experiment& experiment);

/// A number in the unit of a measure.
double as_number_of(const std::string& measure, TomlValue value, const Range& range = any_number);

/// [measured], and [[load_case]] and [[input]] beside it; all but what is expected and printed must have been read.
void read_measured(const TomlTable& document, Experiment& experiment);

/// @throws InputError at an [[identify]] that seeks what cannot be sought (identification.h); all else must have been
/// read.
void check_identifications(const Experiment& experiment);

/// A case file's content, which need not be what the file of `experiment` holds; file and text are those of it.
/// @throws InputError as read_experiment
Experiment read_document(const toml::table& document, const Experiment& experiment);

/// One line of a history, a CSV file of what was measured in time.
struct HistorySample {
  double time = 0;          ///< [s]
  double value = 0, u = 0;  ///< with its standard uncertainty, in the unit of the columns
};

inline constexpr std::size_t most_samples = 20;  ///< of a history: each is an equilibrium of its own

/// Columns time_s, value_UNIT and u_UNIT, of a quantity without a unit value and u.
/// @param unit "mm"; "1": none
/// @throws InputError with file and line at other columns, a field that is empty or no number, times that do not
/// ascend from above 0, an uncertainty of 0 or below, no sample, or more than most_samples
std::vector<HistorySample> read_history(const std::filesystem::path& file, const std::string& unit);

}  // namespace springproof
