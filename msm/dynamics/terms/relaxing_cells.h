// Relaxation of a moving model: Maxwell elements in its cells, beside the springs, which have the long-time moduli.
#pragma once

#include <vector>

#include "msm/laws/cell_forms.h"
#include "msm/laws/laws.h"
#include "problem/relaxation.h"

namespace springproof {

/// The branches of a model's cells.  Each has the overstrains Q of two invariants of the cell's mean deformation
/// gradient F: the deviator of Green-Lagrange's strain, with the stress 2 share G Q (second Piola-Kirchhoff), and the
/// hourglass components F^T q, by which all branches together stiffen a cell suddenly to one of the sudden moduli; left
/// elastic these would hold back a quarter of the creep of a bar of two cells across.  No rigid motion is resisted, and
/// both momenta are kept.
struct RelaxingCells {
  Relaxation relaxation = {};
  AveragedSprings cells = {};  ///< with the long-time moduli, and the hourglass stiffness of branches of sum 1

  /// Those of a model: of its own averaged springs, or of those exact for the material.
  /// @param model a model
  /// @param material of the body, at long times
  /// @param relaxation without branches: none, for any model
  /// @throws InputError for a model that lacks Capability::relaxation.
  static RelaxingCells of(const MassSpringModel& model, const IsotropicMaterial& material,
                          const Relaxation& relaxation);

  bool acts() const { return relaxation.acts(); }
};

/// What a branch of a cell sees: the deviatoric strain [1], then the hourglass components [m].
using CellStrains = Eigen::Matrix<double, 3, 7>;

/// The state of the branches: the overstrains at the positions that were last advanced to.
class Overstrains {
 public:
  /// Relaxed at the rest positions; keeps a reference to the network.
  Overstrains(const Network& network, const RelaxingCells& relaxing);

  bool acts() const { return !branches_.empty(); }

  /// Sets all overstrains to zero.
  /// @param x positions [m], n x 3
  void relax(const NodalVectors& x);

  /// @param x positions at the end of a step [m], n x 3
  /// @param dt step [s]; 0: without one
  /// @param f += the forces [N] there, of carried nodes handed back
  void add_forces(const NodalVectors& x, double dt, NodalVectors& f) const;

  /// The same over a step, in its mean: with the energy of the branches and what they dissipate, exactly its work.
  /// @param x0 positions that were last advanced to [m], n x 3
  /// @param x1 positions at the end of the step [m], n x 3
  /// @param dt step [s]
  /// @param f += the forces [N]
  void add_mean_forces(const NodalVectors& x0, const NodalVectors& x1, double dt, NodalVectors& f) const;

  /// Makes a step.
  /// @param x positions at its end [m], n x 3
  /// @param dt step [s]
  void advance(const NodalVectors& x, double dt);

  double energy() const;                             ///< of the branches [J]
  double dissipated() const { return dissipated_; }  ///< since they were relaxed [J]

 private:
  double twice_energy(std::size_t cell, const CellStrains& a, const CellStrains& b) const;

  const Network& network_;
  std::vector<RelaxationBranch> branches_;
  double shear_modulus_ = 0;  ///< [Pa]
  CellForms forms_;
  std::vector<CellStrains> strains_;      ///< of each cell
  std::vector<CellStrains> of_branches_;  ///< overstrains, of the branches of each cell
  double dissipated_ = 0;
};

}  // namespace springproof
