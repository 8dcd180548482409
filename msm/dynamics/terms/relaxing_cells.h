// Relaxation of a moving model: Maxwell elements in its cells, beside the springs, which have the long-time moduli.
#pragma once

#include <vector>

#include "msm/laws/laws.h"
#include "problem/relaxation.h"

namespace springproof {

/// The branches of a model's cells.  Each has the overstrains Q of how a cell changes its shape (Deformations without
/// the mean strain), by which all branches together stiffen it suddenly to one of the sudden moduli:
///  - of measured cells by their own forms, of the logarithmic strain;
///  - of others by averaged springs, of Green-Lagrange's strain: 2 share G Q is a second Piola-Kirchhoff stress.
/// Hourglass components relax too: left elastic these would hold back a quarter of the creep of a bar of two cells
/// across.  No rigid motion is resisted, and both momenta are kept.
struct RelaxingCells {
  Relaxation relaxation = {};
  AveragedSprings cells = {};   ///< with the long-time moduli, and the hourglass stiffness of branches of sum 1
  MeasuredCells measured = {};  ///< of measured cells in their place: forms without_volume()

  /// Those of a model: of its own averaged springs or measured cells, or of springs exact for the material.
  /// @param model a model
  /// @param material of the body, at long times; of measured cells any
  /// @param relaxation without branches: none, for any model
  /// @throws InputError for a model that lacks Capability::relaxation.
  static RelaxingCells of(const MassSpringModel& model, const IsotropicMaterial& material,
                          const Relaxation& relaxation);

  bool acts() const { return relaxation.acts(); }
  bool of_measured() const { return !measured.form.empty(); }
};

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
  CellShape shape(std::size_t cell) const { return network_.cells.shape(cell); }
  /// Of a cell at positions x.
  Deformations strains(std::size_t cell, const NodalVectors& x) const;
  /// Sum of the branches by their shares.
  template <class Overstrain>
  Deformations sum(std::size_t cell, double dt, const Overstrain& of_branch) const;

  const Network& network_;
  std::vector<RelaxationBranch> branches_;
  StrainOfCell measure_ = StrainOfCell::green_lagrange;
  MeasuredCells forms_;
  std::vector<Deformations> strains_;      ///< of each cell
  std::vector<Deformations> of_branches_;  ///< overstrains, of the branches of each cell
  double dissipated_ = 0;
};

}  // namespace springproof
