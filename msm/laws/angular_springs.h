// Force law: angular springs at the corners of a planar triangular network (Kirkwood's model).
#pragma once

#include "msm/algebra/block_matrix.h"
#include "msm/laws/law_traits.h"
#include "msm/topology/network.h"

namespace springproof {

/// Energy sum beta/2 (phi - phi_0)^2 over the three angles of every triangle, phi_0 the angle at rest: six springs at a
/// node inside a hexagonal lattice.  Kot et al. (2014), eq. (13); Kot and Nagahashi (2015), eq. (4) (their coefficient:
/// docs/papers.md #14).  The angle is measured in space, so the triangles may turn and leave their plane.
/// An angle belongs to one triangle only, so triangles superpose and a boundary needs no special rule.
/// No triangle may be degenerate (phi = 0 or pi: no direction for the force).
struct AngularSprings {
  /// What solvers, kernels and the time step use of this law.
  static constexpr LawTraits traits = {"angular springs", Reach::springs, {Capability::lammps}};

  /// Why it cannot what its traits say, with these parameters; nullptr: it can (law_traits.h).
  const char* lacks(Capability what) const {
    return what == Capability::energy_momentum ? "depend on angles, which have no such forces here" : nullptr;
  }

  double beta = 0;  ///< stiffness of an angle [N m]

  /// Names the parameters, for springs files (law_traits.h).
  template <class Fields>
  void fields(Fields& f) {
    f.number("beta_Nm", beta);
  }

  double energy(const Network& network, const NodalVectors& x) const;                     ///< [J]
  void add_forces(const Network& network, const NodalVectors& x, NodalVectors& f) const;  ///< f += -dE/dx [N]
  void add_tangent(const Network& network, const NodalVectors& x, BlockMatrix& K) const;  ///< K += d2E/dx2 [N/m]
};

/// beta [N m] that gives a hexagonal lattice with springs k [N/m] of length a [m] the plane Poisson's ratio nu_2d:
/// k a^2/6 (1 - 3 nu)/(1 + nu).  Negative above nu = 1/3, and stable even so: in its plane a triangle has affine
/// strains only, and its energy stays positive as long as 6 beta/(k a^2) > -1, nu < 1.
/// @throws std::invalid_argument unless -1 < nu_2d < 1.
double angular_stiffness(double k, double a, double nu_2d);

}  // namespace springproof
