// The elastic system with assembled matrices, for any cells and any law.  The counterpart of the matrix-free operators
// for meshes without a multigrid hierarchy.
#pragma once

#include <memory>
#include <optional>

#ifndef SPRINGPROOF_SOLVER_NAMESPACE
#define SPRINGPROOF_SOLVER_NAMESPACE assembled
#endif
#include "fem_reference/solvers/mixed_field.h"
#include "fem_reference/solvers/multigrid.h"
#include "fem_reference/system/elastic_system.h"

namespace springproof::fem::assembled {

/// Implements the operator interface of solve_linear() and Newton (linear.h, newton.h).
class AssembledOperator {
 public:
  /// Without a law: small strain.
  AssembledOperator(const ElasticSystem& system, std::optional<Law> law);
  ~AssembledOperator();

  MixedField vector() const;
  void apply(MixedField& f, const MixedField& x) const;
  void vmult(MixedField& y, const MixedField& x) const;
  void couple(DofVector& f, const DofVector& p) const;
  void precondition_displacement(DofVector& z, const DofVector& r) const;
  void precondition_pressure(DofVector& y, const DofVector& x) const;
  void clear_constrained(DofVector& f) const;
  CellPressures pressures(const MixedField& x) const;

  double linearise(MixedField& f, const MixedField& x);
  /// Rebuilds the multigrid for the deformed body, if the current one has become slow.
  void prepare(const MixedField& x);
  /// Factors of the stiffness of the body deformed by x (under small strain, of the undeformed one) in place of the
  /// multigrid. Linear elements lock in thin bodies and are of no use below quadratic ones there.
  /// @return false if that is so already, or if it has more rows than `most_factored_for_thin_bodies`
  bool factorise(const MixedField& x);

  const std::string& preconditioner() const { return multigrid_->name(); }  ///< of the displacements, for the report

 private:
  struct Spaces;
  struct Matrices;
  struct CoarseSpaces;
  void assemble_stiffness(const DofVector* deformed_by);
  void assemble_mass();

  const ElasticSystem& system_;
  std::optional<Law> law_;
  std::unique_ptr<Spaces> spaces_;
  std::unique_ptr<Matrices> matrices_;
  MixedField state_;                        ///< state of the last linearise()
  std::unique_ptr<SparseMatrix> smoothed_;  ///< fine-level matrix of the multigrid
  std::unique_ptr<CoarseSpaces> coarse_;    ///< for quadratic elements: the linear ones
  int most_factored_;                       ///< rows, of the level that is factored
  std::unique_ptr<Multigrid> multigrid_;
  std::unique_ptr<SparseMatrix> mass_;  ///< pressure mass matrix
  DofVector inverse_mass_;              ///< its diagonal, inverted
  mutable int cycles_ = 0;              ///< V-cycles since prepare()
  int cycles_when_new_ = 0;             ///< V-cycles in the first solve after the set-up
};

}  // namespace springproof::fem::assembled
