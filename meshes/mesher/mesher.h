// Bodies cut into cells, as callers see it: no gmsh in here.
//
// The work is done by the separate program `springproof-mesh` (beside the running executable, or named by
// $SPRINGPROOF_MESH_PROGRAM), so that a mesher that crashes, hangs or is under another licence stays outside.
#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "meshes/mesh.h"
#include "meshes/surface/surface.h"
#include "problem/body.h"

namespace springproof {

/// Finds the .geo file of a body: beside the case file, else among the built-in bodies (meshes/geo/).
/// @throws InputError listing the built-in bodies; at another script where $SPRINGPROOF_NO_SCRIPTS is set.
std::filesystem::path find_geo(const Body& body, const std::filesystem::path& case_file);

/// Whether the file is one of the built-in bodies.
bool is_built_in(const std::filesystem::path& file);

/// What a .geo is to be cut into.
struct MeshKind {
  bool tetrahedra = false;    ///< else hexahedra
  bool second_order = false;  ///< hexahedra whose edges follow a curved surface (Mesh::curved)
  bool vertices = false;      ///< of an .stl, .obj, .ply or .msh: its vertices in its order, and its triangles as the
                              ///< patch "triangles", without cells
  bool closed = false;        ///< of an .stl, .obj or .ply: its surface alone, closed and repaired (surface_check.h)
};

/// A body in a file:
///   .geo                gmsh script with the parameters size_x size_y size_z [m] and `edge` [m] (tetrahedra), or nx ny
///   nz
///                       and tetrahedra = 0 or 1; physical surfaces name the patches
///   .stl .obj .ply      closed surface; patch "surface", and those of the solids of an ASCII STL file, the groups of
///   an
///                       OBJ file, where there are several
///   .msh                gmsh 2.2 or 4.1: hexahedra or tetrahedra, physical surfaces = patches (one without a name: its
///                       number); as they are, or filled anew within their surface where tetrahedra are asked for;
///                       without cells a closed surface, as .stl
///   .step .stp .brep    solid; patches "surface_1", "surface_2", ...; STEP comes out in metres whatever its unit, a
///                       .brep has no unit and is taken as metres
struct MeshRequest {
  std::filesystem::path file;
  Vec3 size = Vec3::Zero();  ///< of a .geo [m]; zero: the script's own
  Cells cells = {0, 0, 0};   ///< of a .geo cut into nx x ny x nz cells; zero: by `edge`
  MeshKind kind{};
  double edge = 0;     ///< [m] > 0: tetrahedra with edges of about this length
  double scale = 1;    ///< multiplies the coordinates of the file
  int tetrahedra = 0;  ///< > 0 and no edge: about so many tetrahedra
  /// The physical volume of the file, by name or number, that each region of the body is; "": it is none of them.  Of a
  /// solid the number of one of its solids.
  std::vector<std::string> volumes = {};
  std::vector<double> coarser = {};  ///< factors > 1, falling: also meshes whose cells are larger by these (size_ratio)
};

struct MeshedBody {
  Mesh mesh;
  std::vector<std::string> notes;  ///< what was repaired, and the quality of the mesh: for the report
  double edge = 0;                 ///< that the tetrahedra were made with [m]; 0: the cells are the file's own
  std::vector<Mesh> coarser;       ///< one per factor of the request
  Surface facets;                  ///< of a surface file: its own, repaired, in metres; else none
  double smooth_volume = 0;        ///< of the solid whose chords the facets are [m^3]; 0: there is none
};

/// Ratios below it say nothing about a limit: meshes of a reference differ by more.
inline constexpr double least_ratio = 1.2;

/// Cell size of one mesh of a body over that of a finer one: the cube root of how many times more cells there are.
double size_ratio(const Mesh& coarse, const Mesh& fine);

/// Meshes a body under a time limit: 300 s, or $SPRINGPROOF_MESH_SECONDS; or finds the mesh that an earlier run kept
/// (mesh_cache.h).  Thread-safe.
/// @throws InputError "FILE: ..." when the file cannot be meshed: unreadable, no body, several parts, mixed or inverted
/// cells, no coarser meshes by least_ratio, a mesher that crashed or took too long.
/// @throws std::runtime_error if the program cannot be run.
MeshedBody mesh_body(const MeshRequest& request);

/// Edges of the coarser meshes of a reference over those of the finest.
inline constexpr std::array<double, 2> reference_ratios = {2.25, 1.5};

/// The body that springs are cut from where no reference is wanted: still the finest of three meshes, so that it is the
/// same in every command.  A body that has no such coarser meshes has one alone.
/// @param request without `coarser`
/// @return the mesh and the coarser ones
/// @throws as mesh_body
MeshedBody mesh_to_cut(MeshRequest request);

/// Meshes a .geo with the parameters size_x size_y size_z [m], nx ny nz and tetrahedra (0 or 1); physical surfaces name
/// the patches.  The grid is detected.  A process meshes the same but once, and keeps the mesh.  Thread-safe.
/// @throws as mesh_body
/// @param volumes as MeshRequest::volumes
Mesh mesh_geo(const std::filesystem::path& geo, const Vec3& size, const Cells& cells, MeshKind kind = {},
              const std::vector<std::string>& volumes = {});

/// A closed surface in a file, repaired, as MeshedBody::facets.  A process reads the same but once.  Thread-safe.
/// @throws as mesh_body
MeshedBody closed_surface(const std::filesystem::path& file, double scale);

}  // namespace springproof
