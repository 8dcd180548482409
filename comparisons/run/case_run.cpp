#include "comparisons/run/case_run.h"

#include <numbers>

#include "comparisons/judge/deformation.h"
#include "comparisons/judge/line_measure.h"
#include "comparisons/judge/measures.h"
#include "comparisons/results/picture.h"
#include "comparisons/run/case_motion.h"
#include "comparisons/run/case_rows.h"
#include "comparisons/run/convergence_cause.h"
#include "comparisons/run/cut_extrapolation.h"
#include "comparisons/run/external.h"
#include "comparisons/run/external_points.h"
#include "comparisons/run/first_verdict.h"
#include "comparisons/run/model_samples.h"
#include "comparisons/run/motion_reference.h"
#include "comparisons/run/reference_grids.h"
#include "comparisons/run/voxel_body.h"
#include "comparisons/run/voxel_reference.h"
#include "msm/statics/equilibrium.h"
#include "problem/case_file/external.h"
#include "problem/case_file/measures.h"
#include "problem/system/files.h"

namespace springproof {
namespace {

Run fem_run(const PartRun& run, const fem::Solution& s, const std::string& model) {
  return {run.key(model, s.grid.cells),
          "fem",
          s.law.empty() ? run.experiment().kinematics : s.law,
          s.ok,
          s.message,
          s.form,
          s.iterations,
          s.residual,
          s.times.solve,
          s.unknowns,
          s.memory_MiB,
          s.times.set_up};
}

/// Runs the finite elements.
void run_fem(PartRun& run) {
  const auto solve = run.experiment().body.is_voxels() ? solve_body_grids : solve_grids;
  // Of runs that nobody keeps the models are not solved yet.
  const auto say_first_verdict = [&run](const NodalVectors& u) {
    if (run.keeper.keeps()) run.keeper.say([&] { return first_verdict(run, u); });
  };
  run.grids = solve(run.prepared, run.material, run.vtu, run.keeper, say_first_verdict);
  if (run.grids.elements.empty())
    run.part.runs.push_back(
        {run.key("fem_" + run.experiment().reference.elements.front(), run.prepared.reference_cells), "fem",
         run.experiment().kinematics, false, run.grids.failure, "", 0, 0, 0, 0, 0});
  for (const ElementGrids& e : run.grids.elements)
    for (const fem::Solution& s : e.grids) run.part.runs.push_back(fem_run(run, s, "fem_" + e.element));
  for (const auto& on_cubes : run.grids.refined)
    for (const fem::Solution& s : on_cubes) run.part.runs.push_back(fem_run(run, s, "fem_q2"));
}

/// Stresses of the reference as rows of its own: springs have none.
void add_stress_rows(PartRun& run) {
  for (const ReferenceRecord& r : run.part.references)
    if (r.measure.starts_with("stress."))
      run.part.rows.push_back({run.key("fem_" + r.element, r.cells.back()),
                               run.experiment().name,
                               run.experiment().kinematics,
                               r.measure,
                               r.value,
                               r.unit,
                               {},
                               r.uncertainty,
                               {}});
}

void record_elements(PartRun& run) {
  for (const ElementGrids& e : run.grids.elements) {
    if (!complete(e)) continue;
    const std::vector<ReferenceRecord> records = records_of(run.prepared, run.material, e);
    run.part.references.insert(run.part.references.end(), records.begin(), records.end());
  }
  if (run.experiment().models.empty())
    run.part.rows = rows_of(run.prepared, run.part.references);
  else
    add_stress_rows(run);
}

/// The first element's fields as the reference of the lattices; with an exact field, that field.
void build_reference(PartRun& run) {
  run.reference.assign(run.prepared.lattices.size(), {});
  run.voxels.assign(run.prepared.lattices.size(), {});
  if (run.grids.elements.empty() || !complete(run.grids.elements.front())) return;
  const ElementGrids& first = run.grids.elements.front();
  const std::map<std::string, ReferenceValue> scalars = limits_of(run.prepared, first);
  for (std::size_t i = 0; i < run.prepared.lattices.size(); ++i) {
    const Lattice& lattice = run.prepared.lattices[i];
    const Mesh& mesh = *lattice.mesh;
    std::vector<NodalVectors> fields;
    for (const fem::Solution& s : first.grids) fields.push_back(at_nodes(lattice, s.displacement));
    const double share = scale_of_errors(run.prepared, lattice, fields.back()).share;
    ReferenceField field = extrapolate(fields, nodal_volumes(mesh), ratios_of(first), share * doubt_of(scalars));
    widen(share * run.prepared.load_spread, field);
    field.uncertainty /= share;
    const DisplacementScale scale = scale_of_errors(run.prepared, lattice, field.displacement);
    run.reference[i] = Reference{std::move(field), scalars, scale};
    if (run.experiment().body.is_voxels()) run.voxels[i] = voxel_limit(run.prepared, i, run.grids);
    if (i > 0 || !run.experiment().exact.empty()) continue;
    const ReferenceField& f = run.reference[i]->field;
    ReferenceRecord record{run.material.poisson_ratio,
                           "displacement_error",
                           "1",
                           {},
                           {},
                           f.observed_order,
                           0,
                           f.uncertainty,
                           with_note(first, f.note),
                           first.element,
                           f.sequence != Sequence::not_converging,
                           f.correlation};
    if (!record.converging) record.note += "; " + cause_and_remedy(run.prepared, run.material, first, record.measure);
    for (std::size_t g = 0; g < 3; ++g) {
      record.cells.push_back(first.grids[g].grid.cells);
      record.values.push_back(weighted_norm(fields[g] - f.displacement, nodal_volumes(mesh)) / scale.mean);
    }
    run.part.references.push_back(record);
  }
}

/// Size of the deformation of the reference, on the finest lattice.
void measure_deformation(PartRun& run) {
  const std::size_t finest = finest_lattice(run.prepared);
  if (!run.reference[finest]) return;
  const NodalVectors& u = run.reference[finest]->field.displacement;
  const DeformationSize size = deformation_size(run.mesh(finest), u, run.experiment().model_kinematics());
  Deformation record{run.material.poisson_ratio, size.principal_strain, size.rotation * 180 / std::numbers::pi,
                     run.reference[finest]->scale.share};
  record.applied_N = sum_of_loads(run.prepared);
  for (const PatchReaction& r : run.grids.elements.front().grids.back().reactions) record.reacted_N += r.force;
  run.part.deformations.push_back(record);
}

void save(PartRun& run, std::size_t lattice, const std::string& model, const Field& field) {
  const auto* reference = reference_at_rest(run, lattice, model);
  const NodalVectors* truth = reference ? &reference->field.displacement : nullptr;
  const RunKey key = run.key(model, lattice);
  if (lattice == 0) {
    const NodalVectors* difference_to = model == "fem" ? nullptr : truth;
    run.part.pictures.push_back(picture(key, field, difference_to));
    if (run.experiment().body.is_voxels())
      run.part.pictures.push_back(smooth_picture(key, field, *run.prepared.tetrahedra.back(), difference_to));
  }
  if (run.vtu.folder.empty()) return;
  std::vector<std::pair<std::string, NodalVectors>> extra;
  if (truth && model != "fem") extra.emplace_back("difference_to_fem", field.displacement - *truth);
  write_vtu(run.vtu.folder / (vtu_stem(key) + ".vtu"), field, extra, run.notes(key));
  write_file(run.vtu.folder / (vtu_stem(key) + ".csv"), csv_of(field.mesh->nodes, field.displacement));
}

void add_splits(PartRun& run, std::size_t lattice, const std::string& model, const std::vector<NodalVectors>& u,
                const std::vector<std::map<std::string, double>>& scalars) {
  const auto* reference = reference_at_rest(run, lattice, model);
  const auto& voxels = run.voxels[lattice];
  if (!reference || !voxels) return;
  for (ErrorSplit& split : split_error(run.prepared, run.prepared.lattices[lattice], run.key(model, lattice), *voxels,
                                       {reference->field, reference->scalars, reference->scale}, u, scalars))
    run.part.splits.push_back(std::move(split));
}

/// A model of cut cells has no staircase.  Its springs' part is that of the same model on whole cubes, where there are
/// finite elements on the same cells; the rest is the cells' size.
void add_splits_of_cut_cells(PartRun& run, std::size_t lattice, std::size_t number, const std::vector<NodalVectors>& u,
                             const std::vector<std::map<std::string, double>>& scalars) {
  const std::string& label = run.experiment().models[number].label;
  if (!reference_at_rest(run, lattice, label) || !run.voxels[lattice]) return;
  const std::vector<ModelSample> cubes = samples_of(run, lattice, number, true);
  if (!cubes.front().state.ok) return;
  const std::size_t first = run.part.splits.size();
  add_splits(run, lattice, label, {cubes.front().field.displacement}, {cubes.front().scalars});
  const std::vector<ErrorSplit> of_cubes(run.part.splits.begin() + static_cast<std::ptrdiff_t>(first),
                                         run.part.splits.end());
  run.part.splits.resize(first);
  add_splits(run, lattice, label, u, scalars);
  for (std::size_t s = 0; s < of_cubes.size(); ++s) without_staircase(of_cubes[s], run.part.splits[first + s]);
}

/// The share of the load that a model bears, of models without a result too.
void add_stable_load(PartRun& run, Row row, double load_reached) {
  row.measure = "stable_load";
  if (!wanted(row.measure, run.experiment().measures)) return;
  row.unit = unit_of(row.measure);
  row.value = load_reached;
  run.part.rows.push_back(row);
}

/// Cut cells, or whole ones.
std::size_t cells_in_body(const Lattice& lattice, const ModelParameters& parameters) {
  return parameters.cut.value_or(false) ? lattice.cut->cells.size() : lattice.mesh->hexahedra.size();
}

void run_model(PartRun& run, std::size_t lattice, std::size_t number) {
  const Experiment& e = run.experiment();
  const std::string& label = e.models[number].label;
  const std::string kind = e.model_kinematics() == Kinematics::linear ? "linear" : "finite";
  const std::vector<ModelSample> samples = samples_of(run, lattice, number);
  std::vector<NodalVectors> fields;
  std::vector<std::map<std::string, double>> scalars;
  for (const ModelSample& sample : samples) {
    const Equilibrium& s = sample.state;
    run.part.runs.push_back({run.key(label, lattice), is_external(e.models[number]) ? "external" : "msm", kind, s.ok,
                             s.message, s.solver, s.iterations, s.residual, sample.times.solve, s.unknowns,
                             s.memory_MiB, sample.times.set_up, sample.stability,
                             cells_in_body(run.prepared.lattices[lattice], run.prepared.models[number])});
    if (sample.stability)
      add_stable_load(run, {run.key(label, lattice), e.name, kind, "", 0, "", {}, {}, {}, 1, {}},
                      sample.stability->load_reached);
    if (!s.ok) continue;
    if (fields.empty()) {
      save(run, lattice, label, sample.field);
      if (sample.line) static_cast<RunKey&>(run.part.lines.emplace_back(*sample.line)) = run.key(label, lattice);
      if (e.models[number].in_motion) {
        add_motion(run, lattice, label, sample.field, sample.motion);
        add_motion_rows(run, {run.key(label, lattice), e.name, kind, "", 0, "", {}, {}, {}, 1, {}},
                        run.part.histories.back());
      }
    }
    fields.push_back(sample.field.displacement);
    scalars.push_back(sample.scalars);
  }
  if (fields.empty()) return;
  add_rows(run, lattice, label, kind, fields, scalars);
  if (const auto* reference = reference_at_rest(run, lattice, label); reference && is_external(e.models[number]))
    run.part.runs.back().message = unit_doubt(fields.front(), reference->field.displacement);
  if (!run.prepared.models[number].cut.value_or(false)) return add_splits(run, lattice, label, fields, scalars);
  const NodalVectors& u = samples.front().state.displacement;
  if (!run.vtu.folder.empty())
    write_cells(run.vtu.folder / (vtu_stem(run.key(label, lattice)) + "_cells.vtu"),
                *run.prepared.lattices[lattice].cut, u, run.notes(run.key(label, lattice)));
  run.cut_states.push_back({lattice, number, u, samples.front().field.displacement, scalars.front()});
  add_splits_of_cut_cells(run, lattice, number, fields, scalars);
}

/// The limits of models of cut cells as rows of their own; the last step is stated as the spread.
void add_extrapolated(PartRun& run) {
  for (const ExtrapolatedModel& e : extrapolate_cut_cells(run.prepared, run.cut_states)) {
    const std::size_t first = run.part.rows.size();
    add_rows(run, e.lattice, e.label, "linear", {e.field}, {e.scalars});
    for (std::size_t r = first; r < run.part.rows.size(); ++r)
      if (const auto step = e.step.find(run.part.rows[r].measure); step != e.step.end())
        run.part.rows[r].spread = step->second;
    run.part.runs.push_back({run.key(e.label, e.lattice), "msm", "linear", true, "", e.from, 0, 0, 0, 0, 0});
  }
}

/// A model of a body that dries.
void run_fracture_model(PartRun& run, std::size_t lattice, std::size_t number) {
  const RunKey key = run.key(run.experiment().models[number].label, lattice);
  FractureSamples samples = fracture_samples_of(run, lattice, number);
  for (Run& sample : samples.runs) {
    static_cast<RunKey&>(sample) = key;
    run.part.runs.push_back(std::move(sample));
  }
  if (samples.scalars.empty()) return;
  add_rows(run, lattice, key.model, "linear", {}, samples.scalars);
  static_cast<RunKey&>(samples.cracks) = key;
  run.part.cracks.push_back(std::move(samples.cracks));
}

/// The reference's stress on its picture, of the true surface where there is one: the last that was added.
void add_stress(PartRun& run) {
  const auto& stress = run.grids.elements.front().grids.back().stress;
  const Eigen::Index first = first_pictured_stress(run.prepared);
  Picture& p = run.part.pictures.back();
  if (stress.rows() - first == static_cast<Eigen::Index>(p.rest.size() / 3))
    p.von_mises = von_mises(stress.bottomRows(stress.rows() - first));
}

/// The finite elements' results at the nodes of one lattice.
void add_fem(PartRun& run, std::size_t lattice) {
  const Lattice& here = run.prepared.lattices[lattice];
  if (run.reference[lattice]) {
    Field field = sampled_field(here, run.grids.elements.front().grids.back());
    field.displacement = run.reference[lattice]->field.displacement;
    save(run, lattice, "fem", field);
    if (lattice == 0) add_stress(run);
  }
  if (lattice >= run.grids.peers.size()) return;
  for (const fem::Solution& s : run.grids.peers[lattice]) {
    const std::string name = "fem_" + s.grid.element;
    run.part.runs.push_back(fem_run(run, s, name));
    run.part.runs.back().cells = here.cells;
    run.part.runs.back().filled = here.mesh->hexahedra.size();
    if (!s.ok) continue;
    add_rows(run, lattice, name, run.part.runs.back().kinematics, {at_nodes(here, s.displacement)},
             {measures_of(run.prepared, s)});
    save(run, lattice, name, sampled_field(here, s));
  }
}

}  // namespace

Part run_part(const PreparedCase& prepared, std::size_t material, const VtuOutput& vtu, const RunKeeper& keeper) {
  PartRun run{prepared, prepared.experiment.materials[material], vtu, keeper, {}, {}, {}, {}, {}, {}};
  if (!vtu.folder.empty()) std::filesystem::create_directories(vtu.folder);
  for (const LatticeLimit& limit : prepared.limits)
    if (same_poisson_ratio(limit.poisson_ratio, run.material.poisson_ratio)) run.part.limits.push_back(limit);
  const bool dries = prepared.experiment.fracture.has_value();
  const auto for_each_model = [&](std::size_t lattice, const auto& act) {
    if (!small_enough(prepared.experiment, run.mesh(lattice))) return;
    for (std::size_t m = 0; m < prepared.models.size(); ++m) act(m);
  };
  for (std::size_t lattice = 0; keeper.keeps() && lattice < prepared.lattices.size(); ++lattice)
    for_each_model(lattice, [&](std::size_t m) {
      dries ? void(fracture_samples_of(run, lattice, m)) : void(samples_of(run, lattice, m));
    });
  if (!prepared.experiment.reference.elements.empty()) run_fem(run);
  if (prepared.experiment.reference.in_time) run_motion_reference(run);
  record_elements(run);
  build_reference(run);
  measure_deformation(run);
  for (std::size_t lattice = 0; lattice < prepared.lattices.size(); ++lattice) {
    add_fem(run, lattice);
    for_each_model(lattice,
                   [&](std::size_t m) { dries ? run_fracture_model(run, lattice, m) : run_model(run, lattice, m); });
  }
  add_extrapolated(run);
  if (prepared.experiment.line) add_line_orders(prepared.experiment, run.part.rows);
  return std::move(run.part);
}

}  // namespace springproof
