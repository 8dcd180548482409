// Force law: the anchors by which supports hold the true surface of a body of cut cells, and the bonds by which its
// materials hold each other.
#pragma once

#include <array>

#include "msm/algebra/block_matrix.h"
#include "msm/laws/law_traits.h"
#include "msm/topology/network.h"

namespace springproof {

/// Energy sum d.K d/2, d = sum_a w_a x_a - x_node, over Network::anchors and sum g.K g/2 over Network::bonds: springs
/// of rest length zero, so the energy is quadratic, but of bonds that turn (TurnedBond).  That of bonds is the same
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

/// Whether a bond is stiffer along some axes, across its interface: then its energy is v.K v/2 of v = F^T g, g its gap
/// and F the mean of the deformation gradients in the middle of its two cells (covariant frame: as that of the
/// hourglass springs, AveragedSprings); of others g.K g/2.
bool turns(const InterfaceBond& bond);

/// What v of a bond that turns depends on at some positions.
struct TurnedBond {
  std::array<int, 16> nodes;
  std::array<double, 16> weights;      ///< of the gap
  Eigen::Matrix<double, 3, 16> frame;  ///< of F = (positions of the nodes) times its transpose [1/m]
  Eigen::Matrix3d F;                   ///< [1]
  Vec3 gap;                            ///< g [m]

  /// @param bond a bond
  /// @param X positions at rest [m], n x 3
  /// @param x positions [m], n x 3
  TurnedBond(const InterfaceBond& bond, const NodalVectors& X, const NodalVectors& x);

  Vec3 v() const { return F.transpose() * gap; }  ///< [m]

  /// Derivative of v.w to the positions: calls act(node, that [N]).
  /// @param w [N]
  template <class Act>
  void for_each_gradient(const Vec3& w, const Act& act) const {
    const Vec3 of_gap = F * w;
    for (int n = 0; n < 16; ++n) act(nodes[n], Vec3(weights[n] * of_gap + frame.col(n).dot(w) * gap));
  }
};

}  // namespace springproof
