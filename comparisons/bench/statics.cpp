#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <nlohmann/json.hpp>

#include "comparisons/bench/baselines.h"
#include "comparisons/bench/benches.h"
#include "comparisons/bench/bodies.h"
#include "comparisons/bench/interrupt.h"
#include "meshes/mesher/mesher.h"
#include "meshes/volume.h"
#include "meshes/voxels/cut_cells.h"
#include "meshes/voxels/voxelise.h"
#include "msm/models.h"
#include "msm/statics/equilibrium.h"
#include "problem/system/streams.h"

namespace springproof::bench {
namespace {

using Json = nlohmann::json;

constexpr double tolerance = 1e-8;

struct Problem {
  MassSpringModel model;
  BoundaryConditions conditions;
};

Problem cube(int n, double poisson_ratio, const char* name = "hybmss") {
  Problem p{lattice(name, {n, n, n}, poisson_ratio), {}};
  p.conditions = clamped_bottom(p.model.network);
  return p;
}

Problem network(int nodes) {
  Problem p{random_springs(nodes), {}};
  p.conditions = clamped_bottom(p.model.network, 0.5 * edge);
  return p;
}

/// The built-in rabbit, feet held, head pushed back.
struct Rabbit {
  Mesh body;
  VoxelGrid grid;  ///< of about so many cubes
  Mesh cubes;
  std::vector<Load> loads = {PrescribedDisplacement{"feet", {0.0, 0.0, 0.0}}, PatchForce{"head", Vec3(-0.1, 0, 0)}};

  explicit Rabbit(int voxels) {
    Body named;
    named.geo = "rabbit.geo";
    MeshRequest request;
    request.file = find_geo(named, {});
    request.size = Vec3(0.2, 0.12, 0.25);
    request.tetrahedra = std::min(20000, 2 * voxels);
    body = mesh_body(request).mesh;
    grid = voxel_grid(body, std::cbrt(volume(body, body.nodes) / voxels));
    cubes = voxelise(grid, body).mesh;
  }
  Problem whole(const char* model, double poisson_ratio) const {
    return {build_model(resolve({model, {}, model, {}}), cubes, {youngs_modulus, poisson_ratio, density}),
            transfer(loads, cubes, density, Kinematics::linear)};
  }
  Problem cut(const char* model, double poisson_ratio) const {
    EmbeddedModel m = build_cut(resolve({model, {}, model, {}}), cut_body(grid, body), {"feet"}, cubes,
                                {youngs_modulus, poisson_ratio, density});
    BoundaryConditions conditions = transfer(loads, cubes, m.embedding, m.model.network, density, Kinematics::linear);
    return {std::move(m.model), std::move(conditions)};
  }
};

/// Solves; the time of a short solve is the least of three.
Equilibrium solve(const Problem& p, LinearSolver solver = LinearSolver::automatic) {
  const auto once = [&] { return solve_linear(p.model, p.conditions, {solver, tolerance}); };
  Equilibrium e = once();
  if (!e.ok) throw std::runtime_error(e.message);
  for (int more = 0; more < 2 && e.seconds < 3; ++more) e.seconds = std::min(e.seconds, once().seconds);
  return e;
}

/// What is told of a solve.
struct Answer {
  int iterations = 0;
  double seconds = 0, memory_MiB = 0;
  long unknowns = 0;
  std::string solver;

  double us_per_unknown() const { return 1e6 * seconds / double(unknowns); }
};
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Answer, iterations, seconds, memory_MiB, unknowns, solver)

Answer answer(const Equilibrium& e) { return {e.iterations, e.seconds, e.memory_MiB, e.unknowns, e.solver}; }

/// What `work` returns in a child process; on failure nothing, and `row` is added without a result.
template <class Work>
std::optional<Json> measured(Findings& findings, BenchRow row, const Work& work) {
  to_stderr("statics: {}, {} ...\n", row.what, row.size);
  try {
    return in_child(work);
  } catch (const Interrupted&) {
    throw;
  } catch (const std::exception& e) {
    row.ok = false;
    row.note = e.what();
    findings.rows.push_back(row);
    return {};
  }
}

std::optional<Answer> solved(Findings& findings, const BenchRow& row, const std::function<Problem()>& problem) {
  const auto a = measured(findings, row, [&] { return answer(solve(problem())); });
  return a ? std::optional(a->get<Answer>()) : std::nullopt;
}

BenchRow iterations_row(const std::string& what, const std::string& size, double limit) {
  return {"statics", what, size, "iterations to 1e-8", 0, "", 0, at_most(limit)};
}

void add(Findings& findings, BenchRow row, double value, const std::string& note, double baseline_value = 0) {
  row.value = value;
  row.baseline_value = baseline_value;
  row.note = note;
  findings.rows.push_back(row);
}

/// Target for the iterations of a block, by Poisson's ratio.
double iteration_limit(double nu) { return nu <= 0.4 ? 13 : nu <= 0.499 ? 16 : 25; }

void blocks(const Options& options, Findings& findings) {
  const std::vector<int> sizes = options.quick ? std::vector{12} : std::vector{20, 40, 63};
  const std::vector<double> ratios =
      options.quick ? std::vector{0.25, 0.499} : std::vector{0.0, 0.25, 0.4, 0.45, 0.49, 0.499, 0.4999};
  for (const int n : sizes) {
    double quarter = 0;
    const std::string size = fmt::format("{}^3", n);
    for (const double nu : ratios) {
      const BenchRow row = iterations_row(fmt::format("block, nu = {:g}", nu), size, iteration_limit(nu));
      const auto a = solved(findings, row, [&] { return cube(n, nu); });
      if (!a) continue;
      add(findings, row, a->iterations,
          fmt::format("{}, {:.3g} CPU s, {:.3g} us per unknown", a->solver, a->seconds, a->us_per_unknown()));
      if (nu == 0.25) quarter = a->seconds;
      if (nu == 0.499 && quarter > 0)
        findings.rows.push_back(
            {"statics", "nu = 0.499 over nu = 0.25", size, "CPU s", a->seconds, "nu = 0.25", quarter, at_most(4)});
    }
  }
}

/// Momentum dispersion: iterations, and the gain from pressures as unknowns near nu = 1/2.
void dispersion_blocks(int n, double gain, Findings& findings) {
  for (const double nu : {0.25, 0.499}) {
    const BenchRow row =
        iterations_row(fmt::format("emsm block, nu = {:g}", nu), fmt::format("{}^3", n), iteration_limit(nu));
    const auto a = measured(findings, row, [&] {
      const Problem p = cube(n, nu, "emsm");
      return Json{answer(solve(p)), answer(solve(p, LinearSolver::multigrid))};
    });
    if (!a) continue;
    const Answer chosen = a->at(0), displacements = a->at(1);
    add(findings, row, chosen.iterations, fmt::format("{}, {:.3g} CPU s", chosen.solver, chosen.seconds));
    if (nu == 0.25) continue;
    add(findings,
        {"statics", row.what + ", over displacements alone", row.size, "CPU s", 0, "CG + network multigrid", 0,
         at_least(gain)},
        chosen.seconds, fmt::format("{} iterations", displacements.iterations), displacements.seconds);
  }
}

void rabbits(const Options& options, Findings& findings) {
  for (const int voxels : options.quick ? std::vector{1500} : std::vector{5000, 50000, 500000}) {
    const BenchRow row = iterations_row("rabbit with thin ears, nu = 0.25", fmt::format("{} voxels", voxels), 40);
    if (const auto a = solved(findings, row, [&] { return Rabbit(voxels).whole("hybmss", 0.25); }))
      add(findings, row, a->iterations, fmt::format("{}, {:.3g} CPU s", a->solver, a->seconds));
  }
}

/// Cut cells against the whole cubes of the same lattice, whose body has fewer nodes.
void cut_rabbits(int voxels, Findings& findings) {
  const std::vector<double> ratios = {0.25, 0.499};
  BenchRow first = iterations_row("rabbit in cut cells over whole cubes", fmt::format("{} voxels", voxels), 2);
  first.baseline = "whole cubes";
  const auto answers = measured(findings, first, [&] {
    const Rabbit rabbit(voxels);
    Json all;
    for (const double nu : ratios)
      all.push_back({answer(solve(rabbit.cut("hybmss_bt", nu))), answer(solve(rabbit.whole("hybmss_bt", nu)))});
    return all;
  });
  for (std::size_t i = 0; answers && i < ratios.size(); ++i) {
    const auto [cut, whole] = answers->at(i).get<std::array<Answer, 2>>();
    BenchRow row = first;
    row.what += fmt::format(", nu = {:g}", ratios[i]);
    add(findings, row, cut.iterations, cut.solver, whole.iterations);
    row.unit = "CPU us per unknown";
    row.target = {};
    add(findings, row, cut.us_per_unknown(), cut.solver, whole.us_per_unknown());
  }
}

/// Our solver and GAMG on the same problem in the same process.
void against_gamg(const std::string& what, const std::string& size, double limit, const std::function<Problem()>& make,
                  Findings& findings) {
  if (!has_gamg()) return;
  const BenchRow row{"statics", what, size, "CPU s", 0, "PETSc CG + GAMG", 0, at_least(limit)};
  const auto a = measured(findings, row, [&] {
    const Problem p = make();
    const Equilibrium ours = solve(p);
    const GamgResult gamg = solve_gamg(p.model, p.conditions, tolerance, ours.displacement);
    if (!gamg.converged)
      throw std::runtime_error(fmt::format("GAMG did not converge in {} iterations", gamg.iterations));
    return Json{{"ours", answer(ours)},
                {"seconds", gamg.setup_seconds + gamg.solve_seconds},
                {"note", fmt::format("{}, {} iterations, everything counted; GAMG {} iterations, {:.3g} s set-up, "
                                     "{:.3g} s solving, its assembly not counted; displacements differ by {:.1e}",
                                     ours.solver, ours.iterations, gamg.iterations, gamg.setup_seconds,
                                     gamg.solve_seconds, gamg.difference)}};
  });
  if (a) add(findings, row, a->at("ours").at("seconds"), a->at("note"), a->at("seconds"));
}

void against_dynamics(int n, Findings& findings) {
  const BenchRow row{"statics",
                     "block, nu = 0.25, over damped dynamics",
                     fmt::format("{}^3", n),
                     "CPU s",
                     0,
                     "optimally damped dynamics",
                     0,
                     at_least(15)};
  const auto a = measured(findings, row, [&] {
    const Problem p = cube(n, 0.25);
    const Equilibrium ours = solve(p);
    const DynamicsResult r = relax(p.model, p.conditions, tolerance);
    if (!r.state.ok) throw std::runtime_error(r.state.message);
    return Json{{"ours", ours.seconds}, {"steps", r.steps}, {"seconds", r.state.seconds}};
  });
  if (a)
    add(findings, row, a->at("ours"), fmt::format("{} steps of run_dynamics", a->at("steps").get<long>()),
        a->at("seconds"));
}

void large(int n, Findings& findings) {
  BenchRow row{"statics", "large block, nu = 0.25", fmt::format("{}^3", n), "CPU s", 0, "", 0, at_most(10)};
  const auto a = solved(findings, row, [&] { return cube(n, 0.25); });
  if (!a) return;
  add(findings, row, a->seconds, fmt::format("{}, {} iterations, {} unknowns", a->solver, a->iterations, a->unknowns));
  row.unit = "GiB, peak of the process with its model";
  row.target = at_most(2);
  add(findings, row, a->memory_MiB / 1024, "");
}

}  // namespace

void bench_statics(const Options& options, Findings& findings) {
  const bool quick = options.quick;
  const int n = quick ? 10 : 40, nodes = quick ? 2000 : 100000;
  if (!has_gamg()) findings.remarks.push_back("PETSc was not there when this was built: no rows against CG + GAMG");
  against_gamg(
      "block, nu = 0.25, over GAMG", fmt::format("{}^3", n), 50, [&] { return cube(n, 0.25); }, findings);
  against_dynamics(n, findings);
  blocks(options, findings);
  dispersion_blocks(quick ? 10 : 20, quick ? 3 : 8, findings);
  rabbits(options, findings);
  cut_rabbits(quick ? 1500 : 20000, findings);
  against_gamg(
      "random network over GAMG", fmt::format("{} nodes", nodes), 5, [&] { return network(nodes); }, findings);
  large(quick ? 16 : 100, findings);
}

}  // namespace springproof::bench
