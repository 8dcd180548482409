// What solvers, kernels and the time step need to know of a force law: a constant of each law, next to its forces.
#pragma once

namespace springproof {

/// Which nodes the force at a node depends on.
enum class Reach {
  springs,            ///< those that its springs join it to; on a lattice of cells, part of the stiffness of a cell
  cells,              ///< those of its cells: a term per cell
  second_neighbours,  ///< also those that these are joined to: no part of a cell's stiffness
};

struct LawTraits {
  const char* name;
  Reach reach;
  bool lattice_kernels = false;  ///< msm/kernels/lattice_kernel.h has it; otherwise the plain loops are used
  bool list_kernels = false;     ///< msm/kernels/list_kernels.h has it; otherwise the plain loops are used
};

}  // namespace springproof
