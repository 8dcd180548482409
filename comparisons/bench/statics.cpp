#include <fmt/format.h>

#include <algorithm>
#include <cmath>
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

Json answer(const Equilibrium& e) {
  return {{"iterations", e.iterations},
          {"seconds", e.seconds},
          {"memory_MiB", e.memory_MiB},
          {"unknowns", e.unknowns},
          {"solver", e.solver}};
}

/// Runs `work` in a child process and passes its result to `rows`, which adds the rows; on failure adds the first row
/// without a result.
template <class Work, class Rows>
void measure(Findings& findings, const BenchRow& first, const Work& work, const Rows& rows) {
  to_stderr("statics: {}, {} ...\n", first.what, first.size);
  try {
    rows(in_child(work));
  } catch (const Interrupted&) {
    throw;
  } catch (const std::exception& e) {
    BenchRow row = first;
    row.ok = false;
    row.note = e.what();
    findings.rows.push_back(row);
  }
}

BenchRow iterations_row(const std::string& what, const std::string& size, double limit) {
  return {"statics", what, size, "iterations to 1e-8", 0, "", 0, at_most(limit)};
}

/// Target for the iterations of a block, by Poisson's ratio.
double iteration_limit(double nu) { return nu <= 0.4 ? 13 : nu <= 0.499 ? 16 : 25; }

void blocks(const BenchOptions& options, Findings& findings) {
  const std::vector<int> sizes = options.quick ? std::vector{12} : std::vector{20, 40, 63};
  const std::vector<double> ratios =
      options.quick ? std::vector{0.25, 0.499} : std::vector{0.0, 0.25, 0.4, 0.45, 0.49, 0.499, 0.4999};
  for (const int n : sizes) {
    double quarter = 0;
    for (const double nu : ratios) {
      BenchRow row = iterations_row(fmt::format("block, nu = {:g}", nu), fmt::format("{}^3", n), iteration_limit(nu));
      measure(
          findings, row, [&] { return answer(solve(cube(n, nu))); },
          [&](const Json& a) {
            row.value = a.at("iterations");
            const double seconds = a.at("seconds");
            row.note = fmt::format("{}, {:.3g} CPU s, {:.3g} us per unknown", a.at("solver").get<std::string>(),
                                   seconds, 1e6 * seconds / a.at("unknowns").get<double>());
            findings.rows.push_back(row);
            if (nu == 0.25) quarter = seconds;
            if (nu == 0.499 && quarter > 0)
              findings.rows.push_back({"statics", "nu = 0.499 over nu = 0.25", row.size, "CPU s", seconds, "nu = 0.25",
                                       quarter, at_most(4)});
          });
    }
  }
}

/// Momentum dispersion: iterations, and the gain from pressures as unknowns near nu = 1/2.
void dispersion_blocks(int n, double gain, Findings& findings) {
  for (const double nu : {0.25, 0.499}) {
    const BenchRow row =
        iterations_row(fmt::format("emsm block, nu = {:g}", nu), fmt::format("{}^3", n), iteration_limit(nu));
    const auto work = [&] {
      const Problem p = cube(n, nu, "emsm");
      return Json{{"chosen", answer(solve(p))}, {"displacements", answer(solve(p, LinearSolver::multigrid))}};
    };
    measure(findings, row, work, [&](const Json& a) {
      const double chosen = a.at("chosen").at("seconds"), displacements = a.at("displacements").at("seconds");
      BenchRow found = row;
      found.value = a.at("chosen").at("iterations");
      found.note = fmt::format("{}, {:.3g} CPU s", a.at("chosen").at("solver").get<std::string>(), chosen);
      findings.rows.push_back(found);
      if (nu == 0.25) return;
      findings.rows.push_back({"statics",
                               row.what + ", over displacements alone",
                               row.size,
                               "CPU s",
                               chosen,
                               "CG + network multigrid",
                               displacements,
                               at_least(gain),
                               {},
                               fmt::format("{} iterations", a.at("displacements").at("iterations").get<int>())});
    });
  }
}

void rabbits(const BenchOptions& options, Findings& findings) {
  for (const int voxels : options.quick ? std::vector{1500} : std::vector{5000, 50000, 500000}) {
    BenchRow row = iterations_row("rabbit with thin ears, nu = 0.25", fmt::format("{} voxels", voxels), 40);
    measure(
        findings, row, [&] { return answer(solve(Rabbit(voxels).whole("hybmss", 0.25))); },
        [&](const Json& a) {
          row.value = a.at("iterations");
          row.note = fmt::format("{}, {:.3g} CPU s", a.at("solver").get<std::string>(), a.at("seconds").get<double>());
          findings.rows.push_back(row);
        });
  }
}

/// Cut cells against the whole cubes of the same lattice, whose body has fewer nodes.
void cut_rabbits(int voxels, Findings& findings) {
  const std::vector<double> ratios = {0.25, 0.499};
  const BenchRow first{"statics",
                       "rabbit in cut cells over whole cubes",
                       fmt::format("{} voxels", voxels),
                       "iterations to 1e-8",
                       0,
                       "whole cubes",
                       0,
                       at_most(2)};
  const auto work = [&] {
    const Rabbit rabbit(voxels);
    Json answers;
    for (const double nu : ratios)
      answers.push_back({{"cut", answer(solve(rabbit.cut("hybmss_bt", nu)))},
                         {"whole", answer(solve(rabbit.whole("hybmss_bt", nu)))}});
    return answers;
  };
  measure(findings, first, work, [&](const Json& answers) {
    for (std::size_t i = 0; i < ratios.size(); ++i) {
      const Json &cut = answers[i].at("cut"), &whole = answers[i].at("whole");
      BenchRow row = first;
      row.what += fmt::format(", nu = {:g}", ratios[i]);
      row.value = cut.at("iterations");
      row.baseline_value = whole.at("iterations");
      row.note = cut.at("solver").get<std::string>();
      findings.rows.push_back(row);
      row.unit = "CPU us per unknown";
      row.value = 1e6 * cut.at("seconds").get<double>() / cut.at("unknowns").get<double>();
      row.baseline_value = 1e6 * whole.at("seconds").get<double>() / whole.at("unknowns").get<double>();
      row.target = {};
      findings.rows.push_back(row);
    }
  });
}

/// Our solver and GAMG on the same problem in the same process.
template <class Make>
void against_gamg(const std::string& what, const std::string& size, double limit, const Make& make,
                  Findings& findings) {
  if (!has_gamg()) return;
  BenchRow row{"statics", what, size, "CPU s", 0, "PETSc CG + GAMG", 0, at_least(limit)};
  const auto work = [&] {
    const Problem p = make();
    const Equilibrium ours = solve(p);
    const GamgResult gamg = solve_gamg(p.model, p.conditions, tolerance, ours.displacement);
    if (!gamg.converged)
      throw std::runtime_error(fmt::format("GAMG did not converge in {} iterations", gamg.iterations));
    return Json{{"ours", answer(ours)},
                {"setup", gamg.setup_seconds},
                {"solve", gamg.solve_seconds},
                {"iterations", gamg.iterations},
                {"difference", gamg.difference}};
  };
  measure(findings, row, work, [&](const Json& a) {
    row.value = a.at("ours").at("seconds");
    row.baseline_value = a.at("setup").get<double>() + a.at("solve").get<double>();
    row.note = fmt::format(
        "{}, {} iterations, everything counted; GAMG {} iterations, {:.3g} s set-up, {:.3g} s solving, its assembly "
        "not counted; displacements differ by {:.1e}",
        a.at("ours").at("solver").get<std::string>(), a.at("ours").at("iterations").get<int>(),
        a.at("iterations").get<int>(), a.at("setup").get<double>(), a.at("solve").get<double>(),
        a.at("difference").get<double>());
    findings.rows.push_back(row);
  });
}

void against_dynamics(int n, Findings& findings) {
  BenchRow row{"statics",
               "block, nu = 0.25, over damped dynamics",
               fmt::format("{}^3", n),
               "CPU s",
               0,
               "optimally damped dynamics",
               0,
               at_least(15)};
  const auto work = [&] {
    const Problem p = cube(n, 0.25);
    const Equilibrium ours = solve(p);
    const Relaxation r = relax(p.model, p.conditions, tolerance);
    if (!r.at_rest) throw std::runtime_error(r.message);
    return Json{{"ours", answer(ours)}, {"steps", r.steps}, {"seconds", r.seconds}};
  };
  measure(findings, row, work, [&](const Json& a) {
    row.value = a.at("ours").at("seconds");
    row.baseline_value = a.at("seconds");
    row.note = fmt::format("{} steps of run_dynamics", a.at("steps").get<long>());
    findings.rows.push_back(row);
  });
}

void large(int n, Findings& findings) {
  BenchRow row{"statics", "large block, nu = 0.25", fmt::format("{}^3", n), "CPU s", 0, "", 0, at_most(10)};
  measure(
      findings, row, [&] { return answer(solve(cube(n, 0.25))); },
      [&](const Json& a) {
        row.value = a.at("seconds");
        row.note = fmt::format("{}, {} iterations, {} unknowns", a.at("solver").get<std::string>(),
                               a.at("iterations").get<int>(), a.at("unknowns").get<long>());
        findings.rows.push_back(row);
        findings.rows.push_back({"statics", row.what, row.size, "GiB, peak of the process with its model",
                                 a.at("memory_MiB").get<double>() / 1024, "", 0, at_most(2)});
      });
}

}  // namespace

void bench_statics(const BenchOptions& options, Findings& findings) {
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
