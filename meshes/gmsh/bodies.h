// Each kind of file as a meshed body.  A gmsh session of its own each; not thread-safe.
#pragma once

#include <algorithm>

#include "meshes/gmsh/session.h"
#include "meshes/mesher/mesher.h"
#include "meshes/surface/surface.h"

namespace springproof {

/// Any of the kinds below, by the file's extension, scaled.
/// @throws InputError when gmsh fails, or no body comes out.
MeshedBody mesh_file(const MeshRequest& request);

/// A script: structured (no edge), or tetrahedra with the parameter `edge`.
MeshedBody mesh_script(const MeshRequest& request);

/// A mesh file: its cells, or its triangles as a surface.
MeshedBody mesh_msh(const MeshRequest& request);

/// STEP or BREP by OpenCASCADE.
MeshedBody mesh_solid(const MeshRequest& request);

/// A closed surface: STL, OBJ or PLY.
MeshedBody mesh_surface(const MeshRequest& request);

/// The vertices of an STL, OBJ, PLY or mesh file, as MeshKind::vertices says.
MeshedBody vertices_of(const MeshRequest& request);

/// The closed surface of an STL, OBJ or PLY file, as MeshKind::closed says.
MeshedBody closed_surface_of(const MeshRequest& request);

/// The vertices of a mesh file, by ascending number, and its triangles.
Surface vertices_of_msh(const MeshRequest& request);

/// Fills a surface, as read, with tetrahedra: checked, remeshed if its facets do not suit the edge.  Its parts are
/// patches beside "surface".
MeshedBody fill_surface(const MeshRequest& request, const Surface& raw);

/// Meshes the model's volumes with tetrahedra and reads them, with the notes of read_mesh().
Mesh fill_with_tetrahedra(const MeshRequest& request, const GmshSession& session, std::vector<std::string>& notes);

/// Edge with which a body of this volume has about so many tetrahedra.
double edge_for(int tetrahedra, double volume);

/// Tells gmsh to make edges of this length, in the file's units.
void want_edge(double edge);

/// Whether a region of the body is a physical volume of its file.
inline bool has_volumes(const MeshRequest& request) {
  return std::any_of(request.volumes.begin(), request.volumes.end(), [](const std::string& v) { return !v.empty(); });
}

/// @throws InputError when a body of this volume [m^3] would have too many cells.
void refuse_too_many(const MeshRequest& request, double volume);

}  // namespace springproof
