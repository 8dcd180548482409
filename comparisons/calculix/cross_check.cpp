#include "comparisons/calculix/cross_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "comparisons/calculix/run.h"
#include "comparisons/judge/measures.h"
#include "comparisons/reference/reference_grids.h"
#include "comparisons/reference/solve_each.h"
#include "comparisons/run/case_run.h"
#include "comparisons/run/prepare.h"
#include "comparisons/sweep/status.h"
#include "fem_reference/exchange/case_request.h"
#include "fem_reference/exchange/reference.h"
#include "meshes/mesher/mesher.h"
#include "meshes/patches/select_patches.h"
#include "meshes/regions/mark_regions.h"
#include "problem/processes/child.h"
#include "problem/processes/interrupts.h"
#include "problem/system/streams.h"

namespace springproof {
namespace {

// Elements of CalculiX' finest grid: what its direct solver factors in some ten seconds; at finite strain a
// dozen times.
constexpr double linear_elements = 1728, finite_elements = 512;

constexpr const char* field_measure = "displacement field, peak";

/// One case at one Poisson's ratio, to be solved by both programs.
struct Question {
  const PreparedCase& prepared;
  IsotropicMaterial material;
  std::array<Cells, 3> cells;  ///< CalculiX' grids, coarse to fine
  std::vector<Mesh> meshes;    ///< the same
  double time_limit;

  const Experiment& experiment() const { return prepared.experiment; }
};

/// The results of one program on one grid.
struct Answer {
  std::map<std::string, double> values;
  NodalVectors displacement;  ///< at the nodes of the coarsest of CalculiX' grids [m]
};

/// Values extrapolated from the three grids.
struct Opinion {
  std::map<std::string, ReferenceValue> values;
  ReferenceField field;
};

std::array<Cells, 3> three_grids(const Cells& fine) {
  std::array<Cells, 3> grids;
  for (int g = 0; g < 3; ++g)
    for (int d = 0; d < 3; ++d) grids[g][d] = fine[d] / (4 >> g);
  return grids;
}

/// Near-cubic elements, counts divisible by four; at least eight with reduced integration, as a single element across a
/// body has zero-energy modes.
Cells finest_cells(const Experiment& e, const IsotropicMaterial& material, const Cells& given) {
  Cells cells = given;
  if (given[0] == 0) {
    const double elements = e.model_kinematics() == Kinematics::linear ? linear_elements : finite_elements;
    const double edge = std::cbrt(e.body.size.prod() / elements);
    const int fewest = calculix::needs_reduced_integration(e, material) ? 2 : 1;
    for (int d = 0; d < 3; ++d)
      cells[d] = 4 * std::max(fewest, static_cast<int>(std::lround(e.body.size[d] / edge / 4)));
  }
  for (const int n : cells)
    if (n < 4 || n % 4 != 0)
      throw InputError(fmt::format("--cells: {} is not divisible by 4 (the grid is halved twice)", n));
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

/// Rows of `field` at the nodes of a mesh that are those of a coarser one too.
NodalVectors at_common_nodes(const Mesh& coarse, const Mesh& mesh, const NodalVectors& field) {
  NodalVectors out(coarse.nodes.rows(), 3);
  for (Eigen::Index n = 0; n < out.rows(); ++n) {
    Eigen::Index nearest = 0;
    (mesh.nodes.rowwise() - coarse.nodes.row(n)).rowwise().squaredNorm().minCoeff(&nearest);
    out.row(n) = field.row(nearest);
  }
  return out;
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

double noise_of(const std::string& measure, const Noise& noise) {
  if (measure.starts_with("force.")) return noise.force;
  if (measure.starts_with("torque.")) return noise.torque;
  return measure.starts_with("displacement.") ? noise.displacement : noise.volume;
}

Opinion opinion(const PreparedCase& prepared, const Mesh& coarse, const std::vector<Answer>& answers,
                const Noise& noise) {
  Opinion out;
  for (const auto& [measure, fine] : answers[2].values)
    if (is_compared(prepared, measure))
      out.values[measure] =
          extrapolate({answers[0].values.at(measure), answers[1].values.at(measure), fine}, noise_of(measure, noise));
  out.field =
      extrapolate({answers[0].displacement, answers[1].displacement, answers[2].displacement}, nodal_volumes(coarse));
  out.field.nodal_uncertainty.array() += std::sqrt(3.0) * noise.displacement;
  return out;
}

Answer calculix_answer(const Question& q, const calculix::Deck& deck, const calculix::Solution& s) {
  const std::vector<Probe>& probes = q.experiment().probes;
  NodalVectors at_probes = NodalVectors::Zero(static_cast<Eigen::Index>(probes.size()), 3);
  for (std::size_t i = 0; i < probes.size(); ++i)
    for (const auto& [node, weight] : calculix::weights_at(deck.mesh, deck.linear, probes[i].at))
      at_probes.row(static_cast<Eigen::Index>(i)) += weight * s.displacement.row(node);
  return {scalar_measures(s.field, probes, at_probes), at_common_nodes(q.meshes[0], deck.linear, s.field.displacement)};
}

std::optional<Opinion> ask_calculix(const Question& q, Status& status) {
  std::vector<Answer> answers;
  Noise noise;
  for (int g = 0; g < 3 && !children_interrupted(); ++g) {
    const calculix::Deck deck = calculix::make_deck(q.experiment(), q.material, q.meshes[g]);
    const std::string run = fmt::format("CalculiX {} {}", deck.element, cells_text(q.cells[g], " x "));
    progress::phase(run);
    const calculix::Solution s = calculix::solve(deck, q.time_limit);
    if (children_interrupted()) break;
    status.print(fmt::format("  {}: {}", run, s.ok ? fmt::format("{:.1f} s", s.seconds) : s.message));
    if (!s.ok) return {};
    answers.push_back(calculix_answer(q, deck, s));
    noise = s.floor;
  }
  if (children_interrupted()) return {};
  return opinion(q.prepared, q.meshes[0], answers, noise);
}

/// Round-off of our solver: 1e-7 of the largest forces and displacements.
Noise our_noise(const Question& q, const Answer& finest) {
  constexpr double relative = 1e-7;
  const double size = q.prepared.body.size.norm(), u = finest.displacement.rowwise().norm().maxCoeff();
  double force = 0;
  for (const auto& [name, value] : finest.values) {
    if (name.starts_with("force.")) force = std::max(force, std::abs(value));
    if (name.starts_with("torque.")) force = std::max(force, std::abs(value) / size);
  }
  return {relative * force, relative * force * size, relative * u, relative * u / size};
}

std::optional<Opinion> ask_fem(const Question& q, Status& status) {
  const NodalVectors& nodes = q.meshes[0].nodes;
  const NodalVectors probes = probe_points(q.experiment());
  NodalVectors points(nodes.rows() + probes.rows(), 3);
  points << nodes, probes;
  fem::Request request = fem::request_of(q.experiment(), q.material);
  request.material = q.material;
  request.points = points;
  for (const Cells& cells : three_grids(q.prepared.reference_cells)) {
    request.grids.emplace_back().cells = cells;  // Q2
    request.grids.back().grading = q.experiment().reference.grading;
  }
  std::vector<Answer> answers;
  std::vector<fem::Solution> solutions;
  try {
    solutions = solve_each(request);
  } catch (const std::runtime_error& e) {
    if (!children_interrupted()) status.print(fmt::format("  FEM: {}", e.what()));
    return {};
  }
  for (const fem::Solution& s : solutions) {
    status.print(fmt::format("  FEM {} {}: {}", s.form, cells_text(s.grid.cells, " x "),
                             s.ok ? fmt::format("{:.1f} s", s.seconds) : s.message));
    if (!s.ok) return {};
    const Field field{nullptr, {}, s.reactions, s.volume_change, s.volume_change_first_order};
    answers.push_back({scalar_measures(field, q.experiment().probes, s.displacement.bottomRows(probes.rows())),
                       s.displacement.topRows(nodes.rows())});
  }
  return opinion(q.prepared, q.meshes[0], answers, our_noise(q, answers[2]));
}

/// Largest displacement, with the largest uncertainty at a node.
ReferenceValue largest(const ReferenceField& field) {
  return {field.displacement.rowwise().norm().maxCoeff(), field.nodal_uncertainty.maxCoeff(), field.observed_order,
          field.note};
}

std::vector<SecondOpinion> compare_opinions(const Opinion& calculix, const Opinion& ours) {
  std::vector<SecondOpinion> rows;
  for (const auto& [measure, value] : calculix.values)
    if (const auto other = ours.values.find(measure); other != ours.values.end())
      rows.push_back(second_opinion(measure, value, other->second));
  SecondOpinion field = second_opinion(field_measure, largest(calculix.field), largest(ours.field));
  field.unit = std::string(1, 'm');
  field.difference = (calculix.field.displacement - ours.field.displacement).rowwise().norm().maxCoeff();
  field.agrees = field.difference <= field.calculix.uncertainty + field.ours.uncertainty;
  rows.push_back(field);
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
  if (const auto zeros = std::count_if(rows.begin(), rows.end(), vanishes))
    to_stdout("and {} component{} that both find to be zero\n", zeros, zeros == 1 ? "" : "s");
}

void print_title(const Question& q) {
  const auto& e = q.experiment();
  const Cells& c = q.cells[2];
  const bool reduced = calculix::needs_reduced_integration(e, q.material);
  to_stdout("\n{}: nu = {:g}, {}\n", e.name, q.material.poisson_ratio, e.kinematics);
  to_stdout("CalculiX {}: {} up to {} x {} x {}, {}\n", calculix::version(), reduced ? "C3D20R" : "C3D20", c[0], c[1],
            c[2], reduced ? "integrated with 8 points: with 27 they lock as nu nears 1/2" : "fully integrated");
  const Cells& r = q.prepared.reference_cells;
  to_stdout("ours: Q2 up to {} x {} x {}\n", r[0], r[1], r[2]);
  if (!q.prepared.sharing.empty())
    to_stdout("left out, as held edges in common make them a convention: forces on {}\n",
              fmt::join(q.prepared.sharing, ", "));
}

Question question(const PreparedCase& prepared, const IsotropicMaterial& material, const CrossCheckOptions& options) {
  const Experiment& e = prepared.experiment;
  Question q{prepared, material, three_grids(finest_cells(e, material, options.cells)), {}, options.time_limit};
  for (const Cells& cells : q.cells) {
    q.meshes.push_back(mesh_geo(prepared.body.geo, e.body.size, cells, {}, volumes_of(e.regions)));
    mark_regions(e.regions, 1, q.meshes.back());
    select_whole_facets(e.patches, q.meshes.back());
    if (q.meshes.back().grid) grade(e.reference.grading, q.meshes.back());
  }
  return q;
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
  const std::vector<SecondOpinion> rows = compare_opinions(*calculix, *ours);
  print_table(rows);
  std::fflush(stdout);
  return static_cast<int>(std::count_if(rows.begin(), rows.end(), [](const auto& r) { return !r.agrees; }));
}

bool programs_are_there() {
  const bool ccx = !calculix::program().empty(), fem = fem::available();
  if (!ccx) to_stderr("error: CalculiX is not here: no `ccx` on PATH.  To install it: apt-get install calculix-ccx\n");
  if (!fem) to_stderr("error: springproof-fem is neither beside springproof nor named by SPRINGPROOF_FEM_PROGRAM\n");
  return ccx && fem;
}

}  // namespace

SecondOpinion second_opinion(const std::string& measure, const ReferenceValue& calculix, const ReferenceValue& ours) {
  const double difference = calculix.value - ours.value;
  return {measure, unit_of(measure), calculix,
          ours,    difference,       std::abs(difference) <= calculix.uncertainty + ours.uncertainty};
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
  calculix::require_counterpart(experiment);
  if (experiment.body.is_voxels())
    throw InputError(experiment.body.where,
                     "a body of voxels has no cross-check of its own; `springproof export` writes its tetrahedra with "
                     "the loads for CalculiX");
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
