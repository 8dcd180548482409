#include "comparisons/calculix/cross_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "comparisons/calculix/opinions.h"
#include "comparisons/calculix/run.h"
#include "comparisons/judge/measures.h"
#include "comparisons/models/motion_reference.h"
#include "comparisons/run/prepare.h"
#include "fem_reference/exchange/reference.h"
#include "problem/processes/child.h"
#include "problem/processes/interrupts.h"
#include "problem/system/streams.h"

namespace springproof {
namespace {

constexpr const char* field_measure = "displacement field, peak";
constexpr const char* history_measure = "probes in time, rms";
constexpr const char* same_mesh_measure = "the same, finest mesh";

/// Largest displacement, with the largest uncertainty at a node.
ReferenceValue largest(const ReferenceField& field) {
  return {field.displacement.rowwise().norm().maxCoeff(), field.nodal_uncertainty.maxCoeff(), field.observed_order,
          field.note};
}

/// A row of two displacement fields, of the largest values and uncertainties; it differs by the largest of the
/// differences.
SecondOpinion field_row(const std::string& measure, const ReferenceField& calculix, const ReferenceField& ours) {
  return second_opinion(measure, largest(calculix), largest(ours),
                        (calculix.displacement - ours.displacement).rowwise().norm().maxCoeff());
}

/// The field of the finest grid, certain but for round-off.
ReferenceField as_solved(const Opinion& o) {
  ReferenceField field;
  field.displacement = o.finest;
  field.nodal_uncertainty.setConstant(o.finest.rows(), std::sqrt(3.0) * o.noise);
  return field;
}

/// Root mean square of the displacements of the probes in time [m].
double size_of(const HistoryRecord& history) {
  double squares = 0;
  std::size_t count = 0;
  for (std::size_t i = 0; i < history.names.size(); ++i) {
    if (!history.names[i].starts_with("displacement.")) continue;
    for (const double u : history.values[i]) squares += u * u;
    count += history.values[i].size();
  }
  return std::sqrt(3 * squares / static_cast<double>(count));
}

/// A row of two motions; it differs by the root mean square of their distance.
SecondOpinion history_row(const Opinion& calculix, const Opinion& ours) {
  const auto value = [](const Opinion& o) {
    const double size = size_of(o.history);
    return ReferenceValue{size, o.uncertainty * size, {}, ""};
  };
  return second_opinion(history_measure, value(calculix), value(ours),
                        history_error(calculix.history, ours.history) * size_of(ours.history));
}

std::vector<SecondOpinion> compare_opinions(const Question& q, const Opinion& calculix, const Opinion& ours) {
  std::vector<SecondOpinion> rows;
  for (const auto& [measure, value] : calculix.values)
    if (const auto other = ours.values.find(measure); other != ours.values.end())
      rows.push_back(second_opinion(measure, value, other->second));
  if (!calculix.history.time.empty() && !ours.history.time.empty()) rows.push_back(history_row(calculix, ours));
  if (q.modes > 0 || q.moves()) return rows;
  rows.push_back(field_row(field_measure, calculix.field, ours.field));
  if (q.same_equations()) rows.push_back(field_row(same_mesh_measure, as_solved(calculix), as_solved(ours)));
  return rows;
}

bool vanishes(const SecondOpinion& r) {
  const auto is_zero = [](const ReferenceValue& v) { return std::abs(v.value) <= v.uncertainty; };
  return r.agrees && is_zero(r.calculix) && is_zero(r.ours);
}

void print_table(const std::vector<SecondOpinion>& rows) {
  to_stdout("{:<26} {:>4} {:>13} {:>9} {:>13} {:>9} {:>10}  {}\n", "quantity", "", "CalculiX", "+-", "ours", "+-",
            "difference", "within both");
  for (const SecondOpinion& r : rows)
    if (!vanishes(r))
      to_stdout("{:<26} {:>4} {:>13.6g} {:>9.1e} {:>13.6g} {:>9.1e} {:>10.1e}  {}\n", r.measure, r.unit,
                r.calculix.value, r.calculix.uncertainty, r.ours.value, r.ours.uncertainty, r.difference,
                r.agrees ? "yes" : "NO");
  if (const auto zeros = std::ranges::count_if(rows, vanishes))
    to_stdout("and {} component{} that both find to be zero\n", zeros, zeros == 1 ? "" : "s");
}

void print_title(const Question& q) {
  const auto& e = q.experiment();
  const std::string element = calculix::element_of(e, q.material, *q.meshes[0]);
  to_stdout("\n{}: nu = {:g}, {}\n", e.name, q.material.poisson_ratio, e.kinematics);
  to_stdout("CalculiX {}: {} up to {}, {}\n", calculix::version(), element, q.grids[2],
            element == "C3D20R" ? "integrated with 8 points: with 27 they lock as nu nears 1/2" : "fully integrated");
  if (q.same_meshes())
    to_stdout("ours: P2 on the same meshes\n");
  else
    to_stdout("ours: Q2 up to {}\n", q.moves() ? q.grids[2] : cells_text(q.prepared.reference_cells, " x "));
  if (!q.prepared.sharing.empty())
    to_stdout("left out, as held edges in common make them a convention: forces on {}\n",
              fmt::join(q.prepared.sharing, ", "));
}

/// Number of rows that differ; 1 if a program has no result.
int check_material(const Question& q) {
  std::optional<Opinion> calculix, ours;
  {
    Status status;
    const std::string title = fmt::format("{}, nu = {:g}", q.experiment().name, q.material.poisson_ratio);
    status.print(title);
    const Status::Working working(status, title);
    calculix = ask_calculix(q, status);
    if (!children_interrupted()) ours = ask_fem(q, status);
  }
  if (children_interrupted()) return 1;
  print_title(q);
  if (!calculix || !ours) {
    to_stdout("no answer from {}\n", calculix ? "our reference" : "CalculiX");
    return 1;
  }
  if (calculix->values.size() != ours->values.size()) to_stdout("not all quantities have a value from both\n");
  const std::vector<SecondOpinion> rows = compare_opinions(q, *calculix, *ours);
  print_table(rows);
  std::fflush(stdout);
  return static_cast<int>(std::ranges::count_if(rows, [](const auto& r) { return !r.agrees; }));
}

bool programs_are_there() {
  const bool ccx = !calculix::program().empty(), fem = fem::available();
  if (!ccx) to_stderr("error: CalculiX is not here: no `ccx` on PATH.  To install it: apt-get install calculix-ccx\n");
  if (!fem) to_stderr("error: springproof-fem is neither beside springproof nor named by SPRINGPROOF_FEM_PROGRAM\n");
  return ccx && fem;
}

}  // namespace

SecondOpinion second_opinion(const std::string& measure, const ReferenceValue& calculix, const ReferenceValue& ours,
                             std::optional<double> distance) {
  const double difference = distance.value_or(calculix.value - ours.value);
  return {measure,    distance ? "m" : unit_of(measure),
          calculix,   ours,
          difference, std::abs(difference) <= calculix.uncertainty + ours.uncertainty};
}

Experiment at_wanted(const Experiment& experiment, std::optional<double> setting) {
  const std::vector<double> known = experiment.settings();
  for (std::size_t s = 0; s < known.size(); ++s) {
    if (setting && !same_poisson_ratio(known[s], *setting)) continue;
    Experiment one = experiment.at(s);
    one.materials = {one.body_material(s)};
    return one;
  }
  throw InputError(fmt::format("--poisson-ratio: {} is none of the case's ({})", *setting, fmt::join(known, ", ")));
}

int cross_check(const std::filesystem::path& file, const CrossCheckOptions& options) try {
  Experiment experiment = read_experiment(file);
  if (options.poisson_ratio || experiment.listed.materials.size() == 1)
    experiment = at_wanted(experiment, options.poisson_ratio);
  require_one_listed(experiment);
  if (options.modes == 0) calculix::counterpart(experiment);
  if (options.modes == 0 && moves_in_time(experiment)) {
    calculix::require_motion_counterpart(experiment);
    if (options.cells[0] > 0)
      throw InputError("--cells: is for equilibria and frequencies; the grids of a motion have [reference] cells");
  }
  if (experiment.body.is_voxels() && options.cells[0] > 0)
    throw InputError("--cells: is for bodies of hexahedra; the tetrahedra of this one have [reference] edge_m");
  end_at_interrupts();
  const PreparedCase prepared = prepare(experiment);
  std::vector<Question> questions;
  for (const IsotropicMaterial& m : experiment.materials)
    questions.push_back(question(prepared, experiment.at_rest(m), options));
  if (!programs_are_there()) return no_program;
  if (children_interrupted()) return interrupted_status;
  int differing = 0;
  for (const Question& q : questions) {
    differing += check_material(q);
    if (children_interrupted()) return interrupted_status;
  }
  if (differing == 0)
    to_stdout("\nCalculiX and our reference agree within their uncertainties in every row\n");
  else
    to_stdout("\n{} row{} beyond the two uncertainties, or without an answer\n", differing, differing == 1 ? "" : "s");
  return differing == 0 ? all_agree : some_differ;
} catch (const std::runtime_error&) {
  if (children_interrupted()) return interrupted_status;  // the mesher was stopped by the same signal
  throw;
}

}  // namespace springproof
