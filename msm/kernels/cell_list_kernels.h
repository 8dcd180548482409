// Interface of the kernels for lists of cells, which the body may fill in part, on plain arrays; cell_list_kernel.cpp
// defines them once per instruction set.
#pragma once

#include "msm/kernels/lattice_kernel.h"
#include "msm/kernels/list_kernels.h"

namespace springproof {

/// What is stored of a cell of edge l, of FilledPart: alpha l^2 [m^2], c / 2, p and rho [1] (AveragedSprings), 1 / l
/// [1/m].
namespace cell_number {
constexpr int area = 0, mean = 1, mixed = 4, variance = 7, per_edge = 10, count = 11;
}  // namespace cell_number

/// Cells in blocks of as many as a kernel computes together; an unused place of the last block repeats a cell without
/// volume.
template <class Real>
struct CellList {
  long blocks = 0;
  const int* corners = nullptr;         ///< places; per block those of each corner x + 2 y + 4 z in turn
  const Real* numbers = nullptr;        ///< per block each of cell_number in turn
  LatticeAveraged<Real> springs = {};   ///< moduli, hourglass stiffness times G / 8 [Pa]
  LatticeAveraged<Real> dashpots = {};  ///< the same times the time of retardation [s]; without a curve
  bool boxes = false;                   ///< full cells that are no cubes: l that of the cube of their volume, rho p_i^2
  Real proportions[3] = {1, 1, 1};      ///< Network::proportions
  Real per_proportion[3] = {1, 1, 1};
};

template <class Real>
struct CellListKernels {
  int cells;  ///< of a block
  /// f += forces of the cells at displacements u [m].
  void (*forces)(const CellList<Real>&, const Padded<Real>* u, Padded<Real>* f);
  /// f += forces of springs and dashpots.  Velocities are s times the fourth number of u.
  void (*viscous_forces)(const CellList<Real>&, const Padded<Real>* u, const Padded<Real>* s, Padded<Real>* f);
};

#define SPRINGPROOF_CELL_LIST_KERNELS(instruction_set)   \
  namespace instruction_set {                            \
  extern const CellListKernels<double> cell_list_double; \
  extern const CellListKernels<float> cell_list_float;   \
  }
SPRINGPROOF_CELL_LIST_KERNELS(portable)
SPRINGPROOF_CELL_LIST_KERNELS(avx2)
SPRINGPROOF_CELL_LIST_KERNELS(avx512)
#undef SPRINGPROOF_CELL_LIST_KERNELS

}  // namespace springproof
