// What models and finite elements cost on this machine: a calibration of seconds.
#pragma once

#include <functional>
#include <string>

#include "msm/embedding/boundary.h"
#include "msm/models.h"
#include "problem/material.h"

namespace springproof {

/// An explicit step of a model.
struct StepCost {
  double seconds_per_cell = 0;  ///< CPU time
  double safe_step = 0;         ///< largest step over the edge of the cells [s/m]
  std::string failure;          ///< why it could not be measured
};

/// The nodes at the bottom (z <= depth [m] above the lowest) clamped, an oblique body force on all, small enough for
/// linear behaviour.
BoundaryConditions clamped_bottom(const Network& network, double density, double depth);

/// Of the model that `build` returns, of so many cells of an edge [m]; the least of some repetitions counts.
StepCost step_cost(const std::function<MassSpringModel()>& build, double density, double cells, double edge);

/// Cost of one model or element as a function of the number of cells of a lattice, one core.
struct Speed {
  std::string model;
  StepCost step = {};
  double solve_cells = 1, solve = 0;  ///< CPU seconds of set-up and solve of a block of so many cells
  double solve_power = 1;             ///< by which they grow with the number of cells
  double MiB_per_cell = 0;            ///< of a solve
  std::string failure;                ///< why nothing could be measured

  double solve_seconds(double cells) const;
};

/// Of a block clamped on one side, small strain, as `springproof bench` measures.
Speed speed_of_model(const std::string& model, const IsotropicMaterial& material);

/// Of the finite element program, per cell; failure: it is not here.
Speed speed_of_element(const std::string& element, const IsotropicMaterial& material);

/// "AMD EPYC 7B13"; empty: not known.
std::string processor_name();

}  // namespace springproof
