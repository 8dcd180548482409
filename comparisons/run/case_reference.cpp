#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <numbers>

#include "comparisons/judge/deformation.h"
#include "comparisons/judge/measures.h"
#include "comparisons/models/motion_reference.h"
#include "comparisons/reference/reference_grids.h"
#include "comparisons/reference/voxel_reference.h"
#include "comparisons/run/part_run.h"

namespace springproof {
namespace {

/// "beside the coarsest grid alone: hybmss_avg 2.1 %, emsm 4.3 %", the closest first, on the finest lattice; empty
/// where no model has a displacement at rest.
/// @param coarsest displacement at the nodes of all lattices [m]
std::string first_verdict(const PartRun& run, const NodalVectors& coarsest) {
  const std::size_t lattice = finest_lattice(run.prepared);
  const Experiment& e = run.experiment();
  if (e.fracture || !small_enough(e, run.mesh(lattice))) return {};
  const NodalVectors u = at_nodes(run.prepared.lattices[lattice], coarsest);
  const Eigen::VectorXd volumes = nodal_volumes(run.mesh(lattice));
  const double scale = scale_of_errors(run.prepared, run.prepared.lattices[lattice], u).mean;
  std::vector<std::pair<double, std::string>> errors;
  for (std::size_t m = 0; m < run.prepared.models.size(); ++m) {
    if (e.models[m].in_motion) continue;
    const std::vector<ModelSample> samples = samples_of(run, lattice, {m});  // none of a file of other cells or ratios
    if (samples.empty() || !samples.front().state.ok) continue;
    const NodalVectors difference = samples.front().field.displacement - u;
    errors.emplace_back(weighted_norm(difference, volumes) / scale, e.models[m].label);
  }
  if (errors.empty()) return {};
  std::ranges::sort(errors);
  constexpr std::size_t most_named = 4;
  std::vector<std::string> words;
  for (std::size_t i = 0; i < std::min(most_named, errors.size()); ++i)
    words.push_back(fmt::format("{} {:.2g} %", errors[i].second, 100 * errors[i].first));
  if (errors.size() > most_named)
    words.push_back(fmt::format("{} more up to {:.2g} %", errors.size() - most_named, 100 * errors.back().first));
  return fmt::format("beside the coarsest grid alone: {}", fmt::join(words, ", "));
}

/// The first element of [reference], where the program failed.
Run failed_run(const PartRun& run) {
  Run record = of_run<Run>(run.key("fem_" + run.experiment().reference.elements.front(), run.prepared.reference_cells));
  record.kind = "fem";
  record.kinematics = run.experiment().kinematics;
  record.message = run.grids.failure;
  return record;
}

/// Runs the finite elements.
void run_fem(PartRun& run) {
  const auto solve = run.experiment().body.is_voxels() ? solve_body_grids : solve_grids;
  // Of runs that nobody keeps the models are not solved yet.
  const auto say_first_verdict = [&run](const NodalVectors& u) {
    if (run.keeper.keeps()) run.keeper.say([&] { return first_verdict(run, u); });
  };
  run.grids = solve(run.prepared, run.material, run.vtu, run.keeper, say_first_verdict);
  if (run.grids.elements.empty()) run.part.runs.push_back(failed_run(run));
  for (const ElementGrids& e : run.grids.elements)
    for (const fem::Solution& s : e.grids) run.part.runs.push_back(fem_run(run, s, "fem_" + e.element));
  for (const auto& on_cubes : run.grids.refined)
    for (const fem::Solution& s : on_cubes) run.part.runs.push_back(fem_run(run, s, "fem_q2"));
}

/// Stresses of the reference as rows of its own: most springs have none.
void add_stress_rows(PartRun& run) {
  for (const ReferenceRecord& r : run.part.references)
    if (r.measure.starts_with("stress.")) {
      Row row = blank_row(run, run.key("fem_" + r.element, r.cells.back()), run.experiment().kinematics);
      row.value = r.value;
      row.reference_uncertainty = r.uncertainty;
      add_row(run, row, r.measure);
    }
}

void record_elements(PartRun& run) {
  for (const ElementGrids& e : run.grids.elements) {
    if (!complete(e)) continue;
    for (ReferenceRecord& r : records_of(run.prepared, run.material, e)) {
      r.cells = solved_cells(e);
      run.part.references.push_back(std::move(r));
    }
  }
  if (run.experiment().models.empty())
    run.part.rows = rows_of(run.prepared, run.part.references);
  else
    add_stress_rows(run);
}

/// The reference at the nodes of one lattice, from the fields on the three grids.
Reference reference_at(const PartRun& run, const Lattice& lattice, const std::vector<NodalVectors>& fields,
                       const std::map<std::string, ReferenceValue>& scalars) {
  const double share = scale_of_errors(run.prepared, lattice, fields.back()).share;
  const ElementGrids& e = run.grids.elements.front();
  ReferenceField field = extrapolate(fields, nodal_volumes(*lattice.mesh), ratios_of(e), share * doubt_of(scalars),
                                     trusted_orders("displacement", e.element, run.experiment().reference.smooth));
  widen(share * run.prepared.body.load_spread, field);
  field.uncertainty /= share;
  const DisplacementScale scale = scale_of_errors(run.prepared, lattice, field.displacement);
  return {std::move(field), scalars, scale};
}

/// displacement_error of the reference itself, on a lattice.
ReferenceRecord field_record(const PartRun& run, const Lattice& lattice, const std::vector<NodalVectors>& fields,
                             const Reference& reference) {
  const ElementGrids& first = run.grids.elements.front();
  const ReferenceField& f = reference.field;
  ReferenceRecord record{.poisson_ratio = run.setting(),
                         .measure = "displacement_error",
                         .unit = "1",
                         .cells = solved_cells(first),
                         .values = {},
                         .observed_order = f.observed_order,
                         .uncertainty = f.uncertainty,
                         .note = with_note(first, f.note),
                         .element = first.element,
                         .converging = f.sequence != Sequence::not_converging,
                         .correlation = f.correlation};
  if (!record.converging) record.note += "; " + cause_and_remedy(run.prepared, run.material, first, record.measure);
  const Eigen::VectorXd volumes = nodal_volumes(*lattice.mesh);
  for (const NodalVectors& field : fields)
    record.values.push_back(weighted_norm(field - f.displacement, volumes) / reference.scale.mean);
  return record;
}

/// The first element's fields as the reference of the lattices; with an exact field, that field.
void build_reference(PartRun& run) {
  run.reference.assign(run.prepared.lattices.size(), {});
  run.voxels.assign(run.prepared.lattices.size(), {});
  if (run.grids.elements.empty() || !complete(run.grids.elements.front())) return;
  const ElementGrids& first = run.grids.elements.front();
  const std::map<std::string, ReferenceValue> scalars = limits_of(run.prepared, first);
  build_stress_limit(run, doubt_of(scalars));
  for (std::size_t i = 0; i < run.prepared.lattices.size(); ++i) {
    const Lattice& lattice = run.prepared.lattices[i];
    std::vector<NodalVectors> fields;
    for (const fem::Solution& s : first.grids) fields.push_back(at_nodes(lattice, s.displacement));
    run.reference[i] = reference_at(run, lattice, fields, scalars);
    if (run.experiment().body.is_voxels()) run.voxels[i] = voxel_limit(run.prepared, i, run.grids);
    if (i == 0 && run.experiment().exact.empty())
      run.part.references.push_back(field_record(run, lattice, fields, *run.reference[i]));
  }
}

/// Size of the deformation of the reference, on the finest lattice.
void measure_deformation(PartRun& run) {
  const std::size_t finest = finest_lattice(run.prepared);
  if (!run.reference[finest]) return;
  const NodalVectors& u = run.reference[finest]->field.displacement;
  const DeformationSize size = deformation_size(run.mesh(finest), u, run.experiment().model_kinematics());
  Deformation record{.poisson_ratio = run.setting(),
                     .principal_strain = size.principal_strain,
                     .rotation_deg = size.rotation * 180 / std::numbers::pi,
                     .strained_share = run.reference[finest]->scale.share,
                     .applied_N = sum_of_loads(run.prepared)};
  for (const PatchReaction& r : run.grids.elements.front().grids.back().reactions) record.reacted_N += r.force;
  run.part.deformations.push_back(record);
}

}  // namespace

Cells solved_cells(const fem::Solution& s) {
  return is_tetrahedra(s.grid.cells) && s.cells > 0 ? Cells{static_cast<int>(s.cells), 0, 0} : s.grid.cells;
}

std::vector<Cells> solved_cells(const ElementGrids& e) {
  std::vector<Cells> cells;
  for (const fem::Solution& s : e.grids) cells.push_back(solved_cells(s));
  return cells;
}

Run fem_run(const PartRun& run, const fem::Solution& s, const std::string& model) {
  Run record = of_run<Run>(run.key(model, solved_cells(s)));
  record.kind = "fem";
  record.kinematics = s.law.empty() ? run.experiment().kinematics : s.law;
  record.ok = s.ok;
  record.message = s.message;
  record.solver = s.form;
  record.iterations = s.iterations;
  record.residual = s.residual;
  record.seconds = s.times.solve;
  record.unknowns = s.unknowns;
  record.memory_MiB = s.memory_MiB;
  record.set_up_seconds = s.times.set_up;
  return record;
}

void run_reference(PartRun& run) {
  if (!run.experiment().reference.elements.empty()) run_fem(run);
  if (run.experiment().reference.in_time) run_motion_reference(run);
  record_elements(run);
  build_reference(run);
  measure_deformation(run);
}

}  // namespace springproof
