// Force law: the volume energy of HybMSS, one term per cubic cell.
#pragma once

#include <array>
#include <vector>

#include "msm/algebra/block_matrix.h"
#include "msm/laws/law_traits.h"
#include "msm/topology/network.h"

namespace springproof {

/// How the energy grows with J = V'/V; both give kappa/2 (J - 1)^2 for small changes.
enum class VolumeEnergy {
  paper,    ///< kappa/2 (J - 1)^2; Golec et al. (2019), eq. (5.1).  Unbounded below in dilation if kappa < 0.
  bounded,  ///< 9 kappa/2 (J^(1/3) - 1)^2: grows like the springs' energy, so kappa < 0 has no limit point in tension.
};
constexpr std::array<const char*, 2> names_of(VolumeEnergy) { return {"paper", "bounded"}; }

/// Energy sum_c V psi(V'/V) with V' = a . (b x c), a, b, c the mean edge vectors of the cell;
/// Golec et al. (2019), eqs. (5.13)-(5.16).  DEVIATION from eq. (5.16): factor 1/4, docs/papers.md.
struct VolumeCorrection {
  /// What solvers, kernels and the time step use of this law.
  static constexpr LawTraits traits = {
      "volume correction", Reach::cells, {Capability::lattice_kernels, Capability::gpu, Capability::energy_momentum}};

  double kappa = 0;                            ///< lambda - G [Pa]
  VolumeEnergy form = VolumeEnergy::bounded;   ///< how the energy grows with J
  std::vector<VolumeCorrection> regions = {};  ///< those of the cells of material 1, 2, ...; of material 0: this

  /// Names the parameters, for springs files (law_traits.h).
  template <class Fields>
  void fields(Fields& f) {
    f.number("kappa_Pa", kappa);
    f.choice("form", form);
  }

  /// That of a material, by its number.
  const VolumeCorrection& in(int material) const { return material == 0 ? *this : regions[material - 1]; }

  double energy(const Network& network, const NodalVectors& x) const;  ///< [J]; +inf if J <= 0 (bounded)
  void add_forces(const Network& network, const NodalVectors& x, NodalVectors& f) const;  ///< f += -dE/dx [N]
  void add_tangent(const Network& network, const NodalVectors& x, BlockMatrix& K) const;  ///< K += d2E/dx2 [N/m]
};

/// Mean-edge volume V' = a . (b x c) of a cell and its gradient (rows: corners in mesh order) [m^3, m^2].
struct MeanEdgeVolume {
  Vec3 a;                                ///< mean edge along x [m]
  Vec3 b;                                ///< along y
  Vec3 c;                                ///< along z
  double value;                          ///< V' [m^3]
  Eigen::Matrix<double, 8, 3> gradient;  ///< dV'/dx [m^2]
};
/// That of a cell at positions x [m].
MeanEdgeVolume mean_edge_volume(const Hexahedron& cell, const NodalVectors& x);

/// psi(J), psi'(J), psi''(J) per unit kappa.
struct VolumeDensity {
  double value;      ///< psi
  double slope;      ///< dpsi/dJ
  double curvature;  ///< d2psi/dJ2
};
/// At J = V'/V; the bounded form needs J > 0.
VolumeDensity volume_density(VolumeEnergy form, double J);

/// K += pressure d2V'/dx2 of one cell [N/m].
void add_volume_curvature(const Hexahedron& cell, const MeanEdgeVolume& volume, double pressure, BlockMatrix& K);

}  // namespace springproof
