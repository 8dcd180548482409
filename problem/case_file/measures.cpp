#include "problem/case_file/measures.h"

#include <algorithm>
#include <set>

#include "problem/case_file/experiment.h"

namespace springproof {
namespace {

using Rows = std::vector<std::string>;
const Rows of_axes = {".x", ".y", ".z"}, of_vector = {".x", ".y", ".z", ".magnitude"},
           of_tensor = {".xx", ".yy", ".zz", ".xy", ".yz", ".xz"},
           of_a_region = {".volume_change",         ".pressure",       ".energy",         ".mean_stress.xx",
                          ".mean_stress.yy",        ".mean_stress.zz", ".mean_stress.xy", ".mean_stress.yz",
                          ".mean_stress.xz",        ".displacement.x", ".displacement.y", ".displacement.z",
                          ".displacement.magnitude"};

/// The names of things, or names, each with each of the endings.
template <class Things>
Rows each(const std::string& beginning, const Things& things, const Rows& endings = {""}) {
  Rows rows;
  for (const auto& thing : things)
    for (const std::string& ending : endings)
      if constexpr (requires { thing.name; })
        rows.push_back(beginning + thing.name + ending);
      else
        rows.push_back(beginning + thing + ending);
  return rows;
}

const std::string mean_displacement = "mean_displacement.", turn = "turn.";

/// Whether the load prescribes a displacement other than zero.
bool moves(const Load& load) {
  if (const auto* p = std::get_if<PrescribedDisplacement>(&load))
    return std::ranges::any_of(p->displacement, [](const auto& u) { return u.value_or(0) != 0; });
  if (const auto* a = std::get_if<PrescribedAffine>(&load)) return !a->gradient.isZero(0) || !a->offset.isZero(0);
  if (const auto* r = std::get_if<PrescribedRotation>(&load)) return r->angle != 0;
  return std::holds_alternative<PrescribedField>(load);
}

/// Patches of the loads for which `does` is true, in the file's order, each once.
std::vector<std::string> patches_of(const Experiment& experiment, bool (*does)(const Load&)) {
  std::vector<std::string> patches;
  for (const Load& load : experiment.loads) {
    if (!does(load)) continue;
    const std::string& patch = *patch_of(load);
    if (std::ranges::find(patches, patch) == patches.end()) patches.push_back(patch);
  }
  return patches;
}

Rows reaction_rows(const Experiment& experiment) {
  Rows kinds;
  for (const std::string& patch : supported_patches(experiment))
    kinds.insert(kinds.end(), {"force." + patch, "torque." + patch});
  return each("", kinds, of_vector);
}

/// Patches named in the case file.
std::set<std::string> named_patches(const Experiment& experiment) {
  std::set<std::string> patches;
  for (const Load& load : experiment.loads)
    if (const std::string* on = patch_of(load)) patches.insert(*on);
  for (const PatchRule& rule : experiment.patches) patches.insert(rule.name);
  return patches;
}

/// What is measured of a region, with its unit.
const std::vector<std::pair<std::string, std::string>> of_region = {
    {".volume_change", "1"}, {".mean_stress", "Pa"}, {".pressure", "Pa"}, {".displacement", "m"}, {".energy", "J"}};

Rows interface_rows(const Experiment& experiment) {
  Rows interfaces;
  for (std::size_t r = 0; r < experiment.regions.size(); ++r)
    for (std::size_t other = 0; other <= r; ++other)
      interfaces.push_back(interface_of(experiment.regions, static_cast<int>(r + 1), static_cast<int>(other)));
  return each("", interfaces, of_vector);
}

Rows line_rows(const Experiment& experiment) {
  Rows endings = of_tensor;
  endings.emplace_back(".all");
  if (experiment.body.resolutions() > 1) endings.emplace_back(".order");
  return each("line.", Rows{"strain", "stress"}, endings);
}

/// Length of `name` if it equals the row's name or is its prefix before a dot; otherwise 0.
std::size_t common(const std::string& row, const std::string& name) {
  return row == name || row.starts_with(name + '.') ? name.size() : 0;
}

}  // namespace

const std::vector<MotionMeasure>& motion_measures() {
  static const std::vector<MotionMeasure> all = {
      {"period", "period [s]"},
      {"amplitude", "amplitude [m]"},
      {"arrival", "arrival [s]"},
      {"damping_ratio", "share of critical damping"},
      {"contact_time", "time of the first contact [s]", false},
      {"restitution", "restitution", false},
      {"energy_drift", "change of energy", false},
      {"momentum_drift", "of momentum", false},
      {"angular_momentum_drift", "of angular momentum", false},
      {"inertia_excess", "excess of the moments of inertia", false},
  };
  return all;
}

const std::vector<Measure>& measure_table() {
  using enum MeasureKind;
  // clang-format off
  static const std::vector<Measure> table = {
    {"displacement_error", distance, {{"displacement_error", "1"}}, "relative L2 difference to FEM over the nodes",
     "displacement error", "|u − u_fem| in the L2 norm over the body, divided by |u_fem|"},
    {"displacement_error_max", distance, {{"displacement_error_max", "1"}}, "largest difference over the largest displacement",
     "largest displacement error", "largest |u − u_fem| over the nodes, divided by the largest |u_fem|"},
    {"displacement_error_order", value, {{"displacement_error_order", "1"}},
     "observed order of the displacement error, where the exact solution is known", "observed order of the displacement error", ""},
    {"promised_error", value, {{"promised_error", "1"}}, "of cut cells: relative error of the displacement by their stresses alone",
     "promised error", "energy of σ* − σ over that of σ, σ* the stress recovered at the nodes, times what that falls short by on lattices before: what the displacement error should be"},
    {"section_distance", distance, {{"section_distance", "m"}}, "mean distance to FEM on the plane [section] [m]",
     "mean distance on the section", "mean |u − u_fem| over the nodes of the section"},
    {"section_axis_distance", distance, {{"section_axis_distance", "m"}}, "the same per coordinate in the plane, (|dx| + |dy|)/2 [m]",
     "mean distance per coordinate on the section", "mean |u − u_fem| per coordinate in the section, (|Δx| + |Δy|)/2"},
    {"volume_change", value, {{"volume_change", "1"}}, "(V' - V)/V of the displaced body",
     "volume change", "(V′ − V) / V of the deformed cells, exact; errors in percentage points"},
    {"volume_change_magnitude", value, {{"volume_change_magnitude", "1"}}, "its absolute value, the papers' e",
     "size of the volume change", "|V′ − V| / V, as the paper prints it; errors in percentage points"},
    {"volume_change_first_order", value, {{"volume_change_first_order", "1"}}, "integral of div u over V",
     "volume change, first order", "integral of div u over V; errors in percentage points"},
    {"stable_load", value, {{"stable_load", "1"}}, "share of the load up to which a lattice has a stable equilibrium; also of models without a result",
     "share of the load that is borne", "the largest share of the load at which a stable equilibrium was found; 1: all of it"},
    {"reaction", value, {{"force", "N"}, {"torque", "N m"}}, "force.PATCH.x|y|z|magnitude [N], torque.PATCH... [N m] about the centroid of the patch at rest, where displacement is prescribed",
     "", "", reaction_rows},
    {"reaction_error", distance, {{"reaction_error", "1"}},
     "largest relative error of force or torque on a moved support; always measured where one moves",
     "reaction error of moved supports",
     "|F − F_fem| / |F_fem| or |T − T_fem| / |T_fem|, the largest over the supports that are moved; those that vanish are left out"},
    {"mean_displacement", value, {{"mean_displacement", "m"}},
     "mean_displacement.PATCH.x|y|z|magnitude, area-weighted mean over a patch [m]", "", "", [](const Experiment& e) { return each(mean_displacement, named_patches(e), of_vector); }},
    {"turn", value, {{"turn", "deg"}}, "turn.PATCH.x|y|z, rotation of a patch as a whole, about an axis [deg]",
     "", "", [](const Experiment& e) { return each(turn, named_patches(e), of_axes); }},
    {"frequency", value, {{"frequency", "Hz"}}, "frequency.x|y|z, lowest natural frequency of a model whose motion is mostly along that axis [Hz]",
     "", "", [](const Experiment&) { return each("frequency", of_axes); }},
    {"measured", value, {{"measured", "1"}}, "measured.NAME, |E|/u_val of a value of [[measured]]; always judged where there are any",
     "", "", [](const Experiment& e) { return each("measured.", e.measured); }},
    {"probe", value, {{"displacement", "m"}}, "displacement.PROBE.x|y|z|magnitude [m]", "", "", [](const Experiment& e) { return each("displacement.", e.probes, of_vector); }},
    {"stress", value, {{"stress", "Pa"}}, "stress.PROBE.xx|yy|zz|xy|yz|xz [Pa], finite elements and `hybmss_avg` at small strain", "", "", [](const Experiment& e) { return each("stress.", e.probes, of_tensor); }},
    {"stress_error", distance, {{"stress_error", "1"}},
     "stress_error.von_mises|hydrostatic|principal of `hybmss_avg` and, of blocks, finite elements, small strain: relative L2 difference to FEM over the body",
     "stress error", "of von Mises’, the mean normal and the largest principal stress, recovered at nodes: |σ − σ_fem| in the L2 norm over the body, divided by |σ_fem|",
     [](const Experiment&) { return each("stress_error.", Rows{"von_mises", "hydrostatic", "principal"}); }},
    {"stress_peak", value, {{"stress_peak", "Pa"}}, "largest von Mises stress of the same [Pa], where the reference's is not at a singular edge",
     "largest von Mises stress", "where that of FEM has a limit: not at singular edges and corners"},
    {"region", value, {{"region", "1"}}, "region.REGION.volume_change, .mean_stress.xx|yy|zz|xy|yz|xz and .pressure [Pa], .displacement.x|y|z|magnitude [m] in the mean, .energy [J] of a [[region]]",
     "", "", [](const Experiment& e) { return each("region.", e.regions, of_a_region); }},
    {"interface", value, {{"interface", "N"}}, "interface.REGION.OTHER.force.x|y|z|magnitude, force on a region by another, named earlier, or by the `body`'s own material [N]",
     "", "", interface_rows},
    {"motion", value, {{"motion.period", "s"}, {"motion.amplitude", "m"}, {"motion.arrival", "s"}, {"motion.contact_time", "s"}, {"motion", "1"}},
     "of a motion: period [s], amplitude [m], of a pulse arrival [s] of the first probe; of a damped one damping_ratio; on a plane contact_time [s] and restitution; energy_drift, momentum_drift, angular_momentum_drift, inertia_excess of free bodies", "", "", [](const Experiment&) { return each("motion.", motion_measures()); }},
    {"motion_error", distance, {{"motion_error", "1"}},
     "relative L2 difference in time of the probes' displacements to finite elements in time; [reference] in_time",
     "difference in time", "|u − u_fem| of the probes in the L2 norm over time, divided by |u_fem|"},
    {"moduli", value, {{"moduli", "1"}, {"moduli.youngs_modulus", "Pa"}, {"moduli.youngs_modulus_local", "Pa"}, {"moduli.affine_youngs_modulus", "Pa"}},
     "E and nu of a block stretched along x, as the Kot papers measure them", "", "", [](const Experiment&) { return each("moduli.", Rows{"youngs_modulus", "youngs_modulus_local", "poisson_ratio", "poisson_ratio_of_fields", "poisson_ratio_as_printed", "affine_youngs_modulus"}); }},
    {"network", value, {{"network", "1"}, {"network.mean_length", "m"}, {"network.length_deviation", "m"}},
     "nodes, springs, springs per node, spring lengths [m]", "", "", [](const Experiment&) { return each("network.", Rows{"nodes", "springs", "springs_per_node", "mean_length", "length_deviation"}); }},
    {"fracture", value, {{"fracture", "1"}, {"fracture.crack_area_per_volume", "1/m"}, {"fracture.stored", "J"}, {"fracture.released", "J"}, {"fracture.released_per_area", "J/m2"}},
     "cracks of a drying body: shrinkage at the first, area, directions, fragments, energy released", "", "", [](const Experiment&) { return each("fracture.", Rows{"first_shrinkage", "broken", "crack_area_per_volume", "along_4", "along_8", "order_4", "order_8", "fragments", "stored", "released", "released_per_area", "imbalance"}); }},
    {"line", deviation, {{"line", "1"}}, "strain and stress along [line] against Kelvin's solution", "", "", line_rows},
  };
  // clang-format on
  return table;
}

const Measure* measure_of(const std::string& row) {
  for (const Measure& measure : measure_table())
    for (const auto& [name, unit] : measure.units)
      if (common(row, name) > 0) return &measure;
  return nullptr;
}

std::string quantity_of_region(const std::string& row) {
  if (!row.starts_with("region.")) return {};
  std::size_t last = 0;
  std::string found;
  for (const auto& [quantity, unit] : of_region)
    if (const std::size_t at = row.rfind(quantity); at != std::string::npos && at > last) {
      last = at;
      found = quantity.substr(1);
    }
  return found;
}

std::string interface_of(const std::vector<MaterialRegion>& regions, int region, int other) {
  return "interface." + regions[region - 1].name + '.' + (other == 0 ? "body" : regions[other - 1].name) + ".force";
}

std::string unit_of(const std::string& row) {
  for (const auto& [quantity, unit] : of_region)
    if (quantity_of_region(row) == quantity.substr(1)) return unit;
  std::size_t longest = 0;
  std::string found = "1";
  if (const Measure* measure = measure_of(row))
    for (const auto& [name, unit] : measure->units)
      if (common(row, name) > longest) {
        longest = common(row, name);
        found = unit;
      }
  return found;
}

bool is_distance(const std::string& row) {
  const Measure* measure = measure_of(row);
  return measure && measure->kind == MeasureKind::distance;
}

bool is_deviation(const std::string& row) {
  const Measure* measure = measure_of(row);
  return measure && measure->kind == MeasureKind::deviation && !row.ends_with(".order");
}

bool wanted(const std::string& row, const std::vector<std::string>& measures) {
  const Measure* measure = measure_of(row);
  return measure && std::ranges::find(measures, measure->name) != measures.end();
}

std::vector<std::string> measure_names() {
  std::vector<std::string> names;
  for (const Measure& measure : measure_table()) names.push_back(measure.name);
  return names;
}

std::vector<std::string> rows_of_measure(const std::string& name, const Experiment& experiment) {
  for (const Measure& measure : measure_table())
    if (name == measure.name && measure.rows) return measure.rows(experiment);
  return {name};
}

std::optional<double> elongation_along_x(const Experiment& experiment) {
  std::optional<double> low, high;
  for (const Load& load : experiment.loads)
    if (const auto* p = std::get_if<PrescribedDisplacement>(&load)) {
      if (p->on == "x_min") low = p->displacement[0];
      if (p->on == "x_max") high = p->displacement[0];
    }
  if (!low || !high || *low == *high) return {};
  return *high - *low;
}

std::vector<std::string> supported_patches(const Experiment& experiment) {
  return patches_of(experiment, prescribes_displacement);
}

std::vector<std::string> moved_patches(const Experiment& experiment) { return patches_of(experiment, moves); }

std::string patch_of_row(const std::string& row) {
  for (const std::string& measure : {mean_displacement, turn})
    if (row.starts_with(measure)) return row.substr(measure.size(), row.rfind('.') - measure.size());
  return "";
}

}  // namespace springproof
