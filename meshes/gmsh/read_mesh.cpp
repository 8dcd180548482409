#include "meshes/gmsh/read_mesh.h"

#include <fmt/format.h>
#include <gmsh.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <set>
#include <tuple>

#include "meshes/facets.h"
#include "meshes/mesher/mesher_exchange.h"
#include "meshes/volume.h"

namespace springproof {
namespace {

struct PartsByFacets {
  int count;   ///< of parts within which cells are connected through facets
  Vec3 hinge;  ///< a node that two of them share, if there are several [m]
};

/// Per node the lowest number of a node at its place.
/// @param X positions [m], n x 3
/// @param tolerance largest difference of a coordinate [m]
std::vector<int> coincident_nodes(const NodalVectors& X, double tolerance) {
  using Place = std::array<long, 3>;
  std::map<Place, std::vector<int>> at;  // cubes of edge `tolerance` -> nodes without one at their place before them
  std::vector<int> same(static_cast<std::size_t>(X.rows()));
  for (int n = 0; n < static_cast<int>(same.size()); ++n) {
    same[n] = n;
    Place own;
    for (int d = 0; d < 3; ++d) own[d] = static_cast<long>(std::floor(X(n, d) / tolerance));
    for (int near = 0; near < 27 && same[n] == n; ++near) {
      const auto found = at.find({own[0] + near % 3 - 1, own[1] + near / 3 % 3 - 1, own[2] + near / 9 - 1});
      if (found == at.end()) continue;
      for (const int m : found->second)
        if ((X.row(n) - X.row(m)).cwiseAbs().maxCoeff() <= tolerance) same[n] = m;
    }
    if (same[n] == n) at[own].push_back(n);
  }
  return same;
}

PartsByFacets parts_by_facets(const Mesh& mesh) {
  const std::size_t cells = mesh.hexahedra.size() + mesh.tetrahedra.size();
  UnitedNumbers part(cells);
  std::vector<std::pair<std::array<int, 4>, int>> facets;  // nodes and cell
  std::vector<int> at_node(static_cast<std::size_t>(mesh.nodes.rows()), -1);
  int cell = 0;
  for (const Hexahedron& h : mesh.hexahedra) {
    for (int f = 0; f < 6; ++f) facets.emplace_back(ascending(face_of(h, f)), cell);
    ++cell;
  }
  for (const Tetrahedron& t : mesh.tetrahedra) {
    for (const std::array<int, 4>& facet : facets_of(t)) facets.emplace_back(ascending(facet), cell);
    ++cell;
  }
  unite_by_key(std::move(facets), part);
  std::set<int> heads;
  for (int c = 0; c < static_cast<int>(cells); ++c) heads.insert(part.of(c));
  PartsByFacets parts{static_cast<int>(heads.size()), Vec3::Zero()};
  cell = 0;
  const auto look = [&](const auto& nodes) {
    for (const int n : nodes) {
      if (at_node[n] < 0) at_node[n] = cell;
      if (part.of(at_node[n]) != part.of(cell)) parts.hinge = mesh.nodes.row(n).transpose();
    }
    ++cell;
  };
  if (parts.count == 1) return parts;
  for (const Hexahedron& h : mesh.hexahedra) look(h);
  for (const Tetrahedron& t : mesh.tetrahedra) look(t);
  return parts;
}

namespace fs = std::filesystem;

/// Where gmsh's 27 nodes (corners, edges, faces, middle) stand when counted x fastest.
constexpr std::array<int, 27> place_of_27 = {0,  2,  8,  6,  18, 20, 26, 24, 1,  3,  9,  5,  11, 7,
                                             17, 15, 19, 21, 23, 25, 4,  10, 12, 14, 16, 22, 13};

/// gmsh's nodes by their tags.
struct Nodes {
  std::vector<Vec3> position;
  std::vector<int> number;  ///< in our mesh, -1: not in it
};

Nodes read_nodes() {
  std::vector<std::size_t> tags;
  std::vector<double> coordinates, parametric;
  gmsh::model::mesh::getNodes(tags, coordinates, parametric, -1, -1, false, false);
  const std::size_t last = tags.empty() ? 0 : *std::max_element(tags.begin(), tags.end());
  Nodes nodes{std::vector<Vec3>(last + 1), std::vector<int>(last + 1, -1)};
  for (std::size_t i = 0; i < tags.size(); ++i)
    nodes.position[tags[i]] = Vec3(coordinates[3 * i], coordinates[3 * i + 1], coordinates[3 * i + 2]);
  return nodes;
}

/// Numbers the corners of the cells by ascending tag.
Mesh read_cells(const ElementBlock& cells, Nodes& nodes) {
  for (std::size_t i = 0; i < cells.node_tags.size(); i += cells.nodes)
    for (std::size_t c = 0; c < cells.corners; ++c) nodes.number.at(cells.node_tags[i + c]) = 0;
  int count = 0;
  for (int& number : nodes.number)
    if (number == 0) number = count++;

  Mesh mesh;
  mesh.materials = cells.materials;
  mesh.nodes.resize(count, 3);
  for (std::size_t tag = 0; tag < nodes.number.size(); ++tag)
    if (nodes.number[tag] >= 0) mesh.nodes.row(nodes.number[tag]) = nodes.position[tag];
  for (std::size_t i = 0; i < cells.node_tags.size(); i += cells.nodes) {
    const auto corner = [&](int c) { return nodes.number[cells.node_tags[i + c]]; };
    if (cells.corners == 4)
      mesh.tetrahedra.push_back({corner(0), corner(1), corner(2), corner(3)});
    else
      mesh.hexahedra.push_back(
          {corner(0), corner(1), corner(2), corner(3), corner(4), corner(5), corner(6), corner(7)});
  }
  if (cells.nodes == 27) {
    mesh.curved.resize(static_cast<Eigen::Index>(cells.node_tags.size()), 3);
    for (std::size_t i = 0; i < cells.node_tags.size(); ++i)
      mesh.curved.row(static_cast<Eigen::Index>(i / 27 * 27 + place_of_27[i % 27])) =
          nodes.position.at(cells.node_tags[i]);
  }
  return mesh;
}

/// gmsh turns mirrored cells round itself; what is still negative somewhere is twisted.
void refuse_inverted_cells(const fs::path& file, const Mesh& mesh) {
  const auto refuse_cell = [&](int node) {
    const Vec3 at = mesh.nodes.row(node);
    refuse(file, fmt::format("the mesh has an inverted or flat cell near ({}, {}, {}) m", at.x(), at.y(), at.z()));
  };
  for (const Hexahedron& cell : mesh.hexahedra) {
    const auto jacobians = corner_jacobians(cell, mesh.nodes);
    if (!(*std::min_element(jacobians.begin(), jacobians.end()) > 0)) refuse_cell(cell[0]);
  }
  for (const Tetrahedron& cell : mesh.tetrahedra) {
    Eigen::Matrix<double, 4, 3> x;
    for (int c = 0; c < 4; ++c) x.row(c) = mesh.nodes.row(cell[c]);
    if (!(tetrahedron_volume(x) > 0)) refuse_cell(cell[0]);
  }
}

/// Each cell that is an axis-aligned box with its lowest corner first; others are left as they are.
std::vector<Hexahedron> boxes_lowest_corner_first(const Mesh& mesh) {
  std::vector<Hexahedron> cells = mesh.hexahedra;
  for (Hexahedron& cell : cells) {
    Vec3 middle = Vec3::Zero();
    for (const int n : cell) middle += mesh.nodes.row(n).transpose() / 8;
    Hexahedron sorted;
    sorted.fill(-1);
    for (const int n : cell)
      for (int corner = 0; corner < 8; ++corner) {
        bool here = true;
        for (int c = 0; c < 3; ++c) here &= (mesh.nodes(n, c) > middle[c]) == (hexahedron_corners[corner][c] == 1);
        if (here) sorted[corner] = n;
      }
    if (std::find(sorted.begin(), sorted.end(), -1) == sorted.end()) cell = sorted;
  }
  return cells;
}

template <class T>
std::vector<T> reordered(const std::vector<T>& values, const std::vector<int>& order) {
  std::vector<T> result;
  for (const int i : order) result.push_back(values[i]);
  return result;
}

/// If the cells are boxes of one lattice: sets the grid, numbers nodes and cells x fastest and moves the
/// nodes onto the lattice (gmsh places them to about 1e-12).  `new_number` maps the old node numbers.
void use_grid(Mesh& mesh, std::vector<int>& new_number) {
  Mesh candidate = mesh;
  candidate.hexahedra = boxes_lowest_corner_first(mesh);
  std::optional<Grid> grid = mesh.tetrahedra.empty() ? detect_grid(candidate) : std::nullopt;
  if (!grid) return;

  std::vector<int> order(candidate.hexahedra.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](int a, int b) {
    const auto &p = grid->cell_index[a], &q = grid->cell_index[b];
    return std::tie(p[2], p[1], p[0]) < std::tie(q[2], q[1], q[0]);
  });
  mesh.hexahedra = reordered(candidate.hexahedra, order);
  if (!mesh.materials.empty()) mesh.materials = reordered(mesh.materials, order);
  mesh.curved.resize(0, 3);  // boxes have straight edges
  grid->cell_index = reordered(grid->cell_index, order);

  std::vector<std::array<int, 3>> lattice_point(mesh.nodes.rows());
  for (std::size_t h = 0; h < mesh.hexahedra.size(); ++h)
    for (int corner = 0; corner < 8; ++corner)
      for (int c = 0; c < 3; ++c)
        lattice_point[mesh.hexahedra[h][corner]][c] = grid->cell_index[h][c] + hexahedron_corners[corner][c];
  std::vector<int> old_number(lattice_point.size());
  std::iota(old_number.begin(), old_number.end(), 0);
  std::sort(old_number.begin(), old_number.end(), [&](int a, int b) {
    const auto &p = lattice_point[a], &q = lattice_point[b];
    return std::tie(p[2], p[1], p[0]) < std::tie(q[2], q[1], q[0]);
  });
  for (std::size_t n = 0; n < old_number.size(); ++n) {
    new_number[old_number[n]] = static_cast<int>(n);
    for (int c = 0; c < 3; ++c) mesh.nodes(n, c) = grid->origin[c] + grid->spacing[c] * lattice_point[old_number[n]][c];
  }
  for (Hexahedron& cell : mesh.hexahedra)
    for (int& n : cell) n = new_number[n];
  mesh.grid = std::move(grid);
}

/// Joins nodes at one place, to round-off of the file; nodes of the mesh are numbered anew.
void join_coincident_nodes(Mesh& mesh, Nodes& nodes, std::vector<std::string>& notes) {
  constexpr double tolerance = 1e-6;  // of the body's size
  const double size = (mesh.nodes.colwise().maxCoeff() - mesh.nodes.colwise().minCoeff()).norm();
  const std::vector<int> same = coincident_nodes(mesh.nodes, tolerance * size);
  std::vector<int> number(same.size(), -1);
  int kept = 0;
  for (std::size_t n = 0; n < same.size(); ++n)
    if (same[n] == static_cast<int>(n)) {
      mesh.nodes.row(kept) = mesh.nodes.row(static_cast<Eigen::Index>(n)).eval();
      number[n] = kept++;
    }
  if (kept == mesh.nodes.rows()) return;
  notes.push_back(fmt::format("{} nodes were at the places of others, to {:.2g} m, and are one with them",
                              mesh.nodes.rows() - kept, tolerance * size));
  mesh.nodes.conservativeResize(kept, 3);
  const auto renumber = [&](int n) { return number[same[n]]; };
  for (Hexahedron& cell : mesh.hexahedra) std::transform(cell.begin(), cell.end(), cell.begin(), renumber);
  for (Tetrahedron& cell : mesh.tetrahedra) std::transform(cell.begin(), cell.end(), cell.begin(), renumber);
  for (int& n : nodes.number)
    if (n >= 0) n = renumber(n);
}

/// @throws InputError if the cells are several parts, or parts without a common facet.
void refuse_parts(const fs::path& file, const Mesh& mesh) {
  const std::string remedy = extension_of(file) == ".geo"
                                 ? "join them with BooleanUnion or BooleanFragments, or Coherence"
                                 : "join them in the program that wrote the file, so that they share their nodes";
  if (const int parts = separate_parts(mesh); parts > 1)
    refuse(file, fmt::format("the mesh has {} parts that share no node (allowed: one body; {})", parts, remedy));
  const PartsByFacets parts = parts_by_facets(mesh);
  if (parts.count == 1) return;
  refuse(file, fmt::format("the mesh has {} parts that meet in edges or points only, as at ({:.6g}, {:.6g}, {:.6g}): "
                           "nothing there resists turning (allowed: one body, connected through facets; {})",
                           parts.count, parts.hinge[0], parts.hinge[1], parts.hinge[2], remedy));
}

using FacetPatches = std::map<std::array<int, 4>, std::vector<int>>;  ///< patches by the facet's nodes, sorted

/// A facet of a physical surface as those of the cells: quadrilaterals before tetrahedra as two triangles.
std::vector<std::array<std::size_t, 4>> facet_tags(const std::size_t* tags, std::size_t corners, bool tetrahedra) {
  if (corners < 4) return {{tags[0], tags[1], tags[2], 0}};
  if (!tetrahedra) return {{tags[0], tags[1], tags[2], tags[3]}};
  std::vector<std::array<std::size_t, 4>> facets;
  for (const auto& [a, b, c] : triangles_of({tags[0], tags[1], tags[2], tags[3]})) facets.push_back({a, b, c, 0});
  return facets;
}

/// The physical surfaces' names as patches without facets, and where their facets are wanted.
FacetPatches wanted_facets(const Nodes& nodes, bool tetrahedra, std::vector<Patch>& patches) {
  FacetPatches wanted;
  for (const PhysicalSurface& surface : physical_surfaces()) {
    for (const ElementBlock& block : surface.facets)
      for (std::size_t i = 0; i < block.node_tags.size(); i += block.nodes)
        for (const auto& tags : facet_tags(&block.node_tags[i], block.corners, tetrahedra)) {
          std::array<int, 4> facet = {-1, -1, -1, -1};
          for (int c = 0; c < 4; ++c)
            if (tags[c] > 0) facet[c] = nodes.number.at(tags[c]);
          std::vector<int>& names = wanted[ascending(facet)];
          if (names.empty() || names.back() != static_cast<int>(patches.size()))
            names.push_back(static_cast<int>(patches.size()));
        }
    patches.push_back({surface.name, {}});
  }
  return wanted;
}

/// Leaves out facets that are not on the surface, and patches without others.
/// @param inside patches of such facets
void leave_out(const std::vector<std::array<int, 4>>& facets, const std::set<int>& inside, std::vector<Patch>& patches,
               std::vector<std::string>& notes) {
  std::set<std::array<int, 4>> keys(facets.begin(), facets.end());
  for (const int p : inside) {
    Patch& patch = patches[p];
    std::erase_if(patch.facets, [&](const std::array<int, 4>& f) { return keys.contains(ascending(f)); });
    notes.push_back(patch.facets.empty()
                        ? fmt::format("the physical surface '{}' lies inside of the body: it is no patch", patch.name)
                        : fmt::format("the physical surface '{}' lies inside of the body in part: the patch is the "
                                      "rest of it, {} facets",
                                      patch.name, patch.facets.size()));
  }
  std::erase_if(patches, [](const Patch& p) { return p.facets.empty(); });
}

/// The physical surfaces as faces of the cells, which makes every facet outward whatever gmsh's orientation is.
std::vector<Patch> read_patches(const Mesh& mesh, const Nodes& nodes, std::vector<std::string>& notes) {
  std::vector<Patch> patches;
  const FacetPatches wanted = wanted_facets(nodes, !mesh.tetrahedra.empty(), patches);
  std::vector<bool> on_patch(mesh.nodes.rows(), false);  // most facets are off: no search for them
  for (const auto& [facet, names] : wanted)
    for (const int n : facet)
      if (n >= 0) on_patch[n] = true;
  std::map<std::array<int, 4>, int> times_seen;
  const auto visit = [&](const std::array<int, 4>& facet) {
    for (const int n : facet)
      if (n >= 0 && !on_patch[n]) return;
    const std::array<int, 4> key = ascending(facet);
    const auto found = wanted.find(key);
    if (found == wanted.end()) return;
    ++times_seen[key];
    for (const int p : found->second) patches[p].facets.push_back(facet);
  };
  for (const Hexahedron& cell : mesh.hexahedra)
    for (int f = 0; f < 6; ++f) visit(face_of(cell, f));
  for (const Tetrahedron& cell : mesh.tetrahedra)
    for (const std::array<int, 4>& facet : facets_of(cell)) visit(facet);
  std::vector<std::array<int, 4>> off;
  std::set<int> inside;
  for (const auto& [facet, names] : wanted)
    if (const auto it = times_seen.find(facet); it == times_seen.end() || it->second != 1) {
      off.push_back(facet);
      inside.insert(names.begin(), names.end());
    }
  leave_out(off, inside, patches, notes);
  return patches;
}

}  // namespace

Mesh read_mesh(const fs::path& file, const ElementBlock& cells, std::vector<std::string>& notes) {
  Nodes nodes = read_nodes();
  Mesh mesh = read_cells(cells, nodes);
  refuse_inverted_cells(file, mesh);
  std::vector<int> new_number(mesh.nodes.rows());
  std::iota(new_number.begin(), new_number.end(), 0);
  if (separate_parts(mesh) > 1) join_coincident_nodes(mesh, nodes, notes);
  refuse_parts(file, mesh);
  use_grid(mesh, new_number);
  for (int& number : nodes.number)
    if (number >= 0) number = new_number[number];
  mesh.patches = read_patches(mesh, nodes, notes);
  return mesh;
}

}  // namespace springproof
