// The case of springproof-lattice: one model at one Poisson's ratio and one resolution.
#pragma once

#include <optional>
#include <string>

#include "msm/models.h"
#include "problem/case_file/experiment.h"

namespace springproof {

/// What is asked for.
struct ParallelOptions {
  std::string case_file, model = "hybmss", json_file;
  std::optional<std::array<int, 3>> cells;
  std::optional<int> voxels;
  std::optional<double> poisson_ratio;
  double tolerance = 1e-10;
  int max_iterations = 2000;
  long steps = 0;      ///< > 0: explicit steps instead of equilibrium
  double damping = 0;  ///< [1/s]
};

/// An experiment of that alone: linear, at rest, without a reference or expected values.
struct ParallelCase {
  Experiment experiment;
  Cells cells;  ///< of a block
  IsotropicMaterial material;
  ModelParameters model;
};

/// `options.model`: the label of a model of the case, with its options, or a row of the table of models.
/// @throws InputError for errors in the file, and options that do not suit the body.
ParallelCase read_parallel_case(const ParallelOptions& options);

double wall_seconds();

}  // namespace springproof
