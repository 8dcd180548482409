// Homogenisation with relaxed nodes: effective stiffness of the infinite network of a periodic cell.
#pragma once

#include "msm/laws/laws.h"

namespace springproof {

/// Identifies the opposite faces of a network: each node gets the first node that lies whole boxes away as its master
/// (Network::image_of), and springs that become the same are merged, stiffnesses added.  The half and quarter springs
/// on the faces of a superposed lattice thus become full springs.  A box edge of 0: not periodic along that axis.
/// @throws std::invalid_argument if no two nodes are a box edge apart along an axis.
void make_periodic(const Vec3& box, Network& network);

/// Effective stiffness and its isotropic part (Voigt's projection: the nearest isotropic tensor).  Of a planar network
/// in its plane, xx yy xy, per volume: plane stress if the volume shares are area times thickness.
struct Homogenised {
  Eigen::MatrixXd C;      ///< [Pa], Voigt's notation: xx yy zz yz zx xy, engineering shear strains
  double bulk_modulus;    ///< [Pa]; in a plane K_2D = lambda + mu
  double shear_modulus;   ///< [Pa]
  double youngs_modulus;  ///< [Pa]; in a plane E_2D: Kot et al. (2014), eq. (10)
  double poisson_ratio;   ///< [1]
  double anisotropy;      ///< |C - C_isotropic| / |C|, Kelvin's norm (that of the tensor)
  double asymmetry;       ///< |C - C^T| / |C|; 0 if conservative
  int iterations;         ///< of the linear solver, all strains together
  double residual;        ///< largest |unbalanced force| / |force of the unrelaxed nodes|
};

/// How exactly.
struct HomogeniseOptions {
  double tolerance = 1e-10;    ///< relative residual
  int max_iterations = 20000;  ///< per strain
};

/// Linear response at rest of a network with periodic images.  Displacement eps X + w, w periodic and in equilibrium
/// for each of the six unit strains (of a planar network: the three of its plane); C_ab V = (E_a X)^T K (E_b X + w_b),
/// V the sum of the volume shares.  Symmetric models by conjugate gradients, the others by GMRES preconditioned by
/// their symmetric companion.  Zero-energy modes are harmless: no load does work on them, and C does not depend on
/// them.
/// @throws std::invalid_argument if the network has no images; std::runtime_error if a mode of negative energy is found
///   or the iteration does not converge.
Homogenised homogenise(const MassSpringModel& model, const HomogeniseOptions& options = {});

/// The stiffness of an isotropic solid of 2 or 3 dimensions, in the notation of Homogenised::C.
Eigen::MatrixXd isotropic_stiffness(double bulk_modulus, double shear_modulus, int dimensions = 3);

}  // namespace springproof
