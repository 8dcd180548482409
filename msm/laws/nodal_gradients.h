// Deformation gradients of the nodes of a network, by which momentum dispersion follows a material law at large strain.
#pragma once

#include <array>
#include <vector>

#include "msm/laws/momentum_dispersion.h"
#include "msm/laws/strain_energy.h"

namespace springproof {

/// From one end of a spring to the other, of a nodal field.
inline Vec3 between(const Spring& s, const NodalVectors& x) { return (x.row(s.j) - x.row(s.i)).transpose(); }

/// What Dispersion::finite_strain adds to the springs:
///
///     sum_n V_n [ W(F_n) - W_springs(F_n) ] ,   F_n = sum of d (x) g over the spring ends whose inflow n receives,
///
/// W the material law, W_springs the energy of the linear springs in a homogeneous strain (and of their dispersed
/// elongations, where these are kept: MomentumDispersion::of_volumes()), d from i to j at x, g = w B^-1 N, N the unit
/// vector of d at rest, B = sum w d (x) N at rest.  F_n is exact in affine motions, so that a homogeneous strain has
/// the stress of the law, and J_n = det F_n is the node's change of volume.  At small strain the two energies differ by
/// (lambda - G)/2 (tr F_n - 3)^2 alone, which is that of Dispersion::symmetric where B is isotropic, as exact weights
/// make it.
struct NodalGradients {
  const MomentumDispersion& law;
  const Network& network;
  std::vector<std::array<Vec3, 2>> g;  ///< per spring and end, i then j [1/m]; 0 where w is
  Eigen::VectorXd GV;                  ///< G V_n = tr B / 30 of the springs [J]; 0: the node receives nothing

  /// Of a network and its law, which are kept by reference.
  /// @throws std::invalid_argument if the springs at a node span no volume, as those of planar networks do.
  NodalGradients(const MomentumDispersion& law_, const Network& network_);

  std::vector<Eigen::Matrix3d> at(const NodalVectors& x) const;  ///< F_n at positions x [m]

  /// Energy of node n, for det F > 0 [J].
  StrainEnergy energy_of(int n, const Eigen::Matrix3d& F, Derivative up_to) const;
  double energy(const NodalVectors& x) const;                               ///< [J]; +inf if a det F_n <= 0
  void add_forces(const NodalVectors& x, NodalVectors& f) const;            ///< f += -dE/dx [N]
  void pull(const std::vector<Eigen::Matrix3d>& P, NodalVectors& f) const;  ///< f += forces of P_n : dF_n [N]

  using Entries = std::vector<Eigen::Triplet<double>>;
  /// The tangent as rows of inflow and outflow (algebra/tangent.h) from row `first` on.  Returns how many: at rest
  /// one per node, or none where the dispersed elongations are kept; nine at any other state.
  int add_flow(const NodalVectors& x, int first, Entries& inflow, Entries& outflow) const;

  /// Visits (spring, end 0 or 1, node that receives) where w is not 0.
  template <class Visit>
  void each_end(const Visit& visit) const {
    for (std::size_t s = 0; s < g.size(); ++s)
      for (int end = 0; end < 2; ++end)
        if (g[s][end] != Vec3::Zero())
          visit(s, end, law.sink(network, end == 0 ? network.springs[s].i : network.springs[s].j));
  }

 private:
  std::vector<SpringDirection> directions_;  ///< of the springs
};

}  // namespace springproof
