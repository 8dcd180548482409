// How good tetrahedra are.
#pragma once

#include <string>

#include "meshes/mesh.h"

namespace springproof {

struct TetrahedraQuality {
  double worst = 1;           ///< smallest 3 r/R, radii of inscribed and circumscribed sphere; 1: regular, 0: flat
  Vec3 at = Vec3::Zero();     ///< centre of that tetrahedron [m]
  double smallest_angle = 0;  ///< between two faces of a tetrahedron [degrees]
  double mean_edge = 0;       ///< [m]
};

/// Edge of regular tetrahedra, so many of which have this volume.
double edge_of_regular(double volume, double tetrahedra);

TetrahedraQuality quality_of(const Mesh& mesh);

/// "12345 tetrahedra, mean edge 0.01 m, worst 3 r/R 0.2 near (...) m, smallest dihedral angle 9 degrees".
std::string words_for(const Mesh& mesh, const TetrahedraQuality& quality);

}  // namespace springproof
