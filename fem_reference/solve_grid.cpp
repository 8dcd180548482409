#include "fem_reference/solve_grid.h"

#include <deal.II/base/multithread_info.h>
#include <deal.II/base/revision.h>
#include <fmt/format.h>

#include <cmath>
#include <ctime>
#include <stdexcept>
#include <string>

#include "fem_reference/elements/cell_equations.h"
#include "fem_reference/grid/processes.h"
#include "fem_reference/grid/triangulate.h"
#include "fem_reference/motion.h"
#include "fem_reference/solvers/coarsest_level.h"
#include "fem_reference/system/boundary_conditions.h"
#include "fem_reference/system/elastic_system.h"
#include "fem_reference/system/interfaces.h"
#include "fem_reference/system/local_refinement.h"
#include "fem_reference/system/sample.h"
#include "meshes/quality.h"
#include "meshes/volume.h"
#include "meshes/vtu.h"
#include "problem/files/files.h"
#include "problem/system/progress.h"

namespace springproof::fem {

// Matrix-free, one per vector width (elastic_solver.cpp), and with assembled matrices (assembled_operator.cpp).
namespace one_lane {
extern const Solvers solvers;
}
namespace avx2 {
extern const Solvers solvers;
}
namespace assembled {
extern const Solvers solvers;
}

#ifdef SPRINGPROOF_HAVE_AVX2
static bool processor_has_avx2() { return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma"); }
#endif

namespace {

const Solvers& solvers_of(const ElasticSystem& system) {
  if (system.level_constrained.empty() && !system.below) return assembled::solvers;
#ifdef SPRINGPROOF_HAVE_AVX2
  if (system.wide_vectors && processor_has_avx2()) return avx2::solvers;
#endif
  return one_lane::solvers;
}

/// A cell of VTK: its number, and for each of its nodes which shape function of deal.II is that node's.
struct VtkCell {
  std::uint8_t type;
  std::vector<int> order;
};

// deal.II: vertices (x fastest), then edges, faces, the middle.  VTK goes round the bottom, then round the top.
const VtkCell& vtk_cell(std::size_t nodes) {
  static const VtkCell tetrahedron = {10, {0, 1, 2, 3}}, hexahedron = {12, {0, 1, 3, 2, 4, 5, 7, 6}},
                       quadratic_tetrahedron = {24, {0, 1, 2, 3, 4, 5, 6, 7, 8, 9}},
                       triquadratic_hexahedron = {29, {0,  1,  3,  2,  4,  5,  7,  6,  10, 9,  11, 8,  14, 13,
                                                       15, 12, 16, 17, 19, 18, 20, 21, 22, 23, 24, 25, 26}};
  switch (nodes) {
    case 4:
      return tetrahedron;
    case 8:
      return hexahedron;
    case 10:
      return quadratic_tetrahedron;
    default:
      return triquadratic_hexahedron;
  }
}

/// sqrt(3/2 s : s), s the deviator.
double von_mises(const Eigen::Matrix<double, 1, 6>& s) {
  const double xy = s[0] - s[1], yz = s[1] - s[2], zx = s[2] - s[0];
  return std::sqrt((xy * xy + yz * yz + zx * zx) / 2 + 3 * s.tail<3>().squaredNorm());
}

template <class Rows>
VtuArray array_of(const std::string& name, const Rows& rows) {
  return {name, static_cast<int>(rows.cols()), {rows.data(), rows.data() + rows.size()}};
}

/// Writes displacement [m], stress (xx yy zz xy yz xz) and von Mises stress [Pa] at the nodes; quadratic elements as
/// VTK's quadratic cells.
/// @throws std::runtime_error if the file cannot be written.
void write_solution(const std::string& file, const NodalSolution& solution, const VtuNotes& notes) {
  VtuFile vtu{solution.X, {}, {}, {}, {}, {}, notes};
  std::vector<int> nodes;
  for (const std::vector<int>& cell : solution.cells) {
    const auto& [type, order] = vtk_cell(cell.size());
    nodes.clear();
    for (const int a : order) nodes.push_back(cell[static_cast<std::size_t>(a)]);
    vtu.add_cell(nodes, type);
  }
  VtuArray mises{"von_mises", 1, {}};
  for (Eigen::Index n = 0; n < solution.stress.rows(); ++n) mises.values.push_back(von_mises(solution.stress.row(n)));
  vtu.point_data = {array_of("displacement", solution.displacement), array_of("stress", solution.stress),
                    std::move(mises)};
  if (!solution.materials.empty()) vtu.cell_data = {{"material", 1, solution.materials}};
  write_file(file, text_of(vtu));
}

double cpu_seconds() { return double(std::clock()) / CLOCKS_PER_SEC; }

// Matrix-free multigrid requires a coarse grid of few cells; other grids use algebraic multigrid.
constexpr unsigned int largest_coarse_grid = 1000;  // cells
// A coarsest level of cubes gets a coarse space of linear elements where that is cheaper than iterating on the level.
constexpr unsigned int smallest_grid_for_coarse_space = 300;

// The linear coarse space is for small strain and one process.
bool has_linear_coarse_space(const GridProblem& problem, const Body3& body) {
  return body.triangulation.n_cells(0) > smallest_grid_for_coarse_space && (problem.coarse.grid || body.curved) &&
         problem.law == "linear" && process_count() == 1;
}

bool matrix_free(const GridProblem& problem, const Body3& body) {
  const bool few_cells = body.triangulation.n_cells(0) <= largest_coarse_grid && !body.curved;
  return problem.method == Method::automatic && !body.has_tetrahedra() && problem.regions.empty() &&
         (few_cells || has_linear_coarse_space(problem, body));
}

// Quadratic tetrahedra at small strain: a matrix-free level above linear ones.
bool matrix_free_tetrahedra(const GridProblem& problem, const Body3& body) {
  return body.has_tetrahedra() && problem.degree == 2 && problem.law == "linear" && problem.regions.empty() &&
         problem.method == Method::automatic && process_count() == 1;
}

std::string element_name(const ElasticSystem& system) {
  return describe({system.body.has_tetrahedra(), system.degree}, system.form) +
         (system.laws.empty() ? "" : fmt::format(", {} materials", system.laws.size()));
}

// The discrete problem on one grid, for any law: prescribed degrees of freedom, right-hand side, elastic system.
struct Discrete {
  Discrete(const GridProblem& problem, const Body3& body, const dealii::DoFHandler<3>& dof_handler)
      : held(prescribed(dof_handler, body, problem.loads)),
        load(load_vector(dof_handler, body, problem)),
        system{
            body,
            dof_handler,
            problem.degree,
            form_for({body.has_tetrahedra(), problem.degree}, problem.material.poisson_ratio, problem.law == "linear"),
            shear_modulus(problem.material),
            lame_lambda(problem.material)} {
    system.tolerance = problem.tolerance;
    system.wide_vectors = problem.wide_vectors;
    system.plain_gamg = problem.method == Method::assembled_gamg;
    if (problem.method != Method::automatic) system.most_factored = 0;
    if (!problem.regions.empty()) {
      system.laws = laws_of(problem, law_named(problem.law), body.has_tetrahedra());
      system.form = form_of(system.laws);
    }
    for (const Prescribed& p : held) system.constrained.push_back(p.dof);
    const dealii::IndexSet& owned = dof_handler.locally_owned_dofs();
    held.erase(std::remove_if(held.begin(), held.end(), [&](const auto& p) { return !owned.is_element(p.dof); }),
               held.end());
    check_held(held, dof_handler.get_communicator());
    system.pointwise =
        pointwise_part(body.has_tetrahedra(), {law_named(problem.law), system.form, system.mu, system.lambda});
    if (matrix_free_tetrahedra(problem, body)) add_linear_coarse_space(problem.coarse, problem.place, system);
    if (!dof_handler.has_level_dofs()) return;
    system.level_constrained = prescribed_on_levels(dof_handler, body, problem.loads);
    if (has_linear_coarse_space(problem, body)) add_linear_coarse_space(problem.coarse, problem.place, system);
  }

  std::vector<Prescribed> held;  // locally owned
  DofVector load;
  ElasticSystem system;
};

void prescribe(const GridProblem& problem, const Discrete& discrete, Kinematics kinematics, double factor,
               DofVector& u) {
  u = 0;
  for (const Prescribed& p : discrete.held)
    u[p.dof] = *prescribed_displacement(problem.loads[p.load()], p.X, kinematics, factor)[p.component];
}

ElasticAnswer solve_linear(const GridProblem& problem, const Discrete& discrete, DofVector& u, Solution& solution) {
  prescribe(problem, discrete, Kinematics::linear, 1, u);
  const ElasticAnswer answer = solvers_of(discrete.system).elastic(discrete.system, discrete.load, u);
  solution.form = fmt::format("{}, {}", element_name(discrete.system), answer.method);
  if (!answer.converged)
    solution.message = fmt::format("the linear solver stopped at a relative residual of {:.2e}", answer.residual);
  return answer;
}

// Small enough that the linear predictor stays near the solution path: it enlarges rotating bodies and preserves volume
// only to first order.
double first_load_step(const GridProblem& problem, bool tetrahedra) {
  double largest = problem.material.poisson_ratio;
  for (const IsotropicMaterial& m : problem.regions) largest = std::max(largest, m.poisson_ratio);
  double step = largest > 0.45 || tetrahedra ? 0.25 : 1;
  for (const Load& load : problem.loads)
    if (const auto* turn = std::get_if<PrescribedRotation>(&load)) step = std::min(step, 0.35 / std::abs(turn->angle));
  return step;
}

ElasticAnswer solve_nonlinear(const GridProblem& problem, const Discrete& discrete, DofVector& u, Solution& solution) {
  const std::optional<Law> law = law_named(problem.law);
  if (!law) throw InputError(fmt::format("unknown law \"{}\"; there are: linear, {}", problem.law, law_names()));
  FiniteProblem finite{
      *law, [&](double factor, DofVector& to) { prescribe(problem, discrete, Kinematics::finite, factor, to); }};
  finite.first_step = first_load_step(problem, discrete.system.body.has_tetrahedra());
  const FiniteAnswer answer = solvers_of(discrete.system).finite(discrete.system, finite, discrete.load, u);
  solution.form = fmt::format("{}, {}: {} load steps, {} Newton steps", element_name(discrete.system), answer.method,
                              answer.load_steps, answer.newton_iterations);
  if (!answer.converged)
    solution.message = fmt::format("no equilibrium found beyond {:.4g} % of the load (smallest det F there {:.3g})",
                                   100 * answer.load_reached, answer.min_jacobian);
  return answer;
}

// `start`: CPU time [s] at which the mesh was in memory.
void solve_into(Solution& solution, const GridProblem& problem, const Body3& body,
                const dealii::DoFHandler<3>& dof_handler, double start, const std::optional<MemoryGrowth>& memory) {
  progress::detail(fmt::format("{} unknowns, set-up", dof_handler.n_dofs()));
  const Discrete discrete(problem, body, dof_handler);
  DofVector u = zero_vector(dof_handler);
  const bool linear = problem.law == "linear";
  const double ready = cpu_seconds();
  const ElasticAnswer answer =
      linear ? solve_linear(problem, discrete, u, solution) : solve_nonlinear(problem, discrete, u, solution);
  const MPI_Comm comm = dof_handler.get_communicator();
  solution.times = {dealii::Utilities::MPI::sum(ready - start, comm),
                    dealii::Utilities::MPI::sum(cpu_seconds() - ready, comm)};
  solution.memory_MiB = dealii::Utilities::MPI::max(memory ? memory->most_MiB() : 0, comm);
  solution.unknowns = solution.degrees_of_freedom - dealii::Utilities::MPI::sum(long(discrete.held.size()), comm);
  progress::detail(fmt::format("{} unknowns, measuring", dof_handler.n_dofs()));
  u.update_ghost_values();
  const std::vector<Location> places = locate(body, problem.points);
  solution.ok = answer.converged;
  solution.iterations = answer.iterations;
  solution.residual = answer.residual;
  DofVector imbalance = answer.internal_force;
  imbalance.add(-answer.load_reached, discrete.load);
  solution.reactions = reactions(dof_handler, body, problem.loads, discrete.held, imbalance, linear ? nullptr : &u);
  solution.displacement = displacement_at(places, dof_handler, u);
  solution.stress = stress_at(problem.stress_points, discrete.system, law_named(problem.law), answer, u);
  if (!problem.vtu.empty() && solution.ok)
    write_solution(problem.vtu, at_own_nodes(discrete.system, law_named(problem.law), answer, u), problem.vtu_notes);
  if (!problem.regions.empty()) {
    solution.regions = measure_regions(discrete.system, answer, u);
    std::vector<DofVector> loads;
    for (unsigned int m = 0; m <= problem.regions.size(); ++m)
      loads.push_back(load_vector(dof_handler, body, problem, 0, m));
    solution.interfaces = measure_interfaces(discrete.system, answer, u, loads);
  }
  const VolumeMeasure volume = measure_volume(body, dof_handler, u);
  solution.volume_change = volume.change;
  solution.volume_change_first_order = volume.change_first_order;
  solution.min_jacobian = volume.min_jacobian;
}

}  // namespace

Mesh refined_locally(GridProblem problem, double times_cells) {
  constexpr double shortest = 1. / 64;  // edge that is left, over the mean one
  constexpr double growth = 1.5;        // of the cells by one estimate
  Mesh& mesh = problem.coarse;
  if (problem.degree != 2 || mesh.tetrahedra.empty()) return mesh;
  if (process_count() > 1) throw InputError("tetrahedra are cut by one process");
  dealii::MultithreadInfo::set_thread_limit(1);
  const double cells = double(mesh.tetrahedra.size()), edge = edge_of_regular(volume(mesh, mesh.nodes), cells);
  problem.law = "linear";
  problem.tolerance = 1e-3;
  const int rounds = int(std::ceil(std::log(times_cells) / std::log(growth)));
  for (int round = 1; round <= rounds; ++round) {
    const auto enough = std::size_t(std::pow(times_cells, double(round) / rounds) * cells);
    progress::detail(fmt::format("{} tetrahedra, where their error is", mesh.tetrahedra.size()));
    const auto body = triangulate(mesh, 0, problem.place);
    dealii::DoFHandler<3> dof_handler(body->triangulation);
    dof_handler.distribute_dofs(*displacement_element(*body, problem.degree));
    DofVector u = zero_vector(dof_handler);
    Solution coarse;
    if (!solve_linear(problem, Discrete(problem, *body, dof_handler), u, coarse).converged)
      throw std::runtime_error("where tetrahedra are to be cut: " + coarse.message);
    u.update_ghost_values();
    mesh = cut_where_errors_are_largest(mesh, *body, dof_handler, u, enough, shortest * edge);
  }
  return mesh;
}

Solution solve_grid(const GridProblem& problem) {
  dealii::MultithreadInfo::set_thread_limit(1);
  std::optional<MemoryGrowth> memory;
  if (problem.own_memory) memory.emplace();
  const double start = cpu_seconds();
  check(problem.material);
  for (const IsotropicMaterial& m : problem.regions) check(m);
  if (!problem.regions.empty() && process_count() > 1)
    throw InputError("bodies of several materials are solved by one process");
  if (problem.degree != 1 && problem.degree != 2)
    throw InputError(fmt::format("elements of degree {}: only 1 and 2 are there", problem.degree));
  const auto body = triangulate(problem.coarse, problem.refinements, problem.place);
  check_patches(*body, problem.loads);
  dealii::DoFHandler<3> dof_handler(body->triangulation);
  dof_handler.distribute_dofs(*displacement_element(*body, problem.degree));
  if (matrix_free(problem, *body)) dof_handler.distribute_mg_dofs();

  Solution solution;
  solution.law = problem.law;
  solution.degrees_of_freedom = dof_handler.n_dofs();
  solution.cells = long(body->triangulation.n_global_active_cells());
  solution.cells_per_process =
      dealii::Utilities::MPI::max(long(body->triangulation.n_active_cells()), body->triangulation.get_communicator());
  if (problem.modes > 0)
    solve_modes(problem, *body, dof_handler, solution);
  else if (problem.motion)
    solve_motion(problem, *body, dof_handler, solution);
  else
    solve_into(solution, problem, *body, dof_handler, start, memory);
  const MPI_Comm comm = body->triangulation.get_communicator();
  solution.seconds = dealii::Utilities::MPI::sum(cpu_seconds() - start, comm);
  if (!memory) solution.memory_MiB = dealii::Utilities::MPI::max(peak_memory_MiB(), comm);
  return solution;
}

std::function<Vec3(const Vec3&)> graded(const Vec3& low, const Vec3& high, double exponent) {
  if (exponent == 1.0) return {};
  const double reach = (high - low).minCoeff() / 2;  // the same on every axis, else cells of slender bodies go flat
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
  bool wide = false;
#ifdef SPRINGPROOF_HAVE_AVX2
  wide = processor_has_avx2();
#endif
  return fmt::format("deal.II {}, {}", DEAL_II_PACKAGE_VERSION, wide ? "AVX2" : "one lane");
}

}  // namespace springproof::fem
