// springproof-fem: the finite element reference as a program.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <csignal>
#include <ctime>
#include <fstream>
#include <nlohmann/json.hpp>

#include "fem_reference/bench.h"
#include "fem_reference/elements/element.h"
#include "fem_reference/exchange/case_request.h"
#include "fem_reference/exchange/exchange.h"
#include "fem_reference/exchange/plain_words.h"
#include "fem_reference/grid/processes.h"
#include "fem_reference/solve_grid.h"
#include "problem/processes/fork_server.h"
#include "problem/system/progress.h"
#include "problem/system/streams.h"

namespace springproof::fem {
namespace {

// The request that the first process makes.  The others have of its meshes those that every process needs.
Request shared(const std::function<Request()>& make) {
  Request request;
  std::string bytes;
  together([&] {
    if (process_rank() > 0) return;
    request = make();
    if (process_count() == 1) return;
    Request others = request;
    for (auto& mesh : others.meshes)
      if (!every_process_needs(*mesh)) mesh = std::make_shared<Mesh>();
    nlohmann::json::to_cbor(to_json(others), bytes);
  });
  if (process_count() == 1) return request;
  bytes = from_first(bytes);
  return process_rank() == 0 ? request : request_from_json(nlohmann::json::from_cbor(bytes));
}

Solution solve_one(const Request& request, const Discretisation& grid, Method method) {
  GridProblem problem;
  static_cast<CommonProblem&>(problem) = request;
  problem.method = method;
  problem.degree = element_named(grid.element).degree;
  problem.coarse = *request.meshes.at(grid.mesh);
  problem.refinements = grid.refinements;
  if (problem.coarse.grid)
    problem.place =
        graded(problem.coarse.nodes.colwise().minCoeff(), problem.coarse.nodes.colwise().maxCoeff(), grid.grading);
  problem.regions = materials_of(request.regions);
  problem.own_memory = request.cost;
  problem.steps = grid.steps;
  problem.vtu = grid.vtu;
  problem.vtu_notes = {
      {{"case", request.name}, {"element", grid.element}, {"law", request.law}},
      {{"poisson_ratio", request.material.poisson_ratio}, {"youngs_modulus_Pa", request.material.youngs_modulus}},
      request.vtu_single};
  const std::clock_t start = std::clock();
  if (grid.times_cells > 1) problem.coarse = refined_locally(problem, grid.times_cells);
  const double cutting = double(std::clock() - start) / CLOCKS_PER_SEC;
  Solution solution = solve_grid(problem);
  solution.grid = grid;
  solution.seconds += cutting;
  if (request.cost && solution.ok) {
    problem.points.resize(0, 3);
    problem.stress_points.resize(0, 3);
    problem.vtu.clear();
    solution.times = least_times(solution.times, [&] { return solve_grid(problem).times; });
  }
  solution.times.set_up += cutting;
  return solution;
}

// {812, 0, 0} stands for 812 tetrahedra.
std::string words_for(const Discretisation& grid) {
  const auto& [nx, ny, nz] = grid.cells;
  if (ny == 0) return fmt::format("{} on {} tetrahedra", grid.element, nx);
  return fmt::format("{} on {} x {} x {} cells{}", grid.element, nx, ny, nz, grid.grading == 1 ? "" : ", graded");
}

std::vector<Solution> solve_all(const Request& request, Method method = Method::automatic) {
  std::vector<Solution> solutions;
  for (const Discretisation& grid : request.grids) {
    const std::string which =
        request.grids.size() > 1 ? fmt::format(" {} of {}", solutions.size() + 1, request.grids.size()) : "";
    progress::phase(fmt::format("finite elements{}, {}", which, words_for(grid)));
    try {
      solutions.push_back(solve_one(request, grid, method));
    } catch (const InputError&) {
      throw;
    } catch (const std::exception& e) {
      if (!all_failed()) throw;
      Solution failed;
      failed.grid = grid;
      failed.law = request.law;
      failed.message = plain_words(e.what());
      solutions.push_back(failed);
    }
  }
  return solutions;
}

void answer_request(const std::string& request_file, const std::string& answer_file) {
  const std::vector<Solution> solutions = solve_all(shared([&] {
    std::ifstream in(request_file, std::ios::binary);
    return request_from_json(nlohmann::json::from_cbor(in));
  }));
  together([&] {
    if (process_rank() > 0) return;
    std::ofstream out(answer_file, std::ios::binary);
    nlohmann::json::to_cbor(to_json(solutions), out);
    if (!out.flush()) throw std::runtime_error("cannot write " + answer_file);
  });
}

void print(const std::vector<Probe>& probes, const Solution& s, int digits) {
  const auto& [nx, ny, nz] = s.grid.cells;
  to_stdout("{} x {} x {} cells, grading {}, {} degrees of freedom\n", nx, ny, nz, s.grid.grading,
            s.degrees_of_freedom);
  to_stdout("  form                  {}\n  law                   {}\n", s.form, s.law);
  if (!s.ok) to_stdout("  FAILED                {}\n", s.message);
  to_stdout("  solver                {} iterations, relative residual {:.1e}, {:.2f} CPU s, {:.0f} MiB\n", s.iterations,
            s.residual, s.seconds, s.memory_MiB);
  if (process_count() > 1)
    to_stdout("  processes             {}, which store up to {} of {} cells each\n", process_count(),
              s.cells_per_process, s.cells);
  const auto number = [&](double x) { return fmt::format("{:.{}g}", x, digits); };
  const auto vector = [&](const auto& v) { return fmt::format("{} {} {}", number(v[0]), number(v[1]), number(v[2])); };
  to_stdout("  volume change         {} (first order {}), smallest det F {:.6g}\n", number(s.volume_change),
            number(s.volume_change_first_order), s.min_jacobian);
  for (const PatchReaction& r : s.reactions)
    to_stdout("  reaction on {:<9} force [N] {}   torque [N m] {}\n", r.patch, vector(r.force), vector(r.torque));
  for (Eigen::Index p = 0; p < s.displacement.rows(); ++p)
    to_stdout("  {:<21} {} m\n", probes[p].name, vector(s.displacement.row(p)));
  for (Eigen::Index p = 0; p < s.stress.rows(); ++p) {
    const auto stress = s.stress.row(p);
    to_stdout("  {:<21} xx {} yy {} zz {} xy {} yz {} xz {} Pa\n", probes[p].name, number(stress[0]), number(stress[1]),
              number(stress[2]), number(stress[3]), number(stress[4]), number(stress[5]));
  }
}

struct Options {
  std::string request, answer, progress, case_file;
  std::vector<int> cells;
  double poisson_ratio = std::numeric_limits<double>::quiet_NaN();
  Discretisation grid;
  double tolerance = 1e-9;
  Method method = Method::automatic;
  int digits = 9;
};

bool solve_case(const Options& options) {
  const Experiment experiment = read_experiment(options.case_file);
  if (experiment.body.is_voxels())
    throw InputError(fmt::format(
        "{}: body.voxels: this program alone solves bodies with cells along their axes; bodies of voxels and the "
        "tetrahedra fitted to them come from `springproof compare`",
        options.case_file));
  Discretisation grid = options.grid;
  grid.cells = experiment.body.cells.front();
  if (!options.cells.empty()) std::copy_n(options.cells.begin(), 3, grid.cells.begin());
  NodalVectors points(experiment.probes.size(), 3);
  for (Eigen::Index p = 0; p < points.rows(); ++p) points.row(p) = experiment.probes[p].at;
  std::vector<IsotropicMaterial> materials = experiment.materials;
  if (!std::isnan(options.poisson_ratio)) {
    materials.resize(1);
    materials[0].poisson_ratio = options.poisson_ratio;
  }
  bool ok = true;
  for (const IsotropicMaterial& material : materials) {
    const Request request = shared([&] {
      Request r = request_of(experiment, material);
      r.grids = {grid};
      r.points = r.stress_points = points;
      r.tolerance = options.tolerance;
      mesh_grids(r);
      return r;
    });
    to_stdout("{}, Poisson's ratio {}: ", experiment.name, material.poisson_ratio);
    for (const Solution& s : solve_all(request, options.method)) {
      print(experiment.probes, s, options.digits);
      ok = ok && s.ok;
    }
  }
  return ok;
}

// An error common to all processes is printed by the first alone, any other by the process where it occurred.
int fail(const std::exception& e, int exit_status) {
  const bool everywhere = all_failed();
  if (!everywhere || process_rank() == 0) to_stderr("{}\n", plain_words(e.what()));
  if (!everywhere) end_all(exit_status);
  return exit_status;
}

// The other processes take part in the solve but print nothing.
void start_processes() {
  if (process_count() == 1) return;
  start_mpi();
  if (process_rank() > 0 && !std::freopen("/dev/null", "w", stdout)) end_all(1);
}

int run(int argc, char** argv) {
  start_processes();
  CLI::App app(
      "Solves an experiment with finite elements (deal.II).  Blocks of hexahedra: matrix-free multigrid; curved\n"
      "bodies and tetrahedra: matrices.  Prints reactions, volume change, displacement and stress at the\n"
      "probes, and what the solver did.");
  Options options;
  app.add_option("case", options.case_file, "experiment, a .toml file");
  app.add_option("--poisson-ratio", options.poisson_ratio, "solve for this one instead of those in the file");
  app.add_option("--cells", options.cells, "hexahedra along each side")->expected(3)->check(CLI::PositiveNumber);
  app.add_option("--element", options.grid.element, "q1, q2 (hexahedra), p1, p2 (tetrahedra)")
      ->check(CLI::IsMember({"q1", "q2", "p1", "p2"}))
      ->capture_default_str();
  app.add_option("--grading", options.grid.grading, "1 = uniform, more draws cells towards the faces of the block")
      ->check(CLI::Range(1.0, 4.0))
      ->capture_default_str();
  app.add_option("--tolerance", options.tolerance, "relative residual")
      ->check(CLI::Range(1e-14, 1e-1))
      ->capture_default_str();
  const std::map<std::string, Method> methods = {
      {"automatic", Method::automatic}, {"assembled", Method::assembled}, {"gamg", Method::assembled_gamg}};
  app.add_option("--solver", options.method,
                 "automatic: without a matrix where the cells can be refined, else assembled, small levels factored;\n"
                 "assembled: matrices, a level of linear elements above algebraic multigrid;\n"
                 "gamg: matrices, algebraic multigrid alone")
      ->transform(CLI::CheckedTransformer(methods));
  app.add_option("--digits", options.digits, "significant digits to print")
      ->check(CLI::Range(3, 17))
      ->capture_default_str();
  app.add_option("--request", options.request, "a request file instead of a case (used by springproof)");
  app.add_option("--answer", options.answer, "where to write the answer to --request");
  app.add_option("--progress", options.progress, "where to write, again and again, what --request is at");
  BenchOptions bench_options;
  bool benchmark = false;
  app.add_flag("--bench", benchmark, "measure the solvers against each other instead of solving a case");
  app.add_option("--bench-cells", bench_options.cells, "cells along the side of the benchmark's cube, a multiple of 8")
      ->check(CLI::Range(8, 96))
      ->capture_default_str();
  app.add_flag("!--no-baseline", bench_options.baseline, "leave the assembled baseline out (some 3 GB at 24 cells)");
  app.add_option("--json", bench_options.json_file, "write the benchmark as JSON too");
  app.set_version_flag("--version", [] { return library_versions(); });
  try {
    app.parse(argc, argv);
    if (!benchmark &&
        (options.request.empty() == options.case_file.empty() || options.request.empty() != options.answer.empty()))
      throw CLI::RequiredError("a case, or --request with --answer,");
  } catch (const CLI::ParseError& e) {
    const int status = process_rank() == 0 ? app.exit(e) : e.get_exit_code();
    return status == 0 ? 0 : 2;
  }
  try {
    if (benchmark) {
      if (process_count() > 1) throw InputError("--bench runs on one process");
      bench(bench_options);
      return 0;
    }
    if (!options.request.empty()) {
      std::optional<progress::Listening> listening;
      if (!options.progress.empty() && process_rank() == 0) listening.emplace(progress::into_file(options.progress));
      answer_request(options.request, options.answer);
      return 0;
    }
    return solve_case(options) ? 0 : 1;
  } catch (const InputError& e) {
    return fail(e, 2);
  } catch (const std::exception& e) {
    return fail(e, 1);
  }
}

}  // namespace
}  // namespace springproof::fem

int main(int argc, char** argv) {
  std::signal(SIGXFSZ, SIG_IGN);  // a limit on the size of files is an error of writing
  if (argc == 2 && std::string_view(argv[1]) == springproof::fork_server_argument)
    return springproof::serve_forks(springproof::fem::run);
  return springproof::run_as_program([&] { return springproof::fem::run(argc, argv); });
}
