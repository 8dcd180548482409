#include "comparisons/advise/pilot.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <set>

#include "comparisons/judge/deformation.h"
#include "comparisons/judge/measures.h"
#include "comparisons/judge/reference_value.h"
#include "comparisons/prepare/refined_lattice.h"
#include "comparisons/prepare/sampling.h"
#include "comparisons/prepare/voxel_body.h"
#include "comparisons/reference/reference_grids.h"
#include "comparisons/run/prepare.h"
#include "fem_reference/exchange/reference.h"
#include "meshes/locate/locate.h"
#include "meshes/volume.h"
#include "msm/embedding/rigid_motions.h"
#include "msm/models.h"
#include "msm/statics/equilibrium.h"
#include "problem/system/progress.h"
#include "problem/system/run_cost.h"

namespace springproof {
namespace {

constexpr double large_displacement_share = 0.15;  // of the cells, where each is solved by Newton's method
constexpr double voxel_share = 0.6;                // of the cells of a cut body, whose solver takes more iterations
constexpr double quadratic_share = 0.75;           // of the models' cells along an edge, for quadratic elements
constexpr double seconds_to_measure = 7e-3;        // of processor, a cut cell
constexpr double most_pilot_cells = 5e5;           // of any lattice of a pilot
constexpr double most_beyond_refined = 4;          // cells over those of the finest refined lattice that was solved

/// A model solved on a lattice.
struct LatticeSolve {
  Equilibrium state;
  NodalVectors field;  ///< at the lattice's nodes [m]
  double seconds = 0;
};

LatticeSolve solve_on(const PreparedCase& prepared, const Lattice& lattice, const ModelParameters& parameters,
                      const IsotropicMaterial& material) {
  const Kinematics kinematics = prepared.experiment.model_kinematics();
  const double start = cpu_seconds();
  const auto [model, embedding] = build_on(prepared, lattice, parameters, material, false);
  const LoadPath path = [&, &m = model, &e = embedding](double factor) {
    return transfer(prepared.loads, *lattice.mesh, e, m.network, material.density, kinematics, factor);
  };
  LatticeSolve out;
  out.state = kinematics == Kinematics::linear ? solve_linear(model, path(1), {LinearSolver::automatic, 1e-8, 2000})
                                               : solve_finite(model, path);
  out.seconds = cpu_seconds() - start;
  if (out.state.ok) out.field = embedding.weights * out.state.displacement;
  return out;
}

/// The displacement of a solve at other points.
NodalVectors at_points(const Lattice& lattice, const ModelParameters& p, const LatticeSolve& solve,
                       const NodalVectors& points) {
  if (p.cut.value_or(false)) return displacement_at(*lattice.cut, solve.state.displacement, points);
  const Locator locator(*lattice.mesh);
  NodalVectors out = NodalVectors::Zero(points.rows(), 3);
  for (Eigen::Index i = 0; i < points.rows(); ++i) {
    const Location at = locator(points.row(i).transpose());
    for (int n = 0; n < 8; ++n) out.row(i) += at.shape[n] * solve.field.row(lattice.mesh->hexahedra[at.cell][n]);
  }
  return out;
}

double cells_of(const Lattice& lattice) { return static_cast<double>(lattice.mesh->hexahedra.size()); }

/// The resolutions of a pilot: those of every model, then the three of the reference, as multiples of the coarsest
/// lattice of a block or as numbers of cubes.
struct Resolutions {
  std::vector<int> every, reference;
  std::set<int> all = {};
};

/// About in the ratio of 2 of edges, where there is room for it.
std::vector<int> three_multiples(int top) {
  if (top >= 8) top -= top % 4;
  if (top % 4 == 0) return {top / 4, top / 2, top};
  return {std::max(1, static_cast<int>(std::lround(top / 2.25))), std::max(2, static_cast<int>(std::lround(top / 1.5))),
          top};
}

Resolutions multiples_of(const Cells& base, const PilotSize& size) {
  const double one = double(base[0]) * base[1] * base[2];
  Resolutions out;
  for (const int m : {2, 3, 4, 6, 8, 12, 16, 24})  // one cell between two supports has no free node
    if (m <= 3 || one * m * m * m <= size.cells) out.every.push_back(m);
  const int top = std::max({6, 2 * out.every.back(), static_cast<int>(std::cbrt(size.reference_cells / one))});
  out.reference = three_multiples(top);
  return out;
}

Resolutions voxel_counts_of(const PilotSize& size) {
  const double fine = size.cells, most = voxel_share * size.reference_cells;
  return {{static_cast<int>(fine / 6), static_cast<int>(fine / 2.5), static_cast<int>(fine)},
          {static_cast<int>(most / 12), static_cast<int>(most / 3.5), static_cast<int>(most)}};
}

/// Of a block of so many times the cells of `base`.
double nodes_of(const Cells& base, double multiple) {
  double nodes = 1;
  for (const int n : base) nodes *= n * multiple + 1;
  return nodes;
}

ModelChoice choice_of(const std::string& name, std::optional<bool> cut) {
  ModelChoice choice{name, {}, name, {}};
  if (cut) choice.options["cut"] = *cut;
  if (cut && !*cut) choice.label += " cut=false";
  return choice;
}

/// The case as the pilot solves it: its models, its lattices, no measures; of a block linear elements beside the
/// models, and quadratic ones on the coarser of their lattices.
Experiment pilot_case(Experiment e, const IsotropicMaterial& material, const std::vector<std::string>& models,
                      const Resolutions& at, const Cells& base) {
  e.materials = {material};
  e.measures.clear();
  e.expectations.clear();
  e.published.clear();
  e.probes.clear();
  e.section.reset();
  e.line.reset();
  e.dynamics.reset();
  e.reference.elements.clear();
  e.models.clear();
  const bool voxels = e.body.is_voxels();
  e.elements = voxels ? std::vector<std::string>{} : std::vector<std::string>{"q1", "q2"};
  e.max_unknowns = 3 * 8 * nodes_of(base, quadratic_share * at.every.back());
  const auto add = [&](const std::string& name) {
    const ModelRow row = resolve(choice_of(name, {})).row;
    const bool finite = e.model_kinematics() == Kinematics::finite;
    if (finite && !can(row, Capability::large_displacements)) return;
    const bool cuts = voxels && has_cut_cells(row) && (!finite || row.extension == Extension::averaging);
    if (cuts) e.models.push_back(choice_of(name, true));
    e.models.push_back(choice_of(name, cuts ? std::optional(false) : std::nullopt));
  };
  add(pilot_reference_model);
  for (const std::string& name : models)
    if (name != pilot_reference_model) add(name);
  e.body.coarsened = false;  // beside the others, by pilot_model()
  e.body.cells.clear();
  e.body.voxel_edges.clear();
  e.body.voxel_counts.clear();
  e.body.accuracies.clear();
  for (const int n : at.all)
    if (voxels)
      e.body.voxel_counts.push_back(n);
    else
      e.body.cells.push_back({n * base[0], n * base[1], n * base[2]});
  return e;
}

/// The extrapolated displacement of the reference at the nodes of a lattice.
ReferenceField reference_at(const std::vector<const Lattice*>& lattices, const std::vector<LatticeSolve>& solves,
                            const ModelParameters& p, const Mesh& mesh) {
  std::vector<NodalVectors> fields;
  for (std::size_t i = 0; i < 3; ++i) fields.push_back(at_points(*lattices[i], p, solves[i], mesh.nodes));
  const auto ratio = [&](std::size_t i) { return std::cbrt(cells_of(*lattices[i + 1]) / cells_of(*lattices[i])); };
  return extrapolate(fields, nodal_volumes(mesh), {ratio(0), ratio(1)});
}

/// Whether the cells of a model can be measured in finer ones.
bool can_be_measured(const Experiment& e, const ModelParameters& p) {
  const bool finite = e.model_kinematics() == Kinematics::finite;
  return p.cut.value_or(false) && p.row.extension == Extension::averaging && p.shift == 0 &&
         p.curve.value_or(StrainCurve::hencky) == StrainCurve::hencky && (e.regions.empty() || !finite);
}

/// A pilot while it is being solved.
struct PilotRun {
  const PreparedCase& prepared;
  const IsotropicMaterial& material;
  std::vector<const Lattice*> every, reference;
  std::vector<LatticeSolve> reference_solves;
  std::vector<ReferenceField> truths;  ///< at the nodes of each of `every`
  double share = 1;                    ///< of the displacement that errors are relative to (DisplacementScale)

  /// Of a displacement at the nodes of every[i].
  double error(std::size_t i, const NodalVectors& u) const {
    return displacement_error(u, truths[i].displacement, nodal_volumes(*every[i]->mesh)) / share;
  }
};

std::string label_of(const PilotRun& run, std::size_t number, bool measured) {
  return run.prepared.experiment.models[number].label + (measured ? " coarsened=true" : "");
}

/// @param measured its cells are measured in finer ones
PilotModel pilot_model(const PilotRun& run, std::size_t number, bool measured = false) try {
  ModelParameters p = run.prepared.models[number];
  p.coarsened = measured;
  PilotModel out;
  out.label = label_of(run, number, measured);
  std::vector<NodalVectors> fields;
  Lattice last = *run.every.back();
  if (measured) last.measured = to_be_measured(run.prepared, last);
  for (std::size_t i = 0; i < run.every.size(); ++i) {
    Lattice lattice = i + 1 < run.every.size() ? *run.every[i] : last;
    if (measured) {
      progress::phase(fmt::format("measuring {} cells", lattice.cut->cells.size()));
      if (!lattice.measured) lattice.measured = to_be_measured(run.prepared, lattice);
      describe(lattice.measured->measured(p, run.material));
    }
    progress::phase(fmt::format("{} on {} cells", out.label, cells_of(lattice)));
    const LatticeSolve s = solve_on(run.prepared, lattice, p, run.material);
    if (!s.state.ok) {
      out.failure = s.state.message;
      continue;
    }
    out.cells.push_back(cells_of(lattice));
    out.errors.push_back(run.error(i, s.field));
    fields.push_back(at_points(lattice, p, s, last.mesh->nodes));
  }
  if (out.cells.empty()) return out;
  const auto own = own_poisson_ratio(p.row);
  if (own && !same_poisson_ratio(*own, run.material.poisson_ratio) && fields.size() > 1)
    extrapolate_fields(out, fields, run.truths.back().displacement, nodal_volumes(*last.mesh), run.share);
  else
    extrapolate_errors(out);
  if (measured) {
    const double of_cube = static_cast<double>(last.cut->cells.size()) / cells_of(last);  // less on finer lattices
    out.most_cells = most_measured_cells / of_cube;
    out.making = seconds_to_measure * of_cube;
  }
  if (p.cut.value_or(false))
    out.step = step_cost([&] { return build_on(run.prepared, last, p, run.material, true).model; },
                         run.material.density, cells_of(last), last.voxel_edge);
  return out;
} catch (const InputError&) {
  throw;
} catch (const std::exception& e) {  // no network with this material's moduli, or of this few cells
  return {.label = label_of(run, number, measured), .failure = e.what()};
}

/// Whether a case could ask for cells of several sizes.
bool can_be_refined(const PilotRun& run) {
  const Experiment& e = run.prepared.experiment;
  return run.prepared.models.front().cut.value_or(false) && e.regions.empty() &&
         e.model_kinematics() == Kinematics::linear;
}

/// The model of the reference in the cells of its coarsest lattice, refined step by step, far below the reference.
PilotModel pilot_of_refined(const PilotRun& run) try {
  const ModelParameters& p = run.prepared.models.front();
  PilotModel out;
  out.label = run.prepared.experiment.models.front().label + " accuracy";
  Lattice lattice = *run.every.back();  // whose nodes the displacements are compared at
  const Mesh& body = *run.prepared.body.tetrahedra.back();
  const VoxelGrid& coarse = run.every.front()->cut->grid;
  const double of_cube = static_cast<double>(lattice.cut->cells.size()) / cells_of(lattice);
  Refinement refinement(run.prepared, coarse, body);
  double promised = refinement.until(1).promised();
  const auto most = static_cast<double>(run.reference.front()->cut->cells.size());
  while (out.cells.size() < 4) {
    const double start = cpu_seconds();
    RefinedBody refined = refinement.until(0.8 * promised);
    promised = refined.promised();
    const auto cut_cells = static_cast<double>(refined.cut.cells.size());
    if (!refined.reached || cut_cells > 2 * most) break;
    Lattice finer = lattice;
    finer.cut = std::make_shared<CutBody>(std::move(refined.cut));
    const LatticeSolve s = solve_on(run.prepared, finer, p, run.material);
    if (!s.state.ok) break;
    lattice = std::move(finer);
    out.cells.push_back(cut_cells / of_cube);  // as many as of the other models
    out.making = (cpu_seconds() - start) / out.cells.back();
    out.errors.push_back(run.error(run.every.size() - 1, s.field));
    out.promised.push_back(promised);
  }
  if (out.cells.empty()) {
    out.failure = "no refinement within the reference's cells has a smaller error";
    return out;
  }
  extrapolate_errors(out);
  const double cells = out.cells.back();
  out.most_cells = most_beyond_refined * cells;
  out.step = step_cost([&] { return build_on(run.prepared, lattice, p, run.material, true).model; },
                       run.material.density, cells, std::cbrt(run.prepared.lattices.front().region->volume / cells));
  return out;
} catch (const std::exception& e) {  // nothing holds the body, or it has too few cells
  return {.label = run.prepared.experiment.models.front().label + " accuracy", .failure = e.what()};
}

/// The finite elements of a block on the lattices of the models; none where they cannot be run.
std::vector<PilotModel> pilot_elements(const PilotRun& run) {
  std::vector<PilotModel> out;
  if (run.prepared.experiment.elements.empty() || !fem::available()) return out;
  progress::phase("finite elements");
  PreparedCase coarse = run.prepared;
  coarse.lattices.clear();
  for (const Lattice* lattice : run.every) add_lattice(*lattice, coarse);
  const ReferenceGrids grids = solve_grids(coarse, run.material);
  for (const std::string& element : coarse.experiment.elements) {
    PilotModel m;
    m.label = "fem_" + element;
    for (std::size_t i = 0; i < grids.peers.size(); ++i)
      for (const fem::Solution& s : grids.peers[i]) {
        if (!s.ok || s.grid.element != element) continue;
        m.cells.push_back(cells_of(coarse.lattices[i]));
        m.errors.push_back(run.error(i, at_nodes(coarse.lattices[i], s.displacement)));
      }
    if (m.cells.empty()) continue;
    extrapolate_errors(m);
    out.push_back(m);
  }
  return out;
}

void check_loads(const PreparedCase& prepared) {
  const Experiment& e = prepared.experiment;
  const Mesh& mesh = *prepared.lattices.front().mesh;
  std::vector<std::string> patches;
  for (const Patch& p : mesh.patches) patches.push_back(p.name);
  check_patches(e, patches);
  require_supported(transfer(prepared.loads, mesh, 1000, e.model_kinematics()), mesh.nodes);
}

Cells coarsest(const Body& body) {
  if (body.is_voxels()) return {0, 0, 0};
  const Cells& c = body.cells.front();
  const int common = std::gcd(std::gcd(c[0], c[1]), c[2]);
  const Cells base = {c[0] / common, c[1] / common, c[2] / common};
  if (const double finest = 216.0 * base[0] * base[1] * base[2]; finest > most_pilot_cells)
    throw InputError(body.where,
                     fmt::format("cells: {} x {} x {} have no coarser lattice than {} x {} x {}, and advice needs six "
                                 "times as many along each edge (allowed: up to {:.0g} cells then)",
                                 c[0], c[1], c[2], base[0], base[1], base[2], most_pilot_cells));
  return base;
}

}  // namespace

Pilot solve_pilot(const Experiment& experiment, const IsotropicMaterial& material,
                  const std::vector<std::string>& models, const PilotSize& asked) {
  PilotSize size = asked;
  if (experiment.model_kinematics() == Kinematics::finite) {
    size.cells *= large_displacement_share;
    size.reference_cells *= large_displacement_share;
  }
  Pilot out;
  out.material = material;
  out.experiment_is_linear = experiment.model_kinematics() == Kinematics::linear;
  out.base = coarsest(experiment.body);
  Resolutions at = experiment.body.is_voxels() ? voxel_counts_of(size) : multiples_of(out.base, size);
  for (const auto* some : {&at.every, &at.reference}) at.all.insert(some->begin(), some->end());
  const Experiment e = pilot_case(experiment, material, models, at, out.base);
  const PreparedCase prepared = prepare_lattices(e);
  check_loads(prepared);
  PilotRun run{prepared, material, {}, {}, {}, {}};
  const auto lattice_at = [&](int n) { return &prepared.lattices[std::distance(at.all.begin(), at.all.find(n))]; };
  for (const int n : at.every) run.every.push_back(lattice_at(n));
  for (const int n : at.reference) run.reference.push_back(lattice_at(n));
  for (const Lattice* lattice : run.reference) {
    progress::phase(fmt::format("reference on {} cells", cells_of(*lattice)));
    run.reference_solves.push_back(solve_on(prepared, *lattice, prepared.models.front(), material));
    if (const Equilibrium& s = run.reference_solves.back().state; !s.ok)
      throw std::runtime_error(fmt::format("{}: {} has no equilibrium on {} cells: {}", experiment.file.string(),
                                           pilot_reference_model, cells_of(*lattice), s.message));
  }
  out.reference_cells = cells_of(*run.reference.back());
  out.reference_seconds = run.reference_solves.back().seconds;
  out.reference = fmt::format("{} on {:g}, {:g} and {:g} cells, extrapolated", pilot_reference_model,
                              cells_of(*run.reference[0]), cells_of(*run.reference[1]), out.reference_cells);
  for (const Lattice* lattice : run.every)
    run.truths.push_back(reference_at(run.reference, run.reference_solves, prepared.models.front(), *lattice->mesh));
  const Mesh& mesh = *run.every.back()->mesh;
  const NodalVectors& u = run.truths.back().displacement;
  run.share = scale_of_errors(prepared, *run.every.back(), u).share;
  out.uncertainty = run.truths.back().uncertainty / run.share;
  out.shares = load_shares(mesh, u, material);
  const DeformationSize deformation = deformation_size(mesh, u, e.model_kinematics());
  out.strain = deformation.principal_strain;
  out.rotation_deg = deformation.rotation * 180 / std::numbers::pi;
  out.size = prepared.body.size;
  out.volume = volume(mesh, mesh.nodes);
  for (std::size_t m = 0; m < prepared.models.size(); ++m) {
    out.models.push_back(pilot_model(run, m));
    if (can_be_measured(e, prepared.models[m])) out.models.push_back(pilot_model(run, m, true));
  }
  if (can_be_refined(run)) out.models.push_back(pilot_of_refined(run));
  out.elements = pilot_elements(run);
  return out;
}

}  // namespace springproof
