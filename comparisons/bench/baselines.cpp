#include "comparisons/bench/baselines.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <set>
#include <stdexcept>

#include "comparisons/bench/bodies.h"
#include "comparisons/bench/interrupt.h"
#include "msm/dynamics/time_step.h"
#include "msm/exchange/lammps.h"
#include "problem/files/files.h"
#include "problem/processes/mpi_start.h"
#include "problem/system/run_cost.h"

#ifdef SPRINGPROOF_PETSC
#include "msm/parallel/parted_equations.h"
#endif

namespace springproof::bench {
namespace {

/// Smallest squared frequency [1/s^2], by inverse iteration.
double lowest_frequency_squared(const MassSpringModel& model, BoundaryConditions conditions) {
  const Eigen::VectorXd mass = masses(model.network, density);
  NodalVectors u = solve_linear(model, conditions, {.tolerance = 1e-6}).displacement;
  double lowest = 0;
  for (int i = 0; i < 4; ++i) {
    const NodalVectors load = mass.asDiagonal() * (u / u.norm());
    conditions.external = load;
    u = solve_linear(model, conditions, {.tolerance = 1e-6}).displacement;
    lowest = u.cwiseProduct(load).sum() / (mass.asDiagonal() * u).cwiseProduct(u).sum();
  }
  return lowest;
}

namespace fs = std::filesystem;

fs::path program() {
  if (const char* given = std::getenv("SPRINGPROOF_LAMMPS")) return given;
  return program_on_path("lmp");
}

/// Mass of each node; all get the mean if there are more than 64 different masses.
Eigen::VectorXd few_masses(const Network& network) {
  const Eigen::VectorXd all = masses(network, density);
  if (std::set<double>(all.begin(), all.end()).size() <= 64) return all;
  return Eigen::VectorXd::Constant(all.size(), all.mean());
}

std::string last_words(const std::string& output) {
  const auto at = output.find("ERROR");
  return at == std::string::npos ? "" : trimmed(output.substr(at, 200));
}

}  // namespace

DynamicsResult relax(const MassSpringModel& model, const BoundaryConditions& conditions, double tolerance,
                     double factor) {
  DynamicsOptions options;
  options.damping = factor * 2 * std::sqrt(lowest_frequency_squared(model, conditions));
  options.rest_tolerance = tolerance;
  options.duration = 200 * factor / options.damping * std::max(1.0, factor);
  return run_dynamics(
      model, density, [&](double) { return conditions; }, options);
}

bool Lammps::available() { return !program().empty(); }

Lammps::Lammps(const Network& network) : nodes_(network.nodes()), springs_(long(network.springs.size())) {
  const Eigen::VectorXd mass = few_masses(network);
  const MassSpringModel model{network, {Springs{}}};
  set_up_ = lammps_input(model, mass, "data", 0.25 * safe_time_step(model, density));
  write_file(folder_.path / "data", lammps_data(model, moved(network), mass));
}

double Lammps::seconds_of(const std::string& commands) const {
  write_file(folder_.path / "input", set_up_ + "thermo 1000000000\n" + commands);
  const fs::path log = folder_.path / "output";
  fs::remove(log);
  const ChildEnd end = run_child({program(), {"-in", "input", "-log", "none"}, folder_.path, log, log});
  throw_if_interrupted();
  if (!end.ok()) throw std::runtime_error(fmt::format("lmp {}: {}", words_for(end), last_words(text_of_file(log))));
  return end.seconds;
}

double Lammps::seconds_per_step(double seconds_of_steps, int runs) const {
  const std::string few = "run 1\n";
  double short_run = seconds_of(few), long_run = std::numeric_limits<double>::infinity();
  const long steps = std::max(20L, std::lround(std::max(seconds_of_steps, short_run) / (6e-9 * double(springs_))));
  const std::string many = fmt::format("run {}\n", 1 + steps);
  for (int r = 0; r < runs; ++r) {
    if (r > 0) short_run = std::min(short_run, seconds_of(few));
    long_run = std::min(long_run, seconds_of(many));
  }
  if (!(long_run > short_run))
    throw std::runtime_error(fmt::format("lmp takes no longer for {} steps than for one", 1 + steps));
  return (long_run - short_run) / double(steps);
}

NodalVectors Lammps::forces() const {
  seconds_of("dump 1 all custom 1 forces id fx fy fz\ndump_modify 1 sort id format float %.17g\nrun 0\n");
  std::ifstream in(folder_.path / "forces");
  std::string line;
  while (std::getline(in, line) && !line.starts_with("ITEM: ATOMS")) {
  }
  NodalVectors f(nodes_, 3);
  long id = 0;
  for (long n = 0; n < nodes_; ++n)
    if (!(in >> id >> f(n, 0) >> f(n, 1) >> f(n, 2)) || id != n + 1) throw std::runtime_error("lmp wrote no forces");
  return f;
}

#ifndef SPRINGPROOF_PETSC
bool has_gamg() { return false; }
GamgResult solve_gamg(const MassSpringModel&, const BoundaryConditions&, double, const NodalVectors&) {
  throw std::runtime_error("this program was built without PETSc");
}
#else
bool has_gamg() { return true; }

GamgResult solve_gamg(const MassSpringModel& model, const BoundaryConditions& conditions, double tolerance,
                      const NodalVectors& other) {
  start_mpi_without_network();
  require(PetscInitializeNoArguments());
  const MPI_Comm alone = PETSC_COMM_SELF;
  const Network& network = model.network;
  std::vector<int> owner(network.nodes(), 0);
  for (int n = 0; n < network.nodes(); ++n)
    if (conditions.fixed[3 * n]) owner[n] = -1;
  const EquationNumbers nodes = number_equations(owner, alone);
  const auto of_equations = [&](const NodalVectors& v) -> Eigen::VectorXd {
    return flat(NodalVectors(v(nodes.own, Eigen::all)));
  };
  const PetscMatrix A = matrix_of(tangent(model, network.X), network, nodes, conditions.fixed, alone);
  set_rigid_motions(A, network.X(nodes.own, Eigen::all), alone);
  const PetscVector f = vector_of(of_equations(conditions.external), 3, alone);
  PetscSolver solver;
  PetscVector u;
  PC preconditioner;
  require(KSPCreate(alone, &solver));
  require(KSPSetOperators(solver, A, A));
  require(KSPSetType(solver, KSPCG));
  require(KSPSetNormType(solver, KSP_NORM_UNPRECONDITIONED));
  require(KSPSetTolerances(solver, tolerance, PETSC_DEFAULT, PETSC_DEFAULT, 5000));
  require(KSPGetPC(solver, &preconditioner));
  require(PCSetType(preconditioner, PCGAMG));
  require(PCSetFromOptions(preconditioner));
  require(KSPSetFromOptions(solver));
  require(VecDuplicate(f, &u));
  GamgResult result;
  const double start = cpu_seconds();
  require(KSPSetUp(solver));
  const double set_up = cpu_seconds();
  require(KSPSolve(solver, f, u));
  result.setup_seconds = set_up - start;
  result.solve_seconds = cpu_seconds() - set_up;
  KSPConvergedReason reason;
  PetscInt iterations;
  require(KSPGetConvergedReason(solver, &reason));
  require(KSPGetIterationNumber(solver, &iterations));
  result.converged = reason > 0;
  result.iterations = int(iterations);
  const Eigen::VectorXd v = of_equations(other);
  result.difference = (v - values_of(u)).norm() / v.norm();
  return result;
}
#endif

}  // namespace springproof::bench
