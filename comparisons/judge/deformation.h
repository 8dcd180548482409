// Size of the deformation of a body, which decides whether linear theory applies.
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

}  // namespace springproof
