#include "comparisons/models/frequencies.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <numbers>
#include <numeric>

#include "comparisons/reference/reference_grids.h"
#include "comparisons/reference/solve_each.h"
#include "fem_reference/exchange/case_request.h"
#include "meshes/volume.h"
#include "msm/dynamics/natural_modes.h"
#include "msm/embedding/boundary.h"
#include "problem/processes/child.h"
#include "problem/system/progress.h"

namespace springproof {
namespace {

// Elements (Q2) of the finest grid of a block at most: what a direct solver factors in some ten seconds.
constexpr double most_mode_elements = 1728;
constexpr int modes_beside = 6;         // computed beside those compared, as partners and for whole multiplets
constexpr double eigenvalue_order = 4;  // of frequencies with quadratic elements in smooth solutions

std::string element_of(const PreparedCase& prepared) { return prepared.experiment.body.is_voxels() ? "p2" : "q2"; }

/// Without grids.
fem::Request mode_request(const Experiment& e, const IsotropicMaterial& material, int modes) {
  fem::Request request = fem::request_of(e, material);
  request.material = material;
  request.law = "linear";
  request.loads = supports_of(e);
  request.modes = modes;
  return request;
}

/// Three grids, coarse to fine.
fem::Request reference_request(const PreparedCase& prepared, const IsotropicMaterial& material, int modes) {
  const Experiment& e = prepared.experiment;
  const std::string element = element_of(prepared);
  fem::Request request = mode_request(e, material, modes);
  if (e.body.is_voxels()) {
    request.points = prepared.samples.points;
    request.meshes = prepared.body.tetrahedra;
    for (int m = 0; m < 3; ++m) request.grids.push_back({{prepared.body.uncut[m], 0, 0}, element, 1.0, m, 0});
    return request;
  }
  request.points = lattice_points(prepared);
  double elements = 1;  // as the case says, if it does
  for (const int n : e.reference.cells) elements *= n;
  const Cells fine =
      divisible_cells(e.body.size, elements > 0 ? std::min(elements, most_mode_elements) : most_mode_elements);
  for (const int divisor : {4, 2, 1})
    request.grids.push_back({divided(fine, divisor), element, request.loads.empty() ? 1.0 : e.reference.grading});
  return request;
}

/// A free block: no edge at which stresses are singular.
bool has_smooth_modes(const PreparedCase& prepared) {
  const Experiment& e = prepared.experiment;
  return supports_of(e).empty() && !e.body.is_voxels() &&
         std::abs(volume(*prepared.lattices[0].mesh, prepared.lattices[0].mesh->nodes) / e.body.size.prod() - 1) < 1e-9;
}

/// At the nodes of every lattice, one after the other.
ModeSet modes_at_nodes(const PreparedCase& prepared, const fem::Solution& s) {
  ModeSet out{s.frequencies, {}};
  for (const NodalVectors& u : s.shapes)
    out.shapes.push_back(prepared.experiment.body.is_voxels() ? at_lattice_nodes(prepared, u) : u);
  return out;
}

Eigen::VectorXd weights_of_nodes(const PreparedCase& prepared) {
  Eigen::VectorXd weights(prepared.nodes());
  for (const Lattice& lattice : prepared.lattices)
    weights.segment(lattice.first_node, lattice.mesh->nodes.rows()) = nodal_volumes(*lattice.mesh);
  return weights;
}

/// Limits of near frequencies may be in another order than those of the finest grid.
void put_in_order(FrequencyTable& table) {
  std::vector<std::size_t> order(table.reference.size());
  std::iota(order.begin(), order.end(), 0);
  std::ranges::stable_sort(order, [&](auto a, auto b) { return table.reference[a].value < table.reference[b].value; });
  const FrequencyTable before = table;
  for (std::size_t i = 0; i < order.size(); ++i) {
    table.reference[i] = before.reference[order[i]];
    table.shapes.frequencies[i] = before.shapes.frequencies[order[i]];
    table.shapes.shapes[i] = before.shapes.shapes[order[i]];
  }
}

constexpr int fixed_point_steps = 20;  // more than a frequency of 12 digits needs

/// The frequencies of a material that relaxes, each at the storage modulus of itself: between those of long times and
/// of a sudden strain, of whose shear modulus the square of a frequency is all but a linear function.
/// @param low modes of long times, whose frequencies become these
/// @param high of a sudden strain
/// @return how each is damped, by the loss modulus, share of critical
std::vector<double> relax(const Relaxation& relaxation, const ModeSet& high, const Eigen::VectorXd& weights,
                          ModeSet& low) {
  const std::vector<ModePair> pairs = pair_modes(low, high, weights);
  const double sudden = relaxation.instantaneous();
  std::vector<double> damping;
  for (std::size_t i = 0; i < low.frequencies.size(); ++i) {
    double& f = low.frequencies[i];
    const double square = f * f,
                 other = pairs[i].partner ? std::pow(high.frequencies[*pairs[i].partner], 2) : sudden * square,
                 slope = (other - square) / (sudden - 1);
    for (int step = 0; step < fixed_point_steps; ++step)
      f = std::sqrt(square + slope * (relaxation.storage(2 * std::numbers::pi * f) - 1));
    damping.push_back(slope * relaxation.loss(2 * std::numbers::pi * f) / (2 * f * f));
  }
  return damping;
}

/// Modes of a material, which may relax; none where those of a sudden strain have no result.
/// @param of the modes of a solid
template <class Modes>
ModeSet relaxing_modes(const Relaxation& relaxation, const IsotropicMaterial& material, const Eigen::VectorXd& weights,
                       const Modes& of) {
  ModeSet modes = of(material);
  if (!relaxation.acts() || modes.frequencies.empty()) return modes;
  const ModeSet sudden = of(with_shear(material, relaxation.instantaneous()));
  if (sudden.frequencies.empty()) return sudden;
  modes.damping = relax(relaxation, sudden, weights, modes);
  return modes;
}

/// A table of the reference alone, its shapes at the nodes of every lattice, one after the other.
FrequencyTable reference_modes(const PreparedCase& prepared, const IsotropicMaterial& material, int modes) try {
  FrequencyTable out;
  out.material = material;
  out.element = element_of(prepared);
  const auto solved_at = [&](const IsotropicMaterial& solid) {
    std::vector<fem::Solution> all = solve_each(reference_request(prepared, solid, modes + modes_beside));
    for (const fem::Solution& s : all)
      if (!s.ok) throw std::runtime_error(fmt::format("{} cells: {}", cells_text(s.grid.cells, " x "), s.message));
    return all;
  };
  const ElementGrids grids{out.element, solved_at(material)};
  out.form = grids.grids[2].form;
  out.rigid_motions = grids.grids[2].rigid_motions;
  std::vector<ModeSet> of_grids;
  for (const fem::Solution& s : grids.grids) of_grids.push_back(modes_at_nodes(prepared, s));
  const Relaxation& relaxation = prepared.experiment.relaxation;
  if (relaxation.acts()) {
    const std::vector<fem::Solution> sudden = solved_at(with_shear(material, relaxation.instantaneous()));
    for (std::size_t g = 0; g < sudden.size(); ++g)
      relax(relaxation, modes_at_nodes(prepared, sudden[g]), weights_of_nodes(prepared), of_grids[g]);
  }
  out.shapes = of_grids[2];
  std::vector<std::vector<double>> values(modes);
  for (const ModeSet& s : of_grids) {  // modes may cross from grid to grid
    const auto pairs = pair_modes(out.shapes, s, weights_of_nodes(prepared));
    for (int i = 0; i < modes; ++i) values[i].push_back(s.frequencies[pairs[i].partner.value_or(i)]);
  }
  const TrustedOrders orders{.highest = has_smooth_modes(prepared) ? eigenvalue_order : clamped_order};
  std::map<std::string, ReferenceValue> limits;  // in their order, each the one component of its own vector
  for (int i = 0; i < modes; ++i)
    limits[fmt::format("frequency.{:03}.value", i + 1)] =
        extrapolate(values[i], solver_noise * values[i][2], orders, ratios_of(grids));
  raise_to_usual(limits);
  for (const auto& [name, limit] : limits) out.reference.push_back(limit);
  put_in_order(out);
  return out;
} catch (const std::runtime_error& e) {
  FrequencyTable none;
  none.material = material;
  none.element = element_of(prepared);
  none.failure = e.what();
  return none;
}

void compare(const FrequencyTable& table, const Eigen::VectorXd& weights, ModelFrequencies& model) {
  const std::vector<ModePair> pairs = pair_modes(table.shapes, model.modes, weights);
  int count = 0;
  for (std::size_t i = 0; i < table.reference.size(); ++i) {
    ModeRow& row = model.rows.emplace_back();
    row.mac = pairs[i].mac;
    if (!pairs[i].partner) continue;
    row.frequency = model.modes.frequencies[*pairs[i].partner];
    const double error = *row.frequency / table.reference[i].value - 1;
    model.largest = std::max(model.largest, std::abs(error));
    model.rms = std::sqrt((count * model.rms * model.rms + error * error) / (count + 1));
    ++count;
  }
}

ModelFrequencies frequencies_of(const PreparedCase& prepared, const Lattice& lattice, std::size_t number, double theta,
                                const IsotropicMaterial& material, int modes) try {
  if (prepared.models[number].springs && prepared.experiment.relaxation.acts())
    throw InputError(prepared.experiment.models[number].where,
                     "compare.models: the springs of a file have one stiffness, which is not that of a vibration where "
                     "they relax (allowed beside [material.relaxation]: models by name)");
  ModelFrequencies out;
  out.label = prepared.experiment.models[number].label;
  out.consistency = theta;
  const auto modes_of = [&](const IsotropicMaterial& solid) {
    const auto [model, embedding] = build_on(prepared, lattice, prepared.models[number], solid, false);
    const BoundaryConditions supports = transfer(supports_of(prepared.experiment), *lattice.mesh, embedding,
                                                 model.network, solid.density, Kinematics::linear);
    const NaturalModes found = natural_modes(model, supports.fixed, solid.density, theta, modes + modes_beside);
    if (out.message.empty()) out.message = found.message;
    out.solver = found.solver;
    out.seconds += found.seconds;
    ModeSet at_nodes{found.frequencies, {}};
    for (const NodalVectors& u : found.shapes) at_nodes.shapes.emplace_back(embedding.weights * u);
    return at_nodes;
  };
  out.modes = relaxing_modes(prepared.experiment.relaxation, material, nodal_volumes(*lattice.mesh), modes_of);
  return out;
} catch (const InputError&) {
  throw;
} catch (const std::exception& e) {  // no network with this material's moduli
  ModelFrequencies none;
  none.label = prepared.experiment.models[number].label;
  none.consistency = theta;
  none.message = e.what();
  return none;
}

/// By the axis along which most of a mode's motion is.
std::map<std::string, double> by_axis(const ModeSet& modes, const Eigen::VectorXd& weights) {
  std::map<std::string, double> lowest;
  for (std::size_t i = 0; i < modes.shapes.size(); ++i) {
    Eigen::Index axis = 0;
    (weights.transpose() * modes.shapes[i].cwiseAbs2()).maxCoeff(&axis);
    lowest.emplace(std::string("frequency.") + "xyz"[axis], modes.frequencies[i]);
  }
  return lowest;
}

constexpr int modes_for_axes = 3;

}  // namespace

std::map<std::string, double> lowest_frequencies(const PreparedCase& prepared, const Lattice& lattice,
                                                 std::size_t number, const IsotropicMaterial& material) {
  return by_axis(frequencies_of(prepared, lattice, number, 0, material, modes_for_axes).modes,
                 nodal_volumes(*lattice.mesh));
}

std::map<std::string, double> lowest_frequencies(const PreparedCase& prepared, const Lattice& lattice,
                                                 const std::string& element, const IsotropicMaterial& material) try {
  const Eigen::VectorXd weights = nodal_volumes(*lattice.mesh);
  const auto modes_of = [&](const IsotropicMaterial& m) -> ModeSet {
    fem::Request request = mode_request(prepared.experiment, m, modes_for_axes + modes_beside);
    request.points = lattice.mesh->nodes;
    request.grids = {{lattice.cells, element}};
    const fem::Solution solved = solve_each(request).front();
    return {solved.frequencies, solved.shapes};
  };
  return by_axis(relaxing_modes(prepared.experiment.relaxation, material, weights, modes_of), weights);
} catch (const std::runtime_error&) {  // as a grid without a result
  return {};
}

std::vector<ReferenceRecord> records_of(const FrequencyTable& table) {
  std::vector<ReferenceRecord> records;
  for (const ReferenceValue& value : table.reference) {
    ReferenceRecord& r = records.emplace_back();
    r.poisson_ratio = table.material.poisson_ratio;
    r.measure = fmt::format("frequency.{}", records.size());
    r.unit = "Hz";
    r.value = value.value;
    r.uncertainty = value.uncertainty;
    r.note = value.note;
    r.element = table.element;
  }
  return records;
}

std::vector<Load> supports_of(const Experiment& e) {
  std::vector<Load> supports;
  std::ranges::copy_if(e.loads, std::back_inserter(supports), prescribes_displacement);
  return supports;
}

Experiment case_of_modes(Experiment e, const FrequencyOptions& options) {
  if (options.free && !e.body.accuracies.empty())
    throw InputError(e.body.where,
                     "body.accuracy: cells are halved where the loads strain the body at rest, and --free leaves them "
                     "out (allowed: voxels, or voxel_edge_m, alone)");
  if (options.free) {
    e.loads.clear();
    e.load_locations.clear();
  }
  for (const ModelChoice& m : e.models)  // whose cells have one density
    if (!is_external(m) && resolve(m).coarsened.value_or(e.body.coarsened))
      require_one_material(e, "the frequencies of coarsened cells");
  e.measures.clear();
  e.expectations.clear();
  e.elements.clear();
  if (e.reference.elements.empty()) e.reference.elements = {"q2"};  // the reference of modes is always there
  e.kinematics = "linear";
  std::erase_if(e.models, is_external);
  for (ModelChoice& m : e.models) m.in_motion = false;
  return e;
}

std::vector<FrequencyTable> natural_frequencies(const PreparedCase& prepared, const IsotropicMaterial& material,
                                                const FrequencyOptions& options) {
  std::vector<std::string> patches;
  for (const Patch& p : prepared.lattices.front().mesh->patches) patches.push_back(p.name);
  check_patches(prepared.experiment, patches);
  const FrequencyTable reference = reference_modes(prepared, material, options.modes);
  const auto go_on = [] {
    if (children_interrupted()) throw std::runtime_error("interrupted");
  };
  std::vector<FrequencyTable> tables;
  for (const Lattice& lattice : prepared.lattices) {
    FrequencyTable& table = tables.emplace_back(reference);
    table.lattice = &lattice;
    for (NodalVectors& u : table.shapes.shapes) u = at_nodes(lattice, u);
    const Eigen::VectorXd weights = nodal_volumes(*lattice.mesh);
    for (std::size_t m = 0; m < prepared.models.size(); ++m) {
      const bool cells = prepared.models[m].row.topology == Topology::cells;
      for (const double theta : cells ? options.consistency : std::vector<double>{0}) {
        go_on();
        progress::phase(
            fmt::format("{} on {} cells", prepared.experiment.models[m].label, cells_text(lattice.cells, " x ")));
        table.models.push_back(frequencies_of(prepared, lattice, m, theta, material, options.modes));
        if (table.failure.empty() && table.models.back().message.empty()) compare(table, weights, table.models.back());
      }
    }
  }
  go_on();
  return tables;
}

}  // namespace springproof
