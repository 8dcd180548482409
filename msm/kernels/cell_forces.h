// Forces of averaged springs, or measured cells, in cells that the body may fill in part, by the kernels for lists.
#pragma once

#include "msm/kernels/aligned_array.h"
#include "msm/kernels/block_forces.h"
#include "msm/kernels/kernels.h"
#include "msm/laws/laws.h"
#include "problem/relaxation.h"

namespace springproof {

/// Cells row by row and layer by layer across the longest axis of the body, in blocks; nodes in the order in which the
/// last of their cells comes, so that a sweep completes them in their order, a layer later.  Anchors and bonds are in
/// blocks too.  The cells of a block are of one material, those of a layer one material after the other.
struct CellOrder {
  std::vector<int> cells;         ///< of the network; -1: the rest of a block
  std::vector<int> material;      ///< of the cells of each block
  std::vector<int> anchors;       ///< of the network
  std::vector<int> first_anchor;  ///< per block, and one more
  std::vector<int> bonds;         ///< of the network
  std::vector<int> first_bond;    ///< per block, and one more
  std::vector<int> place;         ///< of each node
  BlockPlan plan;

  /// @param network with cells
  /// @param cells_of_block how many a kernel computes together
  CellOrder(const Network& network, int cells_of_block);
};

/// Internal forces of a model of averaged springs, of one material or several, or measured cells, with anchors or
/// without; keeps no reference to the model.  `x` are displacements. Real = double: equal to forces() (msm/laws/laws.h)
/// to 1e-12 of the largest force; float: 1e-5.
template <class Real>
class CellForces : public BlockForces<Real> {
 public:
  /// @param dashpots stiffness at rest of what AveragedSprings::add_viscous_forces() adds, where `time` > 0; measured
  /// cells have MeasuredCells::add_viscous_forces()
  /// @param time of retardation [s]
  /// @throws std::invalid_argument without Capability::cell_kernels.
  explicit CellForces(const MassSpringModel& model, InstructionSet set = instruction_set(),
                      const AveragedSprings& dashpots = {}, double time = 0);

  /// f = internal forces [N] at x [m] of nodes with velocities v [m/s], in the network's order.
  void at(const NodalVectors& x, const NodalVectors& v, NodalVectors& f);

  std::string name() const override { return "cell kernel"; }
  BlockPlan plan() const override { return order_.plan; }
  const ListKernels<Real>& kernels() const override { return kernels_->list; }
  NodalVectors origin() const override { return X_; }
  void add_blocks(long begin, long end, const Padded<Real>* x, const Padded<Real>* s, Padded<Real>* f) override;
  bool viscous() const override { return viscous_; }
  bool coupled() const override { return !carried_.empty(); }
  void add(const Padded<Real>* x, const Padded<Real>* s, Padded<Real>* f, bool lagged) override;
  bool relaxing() const override { return !branches_.empty(); }
  void relax(const Padded<Real>* x) override;
  void add_relaxing(const Padded<Real>* x, Padded<Real>* f) override;
  std::vector<double> branch_energies(const Padded<Real>* x) override;

  /// Gives the cells branches, relaxed at rest.
  /// @param relaxation with branches or without
  /// @param cells with the long-time moduli of the branches
  /// @param time_step that each call of add_blocks() makes [s]
  void set_branches(const Relaxation& relaxation, const AveragedSprings& cells, double time_step);

 private:
  /// At places, with what its spring is stretched by at rest.
  struct Held {
    int corners[8], node;
    Real weights[8], stiffness[3][3], stretch[3];  ///< [1], [N/m], [m]
  };

  /// The same of a bond of two cells.
  struct Tie {
    int corners[16];
    Real weights[16], stiffness[3][3], gap[3];
  };
  struct Constants {
    LatticeAveraged<Real> springs, dashpots;
  };

  void store_cells(const Network& network);
  void store_forms(const MeasuredCells& law);
  void store_anchors(const Network& network);
  void store_bonds(const Network& network);
  CellList<Real> part_of_list(long begin, long end);
  void place_carried(const Padded<Real>* x, const Padded<Real>* s);
  void add_anchors(long begin, long end, const Padded<Real>* x, Padded<Real>* f) const;
  void add_bonds(long begin, long end, const Padded<Real>* x, Padded<Real>* f) const;

  const Kernels<Real>* kernels_;
  NodalVectors X_;
  bool viscous_;
  CellOrder order_;
  std::vector<int> corners_;
  AlignedArray<Real> numbers_, forms_;
  CellList<Real> list_;
  std::vector<Constants> constants_;  ///< of each material
  std::vector<CellBranch<Real>> branches_;
  AlignedArray<Real> overstrains_;
  std::vector<Held> anchors_;
  std::vector<Tie> ties_;
  std::vector<CarriedPoint> carried_;  ///< places
  std::vector<Padded<Real>> x_, s_;    ///< with carried nodes in their places; of add()
};

extern template class CellForces<double>;
extern template class CellForces<float>;

}  // namespace springproof
