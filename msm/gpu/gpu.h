// The GPU that the library was built for (SPRINGPROOF_CUDA), and what it does.  Plain arrays: what implements this is
// compiled by nvcc, or, without CUDA, by the C++ compiler for the processor (msm/gpu/backend.h).
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "msm/kernels/lattice_kernels.h"

namespace springproof::gpu {

/// Nodes (x, y, z), counted from 1, at x + row y + plane z, with a margin of places without nodes on all sides, so that
/// no thread looks whether it has neighbours.  A block of threads owns `own_x` x `own_y` columns of nodes and
/// `planes_of_block` planes.
struct Box {
  static constexpr int own_x = 31, own_y = 7;  ///< one less than threads: the first of a line and of a row help only

  int nodes[3] = {};
  int blocks[3] = {};
  int planes_of_block = 0;
  int row = 0, plane = 0, size = 0;

  Box() = default;
  Box(int x, int y, int z) : nodes{x, y, z} {
    blocks[0] = (x + own_x - 1) / own_x;
    blocks[1] = (y + own_y - 1) / own_y;
    // A block repeats one plane of cells; some hundred blocks keep a GPU busy.
    planes_of_block = 32;
    while (planes_of_block > 2 && long(blocks[0]) * blocks[1] * ((z + planes_of_block - 1) / planes_of_block) < 500)
      planes_of_block /= 2;
    blocks[2] = (z + planes_of_block - 1) / planes_of_block;
    row = (blocks[0] * own_x + 2 + 15) / 16 * 16;
    plane = row * (blocks[1] * own_y + 2);
    size = plane * (z + 2);
  }
  int at(int x, int y, int z) const { return x + row * y + plane * z; }
  int number_of_blocks() const { return blocks[0] * blocks[1] * blocks[2]; }
};

/// Name of the GPU; empty: the library has none, or the machine.
std::string device_name();
bool built_for_gpu();  ///< by CUDA

/// Where steps of lattices are made that do not say it themselves: SPRINGPROOF_DEVICE, "processor" (default) or "gpu".
/// @throws InputError for another value, or where there is no GPU.
bool wants_gpu();

// An entry of the table of kinds.
constexpr int neighbours = 27;  ///< number c of the neighbour at (c % 3, c / 3 % 3, c / 9) - 1; 13: the node itself
constexpr int kappa_of_kind = neighbours;       ///< kappa edge^2 [N] of the cell whose lowest corner is the node
constexpr int cell_of_kind = neighbours + 1;    ///< 1: there is this cell
constexpr int values_of_kind = neighbours + 2;  ///< before them: spring constant times edge [N] to each neighbour
constexpr int values_of_load = 6;               ///< 1 / (mass edge) of three unknowns (0 if fixed), force [N]
constexpr int no_node = -1;                     ///< in place of an entry of loads

/// What explicit steps need of a lattice; lengths in cell edges, places in the box.
template <class Real>
struct LatticeForGpu {
  Box box;
  std::vector<int> kind;
  std::vector<Real> kinds;  ///< entries of values_of_kind
  int reach = 0;            ///< squared length of the longest springs; 0: there are none
  bool volume = false, bounded = false, corrected = false;
  LatticeHourglass<Real> hourglass = {};
  LatticeAveraged<Real> averaged = {};  ///< with a curve: the model's only law
};

/// Displacements [edges] and velocities [edges/s] of a lattice in the GPU's memory, and what moves them.
template <class Real>
class LatticeSteps {
 public:
  explicit LatticeSteps(const LatticeForGpu<Real>& lattice);
  ~LatticeSteps();

  /// Supports and loads: per place the start of its entry of values_of_load, or no_node.
  void set_loads(const std::vector<int>& load, const std::vector<Real>& loads);
  /// Three components, one after the other, of box.size values.
  void write(const std::vector<Real>& u, const std::vector<Real>& v);
  void read_u(std::vector<Real>& u) const;
  void read_v(std::vector<Real>& v) const;
  /// Sets components of displacements: places count from the first component's first.
  void set(const std::vector<int>& places, const std::vector<Real>& u);

  /// Sums over the nodes of |force|^2 [N^2] at the beginning of the last step.
  LatticeSums advance(long steps, Real time_step, Real decay);
  std::vector<Real> forces();  ///< internal forces [N]
  double bytes() const;

 private:
  struct Data;
  std::unique_ptr<Data> data_;
};

}  // namespace springproof::gpu
