// What models and finite elements cost on this machine: a calibration of seconds.
#pragma once

#include <string>
#include <vector>

#include "problem/material.h"

namespace springproof {

/// Cost of one model or element as a function of the number of cells of a lattice, one core.
struct Speed {
  std::string model;
  double step_per_cell = 0;           ///< CPU seconds of an explicit step, per cell; 0: does not move
  double safe_step = 0;               ///< largest explicit step [s] with cells of 1 m
  double solve_cells = 1, solve = 0;  ///< CPU seconds of set-up and solve of a block of so many cells
  double solve_power = 1;             ///< by which they grow with the number of cells
  double MiB_per_cell = 0;            ///< of a solve
  std::string failure;                ///< why nothing could be measured

  double solve_seconds(double cells) const;
};

/// Of a block clamped on one side, small strain, as `springproof bench` measures; `strain`: true: by Newton's method.
Speed speed_of_model(const std::string& model, const IsotropicMaterial& material);

/// Of the finite element program, per cell; failure: it is not here.
Speed speed_of_element(const std::string& element, const IsotropicMaterial& material);

/// "AMD EPYC 7B13, one core".
std::string this_machine();

}  // namespace springproof
