#include "comparisons/case_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "comparisons/measures.h"
#include "comparisons/picture.h"
#include "comparisons/reference_value.h"
#include "fem_reference/reference.h"
#include "meshes/gmsh_io.h"
#include "meshes/locate.h"
#include "msm/solve/equilibrium.h"

namespace springproof {
namespace {

// Elements of the finest reference grid (Q2): what a few seconds of one core can solve.
constexpr double linear_reference_elements = 4096;
constexpr double finite_reference_elements = 1000;

// Cells of one lattice: what its matrices can hold in a workstation's memory.
constexpr double largest_lattice = 4e6;

/// Near-cubic elements, counts divisible by four so that the grid can be halved twice.
Cells reference_cells(const Experiment& e) {
  if (e.reference.cells[0] > 0) return e.reference.cells;
  const double elements = e.model_kinematics() == Kinematics::linear ? linear_reference_elements : finite_reference_elements;
  const double edge = std::cbrt(e.body.size.prod() / elements);
  Cells cells;
  for (int d = 0; d < 3; ++d) cells[d] = 4 * std::max(1, static_cast<int>(std::lround(e.body.size[d] / edge / 4)));
  return cells;
}

/// The finite element answer at the nodes of one lattice.
struct Reference {
  ReferenceField field;
  std::map<std::string, ReferenceValue> scalars;   ///< the same for every lattice
};

/// One case at one material, while it is being run.
struct PartRun {
  const PreparedCase& prepared;
  const IsotropicMaterial& material;
  const std::filesystem::path& vtu_folder;
  Part part;

  std::vector<fem::Solution> grids;                 ///< the three reference grids, coarse to fine
  std::vector<std::optional<Reference>> reference;  ///< one per lattice; empty: none to be had

  const Experiment& experiment() const { return prepared.experiment; }
};

NodalVectors points_of(const std::vector<Probe>& probes) {
  NodalVectors points(static_cast<Eigen::Index>(probes.size()), 3);
  for (std::size_t i = 0; i < probes.size(); ++i) points.row(static_cast<Eigen::Index>(i)) = probes[i].at.transpose();
  return points;
}

/// All points at which the reference is wanted: the nodes of every lattice, then the probes.
NodalVectors sample_points(const PreparedCase& prepared) {
  const NodalVectors probes = points_of(prepared.experiment.probes);
  Eigen::Index count = probes.rows();
  for (const auto& mesh : prepared.meshes) count += mesh->nodes.rows();
  NodalVectors points(count, 3);
  Eigen::Index at = 0;
  for (const auto& mesh : prepared.meshes) {
    points.middleRows(at, mesh->nodes.rows()) = mesh->nodes;
    at += mesh->nodes.rows();
  }
  points.bottomRows(probes.rows()) = probes;
  return points;
}

NodalVectors at_lattice(const PreparedCase& prepared, std::size_t lattice, const NodalVectors& samples) {
  Eigen::Index at = 0;
  for (std::size_t i = 0; i < lattice; ++i) at += prepared.meshes[i]->nodes.rows();
  return samples.middleRows(at, prepared.meshes[lattice]->nodes.rows());
}

Field sampled_field(const PartRun& run, std::size_t lattice, const fem::Solution& s) {
  return {run.prepared.meshes[lattice], at_lattice(run.prepared, lattice, s.displacement), s.reactions, s.volume_change,
          s.volume_change_first_order};
}

std::map<std::string, double> measures_of(const PartRun& run, const fem::Solution& s) {
  const auto probes = static_cast<Eigen::Index>(run.experiment().probes.size());
  return scalar_measures(sampled_field(run, 0, s), run.experiment().probes, s.displacement.bottomRows(probes));
}

/// False for the force or torque on a patch that shares held nodes with another: no reference can be given.
bool comparable(const PreparedCase& prepared, const std::string& measure) {
  if (!measure.starts_with("force.") && !measure.starts_with("torque.")) return true;
  const auto from = measure.find('.') + 1;
  return !prepared.sharing.contains(measure.substr(from, measure.rfind('.') - from));
}

/// Round-off of a measure: the solver's tolerance times the largest force (times the body's size for torques, over it
/// for forces that balance torques), or times the strain.
double noise_of(const std::string& measure, const std::map<std::string, double>& values, double body_size, double largest_displacement) {
  constexpr double relative = 1e-7;
  if (measure.starts_with("displacement.")) return relative * largest_displacement;
  if (measure.starts_with("volume_change")) return relative * largest_displacement / body_size;
  double force = 0;
  for (const auto& [name, value] : values) {
    if (name.starts_with("force.")) force = std::max(force, std::abs(value));
    if (name.starts_with("torque.")) force = std::max(force, std::abs(value) / body_size);
  }
  return relative * force * (measure.starts_with("torque.") ? body_size : 1);
}

Run fem_run(const PartRun& run, const fem::Solution& s, const std::string& model) {
  return {model,   "fem", run.material.poisson_ratio, s.grid.cells, s.law.empty() ? run.experiment().kinematics : s.law,
          s.ok,    s.message, s.form,                 s.iterations, s.residual,
          s.seconds, s.degrees_of_freedom, s.memory_MiB};
}

/// Runs the reference grids, and eight-node elements on the lattices' own cells; fills run.reference.
std::vector<fem::Solution> run_fem(PartRun& run) {
  const Cells fine = run.prepared.reference_cells;
  fem::Request request{run.experiment(), run.material, {}, sample_points(run.prepared), 1e-8};
  for (int divisor : {4, 2, 1})
    request.grids.push_back({{fine[0] / divisor, fine[1] / divisor, fine[2] / divisor}, 2, run.experiment().reference.grading});
  for (const Cells& cells : run.experiment().body.cells) request.grids.push_back({cells, 1, 1.0});
  std::vector<fem::Solution> solutions;
  try {
    solutions = fem::solve(request);
  } catch (const std::runtime_error& e) {
    run.part.runs.push_back({"fem_q2", "fem", run.material.poisson_ratio, fine, run.experiment().kinematics, false, e.what(), "", 0, 0, 0, 0, 0});
    return {};
  }
  run.grids.assign(solutions.begin(), solutions.begin() + 3);
  for (const fem::Solution& s : run.grids) run.part.runs.push_back(fem_run(run, s, "fem_q2"));
  return {solutions.begin() + 3, solutions.end()};
}

void build_reference(PartRun& run) {
  run.reference.assign(run.prepared.meshes.size(), {});
  if (run.grids.size() != 3 || !std::all_of(run.grids.begin(), run.grids.end(), [](const auto& s) { return s.ok; })) return;
  std::vector<std::map<std::string, double>> values;
  for (const fem::Solution& s : run.grids) values.push_back(measures_of(run, s));
  std::map<std::string, ReferenceValue> scalars;
  const double largest_displacement = run.grids[2].displacement.rowwise().norm().maxCoeff();
  for (const auto& [measure, fine] : values[2]) {
    const std::vector<double> sequence = {values[0].at(measure), values[1].at(measure), fine};
    const ReferenceValue v = scalars[measure] = extrapolate(sequence, noise_of(measure, values[2], run.experiment().body.size.norm(), largest_displacement));
    if (!wanted(measure, run.experiment().measures) || !comparable(run.prepared, measure)) continue;
    run.part.references.push_back({run.material.poisson_ratio, measure, unit_of(measure), {}, sequence, v.observed_order, v.value, v.uncertainty, v.note});
  }
  for (std::size_t i = 0; i < run.prepared.meshes.size(); ++i) {
    const Mesh& mesh = *run.prepared.meshes[i];
    std::vector<NodalVectors> fields;
    for (const fem::Solution& s : run.grids) fields.push_back(at_lattice(run.prepared, i, s.displacement));
    run.reference[i] = Reference{extrapolate(fields, nodal_volumes(mesh)), scalars};
    if (i > 0) continue;
    const ReferenceField& f = run.reference[i]->field;
    std::vector<double> distance;
    for (const NodalVectors& u : fields) distance.push_back(displacement_error(u, f.displacement, nodal_volumes(mesh)));
    run.part.references.push_back({run.material.poisson_ratio, "displacement_error", "1", {}, distance, f.observed_order, 0, f.uncertainty, f.note});
  }
  for (ReferenceRecord& r : run.part.references)
    for (const fem::Solution& s : run.grids) r.cells.push_back(s.grid.cells);
}

/// Distances from the reference field [their units].
std::map<std::string, double> distances(const PartRun& run, std::size_t lattice, const NodalVectors& u) {
  const Mesh& mesh = *run.prepared.meshes[lattice];
  const NodalVectors& v = run.reference[lattice]->field.displacement;
  std::map<std::string, double> out = {{"displacement_error", displacement_error(u, v, nodal_volumes(mesh))},
                                       {"displacement_error_max", displacement_error_max(u, v)}};
  if (run.experiment().section) {
    out["section_distance"] = section_distance(mesh, *run.experiment().section, u, v);
    out["section_axis_distance"] = section_axis_distance(mesh, *run.experiment().section, u, v);
  }
  return out;
}

void add_rows(PartRun& run, std::size_t lattice, const std::string& model, const std::string& kinematics,
              const NodalVectors& u, const std::map<std::string, double>& scalars) {
  const auto& reference = run.reference[lattice];
  const Row blank{run.experiment().name, kinematics, model, run.material.poisson_ratio,
                  run.experiment().body.cells[lattice], "", 0, "", {}, {}, {}};
  for (const auto& [measure, value] : scalars) {
    if (!wanted(measure, run.experiment().measures)) continue;
    Row row = blank;
    row.measure = measure;
    row.value = value;
    row.unit = unit_of(measure);
    if (reference && comparable(run.prepared, measure)) {
      const ReferenceValue& r = reference->scalars.at(measure);
      row.reference = r.value;
      row.reference_uncertainty = r.uncertainty;
      row.error = value - r.value;
    }
    run.part.rows.push_back(row);
  }
  if (!reference) return;
  // What the reference may be off, node by node, measured by the same ruler.
  NodalVectors doubt = reference->field.displacement;
  doubt.col(0) += reference->field.nodal_uncertainty;
  const std::map<std::string, double> uncertainty = distances(run, lattice, doubt);
  for (const auto& [measure, value] : distances(run, lattice, u)) {
    if (!wanted(measure, run.experiment().measures)) continue;
    Row row = blank;
    row.measure = measure;
    row.value = value;
    row.unit = unit_of(measure);
    row.reference = 0.0;
    row.reference_uncertainty = uncertainty.at(measure);
    row.error = value;
    run.part.rows.push_back(row);
  }
}

void save(PartRun& run, std::size_t lattice, const std::string& model, const Field& field) {
  const auto& reference = run.reference[lattice];
  const NodalVectors* truth = reference ? &reference->field.displacement : nullptr;
  const Cells& cells = run.experiment().body.cells[lattice];
  if (lattice == 0)
    run.part.pictures.push_back(picture(model, run.material.poisson_ratio, cells, field, model == "fem" ? nullptr : truth));
  if (run.vtu_folder.empty()) return;
  std::vector<std::pair<std::string, NodalVectors>> extra;
  if (truth && model != "fem") extra.emplace_back("difference_to_fem", field.displacement - *truth);
  std::string name = fmt::format("{}_nu{}_{}x{}x{}.vtu", model, run.material.poisson_ratio, cells[0], cells[1], cells[2]);
  std::replace(name.begin(), name.end(), ' ', '_');
  write_vtu(run.vtu_folder / name, field, extra);
}

void run_model(PartRun& run, std::size_t lattice, std::size_t number) {
  const Experiment& e = run.experiment();
  const auto& mesh = run.prepared.meshes[lattice];
  const Kinematics kinematics = e.model_kinematics();
  const std::string& label = e.models[number].label;
  const MassSpringModel model = build_model(run.prepared.models[number], *mesh, run.material);
  const LoadPath path = [&](double factor) { return transfer(e.loads, *mesh, run.material.density, kinematics, factor); };
  const BoundaryConditions conditions = path(1.0);
  const Equilibrium state = kinematics == Kinematics::linear ? solve_linear(model, conditions) : solve_finite(model, path);
  const std::string kind = kinematics == Kinematics::linear ? "linear" : "finite";
  run.part.runs.push_back({label, "msm", run.material.poisson_ratio, e.body.cells[lattice], kind, state.ok, state.message,
                           state.solver, state.iterations, state.residual, state.seconds, state.unknowns, state.memory_MiB});
  if (!state.ok) return;
  const Field field = to_field(state, mesh, e.loads, conditions, kinematics);
  const NodalVectors probes = interpolate(*mesh, field.displacement, points_of(e.probes));
  add_rows(run, lattice, label, kind, field.displacement, scalar_measures(field, e.probes, probes));
  save(run, lattice, label, field);
}

}  // namespace

PreparedCase prepare(const Experiment& experiment) {
  PreparedCase prepared{experiment, {}, {}, reference_cells(experiment), {}, {}};
  for (int n : prepared.reference_cells)
    if (n % 4 != 0)
      throw InputError(fmt::format("{}: reference.cells: {} is not divisible by 4 (the grid is halved twice)", experiment.file.string(), n));
  for (const Cells& c : experiment.body.cells)
    if (const double total = double(c[0]) * c[1] * c[2]; total > largest_lattice)
      throw InputError(experiment.body.where, fmt::format("cells: {} x {} x {} = {:.3g} cells (allowed: up to {:.0g}; a lattice takes some 3 kB per cell)",
                                                          c[0], c[1], c[2], total, largest_lattice));
  for (const Expectation& e : experiment.expectations) {
    if (e.value) continue;
    if (e.model == "fem")
      throw InputError(e.location, "value: an expectation of the reference itself needs one");
    if (e.relative && is_distance(e.measure))
      throw InputError(e.location, fmt::format("within_relative: {} is expected to be 0; give an absolute `within`", e.measure));
  }
  for (const ModelChoice& choice : experiment.models) prepared.models.push_back(resolve(choice));
  try {
    prepared.geo = find_geo(experiment.body, experiment.file);
    for (const Cells& cells : experiment.body.cells) {
      prepared.meshes.push_back(std::make_shared<Mesh>(mesh_geo(prepared.geo, experiment.body.size, cells)));
      const Mesh& mesh = *prepared.meshes.back();
      std::vector<std::string> patches;
      for (const Patch& p : mesh.patches) patches.push_back(p.name);
      check_patches(experiment, patches);
      prepared.sharing = patches_sharing_supports(experiment.loads, mesh, experiment.model_kinematics());
      require_supported(transfer(experiment.loads, mesh, 1000, experiment.model_kinematics()), mesh);
      for (const ModelParameters& p : prepared.models) build_model(p, mesh, experiment.materials.front());
      const NodalVectors u = NodalVectors::Zero(mesh.nodes.rows(), 3);
      if (experiment.section) section_distance(mesh, *experiment.section, u, u);
      interpolate(mesh, u, points_of(experiment.probes));
    }
  } catch (const InputError& e) {
    const std::string message = e.what(), file = experiment.file.string();
    throw InputError(message.starts_with(file) ? message : file + ": " + message);
  }
  return prepared;
}

Part run_part(const PreparedCase& prepared, std::size_t material, const std::filesystem::path& vtu_folder) {
  PartRun run{prepared, prepared.experiment.materials[material], vtu_folder, {}, {}, {}};
  if (!vtu_folder.empty()) std::filesystem::create_directories(vtu_folder);
  const std::vector<fem::Solution> peers = run_fem(run);
  build_reference(run);
  for (std::size_t lattice = 0; lattice < prepared.meshes.size(); ++lattice) {
    if (run.reference[lattice]) {
      Field field = sampled_field(run, lattice, run.grids.back());
      field.displacement = run.reference[lattice]->field.displacement;
      save(run, lattice, "fem", field);
    }
    if (lattice < peers.size()) {
      const fem::Solution& s = peers[lattice];
      run.part.runs.push_back(fem_run(run, s, "fem_q1"));
      if (s.ok) {
        add_rows(run, lattice, "fem_q1", run.part.runs.back().kinematics, at_lattice(prepared, lattice, s.displacement), measures_of(run, s));
        save(run, lattice, "fem_q1", sampled_field(run, lattice, s));
      }
    }
    for (std::size_t m = 0; m < prepared.models.size(); ++m) run_model(run, lattice, m);
  }
  return std::move(run.part);
}

}  // namespace springproof
