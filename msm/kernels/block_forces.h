// What the list kernels have in common: forces on nodes in an order of their own, in blocks that follow each other.
#pragma once

#include <string>
#include <vector>

#include "msm/kernels/list_kernels.h"
#include "msm/topology/network.h"

namespace springproof {

/// The blocks that touch a node; first > last: none.
struct BlockRange {
  long first, last;
};

/// Order of the nodes, and which blocks need which of them.
struct BlockPlan {
  std::vector<int> order;           ///< node of the network at each place
  std::vector<BlockRange> touched;  ///< per place
  long blocks = 0;
  long blocks_of_piece = 1;  ///< that take some microseconds together
};

/// Converts a vector of 3 n in the network's order, times `factor`, to one by place.
template <class Real>
void by_place(const std::vector<int>& order, const double* v, double factor, std::vector<Padded<Real>>& out) {
  out.resize(order.size());
  for (std::size_t p = 0; p < out.size(); ++p) {
    const double* from = v + 3 * order[p];
    out[p] = {{static_cast<Real>(factor * from[0]), static_cast<Real>(factor * from[1]),
               static_cast<Real>(factor * from[2]), 0}};
  }
}
/// The way back.
template <class Real>
void by_node(const std::vector<int>& order, const std::vector<Padded<Real>>& v, double factor, double* out) {
  for (std::size_t p = 0; p < v.size(); ++p)
    for (int d = 0; d < 3; ++d) out[3 * order[p] + d] = factor * v[p].v[d];
}

/// Internal forces of a model on nodes at their places.
template <class Real>
class BlockForces {
 public:
  virtual ~BlockForces() = default;
  virtual std::string name() const = 0;  ///< "list kernel"
  virtual BlockPlan plan() const = 0;
  virtual const ListKernels<Real>& kernels() const = 0;  ///< of the same instruction set

  /// The positions [m] that `x` of the functions below is counted from.
  virtual NodalVectors origin() const = 0;

  /// f += forces of blocks begin <= b < end, whose branches make a step.  s: ListStep::s, from which dashpots have
  /// velocities.
  virtual void add_blocks(long begin, long end, const Padded<Real>* x, const Padded<Real>* s, Padded<Real>* f) = 0;
  /// There are dashpots: the fourth number of x is velocity / s.
  virtual bool viscous() const { return false; }

  /// There is momentum dispersion, or some nodes are carried: forces are not sums over blocks, but those of add().
  virtual bool coupled() const { return false; }
  /// f += all internal forces, where coupled(); x and s as in add_blocks(), of carried nodes anything.
  /// @param lagged dispersion uses the J of the previous call
  virtual void add(const Padded<Real>*, const Padded<Real>*, Padded<Real>*, bool) {}

  /// There are branches that relax.
  virtual bool relaxing() const { return false; }
  /// Relaxes them at x.
  virtual void relax(const Padded<Real>*) {}
  /// f += their forces at x, at the end of a step that they do not make.
  virtual void add_relaxing(const Padded<Real>*, Padded<Real>*) {}
  /// What each of them has stored there [J].
  virtual std::vector<double> branch_energies(const Padded<Real>*) { return {}; }
};

}  // namespace springproof
