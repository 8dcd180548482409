// Force law: the anchors by which supports hold the true surface of a body of cut cells, and the bonds by which its
// materials hold each other.
#pragma once

#include "msm/algebra/block_matrix.h"
#include "msm/laws/law_traits.h"
#include "msm/topology/network.h"

namespace springproof {

/// Energy sum d.K d/2, d = sum_a w_a x_a - x_node, over Network::anchors and sum g.K g/2 over Network::bonds: springs
/// of rest length zero, so the energy is quadratic, but of bonds that turn (turned_bond.h).  That of bonds is the same
/// in every frame.
struct Anchors {
  /// What solvers, kernels and the time step use of this law.
  static constexpr LawTraits traits = {
      "anchors",
      Reach::cells,
      {Capability::cell_kernels, Capability::cut_multigrid, Capability::energy_momentum, Capability::recovered_stress}};

  /// Names the parameters, for springs files (law_traits.h).
  template <class Fields>
  void fields(Fields&) {}

  double energy(const Network& network, const NodalVectors& x) const;                     ///< [J]
  void add_forces(const Network& network, const NodalVectors& x, NodalVectors& f) const;  ///< f += -dE/dx [N]
  void add_tangent(const Network& network, const NodalVectors& x, BlockMatrix& K) const;  ///< K += d2E/dx2 [N/m]
};

}  // namespace springproof
