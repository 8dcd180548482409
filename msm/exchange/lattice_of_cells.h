// Recognises a network that is a lattice of equal cells with superposed springs.
#pragma once

#include "msm/topology/network.h"

namespace springproof {

/// Sets CellSet::grid and springs of a network with cells if its springs are those of its equal cells superposed,
/// and its volume shares the cells': then it has the kernels and solvers of lattices.  Else it has neither.
void recognise_lattice(Network& network);

}  // namespace springproof
