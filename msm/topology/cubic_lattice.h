// Cubic lattices by superposition of cells: springs that cells share are merged, so boundaries need no special
// treatment.
#pragma once

#include "msm/topology/network.h"

namespace springproof {

/// Spring constants of one family of isotropic cubic patterns, inside the lattice [N/m]:
/// cell edges, face diagonals and cube diagonals.  Golec et al. (2019), eqs. (5.10)-(5.12).
struct CubicPattern {
  double k_e = 0;
  double k_f = 0;
  double k_c = 0;
};

/// Isotropic pattern of face-to-cube ratio A = k_f / k_c with unit k_c (unit k_f for A = infinity): eq. (5.10).
/// Its magnitude is set by calibrate().
/// A = 0: 14 springs per node (edges, cube diagonals); A = infinity: the classic 18 (edges, face diagonals);
/// anything between: 26.  Kot et al. (2014), sec. 3.2.
/// @throws std::invalid_argument if A < 0 or NaN.
CubicPattern isotropic_pattern(double face_to_cube);

/// Whether the cells of a grid are cubes, to 1e-6 of their edge.
bool has_cubes(const Grid& grid);

/// Edge [m] of the cubes that a mesh is cut into.
/// @throws std::invalid_argument if it is not cut into equal cubes (the message gives the edge lengths).
double cube_edge(const Mesh& mesh);

/// The nodes and cells of a mesh of equal cubes or boxes, without springs.
/// @throws std::invalid_argument if the mesh is not cut from one lattice.
Network lattice_without_springs(const Mesh& mesh);

/// The springs of all cells of a lattice, those that cells share merged.
/// @param network lattice of cubes, with the springs of one cell
/// @param of_material the springs of a cell of each material over these
std::vector<Spring> superposed(const Network& network, const std::vector<double>& of_material);

/// Network of a mesh of equal cubes: each cell contributes edges k_e/4, face diagonals k_f/2 and cube diagonals k_c
/// (Golec et al. 2019, sec. 5.4).
/// @throws std::invalid_argument as cube_edge().
Network cubic_lattice(const Mesh& mesh, const CubicPattern& pattern);

}  // namespace springproof
