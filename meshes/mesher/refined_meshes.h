// Meshes of one body that really are finer than each other.
#pragma once

#include <functional>

#include "meshes/mesher/mesher.h"

namespace springproof {

struct OneMesh {
  Mesh mesh;
  std::vector<std::string> notes;
  double edge = 0;  ///< asked for [m]
};

/// Tetrahedra with edges of about this length [m], `times` as long as those of the finest mesh.
/// @throws InputError: not of this length.
using MeshAt = std::function<OneMesh(double edge, double times)>;

/// The finest mesh, and the coarser ones of the request.  Their numbers of cells decide how much coarser they are: a
/// mesh is made anew with other edges until it is.  The finest one has shorter edges than asked for where the body
/// cannot be meshed otherwise, or not coarsely enough.
/// @throws InputError when a mesh cannot be made, or none that is coarser than the next finer one by least_ratio.
MeshedBody mesh_refined(const MeshRequest& request, const MeshAt& at);

/// One mesh alone, with its notes.
MeshedBody mesh_alone(const MeshRequest& request, OneMesh made);

/// Each tetrahedron cut into eight at the middles of its edges, the octahedron between them along its shortest
/// diagonal; each facet of a patch into four.  Materials stay with the parts.
/// @param mesh of tetrahedra
Mesh halved(const Mesh& mesh);

}  // namespace springproof
