#include "comparisons/advise/speed.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>

#include "fem_reference/exchange/reference.h"
#include "meshes/mesher/mesher.h"
#include "msm/dynamics/dynamics.h"
#include "msm/dynamics/time_step.h"
#include "msm/statics/equilibrium.h"
#include "problem/system/run_cost.h"

namespace springproof {
namespace {

constexpr int small_block = 8, large_block = 16;      // cells along each edge
constexpr double cells_stepped = 100 * 16 * 16 * 16;  // in all steps that are timed
constexpr int repeats_timed = 3;                      // the least counts

double seconds_of_steps(const MassSpringModel& model, double density, const BoundaryConditions& held, double safe_step,
                        long steps) {
  DynamicsOptions options;
  options.time_step = 0.5 * safe_step;
  options.duration = steps * *options.time_step;
  const double start = cpu_seconds();
  run_dynamics(
      model, density, [&](double) { return held; }, options);
  return cpu_seconds() - start;
}

/// Set-up and solve of a block [s].
double seconds_of_solve(const ModelParameters& p, const IsotropicMaterial& material, int n, double& MiB) {
  const Mesh mesh = block_mesh(Vec3::Constant(n), {n, n, n});
  build_model(p, mesh, material);  // what a material needs once per program is not counted
  double least = 0;
  for (int repeat = 0; repeat < 2; ++repeat) {
    const MemoryGrowth memory;
    const double start = cpu_seconds();
    const MassSpringModel model = build_model(p, mesh, material);
    const Equilibrium s = solve_linear(model, clamped_bottom(model.network, material.density, 0.5),
                                       {LinearSolver::automatic, compared_residual, 2000});
    if (!s.ok) throw std::runtime_error(s.message);
    const double seconds = cpu_seconds() - start;
    least = repeat == 0 ? seconds : std::min(least, seconds);
    MiB = std::max(MiB, memory.most_MiB());
  }
  return least;
}

}  // namespace

double Speed::solve_seconds(double cells) const { return solve * std::pow(cells / solve_cells, solve_power); }

BoundaryConditions clamped_bottom(const Network& network, double density, double depth) {
  BoundaryConditions bc;
  const Eigen::Index unknowns = network.X.size();
  bc.fixed.assign(unknowns, 0);
  bc.owner.assign(unknowns, -1);
  bc.prescribed = NodalVectors::Zero(network.X.rows(), 3);
  bc.external = masses(network, density) * Eigen::RowVector3d(0.3e-4, 0.5e-4, -1e-4);
  const double bottom = network.X.col(2).minCoeff() + depth;
  for (Eigen::Index n = 0; n < network.X.rows(); ++n)
    if (network.X(n, 2) <= bottom) {
      for (int c = 0; c < 3; ++c) bc.fixed[3 * n + c] = 1, bc.owner[3 * n + c] = 0;
      bc.external.row(n).setZero();
    }
  return bc;
}

StepCost step_cost(const std::function<MassSpringModel()>& build, double density, double cells, double edge) try {
  const MassSpringModel model = build();
  const double safe_step = safe_time_step(model, density);
  const BoundaryConditions held = clamped_bottom(model.network, density, 0.5 * edge);
  const long steps = std::lround(std::ceil(cells_stepped / cells));
  double none = 1e9, some = 1e9;  // the least of each: what disturbs a run does not make it shorter
  for (int repeat = 0; repeat < repeats_timed; ++repeat) {
    none = std::min(none, seconds_of_steps(model, density, held, safe_step, 1));
    some = std::min(some, seconds_of_steps(model, density, held, safe_step, 1 + steps));
  }
  if (some <= none) throw std::runtime_error("its steps took no time that could be measured");
  return {(some - none) / static_cast<double>(steps) / cells, safe_step / edge, ""};
} catch (const std::exception& e) {
  return {0, 0, e.what()};
}

Speed speed_of_model(const std::string& name, const IsotropicMaterial& material) try {
  Speed out;
  out.model = name;
  const ModelParameters p = resolve({name, {}, name, {}});
  const double few = std::pow(small_block, 3), many = std::pow(large_block, 3);
  double MiB = 0;
  const double first = seconds_of_solve(p, material, small_block, MiB);
  out.solve = seconds_of_solve(p, material, large_block, MiB);
  out.solve_cells = many;
  out.solve_power = std::max(1.0, std::log(out.solve / first) / std::log(many / few));
  out.MiB_per_cell = MiB / many;
  out.step = step_cost(
      [&] {
        return build_model(p, block_mesh(Vec3::Constant(large_block), {large_block, large_block, large_block}),
                           material);
      },
      material.density, many, 1);
  return out;
} catch (const std::exception& e) {
  return {.model = name, .failure = e.what()};
}

Speed speed_of_element(const std::string& element, const IsotropicMaterial& material) try {
  Speed out;
  out.model = "fem_" + element;
  if (!fem::available()) throw std::runtime_error("springproof-fem is not here");
  Body body;
  body.geo = "block.geo";
  fem::Request request;
  request.geo = find_geo(body, {});
  request.size = Vec3::Constant(1);
  request.material = material;
  request.loads = {PrescribedDisplacement{"z_min", {0, 0, 0}}, PrescribedDisplacement{"z_max", {1e-3, 0, 0}}};
  request.points = NodalVectors::Zero(1, 3);
  request.tolerance = compared_residual;
  request.cost = true;
  const int few = element == "q2" ? 4 : 8, many = 2 * few;
  for (const int n : {few, many}) request.grids.push_back({{n, n, n}, element, 1.0, -1, 0});
  const std::vector<fem::Solution> solved = fem::solve(request);
  for (const fem::Solution& s : solved)
    if (!s.ok) throw std::runtime_error(s.message);
  const auto seconds = [&](std::size_t i) { return solved[i].times.set_up + solved[i].times.solve; };
  out.solve = seconds(1);
  out.solve_cells = std::pow(many, 3);
  out.solve_power = std::max(1.0, std::log(seconds(1) / seconds(0)) / std::log(8.0));
  out.MiB_per_cell = solved[1].memory_MiB / out.solve_cells;
  return out;
} catch (const std::exception& e) {
  return {.model = "fem_" + element, .failure = e.what()};
}

std::string processor_name() {
  std::string line;
  for (std::ifstream in("/proc/cpuinfo"); std::getline(in, line);)
    if (line.starts_with("model name")) return line.substr(line.find(':') + 2);
  return "";
}

}  // namespace springproof
