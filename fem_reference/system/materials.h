// The laws of the materials of a body.
#pragma once

#include <optional>
#include <vector>

#include "fem_reference/elements/cell_equations.h"
#include "fem_reference/grid/grid_problem.h"

namespace springproof::fem {

/// Of cells by their number in Mesh::materials: the law in the body's own material, then in those of its regions.  Each
/// has the form that is right for it alone.
/// @param law none: small strain
std::vector<CellLaw> laws_of(const GridProblem& problem, std::optional<Law> law, bool tetrahedra);

/// The form of a body of these materials.
inline Form form_of(const std::vector<CellLaw>& laws) { return any_mixed(laws) ? Form::mixed : laws.front().form; }

}  // namespace springproof::fem
