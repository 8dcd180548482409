// All kernels.  They are compiled once per instruction set (msm/kernels/compiled); one set is selected at run time.
#pragma once

#include "msm/kernels/block_rows.h"
#include "msm/kernels/cell_kernels.h"
#include "msm/kernels/instruction_set.h"
#include "msm/kernels/lattice_kernels.h"
#include "msm/kernels/list_kernels.h"

namespace springproof {

/// Those of one instruction set and precision.
template <class Real>
struct Kernels {
  LatticeKernels<Real> lattice;
  CellKernels<Real> cells;
  ListKernels<Real> list;
  CellListKernels<Real> cell_list;
  BlockRowKernels<Real> rows;
  DenseKernels<Real> dense;
};

/// @param set usable here
/// @return its kernels
/// @throws std::invalid_argument for a set that is not usable here.
template <class Real>
const Kernels<Real>& kernels_of(InstructionSet set = instruction_set());

}  // namespace springproof
