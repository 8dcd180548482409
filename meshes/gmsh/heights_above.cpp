#include "meshes/gmsh/heights_above.h"

#include <gmsh.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <map>
#include <stdexcept>
#include <string>

#include "meshes/gmsh/session.h"

namespace springproof {
namespace {

/// Of the edges of the facets on a surface of the model, the points of it above their middles: by the middles of their
/// parameters or, where those are not near (seams, poles), the nearest.
/// @param facets tags of the corners, three of each facet
std::vector<Vec3> above_middles(int surface, const std::vector<std::size_t>& facets) {
  constexpr double near = 0.25;  // of an edge
  std::vector<std::size_t> tags;
  std::vector<double> coordinates, parametric;
  gmsh::model::mesh::getNodes(tags, coordinates, parametric, 2, surface, true, true);
  if (parametric.size() != 2 * tags.size()) throw std::runtime_error("a surface has no parameters");
  std::map<std::size_t, std::size_t> number;
  for (std::size_t i = 0; i < tags.size(); ++i) number[tags[i]] = i;
  std::vector<double> middles, values;
  std::vector<Vec3> straight;
  std::vector<double> lengths;
  for (std::size_t i = 0; i < facets.size(); ++i) {
    const std::size_t p = number.at(facets[i]), q = number.at(facets[i % 3 < 2 ? i + 1 : i - 2]);
    for (int c = 0; c < 2; ++c) middles.push_back((parametric[2 * p + c] + parametric[2 * q + c]) / 2);
    const Vec3 from = Vec3::Map(&coordinates[3 * p]), to = Vec3::Map(&coordinates[3 * q]);
    straight.push_back((from + to) / 2);
    lengths.push_back((to - from).norm());
  }
  gmsh::model::getValue(2, surface, middles, values);
  std::vector<Vec3> points;
  for (std::size_t i = 0; i < straight.size(); ++i) {
    points.push_back(Vec3::Map(&values[3 * i]));
    if ((points[i] - straight[i]).norm() < near * lengths[i]) continue;
    std::vector<double> nearest, at;
    gmsh::model::getClosestPoint(2, surface, {straight[i].x(), straight[i].y(), straight[i].z()}, nearest, at);
    points[i] = Vec3::Map(nearest.data());
  }
  return points;
}

}  // namespace

std::vector<double> heights_above(const Mesh& mesh, const Surface& outside) try {
  const auto place = [](const Vec3& x) { return std::array{x.x(), x.y(), x.z()}; };
  std::map<std::array<double, 3>, int> number;
  for (Eigen::Index n = 0; n < mesh.nodes.rows(); ++n) number[place(mesh.nodes.row(n))] = static_cast<int>(n);
  const auto sorted = [](std::array<int, 3> facet) {
    std::sort(facet.begin(), facet.end());
    return facet;
  };
  std::map<std::array<int, 3>, Vec3> rises;  // from a facet to its surface, as a mean
  gmsh::vectorpair volumes, surfaces;
  gmsh::model::getEntities(volumes, 3);
  gmsh::model::getBoundary(volumes, surfaces, true, false, false);
  std::vector<std::size_t> tags;
  std::vector<double> coordinates, parametric;
  gmsh::model::mesh::getNodes(tags, coordinates, parametric, -1, -1, false, false);
  std::map<std::size_t, Vec3> at;
  for (std::size_t i = 0; i < tags.size(); ++i) at[tags[i]] = Vec3::Map(&coordinates[3 * i]);
  for (const auto& [dimension, surface] : surfaces)
    for (const ElementBlock& b : elements(2, {surface})) {
      if (b.nodes != 3) continue;
      const std::vector<Vec3> above = above_middles(surface, b.node_tags);
      for (std::size_t i = 0; i < b.node_tags.size(); i += 3) {
        std::array<int, 3> facet;
        Vec3 rise = Vec3::Zero();
        for (int c = 0; c < 3; ++c) {
          const Vec3 &from = at.at(b.node_tags[i + c]), &to = at.at(b.node_tags[i + (c + 1) % 3]);
          rise += (above[i + c] - (from + to) / 2) / 3;
          const auto found = number.find(place(from));
          facet[c] = found == number.end() ? -1 : found->second;
        }
        rises[sorted(facet)] = rise;
      }
    }
  std::vector<double> heights;
  for (const auto& [a, b, c] : outside.triangles) {
    const Vec3 &A = outside.points[a], &B = outside.points[b], &C = outside.points[c];
    const auto found = rises.find(sorted({a, b, c}));
    heights.push_back(found == rises.end() ? 0 : found->second.dot((B - A).cross(C - A).normalized()));
  }
  return heights;
} catch (const std::string& message) {
  throw std::runtime_error("gmsh: " + message);
}

}  // namespace springproof
