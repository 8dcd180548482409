#include "comparisons/picture.h"

#include <algorithm>
#include <map>

namespace springproof {
namespace {

constexpr int faces[6][4] = {{0, 4, 7, 3}, {1, 2, 6, 5}, {0, 1, 5, 4}, {3, 7, 6, 2}, {0, 3, 2, 1}, {4, 5, 6, 7}};

/// Facets that belong to one hexahedron only, outward.
std::vector<std::array<int, 4>> surface(const Mesh& mesh) {
  std::map<std::array<int, 4>, std::pair<int, std::array<int, 4>>> count;
  for (const Hexahedron& cell : mesh.hexahedra)
    for (const auto& face : faces) {
      const std::array<int, 4> facet = {cell[face[0]], cell[face[1]], cell[face[2]], cell[face[3]]};
      std::array<int, 4> key = facet;
      std::sort(key.begin(), key.end());
      auto& entry = count[key];
      ++entry.first;
      entry.second = facet;
    }
  std::vector<std::array<int, 4>> outside;
  for (const auto& [key, entry] : count)
    if (entry.first == 1) outside.push_back(entry.second);
  return outside;
}

void append(const Eigen::RowVector3d& v, std::vector<float>& out) {
  for (double value : v) out.push_back(static_cast<float>(value));
}

}  // namespace

Picture picture(const std::string& model, double poisson_ratio, const Cells& cells, const Field& field,
                const NodalVectors* truth) {
  Picture p{model, poisson_ratio, cells, {}, {}, {}, {}};
  std::vector<int> number(static_cast<std::size_t>(field.mesh->nodes.rows()), -1);
  int used = 0;
  for (const auto& facet : surface(*field.mesh))
    for (int n : facet) {
      if (number[n] < 0) {
        number[n] = used++;
        append(field.mesh->nodes.row(n), p.rest);
        append(field.displacement.row(n), p.displacement);
        if (truth) p.difference.push_back(static_cast<float>((field.displacement.row(n) - truth->row(n)).norm()));
      }
      p.quads.push_back(number[n]);
    }
  return p;
}

}  // namespace springproof
