// The kernels that each source has for the table of its instruction set.
#pragma once

#include "msm/kernels/block_rows.h"
#include "msm/kernels/cell_kernels.h"
#include "msm/kernels/lattice_kernels.h"
#include "msm/kernels/list_kernels.h"

namespace springproof::SPRINGPROOF_KERNEL_NAMESPACE {

template <class Real>
LatticeKernels<Real> lattice_kernels();
template <class Real>
CellKernels<Real> cell_kernels();
template <class Real>
ListKernels<Real> list_kernels();
template <class Real>
CellListKernels<Real> cell_list_kernels();
template <class Real>
BlockRowKernels<Real> block_row_kernels();
template <class Real>
DenseKernels<Real> dense_kernels();

}  // namespace springproof::SPRINGPROOF_KERNEL_NAMESPACE
