#include "meshes/gmsh/heights_above.h"

#include <gmsh.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <map>
#include <stdexcept>
#include <string>

#include "meshes/facets.h"
#include "meshes/gmsh/session.h"

namespace springproof {
namespace {

struct SurfaceNode {
  Vec3 at;
  Eigen::Vector2d parameters;
};

/// Nodes on a surface of the model and its rim, by their tags.
std::map<std::size_t, SurfaceNode> nodes_on(int surface) {
  std::vector<std::size_t> tags;
  std::vector<double> coordinates, parametric;
  gmsh::model::mesh::getNodes(tags, coordinates, parametric, 2, surface, true, true);
  if (parametric.size() != 2 * tags.size()) throw std::runtime_error("a surface has no parameters");
  std::map<std::size_t, SurfaceNode> nodes;
  for (std::size_t i = 0; i < tags.size(); ++i)
    nodes[tags[i]] = {Vec3::Map(&coordinates[3 * i]), Eigen::Vector2d::Map(&parametric[2 * i])};
  return nodes;
}

/// From the middles of the facets' edges to the surface: to where the parameters are the middle of the ends' or, if
/// that is not near (seams, poles), to the nearest point.
/// @param facets tags of the corners, three of each facet
/// @return three of each facet
std::vector<Vec3> bows(int surface, const std::map<std::size_t, SurfaceNode>& nodes,
                       const std::vector<std::size_t>& facets) {
  constexpr double near = 0.25;  // of an edge; of a chord of a circle the bow is that of 106 degrees
  const auto end = [&](std::size_t i) -> const SurfaceNode& { return nodes.at(facets[i % 3 < 2 ? i + 1 : i - 2]); };
  std::vector<double> parameters, points;
  for (std::size_t i = 0; i < facets.size(); ++i) {
    const Eigen::Vector2d middle = (nodes.at(facets[i]).parameters + end(i).parameters) / 2;
    parameters.insert(parameters.end(), {middle.x(), middle.y()});
  }
  gmsh::model::getValue(2, surface, parameters, points);
  std::vector<Vec3> bows;
  for (std::size_t i = 0; i < facets.size(); ++i) {
    const Vec3 &from = nodes.at(facets[i]).at, &to = end(i).at, middle = (from + to) / 2;
    bows.push_back(Vec3::Map(&points[3 * i]) - middle);
    if (bows[i].norm() < near * (to - from).norm()) continue;
    std::vector<double> nearest, at;
    gmsh::model::getClosestPoint(2, surface, {middle.x(), middle.y(), middle.z()}, nearest, at);
    bows[i] = Vec3::Map(nearest.data()) - middle;
  }
  return bows;
}

}  // namespace

std::vector<double> heights_above(const Mesh& mesh, const Surface& outside) try {
  const auto place = [](const Vec3& x) { return std::array{x.x(), x.y(), x.z()}; };
  std::map<std::array<double, 3>, int> number;
  for (Eigen::Index n = 0; n < mesh.nodes.rows(); ++n) number[place(mesh.nodes.row(n))] = static_cast<int>(n);
  std::map<std::array<int, 3>, Vec3> rises;  // from a facet to its surface, as a mean
  gmsh::vectorpair volumes, surfaces;
  gmsh::model::getEntities(volumes, 3);
  gmsh::model::getBoundary(volumes, surfaces, true, false, false);
  for (const auto& [dimension, surface] : surfaces) {
    const std::map<std::size_t, SurfaceNode> nodes = nodes_on(surface);
    for (const ElementBlock& b : elements(2, {surface})) {
      if (b.nodes != 3) continue;
      const std::vector<Vec3> of_edges = bows(surface, nodes, b.node_tags);
      for (std::size_t i = 0; i < b.node_tags.size(); i += 3) {
        std::array<int, 3> facet;
        for (int c = 0; c < 3; ++c) {
          const auto found = number.find(place(nodes.at(b.node_tags[i + c]).at));
          facet[c] = found == number.end() ? -1 : found->second;
        }
        rises[ascending(facet)] = (of_edges[i] + of_edges[i + 1] + of_edges[i + 2]) / 3;
      }
    }
  }
  std::vector<double> heights;
  for (const auto& [a, b, c] : outside.triangles) {
    const Vec3 &A = outside.points[a], &B = outside.points[b], &C = outside.points[c];
    const auto found = rises.find(ascending(std::array{a, b, c}));
    heights.push_back(found == rises.end() ? 0 : found->second.dot((B - A).cross(C - A).normalized()));
  }
  return heights;
} catch (const std::string& message) {
  throw std::runtime_error("gmsh: " + message);
}

}  // namespace springproof
