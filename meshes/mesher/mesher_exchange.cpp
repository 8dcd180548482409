#include "meshes/mesher/mesher_exchange.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "meshes/facets.h"
#include "meshes/mesh_json.h"
#include "problem/system/json.h"

namespace springproof {
namespace {

using nlohmann::json;

/// Whether all are numbers of nodes.
template <std::size_t n>
bool within(const std::vector<std::array<int, n>>& tuples, Eigen::Index nodes) {
  return std::all_of(tuples.begin(), tuples.end(), [&](const auto& tuple) {
    return std::all_of(tuple.begin(), tuple.end(), [&](int node) { return node >= 0 && node < nodes; });
  });
}

/// The fourth node of a triangle is -1.
bool within(const Patch& patch, Eigen::Index nodes) {
  return std::all_of(patch.facets.begin(), patch.facets.end(), [&](auto f) {
    if (f[3] == -1) f[3] = f[0];
    return within(std::vector{f}, nodes);
  });
}

/// Whether each of `cells` hexahedra, which touch one another, has its place in the grid.
bool fits(const Grid& grid, std::size_t cells) {
  const auto inside = [&](const std::array<int, 3>& at) {
    return std::equal(at.begin(), at.end(), grid.cells.begin(), [](int i, int n) { return i >= 0 && i < n; });
  };
  return grid.cell_index.size() == cells && std::all_of(grid.cell_index.begin(), grid.cell_index.end(), inside) &&
         std::all_of(grid.cells.begin(), grid.cells.end(), [&](int n) { return std::size_t(n) <= cells; }) &&
         grid.origin.allFinite() && grid.spacing.allFinite() && grid.spacing.minCoeff() > 0;
}

/// The mesh itself.
/// @throws std::runtime_error if its numbers lead outside of it.
Mesh sound(Mesh mesh) {
  const Eigen::Index nodes = mesh.nodes.rows();
  const std::size_t cells = mesh.hexahedra.size();
  const bool facets_fit =
      std::all_of(mesh.patches.begin(), mesh.patches.end(), [&](const Patch& p) { return within(p, nodes); });
  if ((cells + mesh.tetrahedra.size() == 0 && mesh.patches.empty()) || !mesh.nodes.allFinite() ||
      !within(mesh.hexahedra, nodes) || !within(mesh.tetrahedra, nodes) || !facets_fit ||
      (mesh.curved.rows() > 0 && static_cast<std::size_t>(mesh.curved.rows()) != 27 * cells) ||
      (!mesh.materials.empty() && mesh.materials.size() != cells + mesh.tetrahedra.size()) ||
      (mesh.grid && !fits(*mesh.grid, cells)))
    throw std::runtime_error("a mesh that does not hold together");
  return mesh;
}

/// The surface of which `mesh_of` made a mesh.
Surface surface_of(const Mesh& mesh) {
  Surface surface;
  for (const auto& row : mesh.nodes.rowwise()) surface.points.push_back(row.transpose());
  for (const auto& [a, b, c, none] : mesh.patches.at(0).facets) surface.triangles.push_back({a, b, c});
  return surface;
}

}  // namespace

Mesh mesh_of(const Surface& surface, const std::string& patch) {
  Mesh mesh;
  mesh.nodes = rows_of(surface.points);
  Patch& facets = mesh.patches.emplace_back(Patch{patch, {}});
  for (const auto& [a, b, c] : surface.triangles) facets.facets.push_back({a, b, c, -1});
  return mesh;
}

std::string to_cbor(const MeshRequest& r) {
  return cbor({{"file", r.file.string()},
               {"size", r.size},
               {"cells", r.cells},
               {"tetrahedra", r.kind.tetrahedra},
               {"second_order", r.kind.second_order},
               {"vertices", r.kind.vertices},
               {"closed", r.kind.closed},
               {"edge", r.edge},
               {"about", r.tetrahedra},
               {"coarser", r.coarser},
               {"scale", r.scale},
               {"volumes", r.volumes}});
}

MeshRequest mesh_request_from_cbor(const std::string& bytes) {
  const json j = json::from_cbor(bytes);
  MeshRequest r;
  r.file = std::string(j.at("file"));
  r.size = j.at("size").get<Vec3>();
  r.cells = j.at("cells");
  r.kind = {j.at("tetrahedra"), j.at("second_order"), j.at("vertices"), j.at("closed")};
  r.edge = j.at("edge");
  r.tetrahedra = j.at("about");
  r.coarser = j.at("coarser").get<std::vector<double>>();
  r.scale = j.at("scale");
  r.volumes = j.at("volumes").get<std::vector<std::string>>();
  return r;
}

std::string to_cbor(const MeshedBody& body) {
  json coarser = json::array();
  for (const Mesh& mesh : body.coarser) coarser.push_back(to_json(mesh));
  return cbor({{"mesh", to_json(body.mesh)},
               {"notes", body.notes},
               {"edge", body.edge},
               {"coarser", coarser},
               {"facets", to_json(mesh_of(body.facets, "facets"))},
               {"smooth_volume", body.smooth_volume}});
}

std::string refusal_to_cbor(const std::string& message) { return cbor({{"refused", message}}); }

MeshedBody answer_from_cbor(const std::string& bytes) try {
  const json j = json::from_cbor(bytes);
  if (j.contains("refused")) throw InputError(j.at("refused").get<std::string>());
  MeshedBody body{sound(mesh_from_json(j.at("mesh"))), j.at("notes"), j.at("edge"), {}, {}, j.at("smooth_volume")};
  for (const json& mesh : j.at("coarser")) body.coarser.push_back(sound(mesh_from_json(mesh)));
  body.facets = surface_of(sound(mesh_from_json(j.at("facets"))));
  return body;
} catch (const InputError&) {
  throw;
} catch (const std::exception&) {  // the words of a JSON library are no help
  throw std::runtime_error(
      "the answer of springproof-mesh cannot be used (build springproof and springproof-mesh together)");
}

bool is_surface_file(const std::string& extension) {
  return extension == ".stl" || extension == ".obj" || extension == ".ply";
}

std::string extension_of(const std::filesystem::path& file) {
  std::string extension = file.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return std::tolower(c); });
  return extension;
}

}  // namespace springproof
