// How far a body is deformed: whether linear theory may be asked at all.
#pragma once

#include "meshes/mesh.h"
#include "problem/loads.h"

namespace springproof {

/// What 99 % of a body's volume stay below: singular edges and point forces have no say.
struct DeformationSize {
  double principal_strain =
      0;                ///< largest principal strain in size [1]: of sym grad u (linear), of U - 1 in F = R U (finite)
  double rotation = 0;  ///< [rad], from the rest position: of the rotation vector of grad u (linear), of R (finite)
};

/// Of a displacement (n x 3 [m]) at the nodes of a mesh of hexahedra, read at the 2 x 2 x 2 points of Gauss of each
/// cell.
DeformationSize deformation_size(const Mesh& mesh, const NodalVectors& displacement, Kinematics kinematics);

}  // namespace springproof
