// Homogenisation with relaxed nodes: effective stiffness of the infinite network of a periodic cell.
#pragma once

#include "msm/laws/laws.h"

namespace springproof {

/// Identifies the opposite faces of a network: each node gets the first node that lies whole boxes away as its master
/// (Network::image_of), and springs that become the same are merged, stiffnesses added.  The half and quarter springs
/// on the faces of a superposed lattice thus become full springs.  A box edge of 0: not periodic along that axis.
/// @throws std::invalid_argument if no two nodes are a box edge apart along an axis.
void make_periodic(const Vec3& box, Network& network);

/// Effective stiffness and its isotropic part (Voigt's projection: the nearest isotropic tensor).
struct Homogenised {
  Eigen::Matrix<double, 6, 6> C;  ///< [Pa], Voigt's notation: xx yy zz yz zx xy, engineering shear strains
  double bulk_modulus;            ///< [Pa]
  double shear_modulus;           ///< [Pa]
  double youngs_modulus;          ///< [Pa]
  double poisson_ratio;           ///< [1]
  double anisotropy;              ///< |C - C_isotropic| / |C|, Kelvin's norm (that of the tensor)
  double asymmetry;               ///< |C - C^T| / |C|; 0 if conservative
  int iterations;                 ///< of the linear solver, all strains together
  double residual;                ///< largest |unbalanced force| / |force of the unrelaxed nodes|
};

/// The same in the plane of a planar network, per volume: plane stress if the volume shares are area times thickness.
struct HomogenisedPlane {
  Eigen::Matrix3d C;      ///< [Pa]; xx yy xy
  double bulk_modulus;    ///< K_2D = lambda + mu [Pa]
  double shear_modulus;   ///< [Pa]
  double youngs_modulus;  ///< E_2D [Pa]; Kot et al. (2014), eq. (10)
  double poisson_ratio;   ///< nu_2D
  double anisotropy;      ///< as in Homogenised
  double asymmetry;       ///< as in Homogenised
  int iterations;         ///< of the linear solver, all strains together
  double residual;        ///< as in Homogenised
};

/// How exactly.
struct HomogeniseOptions {
  double tolerance = 1e-10;    ///< relative residual
  int max_iterations = 20000;  ///< per strain
};

/// Linear response at rest of a network with periodic images.  Displacement eps X + w, w periodic and in equilibrium
/// for each of the six unit strains; C_ab V = (E_a X)^T K (E_b X + w_b), V the sum of the volume shares.  Symmetric
/// models by conjugate gradients, the others by GMRES preconditioned by their symmetric companion.  Zero-energy modes
/// are harmless: no load does work on them, and C does not depend on them.
/// @throws std::invalid_argument if the network has no images; std::runtime_error if a mode of negative energy is found
///   or the iteration does not converge.
Homogenised homogenise(const MassSpringModel& model, const HomogeniseOptions& options = {});
/// The same for a planar network: the three unit strains of its plane.
HomogenisedPlane homogenise_plane(const MassSpringModel& model, const HomogeniseOptions& options = {});

/// The stiffness of an isotropic solid, in the notation of Homogenised::C.
Eigen::Matrix<double, 6, 6> isotropic_stiffness(double bulk_modulus, double shear_modulus);

}  // namespace springproof
