// Prepares a case for its runs.
#pragma once

#include "comparisons/prepare/prepared_case.h"

namespace springproof {

/// @throws InputError for every error in the input, before any long work starts.
PreparedCase prepare(const Experiment& experiment);

/// The first part of prepare(): the body meshed, its lattices cut and its models resolved; loads and measures are not
/// looked at.
/// @throws InputError for errors in the body and the models.
PreparedCase prepare_lattices(const Experiment& experiment);

/// Of a block the finest of the three reference grids: near-cubic elements, counts divisible by four so that the grid
/// can be halved twice, where the case leaves them to the program.
Cells reference_cells(const Experiment& experiment);

}  // namespace springproof
