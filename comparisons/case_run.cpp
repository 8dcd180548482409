#include "comparisons/case_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "comparisons/lattice_body.h"
#include "comparisons/line_measure.h"
#include "comparisons/measures.h"
#include "comparisons/model_run.h"
#include "comparisons/picture.h"
#include "comparisons/reference_grids.h"
#include "meshes/mesher.h"
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

  std::vector<ElementGrids> grids;                  ///< of every element; empty: none to be had
  std::vector<std::optional<Reference>> reference;  ///< one per lattice; empty: none to be had

  const Experiment& experiment() const { return prepared.experiment; }
};

NodalVectors points_of(const std::vector<Probe>& probes) {
  NodalVectors points(static_cast<Eigen::Index>(probes.size()), 3);
  for (std::size_t i = 0; i < probes.size(); ++i) points.row(static_cast<Eigen::Index>(i)) = probes[i].at.transpose();
  return points;
}

Run fem_run(const PartRun& run, const fem::Solution& s, const std::string& model) {
  return {model,   "fem", run.material.poisson_ratio, s.grid.cells, s.law.empty() ? run.experiment().kinematics : s.law,
          s.ok,    s.message, s.form,                 s.iterations, s.residual,
          s.seconds, s.degrees_of_freedom, s.memory_MiB};
}

/// Runs the finite elements; fills run.grids and gives the peers of the models.
std::vector<fem::Solution> run_fem(PartRun& run) {
  ReferenceGrids answer = solve_grids(run.prepared, run.material);
  if (answer.elements.empty())
    run.part.runs.push_back({"fem_" + run.experiment().reference.elements.front(), "fem", run.material.poisson_ratio,
                             run.prepared.reference_cells, run.experiment().kinematics, false, answer.failure, "", 0, 0, 0, 0, 0});
  for (const ElementGrids& e : answer.elements)
    for (const fem::Solution& s : e.grids) run.part.runs.push_back(fem_run(run, s, "fem_" + e.element));
  run.grids = std::move(answer.elements);
  return std::move(answer.peers);
}

void record_elements(PartRun& run) {
  for (const ElementGrids& e : run.grids) {
    if (!complete(e)) continue;
    const std::vector<ReferenceRecord> records = records_of(run.prepared, run.material, e);
    run.part.references.insert(run.part.references.end(), records.begin(), records.end());
  }
  if (run.experiment().models.empty()) run.part.rows = rows_of(run.prepared, run.part.references);
}

/// The first element's fields as the reference of the lattices; with an exact field, that field.
void build_reference(PartRun& run) {
  run.reference.assign(run.prepared.meshes.size(), {});
  if (run.grids.empty() || !complete(run.grids.front())) return;
  const ElementGrids& first = run.grids.front();
  const std::map<std::string, ReferenceValue> scalars = limits_of(run.prepared, first);
  for (std::size_t i = 0; i < run.prepared.meshes.size(); ++i) {
    const Mesh& mesh = *run.prepared.meshes[i];
    std::vector<NodalVectors> fields;
    for (const fem::Solution& s : first.grids) fields.push_back(at_lattice(run.prepared, i, s.displacement));
    run.reference[i] = Reference{extrapolate(fields, nodal_volumes(mesh)), scalars};
    if (i > 0 || !run.experiment().exact.empty()) continue;
    const ReferenceField& f = run.reference[i]->field;
    ReferenceRecord record{run.material.poisson_ratio, "displacement_error", "1", {}, {}, f.observed_order, 0, f.uncertainty, f.note,
                           first.element};
    for (std::size_t g = 0; g < 3; ++g) {
      record.cells.push_back(first.grids[g].grid.cells);
      record.values.push_back(displacement_error(fields[g], f.displacement, nodal_volumes(mesh)));
    }
    run.part.references.push_back(record);
  }
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

/// Mean and standard deviation of a measure over the samples that have it.
void set_value(const std::vector<std::map<std::string, double>>& samples, const std::string& measure, Row& row) {
  double sum = 0, squares = 0;
  row.samples = 0;
  for (const auto& sample : samples) {
    const auto at = sample.find(measure);
    if (at == sample.end()) continue;
    ++row.samples;
    sum += at->second;
    squares += at->second * at->second;
  }
  row.value = sum / row.samples;
  if (row.samples > 1)
    row.spread = std::sqrt(std::max(0.0, squares - sum * row.value) / (row.samples - 1));
}

std::set<std::string> measures_in(const std::vector<std::map<std::string, double>>& samples) {
  std::set<std::string> names;
  for (const auto& sample : samples)
    for (const auto& [measure, value] : sample) names.insert(measure);
  return names;
}

/// One displacement field and one set of scalars per sample.
void add_rows(PartRun& run, std::size_t lattice, const std::string& model, const std::string& kinematics,
              const std::vector<NodalVectors>& u, const std::vector<std::map<std::string, double>>& scalars) {
  const auto& reference = run.reference[lattice];
  const Row blank{run.experiment().name, kinematics, model, run.material.poisson_ratio,
                  run.experiment().body.cells[lattice], "", 0, "", {}, {}, {}, 1, {}};
  for (const std::string& measure : measures_in(scalars)) {
    if (!wanted(measure, run.experiment().measures)) continue;
    Row row = blank;
    row.measure = measure;
    set_value(scalars, measure, row);
    row.unit = unit_of(measure);
    if (is_deviation(measure)) row.error = row.value;
    if (reference && reference->scalars.contains(measure) && comparable(run.prepared, measure)) {
      const ReferenceValue& r = reference->scalars.at(measure);
      row.reference = r.value;
      row.reference_uncertainty = r.uncertainty;
      row.error = row.value - r.value;
    }
    run.part.rows.push_back(row);
  }
  if (!reference) return;
  // What the reference may be off, node by node, measured by the same ruler.
  NodalVectors doubt = reference->field.displacement;
  doubt.col(0) += reference->field.nodal_uncertainty;
  const std::map<std::string, double> uncertainty = distances(run, lattice, doubt);
  std::vector<std::map<std::string, double>> of_samples;
  for (const NodalVectors& field : u) of_samples.push_back(distances(run, lattice, field));
  for (const std::string& measure : measures_in(of_samples)) {
    if (!wanted(measure, run.experiment().measures)) continue;
    Row row = blank;
    row.measure = measure;
    set_value(of_samples, measure, row);
    row.unit = unit_of(measure);
    row.reference = 0.0;
    row.reference_uncertainty = uncertainty.at(measure);
    row.error = row.value;
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

void add_line(PartRun& run, std::size_t lattice, const std::string& model, LineRecord line) {
  line.model = model;
  line.poisson_ratio = run.material.poisson_ratio;
  line.cells = run.experiment().body.cells[lattice];
  run.part.lines.push_back(std::move(line));
}

void run_model(PartRun& run, std::size_t lattice, std::size_t number) {
  const Experiment& e = run.experiment();
  const std::string& label = e.models[number].label;
  const std::string kind = e.model_kinematics() == Kinematics::linear ? "linear" : "finite";
  const std::vector<Sample> samples = run_samples(run.prepared, lattice, number, run.material);
  std::vector<NodalVectors> fields;
  std::vector<std::map<std::string, double>> scalars;
  for (const Sample& sample : samples) {
    const Equilibrium& s = sample.state;
    run.part.runs.push_back({label, "msm", run.material.poisson_ratio, e.body.cells[lattice], kind, s.ok, s.message, s.solver,
                             s.iterations, s.residual, s.seconds, s.unknowns, s.memory_MiB});
    if (!s.ok) continue;
    if (fields.empty()) {
      save(run, lattice, label, sample.field);
      if (sample.line) add_line(run, lattice, label, *sample.line);
    }
    fields.push_back(sample.field.displacement);
    scalars.push_back(sample.scalars);
  }
  if (!fields.empty()) add_rows(run, lattice, label, kind, fields, scalars);
}

/// Builds the model and puts the loads on it, for what may be wrong with either.
void try_model(const Experiment& experiment, const ModelParameters& parameters, const Mesh& mesh, const Region* region) try {
  const auto [model, embedding] = build_embedded(parameters, mesh, experiment.materials.front(), region);
  if (parameters.row.topology == Topology::cells) return;
  const BoundaryConditions bc = transfer(experiment.loads, mesh, embedding, model.network, 1000, experiment.model_kinematics());
  if (!parameters.hold_rigid_motions) require_supported(bc, model.network.X);
} catch (const InputError&) {
  throw;
} catch (const std::runtime_error&) {
  // No network with this material's moduli: the run will say so.
}

/// The loads that a lattice can be tried with before the work starts: all but the body forces of exact fields.
std::vector<Load> lattice_loads(const Experiment& experiment) {
  std::vector<Load> loads;
  for (const Load& load : experiment.loads)
    if (!std::holds_alternative<FieldBodyForce>(load)) loads.push_back(load);
  return loads;
}

}  // namespace

PreparedCase prepare(const Experiment& experiment) {
  PreparedCase prepared{experiment, {}, {}, {}, reference_cells(experiment), {}, {}};
  for (int n : prepared.reference_cells)
    if (n % 4 != 0 && n != 1)
      throw InputError(fmt::format("{}: reference.cells: {} is not 1 or divisible by 4 (the grid is halved twice)", experiment.file.string(), n));
  for (const Cells& c : experiment.body.cells)
    if (const double total = double(c[0]) * c[1] * c[2]; total > largest_lattice)
      throw InputError(experiment.body.where, fmt::format("cells: {} x {} x {} = {:.3g} cells (allowed: up to {:.0g}; a lattice takes some 3 kB per cell)",
                                                          c[0], c[1], c[2], total, largest_lattice));
  for (const Expectation& e : experiment.expectations) {
    if (e.value || e.at_least) continue;
    if (reference_element(experiment, e.model))
      throw InputError(e.location, "value: an expectation of the reference itself needs one");
    if (e.relative && is_distance(e.measure))
      throw InputError(e.location, fmt::format("within_relative: {} is expected to be 0; give an absolute `within`", e.measure));
  }
  for (const ModelChoice& choice : experiment.models) prepared.models.push_back(resolve(choice));
  try {
    prepared.geo = find_geo(experiment.body, experiment.file);
    for (const Cells& cells : experiment.body.cells) {
      const LatticeBody body = lattice_body(prepared.geo, experiment.body, cells);
      prepared.meshes.push_back(body.mesh);
      prepared.regions.push_back(body.region);
      const Mesh& mesh = *prepared.meshes.back();
      std::vector<std::string> patches;
      for (const Patch& p : mesh.patches) patches.push_back(p.name);
      check_patches(experiment, patches);
      prepared.sharing = patches_sharing_supports(experiment.loads, mesh, experiment.model_kinematics());
      if (std::none_of(prepared.models.begin(), prepared.models.end(), [](const auto& p) { return p.hold_rigid_motions; }))
        require_supported(transfer(lattice_loads(experiment), mesh, 1000, experiment.model_kinematics()), mesh.nodes);
      for (const ModelParameters& p : prepared.models)
        if (p.row.topology == Topology::cells || prepared.meshes.size() == 1) try_model(experiment, p, mesh, body.region.get());
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
  const std::vector<fem::Solution> peers = prepared.experiment.reference.elements.empty() ? std::vector<fem::Solution>() : run_fem(run);
  record_elements(run);
  build_reference(run);
  for (std::size_t lattice = 0; lattice < prepared.meshes.size(); ++lattice) {
    if (run.reference[lattice]) {
      Field field = sampled_field(prepared, lattice, run.grids.front().grids.back());
      field.displacement = run.reference[lattice]->field.displacement;
      save(run, lattice, "fem", field);
    }
    if (lattice < peers.size()) {
      const fem::Solution& s = peers[lattice];
      run.part.runs.push_back(fem_run(run, s, "fem_q1"));
      if (s.ok) {
        add_rows(run, lattice, "fem_q1", run.part.runs.back().kinematics, {at_lattice(prepared, lattice, s.displacement)}, {measures_of(prepared, s)});
        save(run, lattice, "fem_q1", sampled_field(prepared, lattice, s));
      }
    }
    for (std::size_t m = 0; m < prepared.models.size(); ++m) run_model(run, lattice, m);
  }
  if (prepared.experiment.line) add_line_orders(prepared.experiment, run.part.rows);
  return std::move(run.part);
}

}  // namespace springproof
