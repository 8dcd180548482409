#include "fem_reference/solve_grid.h"

#include <deal.II/base/multithread_info.h>
#include <deal.II/base/revision.h>
#include <deal.II/fe/fe_q.h>
#include <deal.II/fe/fe_system.h>
#include <fmt/format.h>
#include <petscversion.h>
#include <sys/resource.h>

#include <ctime>

#include "fem_reference/boundary_conditions.h"
#include "fem_reference/elastic_system.h"
#include "fem_reference/sample.h"
#include "fem_reference/triangulate.h"

namespace springproof::fem {

namespace one_lane {
ElasticAnswer solve(const ElasticSystem& system, const DofVector& load, DofVector& displacement);
}
namespace avx2 {
ElasticAnswer solve(const ElasticSystem& system, const DofVector& load, DofVector& displacement);
}

ElasticAnswer solve_elastic(const ElasticSystem& system, const DofVector& load, DofVector& displacement) {
#ifdef SPRINGPROOF_HAVE_AVX2
  if (system.wide_vectors && __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma"))
    return avx2::solve(system, load, displacement);
#endif
  return one_lane::solve(system, load, displacement);
}

namespace {

double cpu_seconds() {
  return double(std::clock()) / CLOCKS_PER_SEC;
}

double peak_memory_MiB() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return usage.ru_maxrss / 1024.0;
}

// Above 0.4 the pressure becomes an unknown, so that the solver does not depend on Poisson's ratio.  For Q1
// that is the same discretisation as the mean dilatation; Q2 changes from full integration to a linear
// pressure per cell.
Form form_for(const GridProblem& problem) {
  if (problem.material.poisson_ratio > 0.4) return Form::mixed;
  return problem.degree == 1 ? Form::mean_dilatation : Form::pointwise;
}

std::string element_name(const ElasticSystem& system) {
  if (system.degree == 1) return system.form == Form::mixed ? "Q1 B-bar as Q1-P0" : "Q1 B-bar";
  return system.form == Form::mixed ? "Q2-P1disc mixed" : "Q2 displacement";
}

void solve_linear(const GridProblem& problem, const Body3& body, dealii::DoFHandler<3>& dof_handler,
                  Solution& solution) {
  const std::vector<Prescribed> held = prescribed(dof_handler, body, problem.loads);
  check_held(held);
  const DofVector load = load_vector(dof_handler, body, problem.loads, problem.material, problem.body_force);
  DofVector u(dof_handler.n_dofs());
  ElasticSystem system{dof_handler,
                       {},
                       prescribed_on_levels(dof_handler, body, problem.loads),
                       problem.degree,
                       form_for(problem),
                       shear_modulus(problem.material),
                       lame_lambda(problem.material),
                       problem.tolerance,
                       problem.wide_vectors};
  for (const Prescribed& p : held) {
    system.constrained.push_back(p.dof);
    u[p.dof] = *prescribed_displacement(problem.loads[p.load], p.X, Kinematics::linear)[p.component];
  }
  ElasticAnswer answer = solve_elastic(system, load, u);

  solution.ok = answer.converged;
  if (!answer.converged)
    solution.message =
        fmt::format("the linear solver stopped at a relative residual of {:.2e}", answer.residual);
  solution.form = fmt::format("{}, {}", element_name(system), answer.method);
  solution.iterations = answer.iterations;
  solution.residual = answer.residual;
  DofVector imbalance = answer.internal_force;
  imbalance -= load;
  solution.reactions = reactions(dof_handler, body, problem.loads, held, imbalance, nullptr);
  solution.displacement = displacement_at(locate(body.triangulation, problem.points), dof_handler, u);
  const VolumeMeasure volume = measure_volume(dof_handler, u);
  solution.volume_change = volume.change;
  solution.volume_change_first_order = volume.change_first_order;
  solution.min_jacobian = volume.min_jacobian;
}

}  // namespace

Solution solve_grid(const GridProblem& problem) {
  dealii::MultithreadInfo::set_thread_limit(1);
  const double start = cpu_seconds();
  check(problem.material);
  if (problem.degree != 1 && problem.degree != 2)
    throw InputError(fmt::format("elements of degree {}: only 1 and 2 are there", problem.degree));
  const auto body = triangulate(problem.coarse, problem.refinements, problem.place);
  check_patches(*body, problem.loads);
  const dealii::FESystem<3> fe(dealii::FE_Q<3>(problem.degree), 3);
  dealii::DoFHandler<3> dof_handler(body->triangulation);
  dof_handler.distribute_dofs(fe);
  dof_handler.distribute_mg_dofs();

  Solution solution;
  solution.law = problem.law;
  solution.degrees_of_freedom = dof_handler.n_dofs();
  if (problem.law != "linear")
    throw InputError(fmt::format("unknown law \"{}\"; there are: linear", problem.law));
  solve_linear(problem, *body, dof_handler, solution);
  solution.seconds = cpu_seconds() - start;
  solution.memory_MiB = peak_memory_MiB();
  return solution;
}

std::function<Vec3(const Vec3&)> graded(const Vec3& low, const Vec3& high, double exponent) {
  if (exponent == 1.0) return {};
  const double reach = (high - low).minCoeff() / 2;  // the same on every axis, or a slender body's cells go flat
  return [=](const Vec3& X) {
    Vec3 x = X;
    for (int c = 0; c < 3; ++c) {
      const double from_low = std::max(X[c] - low[c], 0.0), from_high = std::max(high[c] - X[c], 0.0);
      if (from_low < reach)
        x[c] = low[c] + reach * std::pow(from_low / reach, exponent);
      else if (from_high < reach)
        x[c] = high[c] - reach * std::pow(from_high / reach, exponent);
    }
    return x;
  };
}

std::string library_versions() {
  return fmt::format("deal.II {}, PETSc {}.{}.{}", DEAL_II_PACKAGE_VERSION, PETSC_VERSION_MAJOR,
                     PETSC_VERSION_MINOR, PETSC_VERSION_SUBMINOR);
}

}  // namespace springproof::fem
