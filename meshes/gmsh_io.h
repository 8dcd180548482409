// Meshing by gmsh.
#pragma once

#include <filesystem>

#include "meshes/mesh.h"
#include "problem/experiment.h"

namespace springproof {

/// Finds the .geo file of a body: beside the case file, else among the built-in bodies (meshes/geo/).
/// @throws InputError listing the built-in bodies.
std::filesystem::path find_geo(const Body& body, const std::filesystem::path& case_file);

/// What a .geo is to be cut into.
struct MeshKind {
  bool tetrahedra = false;    ///< else hexahedra
  bool second_order = false;  ///< hexahedra whose edges follow a curved surface (Mesh::curved)
};

/// Meshes a .geo with the parameters size_x size_y size_z [m], nx ny nz and tetrahedra (0 or 1); physical surfaces name
/// the patches.  The grid is detected.  Not thread-safe (gmsh keeps one global model): a mutex serialises callers.
/// @throws InputError when gmsh fails, when no such cells come out or when one is inverted.
Mesh mesh_geo(const std::filesystem::path& geo, const Vec3& size, const Cells& cells, MeshKind kind = {});

}  // namespace springproof
