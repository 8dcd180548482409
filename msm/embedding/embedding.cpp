#include "msm/embedding/embedding.h"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <stdexcept>

#include "meshes/locate/outer_facets.h"
#include "msm/algebra/dense.h"
#include "msm/embedding/surface_shares.h"
#include "msm/topology/point_cells.h"

namespace springproof {
namespace {

/// Cell list of the nodes, to find those near a point.
struct Neighbourhood {
  const NodalVectors& X;
  double edge;
  PointCells cells;

  Neighbourhood(const NodalVectors& nodes, double cell_edge)
      : X(nodes),
        edge(cell_edge),
        cells(nodes.colwise().minCoeff().transpose(),
              nodes.colwise().maxCoeff().transpose() + Vec3::Constant(1e-9 * cell_edge), cell_edge, false) {
    for (int n = 0; n < X.rows(); ++n) cells.add(X.row(n).transpose());
  }

  /// Nodes within `radius` of p, in order of number.
  std::vector<int> near(const Vec3& p, double radius) const {
    std::vector<int> found;
    cells.for_near(p, static_cast<int>(radius / edge) + 1, [&](int n) {
      if ((X.row(n).transpose() - p).norm() <= radius) found.push_back(n);
    });
    std::sort(found.begin(), found.end());
    return found;
  }
};

/// Those of `nodes` (ascending) that are connected, through springs among them, with the one nearest to p: nodes across
/// a gap in the body are excluded from the fit at p.
std::vector<int> connected_to_nearest(const NodalVectors& X, const std::vector<std::vector<int>>& neighbours,
                                      const std::vector<int>& nodes, const Vec3& p) {
  if (nodes.empty()) return {};
  const auto distance = [&](int n) { return (X.row(n).transpose() - p).squaredNorm(); };
  const auto nearest =
      std::min_element(nodes.begin(), nodes.end(), [&](int a, int b) { return distance(a) < distance(b); });
  std::vector<int> found = connected_with(*nearest, nodes, neighbours);
  std::sort(found.begin(), found.end());
  return found;
}

/// Moving least squares weights of `nodes` for a field at p: sum = 1, sum weight X = p.  Nothing if the nodes do not
/// span the directions that the whole network spans (`flat`: it lies in a plane z = const).
std::optional<Eigen::VectorXd> least_squares(const NodalVectors& X, const std::vector<int>& nodes, const Vec3& p,
                                             double radius, bool flat) {
  const int terms = flat ? 3 : 4;
  if (static_cast<int>(nodes.size()) < terms) return {};
  Eigen::MatrixXd basis(nodes.size(), terms);
  Eigen::VectorXd bell(nodes.size());
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const Vec3 d = (X.row(nodes[i]).transpose() - p) / radius;
    basis.row(static_cast<Eigen::Index>(i)) << 1, d.head(terms - 1).transpose();
    const double r = std::min(d.norm(), 1.0);
    bell[static_cast<Eigen::Index>(i)] = std::pow(1 - r * r, 3) + 1e-9;
  }
  const Eigen::MatrixXd moments = basis.transpose() * bell.asDiagonal() * basis;
  const Eigen::VectorXd eigenvalues = symmetric_eigenvalues(moments);
  if (eigenvalues[0] < 1e-3 * eigenvalues[terms - 1]) return {};
  return bell.cwiseProduct(basis * symmetric_solve(moments, Eigen::VectorXd::Unit(terms, 0)));
}

/// Network nodes within `grip` of a patch, whose corners are at point(number).
template <class Point>
std::vector<int> held_by(const Patch& patch, const Point& point, const Network& network,
                         const Neighbourhood& neighbourhood, double grip) {
  std::vector<char> held(network.nodes(), 0);
  for (const auto& facet : patch.facets) {
    const int corners = facet[3] < 0 ? 3 : 4;
    std::array<Vec3, 4> x;
    Vec3 middle = Vec3::Zero();
    for (int i = 0; i < corners; ++i) middle += (x[i] = point(facet[i])) / corners;
    double radius = 0;
    for (int i = 0; i < corners; ++i) radius = std::max(radius, (x[i] - middle).norm());
    for (int n : neighbourhood.near(middle, radius + grip)) {
      const Vec3 p = network.X.row(n).transpose();
      const auto is_near = [&](int a, int b, int c) { return (closest_point(p, x[a], x[b], x[c]) - p).norm() <= grip; };
      if (is_near(0, 1, 2) || (corners == 4 && is_near(2, 3, 0))) held[n] = 1;
    }
  }
  std::vector<int> nodes;
  for (int n = 0; n < network.nodes(); ++n)
    if (held[n]) nodes.push_back(n);
  return nodes;
}

constexpr double same_place = 1e-9;  // of the extent

/// The number of the network's node at each node of the mesh, if they have all their nodes in common.
std::optional<std::vector<int>> common_nodes(const Mesh& mesh, const Network& network) {
  if (mesh.nodes.rows() != network.X.rows()) return {};
  const Vec3 extent = (network.X.colwise().maxCoeff() - network.X.colwise().minCoeff()).transpose();
  const double size = extent.maxCoeff();
  const Neighbourhood neighbourhood(network.X, size / std::max(1.0, std::cbrt(network.nodes())) + same_place * size);
  std::vector<int> number;
  std::vector<char> taken(network.nodes(), 0);
  for (int m = 0; m < mesh.nodes.rows(); ++m) {
    const std::vector<int> here = neighbourhood.near(mesh.nodes.row(m).transpose(), same_place * size);
    if (here.size() != 1 || taken[here[0]]++) return {};
    number.push_back(here[0]);
  }
  return number;
}

}  // namespace

Embedding nodes_of_mesh(const Mesh& mesh) {
  Embedding e;
  e.weights.resize(mesh.nodes.rows(), mesh.nodes.rows());
  e.weights.setIdentity();
  for (const Patch& p : mesh.patches) e.held[p.name] = nodes_of(p);
  return e;
}

Embedding embed(const Mesh& mesh, const Network& network, double grip, const Region* region) {
  const Vec3 extent = (network.X.colwise().maxCoeff() - network.X.colwise().minCoeff()).transpose();
  const bool flat = extent[2] <= 1e-9 * extent.maxCoeff();
  const double spacing =
      flat ? std::sqrt(extent[0] * extent[1] / network.nodes()) : std::cbrt(network.volume.sum() / network.nodes());
  const Neighbourhood neighbourhood(network.X, 1.5 * spacing);
  const std::vector<std::vector<int>> neighbours = neighbours_of(network);
  std::vector<Eigen::Triplet<double>> entries;
  for (int m = 0; m < mesh.nodes.rows(); ++m) {
    Vec3 p = mesh.nodes.row(m).transpose();
    if (flat) p[2] = network.X(0, 2);
    std::optional<Eigen::VectorXd> weight;
    std::vector<int> nodes;
    for (double radius = 1.6 * spacing; !weight; radius *= 1.2) {
      if (radius > 100 * spacing + extent.norm()) throw std::invalid_argument("the network's nodes span no volume");
      nodes = connected_to_nearest(network.X, neighbours, neighbourhood.near(p, radius), p);
      weight = least_squares(network.X, nodes, p, radius, flat);
    }
    for (std::size_t i = 0; i < nodes.size(); ++i)
      entries.emplace_back(m, nodes[i], (*weight)[static_cast<Eigen::Index>(i)]);
  }
  Embedding e;
  e.weights.resize(mesh.nodes.rows(), network.nodes());
  e.weights.setFromTriplets(entries.begin(), entries.end());
  const double slack = grip + 1e-9 * extent.maxCoeff();
  const auto node = [&](int n) -> Vec3 { return mesh.nodes.row(n).transpose(); };
  const auto surface_point = [&](int n) -> Vec3 { return region->surface_points[n]; };
  for (const Patch& p : mesh.patches) e.held[p.name] = held_by(p, node, network, neighbourhood, slack);
  if (region)
    for (const Patch& p : region->patches) e.held[p.name] = held_by(p, surface_point, network, neighbourhood, slack);
  return e;
}

Embedding embed_at_nodes(const Mesh& mesh, const Network& network, double grip, const Region* region) {
  const auto number = common_nodes(mesh, network);
  if (!number) return embed(mesh, network, grip, region);
  Embedding e = nodes_of_mesh(mesh);
  std::vector<Eigen::Triplet<double>> entries;
  for (int m = 0; m < mesh.nodes.rows(); ++m) entries.emplace_back(m, (*number)[m], 1.0);
  e.weights.setFromTriplets(entries.begin(), entries.end());
  for (auto& [patch, nodes] : e.held) {
    for (int& n : nodes) n = (*number)[n];
    std::sort(nodes.begin(), nodes.end());
  }
  return e;
}

}  // namespace springproof
