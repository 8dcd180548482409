// `springproof export --to jolt | bullet | mujoco`.
#pragma once

#include <string>
#include <vector>

#include "comparisons/commands/export/export_request.h"
#include "msm/exchange/springs_file.h"

namespace springproof {

/// The request with the model that the engine takes: springs alone for Jolt where none is named; the others' bodies are
/// tetrahedra, for which a lattice gives the nodes.
/// @throws InputError for a model or a name of a file that the engine cannot have.
ExportRequest for_engine(ExportRequest request);

/// The patches that the loads of a case hold or move in all three directions.
std::vector<std::string> held_patches(const Experiment& experiment);

/// Writes the body, whose `held` patches are fixed, for the engine request.to.
/// @throws InputError for what the engine cannot have.
int export_to_engine(const ExportRequest& request, const SpringsFile& springs, const std::vector<std::string>& held);

}  // namespace springproof
