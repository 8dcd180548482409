#include "meshes/gmsh_io.h"

#include <fmt/format.h>
#include <gmsh.h>

#include <algorithm>
#include <map>
#include <mutex>
#include <numeric>
#include <tuple>
#include <unordered_map>

#include "meshes/volume.h"

#ifdef __SANITIZE_ADDRESS__
// gmsh 4.8 leaks a few hundred bytes per extruded mesh; what we leak is still reported.
extern "C" const char* __lsan_default_suppressions() {
  return "leak:libgmsh";
}
#endif

namespace springproof {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void refuse(const fs::path& geo, const std::string& message) {
  throw InputError(SourceLocation{geo.string(), 0, 0}, message);
}

/// gmsh, started with the parameters of a .geo and silent; stopped at the end of the scope.
class GmshSession {
 public:
  explicit GmshSession(const std::vector<std::pair<std::string, double>>& parameters) {
    std::vector<std::string> words = {"springproof"};
    for (const auto& [name, value] : parameters)
      words.insert(words.end(), {"-setnumber", name, fmt::format("{:.17g}", value)});
    std::vector<char*> arguments;
    for (std::string& word : words) arguments.push_back(word.data());
    gmsh::initialize(static_cast<int>(arguments.size()), arguments.data(), false);
    gmsh::option::setNumber("General.Terminal", 0);
    // gmsh's parser keeps the rest of a file it left by an exception and hands it to the next one: errors are
    // collected from the log instead.
    gmsh::option::setNumber("General.AbortOnError", 0);
    gmsh::logger::start();
  }
  ~GmshSession() {
    gmsh::logger::stop();
    gmsh::finalize();
  }
  GmshSession(const GmshSession&) = delete;
  GmshSession& operator=(const GmshSession&) = delete;

  std::string first_error() const {
    std::vector<std::string> log;
    gmsh::logger::get(log);
    for (const std::string& line : log)
      if (line.rfind("Error", 0) == 0) return line;
    return {};
  }
};

/// A gmsh element: its number, and how many of its nodes are corners.
struct ElementType {
  int number, nodes, corners;
  const char* name;
};
constexpr ElementType quadrangle = {3, 4, 4, "quadrangles"}, quadrangle_9 = {10, 9, 4, "quadrangles"};
constexpr ElementType hexahedron = {5, 8, 8, "hexahedra"}, hexahedron_27 = {12, 27, 8, "hexahedra"};
constexpr ElementType triangle = {2, 3, 3, "triangles"}, tetrahedron = {4, 4, 4, "tetrahedra"};

/// Node tags of the elements of one dimension in an entity, or in the whole model (tag -1), one element after the other;
/// only the given type is accepted.
std::vector<std::size_t> elements(const fs::path& geo, int dimension, int tag, const ElementType& wanted) {
  std::vector<int> types;
  std::vector<std::vector<std::size_t>> element_tags, node_tags;
  gmsh::model::mesh::getElements(types, element_tags, node_tags, dimension, tag);
  std::vector<std::size_t> found;
  for (std::size_t t = 0; t < types.size(); ++t) {
    if (types[t] != wanted.number) {
      std::string name;
      int dim, order, nodes, primary_nodes;
      std::vector<double> coordinates;
      gmsh::model::mesh::getElementProperties(types[t], name, dim, order, nodes, coordinates, primary_nodes);
      refuse(geo, fmt::format("the mesh has {} elements of type '{}' where {} are wanted (hexahedra need transfinite or "
                              "extruded volumes with Recombine, tetrahedra no Recombine)",
                              element_tags[t].size(), name, wanted.name));
    }
    found.insert(found.end(), node_tags[t].begin(), node_tags[t].end());
  }
  return found;
}

struct PhysicalGroup {
  std::string name;
  std::vector<std::size_t> node_tags;  ///< of its elements, one after the other
};

std::vector<PhysicalGroup> physical_groups(const fs::path& geo, int dimension, const ElementType& type) {
  gmsh::vectorpair groups;
  gmsh::model::getPhysicalGroups(groups, dimension);
  std::vector<PhysicalGroup> found;
  for (const auto& [dim, tag] : groups) {
    PhysicalGroup group;
    gmsh::model::getPhysicalName(dim, tag, group.name);
    if (group.name.empty()) group.name = std::to_string(tag);
    std::vector<int> entities;
    gmsh::model::getEntitiesForPhysicalGroup(dim, tag, entities);
    for (const int entity : entities) {
      const auto nodes = elements(geo, dim, entity, type);
      group.node_tags.insert(group.node_tags.end(), nodes.begin(), nodes.end());
    }
    found.push_back(std::move(group));
  }
  return found;
}

/// Where gmsh's 27 nodes (corners, edges, faces, middle) stand when counted x fastest.
constexpr std::array<int, 27> place_of_27 = {0,  2,  8,  6,  18, 20, 26, 24, 1,  3,  9,  5,  11, 7,
                                             17, 15, 19, 21, 23, 25, 4,  10, 12, 14, 16, 22, 13};

/// The cells of the physical volumes (of the whole model if there are none) and their corners.
Mesh read_cells(const fs::path& geo, const ElementType& type, std::unordered_map<std::size_t, int>& number_of) {
  std::vector<std::size_t> cells;
  for (const PhysicalGroup& group : physical_groups(geo, 3, type))
    cells.insert(cells.end(), group.node_tags.begin(), group.node_tags.end());
  if (cells.empty()) cells = elements(geo, 3, -1, type);
  if (cells.empty()) refuse(geo, fmt::format("gmsh made no {} (is there a volume?)", type.name));

  std::vector<std::size_t> tags;
  for (std::size_t i = 0; i < cells.size(); i += type.nodes)
    tags.insert(tags.end(), cells.begin() + i, cells.begin() + i + type.corners);
  std::sort(tags.begin(), tags.end());
  tags.erase(std::unique(tags.begin(), tags.end()), tags.end());
  for (std::size_t i = 0; i < tags.size(); ++i) number_of[tags[i]] = static_cast<int>(i);

  Mesh mesh;
  mesh.nodes.resize(static_cast<Eigen::Index>(tags.size()), 3);
  std::vector<std::size_t> all_tags;
  std::vector<double> coordinates, parametric;
  gmsh::model::mesh::getNodes(all_tags, coordinates, parametric, -1, -1, false, false);
  std::unordered_map<std::size_t, Vec3> position;
  for (std::size_t i = 0; i < all_tags.size(); ++i)
    position[all_tags[i]] = Vec3(coordinates[3 * i], coordinates[3 * i + 1], coordinates[3 * i + 2]);
  for (std::size_t i = 0; i < tags.size(); ++i) mesh.nodes.row(static_cast<Eigen::Index>(i)) = position.at(tags[i]);

  for (std::size_t i = 0; i < cells.size(); i += type.nodes) {
    const auto corner = [&](int c) { return number_of.at(cells[i + c]); };
    if (type.corners == 4)
      mesh.tetrahedra.push_back({corner(0), corner(1), corner(2), corner(3)});
    else
      mesh.hexahedra.push_back({corner(0), corner(1), corner(2), corner(3), corner(4), corner(5), corner(6), corner(7)});
  }
  if (type.nodes == 27) {
    mesh.curved.resize(static_cast<Eigen::Index>(cells.size()), 3);
    for (std::size_t i = 0; i < cells.size(); ++i)
      mesh.curved.row(static_cast<Eigen::Index>(i / 27 * 27 + place_of_27[i % 27])) = position.at(cells[i]);
  }
  return mesh;
}

/// gmsh turns mirrored cells round itself; what is still negative somewhere is twisted.
void refuse_inverted_cells(const fs::path& geo, const Mesh& mesh) {
  const auto refuse_cell = [&](int node) {
    const Vec3 at = mesh.nodes.row(node);
    refuse(geo, fmt::format("gmsh made an inverted or flat cell near ({}, {}, {}) m", at.x(), at.y(), at.z()));
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
        for (int c = 0; c < 3; ++c)
          here &= (mesh.nodes(n, c) > middle[c]) == (hexahedron_corners[corner][c] == 1);
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
    for (int c = 0; c < 3; ++c)
      mesh.nodes(n, c) = grid->origin[c] + grid->spacing[c] * lattice_point[old_number[n]][c];
  }
  for (Hexahedron& cell : mesh.hexahedra)
    for (int& n : cell) n = new_number[n];
  mesh.grid = std::move(grid);
}

std::array<int, 4> sorted(std::array<int, 4> facet) {
  std::sort(facet.begin(), facet.end());
  return facet;
}

/// The physical surfaces as faces of the cells, which makes every facet outward whatever gmsh's orientation
/// is.
std::vector<Patch> read_patches(const fs::path& geo, const Mesh& mesh,
                                const std::unordered_map<std::size_t, int>& number_of) {
  const ElementType& type = !mesh.tetrahedra.empty() ? triangle : mesh.curved.size() > 0 ? quadrangle_9 : quadrangle;
  std::vector<Patch> patches;
  std::multimap<std::array<int, 4>, int> patches_of;  // by the facet's nodes, sorted
  for (const PhysicalGroup& group : physical_groups(geo, 2, type)) {
    for (std::size_t i = 0; i < group.node_tags.size(); i += type.nodes) {
      std::array<int, 4> facet = {-1, -1, -1, -1};
      for (int j = 0; j < type.corners; ++j) {
        const auto it = number_of.find(group.node_tags[i + j]);
        if (it == number_of.end())
          refuse(geo, fmt::format("physical surface '{}' is not on the surface of the body", group.name));
        facet[j] = it->second;
      }
      patches_of.emplace(sorted(facet), static_cast<int>(patches.size()));
    }
    patches.push_back({group.name, {}});
  }
  std::map<std::array<int, 4>, int> times_seen;
  const auto visit = [&](const std::array<int, 4>& facet) {
    const std::array<int, 4> key = sorted(facet);
    const auto [begin, end] = patches_of.equal_range(key);
    if (begin == end) return;
    ++times_seen[key];
    for (auto it = begin; it != end; ++it) patches[it->second].facets.push_back(facet);
  };
  for (const Hexahedron& cell : mesh.hexahedra)
    for (int f = 0; f < 6; ++f) visit(face_of(cell, f));
  for (const auto& [a, b, c, d] : mesh.tetrahedra)
    for (const std::array<int, 4>& facet : {std::array{a, c, b, -1}, {a, b, d, -1}, {b, c, d, -1}, {a, d, c, -1}}) visit(facet);
  for (const auto& [facet, patch] : patches_of)
    if (const auto it = times_seen.find(facet); it == times_seen.end() || it->second != 1)
      refuse(geo,
             fmt::format("physical surface '{}' is not on the surface of the body", patches[patch].name));
  return patches;
}

std::string list_of_bodies(const fs::path& folder) {
  std::vector<std::string> names;
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(folder, ignored))
    if (entry.path().extension() == ".geo") names.push_back(entry.path().filename().string());
  std::sort(names.begin(), names.end());
  return fmt::format("{}", fmt::join(names, ", "));
}

}  // namespace

fs::path find_geo(const Body& body, const fs::path& case_file) {
  const fs::path built_in = SPRINGPROOF_GEO_DIR;
  for (const fs::path& candidate : {case_file.parent_path() / body.geo, built_in / body.geo}) {
    std::error_code ignored;
    if (!body.geo.empty() && fs::is_regular_file(candidate, ignored)) return candidate;
  }
  throw InputError(body.where,
                   fmt::format("body.geo: no file '{}' beside the case file or among the built-in "
                               "bodies (allowed: {})",
                               body.geo, list_of_bodies(built_in)));
}

Mesh mesh_geo(const fs::path& geo, const Vec3& size, const Cells& cells, MeshKind kind) {
  if (!size.allFinite() || !(size.minCoeff() > 0)) refuse(geo, "size_m: three positive lengths are needed");
  if (*std::min_element(cells.begin(), cells.end()) < 1) refuse(geo, "cells: three counts >= 1 are needed");
  std::error_code ignored;
  if (!fs::is_regular_file(geo, ignored)) refuse(geo, "no such file");

  static std::mutex one_caller;
  const std::lock_guard lock(one_caller);
  try {
    GmshSession session({{"size_x", size.x()},
                         {"size_y", size.y()},
                         {"size_z", size.z()},
                         {"nx", cells[0]},
                         {"ny", cells[1]},
                         {"nz", cells[2]},
                         {"tetrahedra", kind.tetrahedra}});
    auto stop_on_error = [&] {
      if (const std::string error = session.first_error(); !error.empty()) refuse(geo, "gmsh: " + error);
    };
    gmsh::open(geo.string());
    stop_on_error();
    gmsh::option::setNumber("Mesh.ElementOrder", 1);
    gmsh::model::mesh::generate(3);
    stop_on_error();
    if (kind.second_order) {
      gmsh::option::setNumber("Mesh.SecondOrderIncomplete", 0);
      gmsh::model::mesh::setOrder(2);
      stop_on_error();
    }

    std::unordered_map<std::size_t, int> number_of;  // node number by gmsh tag
    const ElementType& type = kind.tetrahedra ? tetrahedron : kind.second_order ? hexahedron_27 : hexahedron;
    Mesh mesh = read_cells(geo, type, number_of);
    refuse_inverted_cells(geo, mesh);
    if (const int parts = separate_parts(mesh); parts > 1)
      refuse(geo, fmt::format("the mesh has {} parts that share no node (allowed: one body; join them with BooleanUnion or "
                              "BooleanFragments, or Coherence)", parts));
    std::vector<int> new_number(mesh.nodes.rows());
    std::iota(new_number.begin(), new_number.end(), 0);
    use_grid(mesh, new_number);
    for (auto& [tag, number] : number_of) number = new_number[number];
    mesh.patches = read_patches(geo, mesh, number_of);
    return mesh;
  } catch (const std::string& message) {
    refuse(geo, "gmsh: " + message);
  }
}

}  // namespace springproof
