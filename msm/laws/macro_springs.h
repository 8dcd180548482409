// Force law: springs at the points of a macro-cell of 27 nodes, and four modes of its volume.
#pragma once

#include <vector>

#include "msm/algebra/block_matrix.h"
#include "msm/laws/filled_volume.h"
#include "msm/laws/law_traits.h"
#include "msm/laws/strain_energy.h"
#include "msm/topology/network.h"

namespace springproof {

/// Second derivatives of the energy of a macro-cell: K = springs + modulus * gradient^T curvature gradient, of unknown
/// 3 * node + axis.
struct MacroTangent {
  Eigen::Matrix<double, 81, 81> springs;  ///< at constant dU/dtheta [N/m]
  Eigen::Matrix<double, 4, 81> gradient;  ///< dtheta_m/dx [1/m]
  Eigen::Matrix4d curvature;              ///< V d2U/dtheta_m dtheta_n, the mean of U over the cell [m^3]
};

/// Springs in the thirteen directions of a lattice at each of the 27 Gauss points of a macro-cell, where they see the
/// deformation gradient F of the triquadratic displacement of the nodes.  They act on lengths divided by J^(1/3), so
/// that they know the distortion alone.  The change of volume enters by its projection on {1, x, y, z} of the cell,
/// theta: energy V <w(F) + K U(theta)>, means over the points, V the cell's volume.  Objective; homogeneous strain and,
/// at small strain, all quadratic displacements are exact; the only motions without energy are rigid.  At small strain
/// these are finite elements of quadratic displacement and linear, discontinuous pressure (Q2-P1) whose pressure
/// carries all of K, not lambda alone (docs/decisions/msm.md).  Cells: Network::macro_cells.
///
/// Cells that a cut body fills in part have their points in it (msm/laws/macro_points.h), and bonds to their
/// neighbours: springs of rest length zero between the places to which the displacements of the two, each continued
/// over the other, bring a point.  One quadratic displacement of both costs nothing, so that nodes outside of the body
/// follow those inside; in terms of finite elements a ghost penalty (Burman 2010).
struct MacroSprings {
  /// What solvers, kernels and the time step use of this law.
  static constexpr LawTraits traits = {"macro-cell springs", Reach::second_neighbours};

  double shear_modulus = 0;                 ///< G [Pa]
  double lame_lambda = 0;                   ///< [Pa]
  StrainCurve curve = StrainCurve::hencky;  ///< the law at large strain
  /// gamma of the bonds: stiffness gamma G 2l times the mean of the square over each of two neighbours.
  static constexpr double bond = 0.03;

  /// Names the parameters, for springs files (law_traits.h).
  template <class Fields>
  void fields(Fields& f) {
    f.number("shear_modulus_Pa", shear_modulus);
    f.number("lame_lambda_Pa", lame_lambda);
    f.choice("curve", curve, {"hencky", "neo_hooke", "neo_hooke_isochoric", "springs_hencky", "springs_neo_hooke"});
  }

  /// Stiffness of U(theta) [Pa]: K; lambda in neo_hooke, whose springs know the volume.
  double volume_modulus() const { return lame_lambda - shear_modulus + springs_volume_modulus(curve, shear_modulus); }

  double energy(const Network& network, const NodalVectors& x) const;  ///< [J]; +inf if a cell is inverted at a point
  void add_forces(const Network& network, const NodalVectors& x, NodalVectors& f) const;  ///< f += -dE/dx [N]
  void add_tangent(const Network& network, const NodalVectors& x, BlockMatrix& K) const;  ///< K += d2E/dx2 [N/m]

  /// Second derivatives of the energy of one cell, for solvers.
  MacroTangent tangent(const Network& network, std::size_t cell, const NodalVectors& x) const;
  double bond_stiffness(const Network& network) const {
    return bond * shear_modulus * 2 * network.cell_edge;
  }                                                                                            ///< [N/m]
  void add_bond_forces(const Network& network, const NodalVectors& x, NodalVectors& f) const;  ///< those of the bonds
  void add_bonds(const Network& network, BlockMatrix& K) const;                                ///< likewise, any x
};

/// K += the matrix of a macro-cell, of unknown 3 * node + axis.
void add_to(BlockMatrix& K, const MacroCell& cell, const Eigen::Matrix<double, 81, 81>& matrix);

}  // namespace springproof
