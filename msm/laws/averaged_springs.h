// Force law: springs averaged over a cell, a cube that the body may fill in part, or a box.
#pragma once

#include <vector>

#include "msm/algebra/block_matrix.h"
#include "msm/cells/filled_volume.h"
#include "msm/laws/law_traits.h"
#include "msm/laws/strain_energy.h"
#include "msm/topology/network.h"

namespace springproof {

/// Stiffness of the modes of a full cell of edge l that its mean strain does not see, in units of G l: displacements in
/// the patterns xi_p xi_q and xi_x xi_y xi_z of its corners, normalised.
struct HourglassStiffness {
  double bending = 1;   ///< of a bending mode; 1/(3(1 - nu)) is exact
  double coupling = 0;  ///< between the two bending modes of one neutral plane; nu/(3(1 - nu))
  double torsion = 0;   ///< of the paired torsional modes, a quarter of that of the symmetric one; 1/6
  double twist = 0;     ///< in addition, of each torsional mode
  double warping = 0;   ///< of xi_x xi_y xi_z

  /// Of the springs of a cubic pattern of face-to-cube ratio A, with exact bending and torsion where they are
  /// corrected.  `slender`: torsional modes of 0.1, with which bars of two and more cells across twist as they should,
  /// instead of those exact for the linear field in a cell.
  static HourglassStiffness of_pattern(double face_to_cube, double poisson_ratio, bool exact_bending,
                                       bool exact_torsion, bool slender = false);
};

/// The energy of a cell is that of its springs and its volume term at F, the mean deformation gradient of the part that
/// the body fills, times the fraction filled, alpha; and that of hourglass springs, a quadratic form of v = F^T q, q
/// the patterns of corner positions that F does not see (covariant frame: F rotates the form with the cell), times
/// alpha and the second moments of that part (12 S_i, at least `least_variance`).  Uniform strain is exact in a body of
/// cut cells, at any size, and so is, for circular and rectangular sections, the bending and torsional stiffness of the
/// section; no constant is negative for -1 < nu < 1/2.
///
/// Boxes: edges h_i = l p_i, p = CellShape::proportions of product one, so that V = l^3.  The springs' directions are
/// those of a cube, so their part of the energy is the same function of F.  That of the patterns is the energy of the
/// same fields: curvatures and twists H_pq of xi_p xi_q are second derivatives H_pq / (l^2 p_p p_q), and an energy of
/// strains linear in X_i has the second moment V l^2 p_i^2 / 12.  Bending u_x = kappa x y: V E / (1 - nu^2) kappa^2
/// h_y^2 / 24 per cell, the E I kappa^2 / 2 of a section of a plate h_y thick; torsion by shears x_i (t_j + t_k): V G
/// (t_j + t_k)^2 h_i^2 / 24; the field xyz of component i: a weighted sum of h_j^2 h_k^2 and h_i^2 (h_j^2 + h_k^2).
/// The form is that of a cube of edge l with H_pq / (p_p p_q) = p_r H_pq for H_pq and p_i^2 for 1 in rho_i.
struct AveragedSprings {
  /// What solvers, kernels and the time step use of this law.
  static constexpr LawTraits traits = {
      "averaged springs",
      Reach::cells,
      {Capability::lattice_kernels, Capability::gpu, Capability::cell_kernels, Capability::cells_of_any_shape,
       Capability::cut_multigrid, Capability::energy_momentum, Capability::recovered_stress}};
  /// Why it cannot what its traits say, with these parameters; nullptr: it can (law_traits.h).
  const char* lacks(Capability what) const;
  static constexpr double least_variance = 0.1;  ///< of a full cell's; for the solvers

  double shear_modulus = 0;           ///< G [Pa]
  double lame_lambda = 0;             ///< of springs (G) and volume term (kappa = lambda - G) [Pa]
  HourglassStiffness hourglass = {};  ///< of the modes that F does not see [G l]
  /// theta: fraction of the second derivatives that a cell assumes beside those of its trilinear field, by which its
  /// strain is shifted from the middle of the cell to the centroid of the filled part, in the deviator only.  1/2 makes
  /// limbs bend better that lie askew in the lattice, at the price of the patch test, and holds for small displacements
  /// from rest only.
  double shift = 0;
  double contraction = 0;                     ///< nu/(1 - nu) of these second derivatives
  StrainCurve curve = StrainCurve::hencky;    ///< the law at large strain
  std::vector<AveragedSprings> regions = {};  ///< those of the cells of material 1, 2, ...; of material 0: these

  /// Names the parameters, for springs files (law_traits.h).
  template <class Fields>
  void fields(Fields& f) {
    f.number("shear_modulus_Pa", shear_modulus);
    f.number("lame_lambda_Pa", lame_lambda);
    f.number("bending", hourglass.bending, 0);
    f.number("coupling", hourglass.coupling);
    f.number("torsion", hourglass.torsion, 0);
    f.number("twist", hourglass.twist, 0);
    f.number("warping", hourglass.warping, 0);
    f.number("shift", shift, 0, 1);
    f.number("contraction", contraction, -0.5, 1);
    f.choice("curve", curve);
  }

  /// Those of a material, by its number.
  const AveragedSprings& in(int material) const { return material == 0 ? *this : regions[material - 1]; }

  double energy(const Network& network, const NodalVectors& x) const;  ///< [J]; +inf if a cell is inverted
  void add_forces(const Network& network, const NodalVectors& x, NodalVectors& f) const;  ///< f += -dE/dx [N]
  void add_tangent(const Network& network, const NodalVectors& x, BlockMatrix& K) const;  ///< K += d2E/dx2 [N/m]

  /// f += the forces [N] of dashpots whose matrix at rest is `time` [s] times the stiffness: stress 2 G E' (second
  /// Piola-Kirchhoff, E' the rate of Green-Lagrange strain of F) and lambda tr(F' F^-1) F^-T (first), and hourglass
  /// forces of the rate of F^T q.  No rigid motion is resisted, and both momenta are kept.  v: velocities [m/s], n x 3.
  void add_viscous_forces(const Network& network, const NodalVectors& x, const NodalVectors& v, double time,
                          NodalVectors& f) const;

  /// Stiffness of a cell at rest [N/m]; unknown 3 * corner + axis.
  Eigen::Matrix<double, 24, 24> cell_matrix(const CellShape& cell) const;
};

/// Averaged springs in mixed form: what is left of them where pressures hold the volumes of cells.
struct MixedParts {
  AveragedSprings springs;    ///< without volume terms in cells that have a pressure
  std::vector<double> kappa;  ///< of each material [Pa]; 0: its cells have no pressure, as nu <= 1/4
};
/// Their parts.
MixedParts mixed_parts(const AveragedSprings& law);

/// What the energy of a cell depends on beside the positions of its corners.
struct CellForm {
  double volume;                            ///< of the filled part [m^3]
  Eigen::Matrix<double, 3, 8> gradient;     ///< mean gradients of the corners' weights [1/m]
  Eigen::Matrix<double, 12, 12> hourglass;  ///< quadratic form of v, 3 * pattern + axis [N/m]
};
/// The form of a cell.
CellForm cell_form(const AveragedSprings& law, const CellShape& cell);

/// The four patterns of corner positions that F does not see: q = (positions of the corners, 3 x 8) times this.
const Eigen::Matrix<double, 8, 4>& corner_patterns();

/// What the energy of each cell depends on beside the positions of its corners: one of full cells of a size and
/// material, one of each cut cell.
class CellForms {
 public:
  CellForms() = default;
  CellForms(const AveragedSprings& law, const CellSet& cells);

  const CellForm& operator[](std::size_t cell) const { return forms_[of_cell_[cell]]; }

 private:
  std::vector<CellForm> forms_;
  std::vector<int> of_cell_;
};

}  // namespace springproof
