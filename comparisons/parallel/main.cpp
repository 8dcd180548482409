// springproof-lattice: one model of a case file on several processes.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <thread>

#include "comparisons/parallel/parted_run.h"
#include "comparisons/parallel/slab_run.h"
#include "msm/parallel/parted_equations.h"
#include "problem/system/input_error.h"
#include "problem/system/mpi_start.h"
#include "problem/system/named_files.h"
#include "problem/system/number_checks.h"
#include "problem/system/streams.h"

namespace springproof {
namespace {

MPI_Comm failures;  ///< communicator of processes that failed

nlohmann::json run(const ParallelOptions& options, MPI_Comm communicator) {
  ParallelCase c;
  agree(communicator, [&] { c = read_parallel_case(options); });
  const std::string no_slabs = why_no_slabs(c);
  if (options.steps > 0 && !no_slabs.empty())
    throw InputError(fmt::format("{}: --steps: {} (allowed: lattices that can be shared out in slabs)",
                                 options.case_file, no_slabs));
  nlohmann::json result = options.steps > 0 ? move_in_slabs(c, options.steps, options.damping, communicator)
                          : no_slabs.empty()
                              ? solve_in_slabs(c, options.tolerance, communicator)
                              : solve_in_parts(c, options.tolerance, options.max_iterations, communicator);
  result.update(
      {{"processes", size_of(communicator)}, {"poisson_ratio", c.material.poisson_ratio}, {"model", options.model}});
  return result;
}

void print(const nlohmann::json& r) {
  to_stdout("{}, nu = {}: {:.0f} unknowns, {} process{}\n", r["model"].get<std::string>(),
            r["poisson_ratio"].get<double>(), r["unknowns"].get<double>(), r["processes"].get<int>(),
            r["processes"] == 1 ? "" : "es");
  if (r.contains("steps"))
    to_stdout("{} steps of {:.3g} s\n", r["steps"].get<long>(), r["time_step_s"].get<double>());
  else
    to_stdout("{}: {} iterations, residual {:.2e}{}\n", r["solver"].get<std::string>(), r["iterations"].get<int>(),
              r["residual"].get<double>(), r["converged"].get<bool>() ? "" : ": NOT CONVERGED");
  to_stdout("set-up {:.3f} s, then {:.3f} s, {:.0f} MiB per process\n", r["set_up_seconds"].get<double>(),
            r["solve_seconds"].get<double>(), r["MiB_per_process"].get<double>());
  to_stdout("displacement, root mean square: {:.12e} m\n", r["displacement_rms_m"].get<double>());
  for (const auto& [name, value] : r["measures"].items()) to_stdout("{}: {:.12e}\n", name, value.get<double>());
}

void add_options(CLI::App& app, ParallelOptions& options) {
  app.add_option("CASE", options.case_file, "case file")->required();
  app.add_option("--cells", options.cells, "of a block along x, y, z, instead of the case's last")
      ->check(CLI::Range(1, 1000));
  app.add_option("--voxels", options.voxels, "about so many cubes, instead of the case's last")
      ->check(CLI::Range(1, 4000000));
  app.add_option("--poisson-ratio", options.poisson_ratio, "instead of the case's first")
      ->check(CLI::Range(-0.999, 0.4999));
  app.add_option("--model", options.model, "label of a model of the case, or a row of the table of models")
      ->capture_default_str();
  app.add_option("--tolerance", options.tolerance, "relative residual")
      ->capture_default_str()
      ->check(CLI::Range(1e-13, 1e-2));
  app.add_option("--max-iterations", options.max_iterations, "of the Krylov method")
      ->capture_default_str()
      ->check(CLI::Range(1, 1000000));
  app.add_option("--steps", options.steps, "so many explicit steps (large displacements) instead of equilibrium")
      ->check(CLI::Range(0, 1000000000));
  app.add_option("--damping", options.damping, "of explicit steps [1/s]")->capture_default_str()->check(positive(true));
  app.add_option("--json", options.json_file, "write the result as JSON too");
}

/// Whether the other processes come here too within some seconds; if not, they wait for this one elsewhere.
bool all_fail_alike() {
  constexpr double patience = 5;  // [s]
  const double start = wall_seconds();
  MPI_Request all;
  int here = 0;
  MPI_Ibarrier(failures, &all);
  while (MPI_Test(&all, &here, MPI_STATUS_IGNORE), !here && wall_seconds() - start < patience)
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  return here;
}

int parse_and_run(int argc, char** argv) {
  const int rank = rank_of(PETSC_COMM_WORLD);
  MPI_Comm_dup(PETSC_COMM_WORLD, &failures);
  CLI::App app{
      "One model of a case on the processes of mpirun: linear static equilibrium; of full blocks explicit steps too.",
      "springproof-lattice"};
  ParallelOptions options;
  add_options(app, options);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& e) {
    if (rank == 0) app.exit(e);
    return e.get_exit_code() ? 2 : 0;
  }
  try {
    const nlohmann::json result = run(options, PETSC_COMM_WORLD);
    if (rank > 0) return 0;
    print(result);
    if (!options.json_file.empty()) write_named_file(options.json_file, result.dump(2) + "\n");
    return result["converged"].get<bool>() ? 0 : 1;
  } catch (const std::exception& e) {
    const bool of_input = dynamic_cast<const InputError*>(&e), alike = all_fail_alike();
    if (rank == 0 || !alike)
      to_stderr("{}\n", of_input ? e.what() : fmt::format("{}: {}", options.case_file, e.what()));
    if (!alike) MPI_Abort(PETSC_COMM_WORLD, 1);
    return 2;
  }
}

/// Between the start of MPI and its end.
int run_with_mpi(int argc, char** argv) {
  int none = 0, status = 1;
  start_mpi_without_network();
  PetscInitialize(&none, nullptr, nullptr, nullptr);
  PetscPopSignalHandler();
  try {
    set_solver_options();
    status = parse_and_run(argc, argv);
  } catch (const std::exception& e) {
    to_stderr("springproof-lattice: {}\n", e.what());
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
