// The finite elements of a part that is being run: solved, recorded, and brought to the lattices as their reference.
#pragma once

#include <string>

#include "comparisons/run/part_run.h"

namespace springproof {

/// What was solved: of tetrahedra those after all cuts, where grid.cells holds those before, of which the ratios are.
Cells solved_cells(const fem::Solution& solution);
/// Coarse to fine.
std::vector<Cells> solved_cells(const ElementGrids& grids);

/// What is recorded of a solution.
Run fem_run(const PartRun& run, const fem::Solution& solution, const std::string& model);

/// Runs the finite elements of [reference], at rest and in time, and those beside the models; adds their records and
/// sets what the models are compared with.
void run_reference(PartRun& run);

}  // namespace springproof
