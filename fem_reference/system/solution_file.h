// The file of a solution on its own mesh, for ParaView.
#pragma once

#include <string>

#include "fem_reference/system/sample.h"
#include "meshes/vtu.h"

namespace springproof::fem {

/// Writes displacement [m], stress (xx yy zz xy yz xz) and von Mises stress [Pa] at the nodes; quadratic elements as
/// VTK's quadratic cells.
/// @throws std::runtime_error if the file cannot be written.
void write_solution(const std::string& file, const NodalSolution& solution, const VtuNotes& notes);

}  // namespace springproof::fem
