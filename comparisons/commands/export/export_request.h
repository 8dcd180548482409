// What `springproof export` is asked for.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "problem/material.h"

namespace springproof {

struct Experiment;

/// What the command line asks for.
struct ExportRequest {
  std::string what, to, out, model;     ///< out, model: empty: chosen
  std::vector<std::string> hold, load;  ///< of a body alone: rules of patches
  std::string carry;                    ///< file whose vertices the springs carry; empty: the surface of the body
  Moduli moduli;                        ///< of a body alone; of a case the Poisson's ratio selects one of the case's
  double density = 1000, scale = 1;
  std::vector<double> size;
  std::vector<int> cells;
  std::optional<int> voxels;
  bool whole_cubes = false;
};

}  // namespace springproof
