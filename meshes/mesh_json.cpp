#include "meshes/mesh_json.h"

#include <cstring>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "problem/system/json.h"

namespace springproof {
namespace {

using nlohmann::json;

json bytes(const void* data, std::size_t size) {
  const auto* first = static_cast<const std::uint8_t*>(data);
  return json::binary({first, first + size});
}

/// An empty list may have no address, and memcpy wants one.
void copy(const json::binary_t& from, void* to) {
  if (!from.empty()) std::memcpy(to, from.data(), from.size());
}

json points(const NodalVectors& x) { return bytes(x.data(), sizeof(double) * x.size()); }

NodalVectors to_points(const json& j) {
  const auto& binary = j.get_binary();
  NodalVectors x(static_cast<Eigen::Index>(binary.size() / (3 * sizeof(double))), 3);
  if (sizeof(double) * x.size() != binary.size()) throw std::runtime_error("a mesh with a cut-off list of points");
  copy(binary, x.data());
  return x;
}

template <std::size_t n>
json tuples(const std::vector<std::array<int, n>>& values) {
  return bytes(values.data(), sizeof(values[0]) * values.size());
}

template <std::size_t n>
std::vector<std::array<int, n>> to_tuples(const json& j) {
  const auto& binary = j.get_binary();
  std::vector<std::array<int, n>> values(binary.size() / sizeof(std::array<int, n>));
  if (sizeof(std::array<int, n>) * values.size() != binary.size())
    throw std::runtime_error("a mesh with a cut-off list of numbers");
  copy(binary, values.data());
  return values;
}

}  // namespace

json to_json(const Mesh& mesh) {
  json patches = json::array();
  for (const Patch& p : mesh.patches) patches.push_back({{"name", p.name}, {"facets", tuples(p.facets)}});
  json out = {
      {"nodes", points(mesh.nodes)},           {"hexahedra", tuples(mesh.hexahedra)},
      {"tetrahedra", tuples(mesh.tetrahedra)}, {"patches", patches},
      {"curved", points(mesh.curved)},         {"materials", bytes(mesh.materials.data(), mesh.materials.size())}};
  if (mesh.grid)
    out["grid"] = {{"cells", mesh.grid->cells},
                   {"origin", mesh.grid->origin},
                   {"spacing", mesh.grid->spacing},
                   {"cell_index", tuples(mesh.grid->cell_index)}};
  return out;
}

Mesh mesh_from_json(const json& j) {
  Mesh mesh;
  mesh.nodes = to_points(j.at("nodes"));
  mesh.hexahedra = to_tuples<8>(j.at("hexahedra"));
  mesh.tetrahedra = to_tuples<4>(j.at("tetrahedra"));
  for (const json& p : j.at("patches")) mesh.patches.push_back({p.at("name"), to_tuples<4>(p.at("facets"))});
  mesh.curved = to_points(j.at("curved"));
  mesh.materials = j.at("materials").get_binary();
  if (j.contains("grid")) {
    const json& g = j.at("grid");
    mesh.grid =
        Grid{g.at("cells"), g.at("origin").get<Vec3>(), g.at("spacing").get<Vec3>(), to_tuples<3>(g.at("cell_index"))};
  }
  return mesh;
}

}  // namespace springproof
