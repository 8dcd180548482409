// The elastic system with assembled matrices: any cells, any law.  The counterpart of the matrix-free operators for
// meshes without a hierarchy.
#pragma once

#include <memory>
#include <optional>

#ifndef SPRINGPROOF_SOLVER_NAMESPACE
#define SPRINGPROOF_SOLVER_NAMESPACE assembled
#endif
#include "fem_reference/elastic_system.h"
#include "fem_reference/mixed_vector.h"
#include "fem_reference/multigrid.h"

namespace springproof::fem::assembled {

/// What solve_linear() and Newton ask of an operator (linear.h, newton.h).
class AssembledOperator {
 public:
  /// Without a law: small strain.
  AssembledOperator(const ElasticSystem& system, std::optional<Law> law);
  ~AssembledOperator();

  MixedVector vector() const;
  void apply(MixedVector& f, const MixedVector& x) const;
  void vmult(MixedVector& y, const MixedVector& x) const;
  void precondition(MixedVector& z, const MixedVector& r) const;
  void precondition_pressure(DofVector& y, const DofVector& x) const;
  void clear_constrained(DofVector& f) const;
  CellPressures pressures(const MixedVector& x) const;

  double linearise(MixedVector& f, const MixedVector& x);
  /// Sets the multigrid up for the deformed body, if the one there is has become slow.
  void prepare(const MixedVector& x);

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
  MixedVector state_;                       ///< that was linearised at
  std::unique_ptr<SparseMatrix> smoothed_;  ///< the stiffness that the multigrid is of
  std::unique_ptr<CoarseSpaces> coarse_;    ///< of quadratic elements: the linear ones
  std::unique_ptr<Multigrid> multigrid_;
  std::unique_ptr<SparseMatrix> mass_;  ///< of the pressures
  DofVector inverse_mass_;              ///< its diagonal, inverted
  mutable int cycles_ = 0;              ///< since prepare()
  int cycles_when_new_ = 0;             ///< in the first solve after the set-up
};

}  // namespace springproof::fem::assembled
