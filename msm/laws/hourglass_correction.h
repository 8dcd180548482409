// Force law: the six bending (and three torsional) hourglass modes of a cubic cell, given their continuum stiffness.
#pragma once

#include <vector>

#include "msm/algebra/block_matrix.h"
#include "msm/laws/law_traits.h"
#include "msm/topology/network.h"

namespace springproof {

/// 3A / (2 (4 + 3A)): the stiffness, in units of G l, by which the springs of a cell couple the two bending modes of
/// one neutral plane, and that of their paired torsional modes; a quarter of that of the symmetric torsional mode.
double paired_stiffness(double face_to_cube);

/// Springs give a cell's bending mode the stiffness G l for any nu and A; a beam needs G l / (3 (1 - nu)).  This law
/// adds, per cell, the difference as a quadratic energy of the displacement's hourglass components.  The components are
/// orthogonal to affine fields, so the patch test and the moduli are unaffected.
/// Valid for small displacements from rest only (no corotated frame): linear kinematics.
struct HourglassCorrection {
  /// What solvers, kernels and the time step use of this law.
  static constexpr LawTraits traits = {
      "hourglass correction", Reach::cells, {Capability::lattice_kernels, Capability::gpu}};

  /// Why it cannot what its traits say, with these parameters; nullptr: it can (law_traits.h).
  const char* lacks(Capability what) const {
    if (what == Capability::large_displacements) return "is linear in the displacement";
    return what == Capability::energy_momentum
               ? "is linear in the displacement, so its forces have a torque in large rotations"
               : nullptr;
  }

  double shear_modulus = 0;                       ///< G [Pa]
  double poisson_ratio = 0;                       ///< nu [1]
  double face_to_cube = 2;                        ///< A of the springs it corrects
  bool torsion = false;                           ///< correct the modes u_x = yz, u_y = zx, u_z = xy too
  std::vector<HourglassCorrection> regions = {};  ///< those of the cells of material 1, 2, ...; of material 0: this

  /// Names the parameters, for springs files (law_traits.h).
  template <class Fields>
  void fields(Fields& f) {
    f.number("shear_modulus_Pa", shear_modulus);
    f.number("poisson_ratio", poisson_ratio, -1, 0.5);
    f.number("face_to_cube", face_to_cube, 0);
    f.flag("torsion", torsion);
  }

  double energy(const Network& network, const NodalVectors& x) const;                     ///< [J]
  void add_forces(const Network& network, const NodalVectors& x, NodalVectors& f) const;  ///< f += -dE/dx [N]
  void add_tangent(const Network& network, const NodalVectors& x, BlockMatrix& K) const;  ///< K += d2E/dx2 [N/m]

  /// Stiffness added to the normalised modes of a cell [N/m]: G l times what docs/papers.md, section 4, derives.
  struct Stiffness {
    double bending;               ///< of each bending mode
    double coupling;              ///< between the two that share a neutral plane
    double torsion = 0;           ///< of each torsional mode
    double torsion_coupling = 0;  ///< between two of them
  };
  /// That of a cell of edge l [m].
  Stiffness stiffness(double edge) const;

  /// That of a material, by its number.
  const HourglassCorrection& in(int material) const { return material == 0 ? *this : regions[material - 1]; }

  /// The added stiffness of one cell of edge l [N/m]; unknown 3 * corner + axis.
  Eigen::Matrix<double, 24, 24> cell_matrix(double edge) const;
};

}  // namespace springproof
