// Meshing by gmsh.
#pragma once

#include <filesystem>

#include "meshes/mesh.h"
#include "problem/experiment.h"

namespace springproof {

/// Finds the .geo file of a body: beside the case file, else among the built-in bodies (meshes/geo/).
/// @throws InputError listing the built-in bodies.
std::filesystem::path find_geo(const Body& body, const std::filesystem::path& case_file);

/// Meshes a .geo with parameters size_x size_y size_z [m] and nx ny nz into hexahedra; physical surfaces name the
/// patches.  The grid is detected.  Not thread-safe (gmsh keeps one global model): a mutex serialises callers.
/// @throws InputError when gmsh fails, when no hexahedra come out or when a cell is inverted.
Mesh mesh_geo(const std::filesystem::path& geo, const Vec3& size, const Cells& cells);

}  // namespace springproof
