// springproof-mpi: solves the models of a case on the processes of mpirun and keeps them as an interrupted `springproof
// compare` does; `springproof compare CASE --resume` adds the rest.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>

#include "comparisons/reference/run_keeper.h"
#include "comparisons/report/words.h"
#include "comparisons/run/part_run.h"
#include "comparisons/run/prepare.h"
#include "comparisons/sweep/find_cases.h"
#include "comparisons/sweep/folder_lock.h"
#include "comparisons/sweep/suite.h"
#include "msm/parallel/parted_equations.h"
#include "msm/parallel/parted_problem.h"
#include "problem/case_file/measures.h"
#include "problem/processes/mpi_start.h"
#include "problem/system/input_error.h"
#include "problem/system/streams.h"

namespace springproof {
namespace {

constexpr int all_solved = 0, some_left = 1, unusable_input = 2;

bool is_first() { return rank_of(PETSC_COMM_WORLD) == 0; }

struct MpiOptions {
  std::vector<std::string> cases;
  std::vector<std::string> models;  ///< labels; empty: all
  SuiteOptions suite;               ///< as compare() takes them
  double tolerance = LinearOptions{}.tolerance;
};

/// Numbers of the models that are solved here: those at rest, of them the chosen ones.
/// @throws InputError if there are none, or a chosen one is not among them.
std::vector<std::size_t> models_at_rest(const Experiment& e, const std::vector<std::string>& chosen) {
  const char* reason = e.model_kinematics() != Kinematics::linear ? "its displacements are large"
                       : e.fracture                               ? "its body breaks"
                       : e.cost                                   ? "its times are those of one process"
                                                                  : nullptr;
  if (reason)
    throw InputError(fmt::format("{}: {} (allowed: equilibria under small displacements)", e.file.string(), reason));
  std::vector<std::size_t> numbers;
  std::vector<std::string> labels;
  for (std::size_t m = 0; m < e.models.size(); ++m) {
    const ModelChoice& choice = e.models[m];
    if (is_external(choice) || choice.in_motion) continue;
    labels.push_back(choice.label);
    if (chosen.empty() || std::ranges::find(chosen, choice.label) != chosen.end()) numbers.push_back(m);
  }
  if (numbers.empty() || numbers.size() < chosen.size())
    throw InputError(fmt::format("{}: {} of {} models to solve (allowed as --model, those at rest: {})",
                                 e.file.string(), numbers.size(), chosen.size(), fmt::join(labels, ", ")));
  return numbers;
}

/// The networks of a model as run_samples() has them, solved by all processes and measured by the first, which alone
/// gets them.
std::vector<ModelSample> solve_samples(const PreparedCase& prepared, const Lattice& lattice, std::size_t number,
                                       const IsotropicMaterial& material, double tolerance) {
  std::vector<ModelSample> samples;
  ModelParameters parameters = prepared.models[number];
  for (int seed = 0; seed < parameters.seeds; ++seed, ++parameters.random.seed) {
    const double start = cpu_seconds();
    SolvedModel solved;
    agree(PETSC_COMM_WORLD, [&] {
      solved.built = build_on(prepared, lattice, parameters, material, false);
      solved.conditions = conditions_of(prepared, lattice, parameters, solved.built, material.density);
    });
    PartedProblem problem(solved.built.model, solved.conditions, PETSC_COMM_WORLD);
    if (!is_first()) solved = {};
    const double ready = cpu_seconds();
    solved.state = problem.solve(tolerance, LinearOptions{}.max_iterations);
    solved.times = {ready - start, cpu_seconds() - ready};
    if (!solved.state.ok) throw InputError(solved.state.message);
    if (is_first()) samples.push_back(measured(prepared, lattice, parameters, std::move(solved), false));
  }
  return samples;
}

/// A case made ready; the plan and the folder are the first process'.
struct ReadyCase {
  PreparedCase prepared;
  std::vector<std::size_t> numbers;  ///< of the models that are solved
  Sweep plan;
  std::unique_ptr<FolderLock> folder;
};

ReadyCase make_ready(const std::filesystem::path& file, const MpiOptions& options) {
  ReadyCase ready;
  agree(PETSC_COMM_WORLD, [&] {
    const Experiment e = only(options.suite.poisson_ratios, read_experiment(file));
    ready.numbers = models_at_rest(e, options.models);
    ready.prepared = prepare(e);
    if (!is_first()) return;
    std::filesystem::create_directories(options.suite.out);
    ready.folder = std::make_unique<FolderLock>(options.suite.out);
    ready.plan = planned({e}, options.suite);
  });
  return ready;
}

void print(const std::string& title, const ModelSample& sample, const std::vector<std::string>& measures) {
  const Equilibrium& s = sample.state;
  to_stdout("{}: {} unknowns, {}: {} iterations, residual {:.1e}; set-up {:.3g} s, then {:.3g} s, {:.0f} MiB\n", title,
            s.unknowns, s.solver, s.iterations, s.residual, sample.times.set_up, sample.times.solve, s.memory_MiB);
  for (const auto& [measure, value] : sample.scalars)
    if (wanted(measure, measures)) to_stdout("  {}: {:.9g} {}\n", measure, value, unit_of(measure));
}

/// Solves a model on a lattice at one material of each region.  What has no result is said and left to `compare`.
int solve_model(const PreparedCase& prepared, std::size_t l, std::size_t number, const IsotropicMaterial& material,
                double tolerance, const RunKeeper& keeper) {
  const Lattice& lattice = prepared.lattices[l];
  const Experiment& e = prepared.experiment;
  const std::string title =
      fmt::format("{}, {}, {} cells", e.models[number].label, words::setting_text(e, e.setting_of(material)),
                  cells_text(lattice.cells, " x "));
  try {
    const std::vector<ModelSample> samples = solve_samples(prepared, lattice, number, e.at_rest(material), tolerance);
    for (const ModelSample& sample : samples) print(title, sample, e.measures);
    if (is_first()) keeper.keep(name_of_samples(l, {number}), json_of(samples));
    return all_solved;
  } catch (const InputError& error) {  // which all processes have
    if (is_first()) to_stderr("{} is left to springproof compare: {}\n", title, error.what());
    return some_left;
  }
}

int solve_case(const std::filesystem::path& file, const MpiOptions& options) {
  const ReadyCase ready = make_ready(file, options);
  const Experiment& e = ready.prepared.experiment;
  int status = all_solved;
  for (std::size_t s = 0; s < e.settings().size(); ++s) {
    const PreparedCase prepared = at_setting(ready.prepared, s);
    RunKeeper keeper;
    if (is_first()) {
      const PlannedPart& part = ready.plan.cases.front().parts[s];
      const std::filesystem::path kept = options.suite.out / "parts" / part.file;
      keeper = RunKeeper(std::filesystem::path(kept).replace_extension(".runs"), part.stamp, {});
      std::filesystem::remove(kept);  // by an earlier run of compare
    }
    for (std::size_t l = 0; l < prepared.lattices.size(); ++l)
      for (const std::size_t number : ready.numbers)
        if (small_enough(e, *prepared.lattices[l].mesh))
          status = std::max(status, solve_model(prepared, l, number, e.body_material(s), options.tolerance, keeper));
  }
  return status;
}

void add_options(CLI::App& app, MpiOptions& options) {
  app.add_option("CASE", options.cases, "case files (*.toml), folders of them, or built-in names (springproof list)")
      ->required();
  app.add_option("--out", options.suite.out, "folder for the results, as of springproof compare")
      ->capture_default_str();
  app.add_option("--poisson-ratio", options.suite.poisson_ratios,
                 "only these of the cases' Poisson's ratios (0.25,0.49)")
      ->delimiter(',')
      ->take_all();
  app.add_option("--model", options.models, "only this model, by its label; may be given several times");
  app.add_option("--tolerance", options.tolerance, "relative residual")
      ->capture_default_str()
      ->check(CLI::Range(1e-13, 1e-2));
  app.footer(
      "Then: springproof compare CASE --resume, with the same --out and no option but --poisson-ratio and --jobs.\n"
      "Exit status: 0 all models are solved, 1 some are left to springproof compare, 2 the input is unusable.");
}

int parse_and_run(int argc, char** argv) {
  CLI::App app{"Linear equilibria of the models of a case on the processes of mpirun.", "springproof-mpi"};
  MpiOptions options;
  add_options(app, options);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& e) {
    if (is_first()) app.exit(e);
    return e.get_exit_code() ? unusable_input : 0;
  }
  try {
    std::vector<std::filesystem::path> files;
    agree(PETSC_COMM_WORLD, [&] { files = find_cases(options.cases); });
    int status = all_solved;
    for (const std::filesystem::path& file : files) status = std::max(status, solve_case(file, options));
    return status;
  } catch (const InputError& e) {  // which all processes have
    if (is_first()) to_stderr("{}\n", e.what());
    return unusable_input;
  }
}

/// Between the start of MPI and its end.  An error of one process alone ends all.
int run_with_mpi(int argc, char** argv) {
  int none = 0, status = 1;
  start_mpi_without_network();
  PetscInitialize(&none, nullptr, nullptr, nullptr);
  PetscPopSignalHandler();
  for (const char* several : {"OMPI_COMM_WORLD_SIZE", "PMI_SIZE"}) unsetenv(several);  // what is started here is alone
  try {
    set_solver_options();
    status = parse_and_run(argc, argv);
  } catch (const std::exception& e) {
    to_stderr("springproof-mpi: {}\n", e.what());
    MPI_Abort(PETSC_COMM_WORLD, 1);
  }
  PetscFinalize();
  return status;
}

}  // namespace
}  // namespace springproof

int main(int argc, char** argv) {
  return springproof::run_as_program([&] { return springproof::run_with_mpi(argc, argv); });
}
