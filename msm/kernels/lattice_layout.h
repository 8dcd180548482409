// Memory layout of the nodes and springs of a lattice in its kernels (msm/kernels/lattice_kernels.h).
#pragma once

#include <array>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "msm/kernels/lattice_kernels.h"
#include "msm/laws/laws.h"

namespace springproof {

/// Table of blocks of coefficients that stores equal ones once.
class CoefficientTable {
 public:
  explicit CoefficientTable(int size) : size_(size) {}

  /// Start of the block among the values; appends it if it is new.
  int entry(const double* block);
  const std::vector<double>& values() const { return values_; }

 private:
  int size_;
  std::vector<double> values_;
  std::unordered_multimap<std::uint64_t, int> known_;
};

struct LatticeLayout {
  std::array<int, 3> axis;   ///< axis of space along x, y and z of the arrays
  std::array<int, 3> nodes;  ///< number of nodes along them
  int lanes = 0;
  int row_blocks = 0;
  long row = 0, plane = 0, size = 0;  ///< strides and length of an array, in values
  std::vector<int> slot;              ///< index of each node of the network in the arrays
  std::vector<int> first_run;
  std::vector<LatticeRun> runs;
  std::vector<int> spring_entry;  ///< per block
  std::vector<double> springs;    ///< coefficients, equal blocks once
  std::vector<int> inflow_entry,
      outflow_entry;  ///< of momentum dispersion; empty outflow: the inflow times outflow_sign
  std::vector<double> inflow, outflow;
  double outflow_sign = 1;

  long rows() const { return long(nodes[1]) * nodes[2]; }
  int block_of(int slot) const;  ///< number of the block that contains a slot
};

/// Whether a network is a cubic lattice of distinct nodes, connected with neighbours at most one edge away on each
/// axis, and its laws are springs, volume and hourglass correction, momentum dispersion; or
/// averaged springs of full cells with a strain curve that the kernels have.
bool is_lattice_of_springs(const MassSpringModel& model);

/// The kernels' name of a strain curve; none: they lack it.
LatticeCurve lattice_curve(StrainCurve curve);

/// Rows run along the axis that wastes fewest lanes, planes across the longest of the others.
/// `viscous`: there are dashpots in all cells.
/// Requires is_lattice_of_springs().
LatticeLayout lattice_layout(const MassSpringModel& model, int lanes, int bytes_per_value, bool viscous = false);

/// First plane of each of `slabs` slabs with equal computational work, and the end.
std::vector<int> split_planes(const LatticeLayout& layout, int slabs);

}  // namespace springproof
