// The benches of `springproof bench`, and its options.  Each adds its rows one by one, so that an interrupted run keeps
// those measured before, and a remark instead of rows where a program or a device is missing.
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "comparisons/bench/machine.h"
#include "comparisons/bench/rows.h"

namespace springproof::bench {

struct Options {
  std::string what;                        ///< "dynamics", "statics", "fem", "gpu", "all"
  std::filesystem::path json;              ///< file for the figures; empty: none
  bool quick = false;                      ///< small sizes, few samples: some 30 s for everything
  int threads = 2;                         ///< of the rows that compare several threads with one
  std::vector<std::string> fem_arguments;  ///< passed on to springproof-fem
};

/// Explicit time steps: cost per spring, against LAMMPS and the plain loop over springs.
void bench_dynamics(const Options& options, const Machine& machine, Findings& findings);

/// Equilibrium, against PETSc CG + GAMG and optimally damped dynamics.
void bench_statics(const Options& options, Findings& findings);

/// Runs `springproof-fem --bench`, which prints its own table, and compares it with CalculiX: its quadratic bricks
/// (C3D20, direct solver) and our Q2 on two cases of small strain at nu = 0.25.  Two rows each: CPU seconds of the
/// whole programs where ours has at least as many unknowns, and where ours is coarse enough that its error is just no
/// larger. Errors are those of displacements, against our grids of half the cell size and their extrapolation.
/// @return the JSON of springproof-fem; null if that program is not found.
nlohmann::json bench_fem(const Options& options, Findings& findings);

/// Explicit steps of lattices on the GPU against the same on several threads of this processor.
void bench_gpu(const Options& options, Findings& findings);

}  // namespace springproof::bench
