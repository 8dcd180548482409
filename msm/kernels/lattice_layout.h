// Where the nodes and springs of a lattice lie in the arrays of its kernels (msm/kernels/lattice_kernel.h).
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <unordered_map>
#include <vector>

#include "msm/kernels/lattice_kernel.h"
#include "msm/laws/laws.h"

namespace springproof {

/// Blocks of coefficients, equal ones kept once.
class CoefficientTable {
 public:
  explicit CoefficientTable(int size) : size_(size) {}

  /// Where the block starts among the values.
  int entry(const double* block);
  const std::vector<double>& values() const { return values_; }

 private:
  int size_;
  std::vector<double> values_;
  std::unordered_multimap<std::uint64_t, int> known_;
};

struct LatticeLayout {
  std::array<int, 3> axis;   ///< of space, along which x, y and z of the arrays run
  std::array<int, 3> nodes;  ///< along them
  int lanes = 0;
  int row_blocks = 0;
  long row = 0, plane = 0, size = 0;  ///< strides and length of an array, in values
  std::vector<int> slot;              ///< of each node of the network in the arrays
  std::vector<int> first_run;
  std::vector<LatticeRun> runs;
  std::vector<int> spring_entry;  ///< per block
  std::vector<double> springs;    ///< their coefficients, each once
  std::vector<int> inflow_entry,
      outflow_entry;  ///< of momentum dispersion; no outflow: it is the inflow times outflow_sign
  std::vector<double> inflow, outflow;
  double outflow_sign = 1;

  long rows() const { return long(nodes[1]) * nodes[2]; }
  int block_of(int slot) const;  ///< number of the block that holds a node
};

/// Whether a network is a cubic lattice of nodes, joined with neighbours at most one edge away on each axis, with no
/// two nodes in one place, and its laws are springs, volume and hourglass correction, momentum dispersion.
bool is_lattice_of_springs(const MassSpringModel& model);

/// Rows run along the axis that wastes fewest lanes, planes across the longest of the others.
/// Requires is_lattice_of_springs().
LatticeLayout lattice_layout(const MassSpringModel& model, int lanes, int bytes_per_value);

}  // namespace springproof
