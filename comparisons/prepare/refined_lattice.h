// Lattices that are refined until they promise an accuracy.
#pragma once

#include <vector>

#include "comparisons/prepare/prepared_case.h"
#include "msm/measure/promised_error.h"

namespace springproof {

/// A body in cells of several sizes.
struct RefinedBody {
  CutBody cut;
  double estimated = 0;    ///< relative error of the displacement by the cells' energies, the largest of the materials
  double falls_short = 1;  ///< by what that must be multiplied, by the elastic energies of the lattices before
  bool reached = false;    ///< the accuracy that was asked for
  double promised() const { return falls_short * estimated; }
};

/// Halves the cells of a body where the stress differs most from that recovered at their nodes.
class Refinement {
 public:
  /// @param grid the cells to begin with
  Refinement(const PreparedCase& prepared, VoxelGrid grid, const Mesh& body);

  /// Goes on until the promised error (msm/measure/promised_error.h) of the first model of cut cells is at most
  /// `accuracy` for each material of the case (at rest, displacements small), cells have been halved four times or
  /// there are 100,000.  As long as no other lattice tells how far the estimate falls short, it is taken four times.
  /// @throws InputError if the loads cannot be applied, or leave a rigid motion.
  RefinedBody until(double accuracy);

 private:
  void solve();

  const PreparedCase& prepared_;
  VoxelGrid grid_;
  const Mesh& body_;
  CutBody cut_;
  std::vector<std::vector<LatticeEstimate>> by_material_;  // of all lattices so far
  std::vector<double> errors_;                             // of the cells, where the material's promise is the worst
  double estimated_ = 0;
  double falls_short_ = 1;
};

}  // namespace springproof
