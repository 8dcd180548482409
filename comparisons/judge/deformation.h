// Size of the deformation of a body, which decides whether linear theory applies; its wrinkles.
#pragma once

#include "meshes/mesh.h"
#include "problem/loads.h"

namespace springproof {

/// The 99th percentile over the body's volume, which excludes singular edges and point forces.
struct DeformationSize {
  double principal_strain =
      0;                ///< largest principal strain in size [1]: of sym grad u (linear), of U - 1 in F = R U (finite)
  double rotation = 0;  ///< [rad], from the rest position: of the rotation vector of grad u (linear), of R (finite)
};

/// For a displacement (n x 3 [m]) at the nodes of a mesh of hexahedra, evaluated at the 2 x 2 x 2 Gauss points of each
/// cell.
DeformationSize deformation_size(const Mesh& mesh, const NodalVectors& displacement, Kinematics kinematics);

/// The rotation nearest to to = R from in the mean square (Kabsch 1976), both n x 3 about their weighted means.
Eigen::Matrix3d nearest_rotation(const NodalVectors& from, const NodalVectors& to, const Eigen::VectorXd& weights);

/// The displacement (n x 3 [m], of points X) less the rigid motion nearest to it in the weighted L2 norm: a + w x X
/// under linear kinematics, a rotation and a translation under finite ones.
NodalVectors less_rigid_motion(const NodalVectors& X, const NodalVectors& u, const Eigen::VectorXd& weights,
                               Kinematics kinematics);

/// Share of the displacement below which what is left beyond a rigid motion counts alone.
inline constexpr double carried_share = 0.1;

/// What errors of a displacement are relative to.
struct DisplacementScale {
  double mean = 0;     ///< root of the mean square over the volume [m]
  double largest = 0;  ///< at a node [m]
  double share = 1;    ///< of the whole displacement's mean; 1: the whole, unless supports carry the body along
};

/// Of the displacement at the nodes of a mesh.  Where `moved` supports carry the body along, so that less than
/// carried_share of its displacement is no rigid motion, it is the scale of that part: a lattice without stiffness
/// would be right in the ride.
DisplacementScale displacement_scale(const Mesh& mesh, const NodalVectors& displacement, bool moved,
                                     Kinematics kinematics);

/// Root mean squares of a displacement field.
struct Wrinkles {
  double alternating = 0;  ///< over pairs of neighbouring cells, of half the difference of their hourglass strains [1]
  double strain = 0;       ///< over cells, of all strain [1]

  double share() const { return strain > 0 ? alternating / strain : 0; }
};

/// The hourglass strain of a cell is what its corners do beyond an affine motion; bending has it too, but alike in
/// neighbours.  The share of a smooth field is of the order (edge over its length)^2; the wave (-1)^(i+j) across x and
/// y, in which the two diagonals of each face grow and shrink in turn (Golec et al. 2019, Figs. 3 and 6), has 0.8.  A
/// field whose strain is round-off of the positions, as of a body that flies, has none.
/// @param mesh of hexahedra
/// @param displacement of its nodes [m], n x 3
Wrinkles wrinkles(const Mesh& mesh, const NodalVectors& displacement);

}  // namespace springproof
