#include "msm/embedding/surface_shares.h"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <stdexcept>

#include "meshes/facets.h"
#include "meshes/volume.h"
#include "msm/algebra/dense.h"
#include "msm/topology/point_cells.h"
#include "msm/topology/random/surface_features.h"

namespace springproof {
namespace {

// In node spacings.
constexpr double on_surface = 1e-6;
constexpr double piece_width = 0.5;
constexpr std::array heights = {1e-6, 0.1, 0.3, 0.6, 1.0};  // of nodes above or below the tangent plane
constexpr std::array reaches = {1.6, 2.0, 2.5, 3.0};
constexpr double laplacian = 4;      // of |x|^2 in a plane
constexpr double edge_reach = 3;     // of nodes on a sharp edge
constexpr double largest_sum = 1.5;  // of |weights|, which is 1 within the convex hull of few nodes

struct SurfaceWeights {
  std::vector<int> nodes;
  Eigen::VectorXd weight;
};

/// Interpolation from the surface nodes of a network to points of the surface.
struct SurfaceInterpolation {
  const Network& network;
  double spacing;
  PointCells cells;
  std::vector<char> at_surface;
  std::vector<std::vector<int>> neighbours;

  SurfaceInterpolation(const Region& region, const Network& n)
      : network(n),
        spacing(std::cbrt(n.volume.sum() / n.nodes())),
        cells(region.lower, region.upper, spacing, false),
        at_surface(n.nodes(), 0),
        neighbours(neighbours_of(n)) {
    for (int node = 0; node < n.nodes(); ++node) cells.add(n.X.row(node).transpose());
    for (const auto& t : region.surface_triangles)
      mark({region.surface_points[t[0]], region.surface_points[t[1]], region.surface_points[t[2]]});
  }

  /// Marks the nodes on a triangle.
  void mark(const std::array<Vec3, 3>& triangle) {
    const Vec3 normal = (triangle[1] - triangle[0]).cross(triangle[2] - triangle[0]).normalized();
    const double width = piece_width * spacing;
    for_pieces(triangle[0], triangle[1], triangle[2], width, [&](const Vec3& a, const Vec3& b, const Vec3& c) {
      const Vec3 middle = (a + b + c) / 3;
      cells.for_near(middle, 1, [&](int n) {
        const bool in_plane = std::abs((network.X.row(n).transpose() - a).dot(normal)) <= on_surface * spacing;
        at_surface[n] = at_surface[n] || (in_plane && distance(n, middle) <= width);
      });
    });
  }

  double distance(int node, const Vec3& p) const { return (network.X.row(node).transpose() - p).norm(); }

  /// Nodes within `reach` [m] of p, nearest first, that are connected with the nearest surface node through such nodes.
  std::vector<int> connected(const Vec3& p, double reach) const {
    std::vector<std::pair<double, int>> near;
    cells.for_near(p, static_cast<int>(reach / spacing) + 1, [&](int n) {
      if (const double d = distance(n, p); d <= reach) near.emplace_back(d, n);
    });
    std::sort(near.begin(), near.end());
    const auto start = std::find_if(near.begin(), near.end(), [&](const auto& at) { return at_surface[at.second]; });
    if (start == near.end()) return {};
    std::vector<int> open;
    for (const auto& at : near) open.push_back(at.second);
    std::sort(open.begin(), open.end());
    return connected_with(start->second, open, neighbours);
  }

  /// Moving least squares in the plane through p with normal n.
  std::optional<SurfaceWeights> in_plane(const std::vector<int>& candidates, const Vec3& p, const Vec3& normal,
                                         double height, double reach) const {
    const Vec3 u = normal.unitOrthogonal(), v = normal.cross(u);
    SurfaceWeights found;
    std::vector<Vec3> basis;
    for (const int n : candidates) {
      const Vec3 d = network.X.row(n).transpose() - p;
      if (!at_surface[n] || std::abs(d.dot(normal)) > height) continue;
      found.nodes.push_back(n);
      basis.emplace_back(1, d.dot(u) / reach, d.dot(v) / reach);
    }
    Eigen::Matrix3d moments = Eigen::Matrix3d::Zero();
    Eigen::VectorXd bell(static_cast<Eigen::Index>(basis.size()));
    for (std::size_t i = 0; i < basis.size(); ++i) {
      bell[i] = std::pow(1 - std::min(1.0, basis[i].tail<2>().squaredNorm()), 3) + 1e-9;
      moments += bell[i] * basis[i] * basis[i].transpose();
    }
    if (!(moments.determinant() > 1e-6 * std::pow(moments(0, 0), 3))) return {};
    const Vec3 c = moments.ldlt().solve(Vec3::UnitX());
    found.weight.resize(bell.size());
    for (std::size_t i = 0; i < basis.size(); ++i) found.weight[i] = bell[i] * basis[i].dot(c);
    return found;
  }

  /// Empty: there are no nodes on the surface nearby, or all are on one line.
  std::optional<SurfaceWeights> at(const Vec3& p, const Vec3& normal) const {
    std::optional<SurfaceWeights> best;
    double least = std::numeric_limits<double>::infinity();
    std::array<std::vector<int>, reaches.size()> candidates;
    for (const double height : heights)
      for (std::size_t r = 0; r < reaches.size(); ++r) {
        if (candidates[r].empty()) candidates[r] = connected(p, reaches[r] * spacing);
        auto found = in_plane(candidates[r], p, normal, height * spacing, reaches[r] * spacing);
        if (!found) continue;
        const double sum = found->weight.cwiseAbs().sum();
        if (sum <= largest_sum) return found;
        if (sum < least) {
          least = sum;
          best = std::move(found);
        }
      }
    return best;
  }

  /// Adds the shares in a triangle, anticlockwise seen from outside.  Returns by how much they overestimate the
  /// integral of |x|^2 [m^4].
  double add(const std::array<Vec3, 3>& triangle, PatchShares& shares) const {
    const Vec3 normal = (triangle[1] - triangle[0]).cross(triangle[2] - triangle[0]).normalized();
    double excess = 0;
    for_pieces(triangle[0], triangle[1], triangle[2], piece_width * spacing,
               [&](const Vec3& a, const Vec3& b, const Vec3& c) {
                 const double area = (b - a).cross(c - a).norm() / 2;
                 const Vec3 middle = (a + b + c) / 3;
                 for (const Vec3& corner : {a, b, c}) excess -= area * (corner - middle).squaredNorm() / 12;
                 const std::optional<SurfaceWeights> w = at(middle, normal);
                 if (!w) refuse(middle);
                 for (std::size_t i = 0; i < w->nodes.size(); ++i) {
                   give(w->nodes[i], area * w->weight[i], normal, shares);
                   excess += area * w->weight[i] * std::pow(distance(w->nodes[i], middle), 2);
                 }
               });
    return excess;
  }

  [[noreturn]] void refuse(const Vec3& p) const {
    throw std::invalid_argument(fmt::format(
        "the surface near ({:.4g}, {:.4g}, {:.4g}) m is far from all of the {} nodes on it, which lie {:.3g} m "
        "apart (allowed: more nodes, by smaller cells or nodes_per_m3, so that thin parts have some)",
        p[0], p[1], p[2], std::count(at_surface.begin(), at_surface.end(), 1), spacing));
  }

  static void give(int node, double area, const Vec3& normal, PatchShares& shares) {
    shares.area[node] += area;
    shares.normal.row(node) += area * normal.transpose();
  }

  /// The nodes before and after p on a straight edge, -1 where there is none.
  std::array<int, 2> on_edge(const Vec3& p, const Vec3& along) const {
    std::array<int, 2> found = {-1, -1};
    std::array<double, 2> nearest = {edge_reach * spacing, edge_reach * spacing};
    cells.for_near(p, static_cast<int>(edge_reach) + 1, [&](int n) {
      const Vec3 d = network.X.row(n).transpose() - p;
      const double at = d.dot(along);
      const int side = at > 0;
      if ((d - at * along).norm() <= on_surface * spacing && std::abs(at) <= nearest[side]) {
        found[side] = n;
        nearest[side] = std::abs(at);
      }
    });
    return found;
  }

  /// Moves `moment` [m^2] times the length of the side ab of a facet inwards, from nodes of areas `unthinned`.  Not
  /// where the face is too narrow to have nodes there.
  void thin(const Vec3& a, const Vec3& b, const Vec3& normal, double moment, const NodalVectors& unthinned,
            PatchShares& shares) const {
    const Vec3 along = (b - a).normalized(), inwards = normal.cross(along);
    const int pieces = static_cast<int>(std::ceil((b - a).norm() / (piece_width * spacing)));
    const double area = moment / spacing * (b - a).norm() / pieces;
    for (int piece = 0; piece < pieces; ++piece) {
      const Vec3 p = a + (b - a) * ((piece + 0.5) / pieces);
      const auto [before, after] = on_edge(p, along);
      if (before < 0 || after < 0) continue;
      // Springs of positive constants hold an edge whose areas in its two faces differ by up to a factor of sqrt(3).
      const auto weight = [&](int n, int other) {
        const Vec3 both = unthinned.row(n).transpose();
        const double here = std::max(0.0, both.dot(normal)), there = (both - here * normal).norm();
        return distance(other, p) * (1e-6 + std::pow(here / (here + there + 1e-12 * spacing * spacing), 4));
      };
      const double of_before = weight(before, after), of_after = weight(after, before);
      const double share = of_after / (of_before + of_after);
      const Vec3 from = (network.X.row(before) + share * (network.X.row(after) - network.X.row(before))).transpose();
      const std::optional<SurfaceWeights> inside = at(from + spacing * inwards, normal);
      if (!inside) continue;
      give(before, -area * (1 - share), normal, shares);
      give(after, -area * share, normal, shares);
      for (std::size_t i = 0; i < inside->nodes.size(); ++i)
        give(inside->nodes[i], area * inside->weight[i], normal, shares);
    }
  }

  PatchShares none() const { return {Eigen::VectorXd::Zero(network.nodes()), NodalVectors::Zero(network.nodes(), 3)}; }
};

/// Makes sum A = 0 and sum A x^T = V 1.
void meet_gauss(const NodalVectors& X, double volume, NodalVectors& A) {
  const Eigen::RowVector3d middle = X.colwise().mean();
  const double size = (X.colwise().maxCoeff() - X.colwise().minCoeff()).norm();
  Eigen::MatrixXd linear(X.rows(), 4);
  linear << (X.rowwise() - middle) / size, Eigen::VectorXd::Ones(X.rows());
  Eigen::Matrix<double, 4, 3> missing = -linear.transpose() * A;
  for (int d = 0; d < 3; ++d) missing(d, d) += volume / size;
  const Eigen::VectorXd share = A.rowwise().norm();
  const Eigen::Matrix4d moments = linear.transpose() * share.asDiagonal() * linear;
  A += share.asDiagonal() * linear * symmetric_solve(moments, missing);
}

/// Sharp edges between plane faces: edges of the triangles of a curved surface may be as sharp.
std::vector<std::array<int, 2>> edges_of_planes(const Region& region) {
  const auto point = [&](int n) -> const Vec3& { return region.surface_points[n]; };
  std::map<std::array<int, 2>, std::vector<std::size_t>> at;  // edge -> triangles
  std::vector<Vec3> normal;
  for (const auto& t : region.surface_triangles) {
    for (int c = 0; c < 3; ++c) at[ascending(std::array{t[c], t[(c + 1) % 3]})].push_back(normal.size());
    normal.push_back((point(t[1]) - point(t[0])).cross(point(t[2]) - point(t[0])).normalized());
  }
  std::vector<char> plane(normal.size(), 0);
  for (const auto& [edge, of] : at)
    if (of.size() == 2 && normal[of[0]].dot(normal[of[1]]) > 1 - 1e-9) plane[of[0]] = plane[of[1]] = 1;
  std::vector<std::array<int, 2>> edges = sharp_edges(region);
  std::erase_if(edges, [&](const auto& edge) {
    const auto& of = at[edge];
    return of.size() != 2 || !plane[of[0]] || !plane[of[1]];
  });
  return edges;
}

/// The sides of facets that are sharp edges.
struct SharpSides {
  const Region& region;
  const SurfaceInterpolation& interpolation;
  std::vector<std::array<int, 2>> sharp = edges_of_planes(region);

  const Vec3& point(int n) const { return region.surface_points[n]; }

  /// Moves area inwards at those of a facet of `corners` points.
  void thin(const int* facet, int corners, double moment, const NodalVectors& unthinned, PatchShares& shares) const {
    const Vec3 normal = (point(facet[1]) - point(facet[0])).cross(point(facet[2]) - point(facet[0])).normalized();
    for (int c = 0; c < corners; ++c) {
      const int a = facet[c], b = facet[(c + 1) % corners];
      if (std::binary_search(sharp.begin(), sharp.end(), ascending(std::array{a, b})))
        interpolation.thin(point(a), point(b), normal, moment, unthinned, shares);
    }
  }

  void thin(double moment, PatchShares& whole, std::map<std::string, PatchShares>& patches) const {
    const NodalVectors unthinned = whole.normal;
    for (const auto& t : region.surface_triangles) thin(t.data(), 3, moment, unthinned, whole);
    for (const Patch& p : region.patches)
      for (const auto& f : p.facets) thin(f.data(), f[3] < 0 ? 3 : 4, moment, unthinned, patches.at(p.name));
  }
};

}  // namespace

SurfaceShares surface_shares(const Region& region, const Network& network) {
  const SurfaceInterpolation interpolation(region, network);
  const auto point = [&](int n) -> const Vec3& { return region.surface_points[n]; };
  SurfaceShares shares;
  for (const Patch& p : region.patches) {
    PatchShares& patch = shares.patches.emplace(p.name, interpolation.none()).first->second;
    for (const auto& f : p.facets) {
      interpolation.add({point(f[0]), point(f[1]), point(f[2])}, patch);
      if (f[3] >= 0) interpolation.add({point(f[0]), point(f[2]), point(f[3])}, patch);
    }
  }
  PatchShares whole = interpolation.none();
  double excess = 0;
  for (const auto& t : region.surface_triangles)
    excess += interpolation.add({point(t[0]), point(t[1]), point(t[2])}, whole);
  SharpSides{region, interpolation}.thin(excess / whole.area.sum() / laplacian, whole, shares.patches);
  shares.area = std::move(whole.normal);
  meet_gauss(network.X, region.volume, shares.area);
  return shares;
}

std::vector<std::vector<int>> neighbours_of(const Network& network) {
  std::vector<std::vector<int>> neighbours(network.nodes());
  for (const Spring& s : network.springs) {
    neighbours[s.i].push_back(s.j);
    neighbours[s.j].push_back(s.i);
  }
  return neighbours;
}

std::vector<int> connected_with(int node, const std::vector<int>& nodes,
                                const std::vector<std::vector<int>>& neighbours) {
  std::vector<int> found = {node};
  for (std::size_t i = 0; i < found.size(); ++i)
    for (const int n : neighbours[found[i]])
      if (std::binary_search(nodes.begin(), nodes.end(), n) && std::find(found.begin(), found.end(), n) == found.end())
        found.push_back(n);
  return found;
}

SurfaceShares vertex_shares(const Mesh& tetrahedra, const Network& network) {
  const Region region = region_of(tetrahedra);
  const SurfaceInterpolation interpolation(region, network);
  SurfaceShares shares;
  const auto X = [&](int n) -> Vec3 { return tetrahedra.nodes.row(n).transpose(); };
  for (const Patch& p : tetrahedra.patches) {
    PatchShares& patch = shares.patches.emplace(p.name, interpolation.none()).first->second;
    patch.area = nodal_areas(tetrahedra, p);
    for (const auto& f : p.facets)
      for (int corner = 0; corner < 3; ++corner)
        patch.normal.row(f[corner]) += (X(f[1]) - X(f[0])).cross(X(f[2]) - X(f[0])).transpose() / 6;
  }
  double excess = 0, area = 0;
  for (const auto& t : region.surface_triangles) {
    const Vec3 &a = region.surface_points[t[0]], &b = region.surface_points[t[1]], &c = region.surface_points[t[2]];
    const double own = (b - a).cross(c - a).norm() / 2;
    area += own;
    excess += own * ((a - b).squaredNorm() + (b - c).squaredNorm() + (c - a).squaredNorm()) / 12;
  }
  PatchShares whole{Eigen::VectorXd::Zero(network.nodes()), volume_gradient(tetrahedra)};
  SharpSides{region, interpolation}.thin(excess / area / laplacian, whole, shares.patches);
  shares.area = std::move(whole.normal);
  meet_gauss(network.X, region.volume, shares.area);
  return shares;
}

}  // namespace springproof
