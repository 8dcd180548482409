#include "comparisons/calculix/opinions.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <tuple>

#include "comparisons/calculix/run.h"
#include "comparisons/judge/measures.h"
#include "comparisons/models/frequencies.h"
#include "comparisons/models/motion_reference.h"
#include "comparisons/prepare/sampling.h"
#include "comparisons/reference/reference_grids.h"
#include "comparisons/reference/solve_each.h"
#include "fem_reference/exchange/case_request.h"
#include "meshes/mesher/mesher.h"
#include "meshes/patches/select_patches.h"
#include "meshes/regions/mark_regions.h"
#include "meshes/volume.h"
#include "msm/embedding/boundary.h"
#include "problem/processes/child.h"
#include "problem/system/progress.h"

namespace springproof {
namespace {

// Elements of CalculiX' finest grid: what its direct solver factors in some ten seconds; at finite strain a
// dozen times.
constexpr double linear_elements = 1728, finite_elements = 512;

/// The results of one program on one grid.
struct Answer {
  std::map<std::string, double> values;
  NodalVectors displacement;  ///< at Question::points [m]
};

std::array<Cells, 3> three_grids(const Cells& fine) {
  std::array<Cells, 3> grids;
  for (int g = 0; g < 3; ++g)
    for (int d = 0; d < 3; ++d) grids[g][d] = fine[d] / (4 >> g);
  return grids;
}

/// Near-cubic elements, counts divisible by four; at least eight with reduced integration, as a single element across a
/// body has zero-energy modes.  With regions those of our reference, whose lines are their borders.
Cells finest_cells(const PreparedCase& prepared, const IsotropicMaterial& material, const Cells& given) {
  const Experiment& e = prepared.experiment;
  Cells cells = given[0] == 0 && !e.regions.empty() ? prepared.reference_cells : given;
  if (cells[0] == 0) {
    const double elements = e.model_kinematics() == Kinematics::linear ? linear_elements : finite_elements;
    const double edge = std::cbrt(e.body.size.prod() / elements);
    const int fewest = calculix::needs_reduced_integration(e, material) ? 2 : 1;
    for (int d = 0; d < 3; ++d)
      cells[d] = 4 * std::max(fewest, static_cast<int>(std::lround(e.body.size[d] / edge / 4)));
  }
  for (const int n : cells)
    if (n < 4 || n % 4 != 0)
      throw InputError(fmt::format("{}: {} is not divisible by 4 (the grid is halved twice)",
                                   given[0] > 0 ? "--cells" : "reference.cells", n));
  return cells;
}

/// Grades nodes towards the faces of the body's bounding box, as fem::graded, so that edges affect both programs alike.
void grade(double exponent, Mesh& mesh) {
  const Eigen::RowVector3d low = mesh.nodes.colwise().minCoeff(), high = mesh.nodes.colwise().maxCoeff();
  const double reach = (high - low).minCoeff() / 2;
  for (auto X : mesh.nodes.rowwise())
    for (int d = 0; d < 3; ++d) {
      const double from_low = X[d] - low[d], from_high = high[d] - X[d];
      if (from_low < reach)
        X[d] = low[d] + reach * std::pow(std::max(from_low, 0.0) / reach, exponent);
      else if (from_high < reach)
        X[d] = high[d] - reach * std::pow(std::max(from_high, 0.0) / reach, exponent);
    }
  mesh.grid.reset();
}

/// False for the force or torque on a patch that shares constrained nodes with another, and for magnitudes, which
/// follow from other rows.
bool is_compared(const PreparedCase& prepared, const std::string& measure) {
  if (measure.ends_with("magnitude")) return false;
  if (!measure.starts_with("force.") && !measure.starts_with("torque.")) return true;
  const auto from = measure.find('.') + 1;
  return !prepared.sharing.contains(measure.substr(from, measure.rfind('.') - from));
}

using Noise = calculix::PrintFloor;

double noise_of(const std::string& measure, double value, const Noise& noise) {
  if (measure.starts_with("force.")) return noise.force;
  if (measure.starts_with("torque.")) return noise.torque;
  if (measure.starts_with("frequency.")) return solver_noise * value;
  return measure.starts_with("displacement.") ? noise.displacement : noise.volume;
}

Opinion opinion(const Question& q, const std::vector<Answer>& answers, const Noise& noise) {
  Opinion out;
  GridRatios ratios;
  if (const std::vector<int>& uncut = q.prepared.body.uncut; q.same_meshes())
    ratios = {std::cbrt(double(uncut[1]) / uncut[0]), std::cbrt(double(uncut[2]) / uncut[1])};
  for (const auto& [measure, fine] : answers[2].values)
    if (is_compared(q.prepared, measure))
      out.values[measure] = extrapolate({answers[0].values.at(measure), answers[1].values.at(measure), fine},
                                        noise_of(measure, fine, noise), {}, ratios);
  if (q.modes > 0) return out;
  out.field =
      extrapolate({answers[0].displacement, answers[1].displacement, answers[2].displacement}, q.weights, ratios);
  out.field.nodal_uncertainty.array() += std::sqrt(3.0) * noise.displacement;
  out.finest = answers[2].displacement;
  out.noise = noise.displacement;
  return out;
}

/// By rank: whichever shapes cross, the k-th frequency of a mesh converges to the k-th of the body (min-max principle),
/// and the program's shapes are not read.
std::map<std::string, double> values_of(const std::vector<double>& frequencies, int modes) {
  std::map<std::string, double> values;
  for (int m = 0; m < std::min<int>(modes, static_cast<int>(frequencies.size())); ++m)
    values[fmt::format("frequency.{}", m + 1)] = frequencies[m];
  return values;
}

Answer calculix_answer(const Question& q, const calculix::Deck& deck, const calculix::Solution& s) {
  if (q.modes > 0) return {values_of(s.frequencies, q.modes), {}};
  const std::vector<Probe>& probes = q.experiment().probes;
  const double reach = q.prepared.body.size.norm() / 100;  // of points between two meshes of a curved body
  const auto at = [&](const NodalVectors& points) -> NodalVectors {
    return calculix::weights_at(deck.mesh, deck.linear, points, reach) * s.displacement;
  };
  return {scalar_measures(s.field, probes, at(probe_points(q.experiment()))), at(q.points)};
}

/// The solution of a deck, which is said; nothing where it has none.
std::optional<calculix::Solution> solved(const Question& q, const calculix::Deck& deck, const std::string& run,
                                         Status& status) {
  progress::phase(run);
  calculix::Solution s = calculix::solve(deck, q.time_limit);
  if (children_interrupted()) return {};
  status.print(fmt::format("  {}: {}", run, s.ok ? fmt::format("{:.1f} s", s.seconds) : s.message));
  return s.ok ? std::optional(std::move(s)) : std::nullopt;
}

std::optional<Opinion> calculix_equilibrium(const Question& q, Status& status) {
  std::vector<Answer> answers;
  Noise noise;
  for (int g = 0; g < 3; ++g) {
    const calculix::Deck deck =
        calculix::make_deck(q.experiment(), q.material, *q.meshes[g], {.modes = q.modes, .steps = 0});
    const auto s = solved(q, deck, fmt::format("CalculiX {} {}", deck.element, q.grids[g]), status);
    if (!s) return {};
    answers.push_back(calculix_answer(q, deck, *s));
    noise = s->floor;
  }
  return opinion(q, answers, noise);
}

/// Round-off of our solver: 1e-7 of the largest forces and displacements.
Noise our_noise(const Question& q, const Answer& finest) {
  if (q.modes > 0) return {};
  constexpr double relative = 1e-7;
  const double size = q.prepared.body.size.norm(), u = finest.displacement.rowwise().norm().maxCoeff();
  double force = 0;
  for (const auto& [name, value] : finest.values) {
    if (name.starts_with("force.")) force = std::max(force, std::abs(value));
    if (name.starts_with("torque.")) force = std::max(force, std::abs(value) / size);
  }
  return {relative * force, relative * force * size, relative * u, relative * u / size};
}

fem::Request request_of(const Question& q) {
  const Experiment& e = q.experiment();
  fem::Request request = fem::request_of(e, q.material);
  request.material = q.material;
  request.modes = q.modes;
  if (q.modes > 0) request.loads = supports_of(e);
  request.points = stacked(q.points, probe_points(e));
  if (q.same_meshes()) {
    request.meshes = q.meshes;
    for (int m = 0; m < 3; ++m)
      request.grids.push_back({{static_cast<int>(q.meshes[m]->tetrahedra.size()), 0, 0}, "p2", 1.0, m, 0});
    return request;
  }
  for (const Cells& cells : three_grids(q.prepared.reference_cells)) {
    request.grids.emplace_back().cells = cells;  // Q2
    request.grids.back().grading = e.reference.grading;
  }
  return request;
}

std::optional<Opinion> opinion(const Question& q, std::vector<fem::Solution> solutions, Status& status) {
  const MotionReference limit = limit_of_motion(q.prepared, std::move(solutions));
  if (limit.history.time.empty()) {
    status.print(fmt::format("  no motion to compare: {}", limit.run.message));
    return {};
  }
  Opinion out;
  for (const auto& [name, value] : limit.measured) out.values["motion." + name] = value;
  out.history = limit.history;
  out.uncertainty = limit.uncertainty;
  return out;
}

/// On three grids, and on the middle one in steps twice as long.
std::optional<Opinion> calculix_motion(const Question& q, Status& status) {
  std::vector<fem::Solution> solutions;
  for (const fem::Discretisation& grid : motion_request(q.prepared, q.material).grids) {
    const std::size_t g = solutions.size() == 3 ? 1 : solutions.size();
    const calculix::Deck deck =
        calculix::make_deck(q.experiment(), q.material, *q.meshes[g], {.modes = 0, .steps = grid.steps});
    const auto s =
        solved(q, deck, fmt::format("CalculiX {} {}, {} steps", deck.element, q.grids[g], grid.steps), status);
    if (!s) return {};
    fem::Solution& solution = solutions.emplace_back();
    solution.grid = grid;
    solution.ok = true;
    solution.time = s->time;
    solution.path = s->path;
  }
  return opinion(q, std::move(solutions), status);
}

/// Our solutions, which are said; nothing where one has failed.
std::optional<std::vector<fem::Solution>> solved(const Question& q, const fem::Request& request, Status& status) try {
  std::vector<fem::Solution> solutions = solve_each(request);
  for (const fem::Solution& s : solutions) {
    const std::string grid = q.moves()         ? fmt::format("{} cells, {} steps", s.cells, s.grid.steps)
                             : q.same_meshes() ? q.grids[s.grid.mesh]
                                               : cells_text(s.grid.cells, " x ");
    status.print(fmt::format("  FEM {} {}: {}", s.form, grid, s.ok ? fmt::format("{:.1f} s", s.seconds) : s.message));
    if (!s.ok) return {};
  }
  return solutions;
} catch (const std::runtime_error& e) {
  if (!children_interrupted()) status.print(fmt::format("  FEM: {}", e.what()));
  return {};
}

std::optional<Opinion> our_motion(const Question& q, Status& status) {
  auto solutions = solved(q, motion_request(q.prepared, q.material), status);
  return solutions ? opinion(q, std::move(*solutions), status) : std::nullopt;
}

std::optional<Opinion> our_equilibrium(const Question& q, Status& status) {
  const auto solutions = solved(q, request_of(q), status);
  if (!solutions) return {};
  std::vector<Answer> answers;
  for (const fem::Solution& s : *solutions) {
    if (q.modes > 0) {
      answers.push_back({values_of(s.frequencies, q.modes), {}});
      if (static_cast<int>(answers.back().values.size()) == q.modes) continue;
      status.print(fmt::format("  FEM: {} modes of {}", answers.back().values.size(), q.modes));
      return {};
    }
    const Field field{nullptr, {}, s.reactions, s.volume_change, s.volume_change_first_order};
    const Eigen::Index points = q.points.rows(), probes = s.displacement.rows() - points;
    answers.push_back({scalar_measures(field, q.experiment().probes, s.displacement.bottomRows(probes)),
                       s.displacement.topRows(points)});
  }
  return opinion(q, answers, our_noise(q, answers[2]));
}

/// Of tetrahedra: middles [m] and volumes [m^3].
std::pair<NodalVectors, Eigen::VectorXd> middles(const Mesh& mesh) {
  const auto cells = static_cast<Eigen::Index>(mesh.tetrahedra.size());
  std::pair<NodalVectors, Eigen::VectorXd> out{NodalVectors(cells, 3), Eigen::VectorXd(cells)};
  for (Eigen::Index c = 0; c < cells; ++c) {
    Eigen::Matrix<double, 4, 3> corners;
    for (int n = 0; n < 4; ++n) corners.row(n) = mesh.nodes.row(mesh.tetrahedra[c][n]);
    out.first.row(c) = corners.colwise().mean();
    out.second[c] = tetrahedron_volume(corners);
  }
  return out;
}

/// @throws InputError if frequencies of the body cannot be compared.
void require_frequencies(const Question& q) {
  const Experiment& e = q.experiment();
  if (!e.masses.empty()) throw InputError("--modes: the deck has no attached masses");
  if (e.relaxation.acts()) throw InputError("--modes: CalculiX' frequencies are of materials that do not relax");
  for (const auto& mesh : q.meshes)
    require_supported(transfer(supports_of(e), *mesh, q.material.density, Kinematics::linear), mesh->nodes);
}

}  // namespace

Mesh mesh_of_cells(const Experiment& e, const std::filesystem::path& geo, const Cells& cells) {
  Mesh mesh = mesh_geo(geo, e.body.size, cells, {}, volumes_of(e.regions));
  mark_regions(e.regions, 1, mesh);
  select_whole_facets(e.patches, mesh);
  return mesh;
}

Question question(const PreparedCase& prepared, const IsotropicMaterial& material, const CrossCheckOptions& options) {
  const Experiment& e = prepared.experiment;
  Question q{prepared, material, options.modes, {}, prepared.body.tetrahedra, {}, {}, options.time_limit};
  if (q.same_meshes()) {
    for (const auto& mesh : q.meshes) q.grids.push_back(fmt::format("{} tetrahedra", mesh->tetrahedra.size()));
    std::tie(q.points, q.weights) = middles(*q.meshes.front());
  } else {
    const Cells finest =
        q.moves() ? motion_request(prepared, material).grids[2].cells : finest_cells(prepared, material, options.cells);
    for (const Cells& cells : three_grids(finest)) {
      Mesh mesh = mesh_of_cells(e, prepared.body.geo, cells);
      if (mesh.grid) grade(e.reference.grading, mesh);
      q.grids.push_back(cells_text(cells, " x "));
      q.meshes.push_back(std::make_shared<const Mesh>(std::move(mesh)));
    }
    q.points = q.meshes.front()->nodes;
    q.weights = nodal_volumes(*q.meshes.front());
  }
  if (q.modes > 0) require_frequencies(q);
  return q;
}

std::optional<Opinion> ask_calculix(const Question& q, Status& status) {
  return q.moves() ? calculix_motion(q, status) : calculix_equilibrium(q, status);
}

std::optional<Opinion> ask_fem(const Question& q, Status& status) {
  return q.moves() ? our_motion(q, status) : our_equilibrium(q, status);
}

}  // namespace springproof
