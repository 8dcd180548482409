#include "comparisons/run/case_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "comparisons/judge/line_measure.h"
#include "comparisons/judge/measures.h"
#include "comparisons/models/external.h"
#include "comparisons/models/frequencies.h"
#include "comparisons/reference/reference_grids.h"
#include "comparisons/reference/voxel_reference.h"
#include "comparisons/results/picture.h"
#include "comparisons/results/records_json.h"
#include "comparisons/run/expected_runs.h"
#include "comparisons/run/part_run.h"
#include "comparisons/run/prepare.h"
#include "meshes/mesher/mesher.h"
#include "meshes/voxels/cells_apart.h"
#include "msm/statics/equilibrium.h"
#include "problem/case_file/measures.h"
#include "problem/files/files.h"
#include "problem/processes/child.h"
#include "problem/system/input_error.h"

namespace springproof {
namespace {

void save(PartRun& run, std::size_t lattice, const std::string& model, const Field& field,
          const NodalStresses& stress = {}) {
  const auto* reference = reference_at_rest(run, lattice, model);
  const NodalVectors* truth = reference ? &reference->field.displacement : nullptr;
  const RunKey key = run.key(model, lattice);
  if (lattice == 0) {
    const NodalVectors* difference_to = model == "fem" ? nullptr : truth;
    run.part.pictures.push_back(picture(key, field, difference_to));
    if (run.experiment().body.is_voxels())
      run.part.pictures.push_back(smooth_picture(key, field, *run.prepared.body.tetrahedra.back(), difference_to));
  }
  if (run.vtu.folder.empty()) return;
  NodalFields extra;
  if (truth && model != "fem") extra.emplace_back("difference_to_fem", field.displacement - *truth);
  Field apart_field = field;
  if (stress.rows() > 0) {
    CellsApart parts = apart(field.mesh->hexahedra, field.mesh->materials);
    const auto mesh = std::make_shared<Mesh>();
    mesh->nodes = field.mesh->nodes(parts.node, Eigen::all);
    mesh->hexahedra = std::move(parts.corners);
    apart_field.mesh = mesh;
    apart_field.displacement = field.displacement(parts.node, Eigen::all);
    for (auto& [name, values] : extra) values = values(parts.node, Eigen::all).eval();
    for (auto& [name, values] : stress_fields(stress)) extra.emplace_back(name, values);
  }
  write_vtu(run.vtu.folder / (file_stem(key) + ".vtu"), apart_field, extra, run.notes(key));
  write_file(run.vtu.folder / (file_stem(key) + ".csv"), csv_of(field.mesh->nodes, field.displacement));
}

void add_splits(PartRun& run, std::size_t lattice, const std::string& model, const std::vector<NodalVectors>& u,
                const std::vector<std::map<std::string, double>>& scalars) {
  const auto* reference = reference_at_rest(run, lattice, model);
  const auto& voxels = run.voxels[lattice];
  if (!reference || !voxels) return;
  for (ErrorSplit& split : split_error(run.prepared, run.prepared.lattices[lattice], run.key(model, lattice), *voxels,
                                       *reference, u, scalars))
    run.part.splits.push_back(std::move(split));
}

/// A model of cut cells has no staircase.  Its springs' part is that of the same model on whole cubes, where there are
/// finite elements on the same cells; the rest is the cells' size.
void add_splits_of_cut_cells(PartRun& run, std::size_t lattice, std::size_t number, const std::vector<NodalVectors>& u,
                             const std::vector<std::map<std::string, double>>& scalars) {
  const std::string& label = run.experiment().models[number].label;
  if (!reference_at_rest(run, lattice, label) || !run.voxels[lattice]) return;
  const std::vector<ModelSample> cubes = samples_of(run, lattice, {.number = number, .whole_cubes = true});
  if (!cubes.front().state.ok) return;
  const std::size_t first = run.part.splits.size();
  add_splits(run, lattice, label, {cubes.front().field.displacement}, {cubes.front().scalars});
  const std::vector<ErrorSplit> of_cubes(run.part.splits.begin() + static_cast<std::ptrdiff_t>(first),
                                         run.part.splits.end());
  run.part.splits.resize(first);
  add_splits(run, lattice, label, u, scalars);
  for (std::size_t s = 0; s < of_cubes.size(); ++s) without_staircase(of_cubes[s], run.part.splits[first + s]);
}

/// As rows and runs of models name it.
std::string kinematics_of_models(const Experiment& e) {
  return e.model_kinematics() == Kinematics::linear ? "linear" : "finite";
}

/// Cut cells, or whole ones.
std::size_t cells_in_body(const Lattice& lattice, const ModelParameters& parameters) {
  return parameters.cut.value_or(false) ? cells_of(lattice, parameters).cells.size() : lattice.mesh->hexahedra.size();
}

/// Stresses on the picture that was added last, of the true surface where there is one.
void add_to_picture(PartRun& run, const ProbeStresses& stress) {
  Picture& p = run.part.pictures.back();
  const auto nodes = static_cast<Eigen::Index>(p.rest.size() / 3);
  if (stress.rows() < nodes) return;
  const Eigen::VectorXd of_nodes = invariants(stress.bottomRows(nodes)).col(0);
  p.von_mises.assign(of_nodes.begin(), of_nodes.end());
}

/// What is recorded of the run of a sample, with a result or without.
Run model_run(const PartRun& run, std::size_t lattice, std::size_t number, const ModelSample& sample) {
  const Experiment& e = run.experiment();
  const Equilibrium& s = sample.state;
  Run record = of_run<Run>(run.key(e.models[number].label, lattice));
  record.kind = is_external(e.models[number]) ? "external" : "msm";
  record.kinematics = kinematics_of_models(e);
  record.ok = s.ok;
  record.message = s.message;
  record.solver = s.solver;
  record.iterations = s.iterations;
  record.residual = s.residual;
  record.seconds = sample.times.solve;
  record.unknowns = s.unknowns;
  record.memory_MiB = s.memory_MiB;
  record.set_up_seconds = sample.times.set_up;
  record.stability = sample.stability;
  record.filled = cells_in_body(run.prepared.lattices[lattice], run.prepared.models[number]);
  return record;
}

/// The pictures, the line, the stresses and the motion of a model, of its first sample that has a result.
void add_first_sample(PartRun& run, std::size_t lattice, std::size_t number, const ModelSample& sample,
                      std::map<std::string, double>& scalars) {
  const Experiment& e = run.experiment();
  const std::string& label = e.models[number].label;
  const RunKey key = run.key(label, lattice);
  const bool cut = run.prepared.models[number].cut.value_or(false);  // whose cells have a file of their own
  save(run, lattice, label, sample.field, cut ? NodalStresses() : sample.stress);
  if (sample.line) static_cast<RunKey&>(run.part.lines.emplace_back(*sample.line)) = key;
  if (sample.stress.rows() > 0) {
    const ProbeStresses stress = at_stress_points(run, lattice, run.prepared.models[number], sample.stress);
    if (const Eigen::Index probes = stress_probes(run.prepared); probes > 0)
      scalars.merge(stress_measures(e.probes, stress.topRows(probes)));
    if (reference_at_rest(run, lattice, label)) add_stress_errors(run, key, kinematics_of_models(e), stress);
    if (lattice == 0) add_to_picture(run, stress);
  }
  if (!e.models[number].in_motion) return;
  add_motion(run, lattice, label, sample.field, sample.motion);
  add_motion_rows(run, blank_row(run, key, kinematics_of_models(e)), run.part.histories.back());
}

void run_model(PartRun& run, std::size_t lattice, std::size_t number) {
  const Experiment& e = run.experiment();
  const std::string &label = e.models[number].label, kind = kinematics_of_models(e);
  const RunKey key = run.key(label, lattice);
  const std::vector<ModelSample> samples = samples_of(run, lattice, {number});
  std::vector<NodalVectors> fields;
  std::vector<std::map<std::string, double>> scalars;
  for (const ModelSample& sample : samples) {
    run.part.runs.push_back(model_run(run, lattice, number, sample));
    if (sample.stability) {  // of models without a result too
      Row row = blank_row(run, key, kind);
      row.value = sample.stability->load_reached;
      add_row(run, row, "stable_load");
    }
    if (!sample.state.ok) continue;
    scalars.push_back(sample.scalars);
    if (fields.empty()) add_first_sample(run, lattice, number, sample, scalars.front());
    fields.push_back(sample.field.displacement);
  }
  if (fields.empty()) return;
  add_rows(run, lattice, label, kind, fields, scalars);
  if (const auto* reference = reference_at_rest(run, lattice, label); reference && is_external(e.models[number]))
    run.part.runs.back().message = unit_doubt(fields.front(), reference->field.displacement);
  if (!run.prepared.models[number].cut.value_or(false)) return add_splits(run, lattice, label, fields, scalars);
  const NodalVectors& u = samples.front().state.displacement;
  if (!run.vtu.folder.empty())
    write_cells(run.vtu.folder / (file_stem(key) + "_cells.vtu"),
                cells_of(run.prepared.lattices[lattice], run.prepared.models[number]), u, run.notes(key),
                samples.front().stress);
  run.cut_states.push_back({lattice, number, u, samples.front().field.displacement, scalars.front()});
  add_splits_of_cut_cells(run, lattice, number, fields, scalars);
}

/// Adds the limits of models of cut cells from their two finest lattices as rows of their own: extrapolated to an edge
/// of zero as errors that fall with the edge, which those of notches, creases and parts few cells thick do, or with the
/// estimated error of refined lattices; whole cubes have no such limit, as their staircase jumps.  The last step is
/// stated as the spread.  Nothing for a model with one lattice, or two whose edges differ by less than least_ratio.
void add_extrapolated(PartRun& run) {
  const PreparedCase& prepared = run.prepared;
  const auto edge = [&](const CutState* s) { return prepared.lattices[s->lattice].error_scale(); };
  for (std::size_t model = 0; model < prepared.models.size(); ++model) {
    std::vector<const CutState*> states;
    for (const CutState& s : run.cut_states)
      if (s.model == model) states.push_back(&s);
    std::ranges::sort(states, [&](const auto* a, const auto* b) { return edge(a) < edge(b); });
    if (states.size() < 2 || edge(states[1]) < least_ratio * edge(states[0])) continue;
    const CutState &fine = *states[0], &coarse = *states[1];
    const double h = edge(&fine), H = edge(&coarse), factor = h / (H - h);
    const NodalVectors from_coarse =
        displacement_at(cells_of(prepared.lattices[coarse.lattice], prepared.models[model]), coarse.displacement,
                        prepared.lattices[fine.lattice].mesh->nodes);
    std::map<std::string, double> scalars, steps;
    for (const auto& [measure, value] : fine.scalars) {
      if (measure == "promised_error") continue;  // what the limit is in proportion to: 0
      const double step = factor * (value - coarse.scalars.at(measure));
      scalars[measure] = value + step;
      steps[measure] = std::abs(step);
    }
    const std::string label = run.experiment().models[model].label + extrapolated_suffix;
    const std::size_t first = run.part.rows.size();
    add_rows(run, fine.lattice, label, "linear", {fine.field + factor * (fine.field - from_coarse)}, {scalars});
    for (std::size_t r = first; r < run.part.rows.size(); ++r)
      if (const auto step = steps.find(run.part.rows[r].measure); step != steps.end())
        run.part.rows[r].spread = step->second;
    Run record = of_run<Run>(run.key(label, fine.lattice));
    record.kind = "msm";
    record.kinematics = "linear";
    record.ok = true;
    record.solver = prepared.lattices[fine.lattice].estimated > 0
                        ? fmt::format("from estimated errors of {:.3g} and {:.3g}", H, h)
                        : fmt::format("from edges of {:.4g} and {:.4g} m", H, h);
    run.part.runs.push_back(record);
  }
}

/// A model of a body that dries.
void run_fracture_model(PartRun& run, std::size_t lattice, std::size_t number) {
  const RunKey key = run.key(run.experiment().models[number].label, lattice);
  FractureSamples samples = fracture_samples_of(run, lattice, {number});
  for (Run& sample : samples.runs) {
    static_cast<RunKey&>(sample) = key;
    run.part.runs.push_back(std::move(sample));
  }
  if (samples.scalars.empty()) return;
  add_rows(run, lattice, key.model, "linear", {}, samples.scalars);
  static_cast<RunKey&>(samples.cracks) = key;
  run.part.cracks.push_back(std::move(samples.cracks));
}

/// The finite elements' results at the nodes of one lattice.
void add_fem(PartRun& run, std::size_t lattice) {
  const Lattice& here = run.prepared.lattices[lattice];
  if (run.reference[lattice]) {
    Field field = sampled_field(here, run.grids.elements.front().grids.back());
    field.displacement = run.reference[lattice]->field.displacement;
    save(run, lattice, "fem", field);
    if (lattice == 0) add_to_picture(run, at_stress_points(run, lattice, run.grids.elements.front().grids.back()));
  }
  if (lattice >= run.grids.peers.size()) return;
  for (const fem::Solution& s : run.grids.peers[lattice]) {
    const std::string name = "fem_" + s.grid.element;
    run.part.runs.push_back(fem_run(run, s, name));
    run.part.runs.back().cells = here.cells;
    run.part.runs.back().filled = here.mesh->hexahedra.size();
    if (!s.ok) continue;
    std::map<std::string, double> scalars = measures_of(run.prepared, s);
    if (wanted("frequency", run.experiment().measures) && !run.experiment().body.is_voxels())
      scalars.merge(lowest_frequencies(run.prepared, here, s.grid.element, run.material));
    add_rows(run, lattice, name, run.part.runs.back().kinematics, {at_nodes(here, s.displacement)}, {scalars});
    if (run.stress)
      add_stress_errors(run, run.key(name, lattice), run.part.runs.back().kinematics,
                        at_stress_points(run, lattice, s));
    save(run, lattice, name, sampled_field(here, s));
  }
}

/// With an input changed on the coarsest lattice alone; only the rows that are measured, and turns.  A change with
/// which the case cannot be run is a run without rows, whose message says why.
VariedRun run_of(const Experiment& e, const Variation& variation, const Experiment& changed) {
  VariedRun out{e.load_cases[variation.load_case].name, variation.input ? e.inputs[*variation.input].name : "", {}, ""};
  Part part;
  try {
    part = run_part(prepare(changed), 0, {});
  } catch (const InputError& refused) {
    out.message = fmt::format("the case is refused: {}", refused.what());
  }
  for (const Row& row : part.rows)
    if (row.measure.starts_with("turn.") ||
        std::ranges::any_of(e.measured, [&](const auto& m) { return m.quantity == row.measure; }))
      out.rows.push_back(row);
  for (const Run& run : part.runs)
    if (!run.ok && out.message.empty()) out.message = run.model + ": " + run.message;
  return out;
}

/// Of the first model, and of the finite elements of the case where only the load case is another.  Each is kept.
/// @return none for a case without measured values
std::vector<VariedRun> varied_runs(const Experiment& e, const RunKeeper& keeper) {
  std::vector<VariedRun> runs;
  for (const Variation& variation : variations(e)) {
    if (children_interrupted()) return runs;
    const Experiment changed = case_of(e, variation);
    runs.push_back(keeper.run(
        fmt::format("load-case-{}-input-{}", variation.load_case, variation.input ? *variation.input + 1 : 0),
        cost_of_variation(changed), [&] { return run_of(e, variation, changed); }));
  }
  return runs;
}

}  // namespace

Part run_part(const PreparedCase& whole, std::size_t setting, const VtuOutput& vtu, const RunKeeper& keeper) {
  const PreparedCase prepared = at_setting(whole, setting);
  PartRun run{prepared, prepared.experiment.body_material(setting), vtu, keeper};
  if (!vtu.folder.empty()) std::filesystem::create_directories(vtu.folder);
  for (const LatticeLimit& limit : prepared.limits)
    if (same_poisson_ratio(limit.poisson_ratio, run.material.poisson_ratio)) {
      run.part.limits.push_back(limit);
      run.part.limits.back().poisson_ratio = run.setting();
    }
  const bool dries = prepared.experiment.fracture.has_value();
  const auto for_each_model = [&](std::size_t lattice, const auto& act) {
    if (!small_enough(prepared.experiment, run.mesh(lattice))) return;
    for (std::size_t m = 0; m < prepared.models.size(); ++m) act(m);
  };
  for (std::size_t lattice = 0; keeper.keeps() && lattice < prepared.lattices.size(); ++lattice)
    for_each_model(lattice, [&](std::size_t m) {
      dries ? void(fracture_samples_of(run, lattice, m)) : void(samples_of(run, lattice, {m}));
    });
  run_reference(run);
  for (std::size_t lattice = 0; lattice < prepared.lattices.size(); ++lattice) {
    add_fem(run, lattice);
    for_each_model(lattice,
                   [&](std::size_t m) { dries ? run_fracture_model(run, lattice, m) : run_model(run, lattice, m); });
  }
  add_extrapolated(run);
  if (prepared.experiment.line) add_line_orders(prepared.experiment, run.part.rows);
  run.part.varied = varied_runs(prepared.experiment, keeper);
  return std::move(run.part);
}

}  // namespace springproof
