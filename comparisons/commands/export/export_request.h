// What `springproof export` is asked for, and what its formats have in common.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "comparisons/prepare/prepared_case.h"
#include "msm/exchange/springs_file.h"
#include "problem/material.h"

namespace springproof {

/// What the command line asks for.
struct ExportRequest {
  std::string what, to, out, model;     ///< out, model: empty: chosen
  std::vector<std::string> hold, load;  ///< of a body alone: rules of patches
  std::string carry;                    ///< file whose vertices the springs carry; empty: the surface of the body
  Moduli moduli;                        ///< of a body alone; of a case the Poisson's ratio selects one of the case's
  double density = 1000, scale = 1;
  std::vector<double> size;
  std::optional<Cells> cells;
  std::optional<int> voxels;
  bool whole_cubes = false;
};

/// Whether a body is asked for that is in no case.
bool is_body(const std::string& name);

/// The case that is asked for.
/// @throws InputError if there is none, or its branches have no place in the file.
Experiment read_case(const ExportRequest& request);

/// A model without options, labelled by its name.
ModelChoice named_model(const std::string& name);

/// A case of the body, with the material, the model and the patches of the command line, and without loads.
/// @throws InputError for a script without its size, moduli that give no solid, a rule that is none.
Experiment body_alone(const ExportRequest& request);

/// The names of the patches of --hold: sides as they are called, other rules "held", "held_2", ...
std::vector<std::string> held_patches(const ExportRequest& request);

/// @throws InputError for a patch of the command line that is the whole surface.
void refuse_whole_surface(const PreparedCase& prepared);

/// The springs of the case or body.
/// @param cut of cut cells where the model has them and the case does not say otherwise
SpringsFile springs_of(const ExportRequest& request, bool cut = false);

/// `springproof export --to jolt | bullet | mujoco`: springs alone for Jolt where no model is named; the others' bodies
/// are tetrahedra, for which a lattice gives the nodes.
/// @return 0  @throws InputError for what the engine cannot have
int export_engine(const ExportRequest& request);

}  // namespace springproof
