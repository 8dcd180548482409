#include "comparisons/calculix/quadratic_mesh.h"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <optional>

#include "meshes/locate/locate.h"
#include "meshes/locate/tetrahedron_locator.h"
#include "problem/system/input_error.h"

namespace springproof::calculix {
namespace {

using Corners4 = std::array<int, 4>;

// Edges in the order of their middle nodes.
constexpr std::array<std::array<int, 2>, 12> hexahedron_edges = {
    {{0, 1}, {1, 2}, {2, 3}, {3, 0}, {4, 5}, {5, 6}, {6, 7}, {7, 4}, {0, 4}, {1, 5}, {2, 6}, {3, 7}}};
constexpr std::array<std::array<int, 2>, 6> tetrahedron_edges = {{{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}}};

// S1 ... S6 and S1 ... S4.
constexpr std::array<Corners4, 6> hexahedron_sides = {
    {{0, 1, 2, 3}, {4, 7, 6, 5}, {0, 4, 5, 1}, {1, 5, 6, 2}, {2, 6, 7, 3}, {3, 7, 4, 0}}};
constexpr std::array<Corners4, 4> tetrahedron_sides = {{{0, 1, 2, -1}, {0, 3, 1, -1}, {1, 3, 2, -1}, {2, 3, 0, -1}}};

const std::array<Vec3, 4> tetrahedron_corners = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1)};

Vec3 hexahedron_corner(int corner) {
  const auto& c = hexahedron_corners[corner];
  return {2.0 * c[0] - 1, 2.0 * c[1] - 1, 2.0 * c[2] - 1};
}

Basis hexahedron_basis(const Vec3& xi) {
  Basis b{Eigen::VectorXd(20), {}};
  b.gradient.resize(20, 3);
  for (int n = 0; n < 20; ++n) {
    const bool corner = n < 8;
    const Vec3 at =
        corner
            ? hexahedron_corner(n)
            : Vec3((hexahedron_corner(hexahedron_edges[n - 8][0]) + hexahedron_corner(hexahedron_edges[n - 8][1])) / 2);
    Vec3 f, df;  // the factor of each direction
    for (int d = 0; d < 3; ++d) {
      f[d] = at[d] == 0 ? 1 - xi[d] * xi[d] : (1 + at[d] * xi[d]) / 2;
      df[d] = at[d] == 0 ? -2 * xi[d] : at[d] / 2;
    }
    const double product = f.prod(), last = corner ? at.dot(xi) - 2 : 1;
    const Vec3 slope(df[0] * f[1] * f[2], f[0] * df[1] * f[2], f[0] * f[1] * df[2]);
    b.value[n] = product * last;
    b.gradient.row(n) = slope * last;
    if (corner) b.gradient.row(n) += product * at;
  }
  return b;
}

Basis tetrahedron_basis(const Vec3& xi) {
  Basis b{Eigen::VectorXd(10), {}};
  b.gradient.resize(10, 3);
  const Eigen::Vector4d L(1 - xi.sum(), xi[0], xi[1], xi[2]);
  Eigen::Matrix<double, 4, 3> dL;
  dL << -1, -1, -1, Eigen::Matrix3d::Identity();
  for (int n = 0; n < 4; ++n) {
    b.value[n] = L[n] * (2 * L[n] - 1);
    b.gradient.row(n) = (4 * L[n] - 1) * dL.row(n);
  }
  for (int e = 0; e < 6; ++e) {
    const auto [i, j] = tetrahedron_edges[e];
    b.value[4 + e] = 4 * L[i] * L[j];
    b.gradient.row(4 + e) = 4 * (L[i] * dL.row(j) + L[j] * dL.row(i));
  }
  return b;
}

// Gauss' three points on [0, 1]: exact to degree five.
const std::array<std::pair<double, double>, 3> gauss = {
    {{0.5 - std::sqrt(0.15), 5. / 18}, {0.5, 8. / 18}, {0.5 + std::sqrt(0.15), 5. / 18}}};

struct QuadraturePoint {
  Vec3 xi;
  double weight;
};

/// Quadrature points of the reference element; tetrahedra as collapsed cubes.
std::vector<QuadraturePoint> volume_points(std::size_t nodes) {
  std::vector<QuadraturePoint> points;
  for (const auto& [u, a] : gauss)
    for (const auto& [v, b] : gauss)
      for (const auto& [w, c] : gauss) {
        if (nodes == 20)
          points.push_back({Vec3(2 * u - 1, 2 * v - 1, 2 * w - 1), 8 * a * b * c});
        else
          points.push_back({Vec3(u, v * (1 - u), w * (1 - u) * (1 - v)), a * b * c * (1 - u) * (1 - u) * (1 - v)});
      }
  return points;
}

Eigen::Matrix<double, Eigen::Dynamic, 3> gathered(const std::vector<int>& element, const NodalVectors& field) {
  Eigen::Matrix<double, Eigen::Dynamic, 3> rows(element.size(), 3);
  for (std::size_t i = 0; i < element.size(); ++i) rows.row(i) = field.row(element[i]);
  return rows;
}

/// Calls visit(element, basis, area vector into the body) at the points of one side.
template <class Visit>
void for_each_point(const QuadraticMesh& mesh, const Side& side, const Visit& visit) {
  const std::vector<int>& element = mesh.elements[side.element];
  const auto X = gathered(element, mesh.nodes);
  const bool brick = element.size() == 20;
  const Corners4& corners = brick ? hexahedron_sides[side.face - 1] : tetrahedron_sides[side.face - 1];
  const auto corner = [&](int i) { return brick ? hexahedron_corner(corners[i]) : tetrahedron_corners[corners[i]]; };
  const Vec3 origin = corner(0), along = corner(1) - origin, across = corner(brick ? 3 : 2) - origin;
  for (const auto& [u, a] : gauss)
    for (const auto& [v, b] : gauss) {
      const double second = brick ? v : v * (1 - u), squeeze = brick ? 1 : 1 - u;
      const Basis at = basis(element.size(), origin + u * along + second * across);
      const Eigen::Matrix3d dX = X.transpose() * at.gradient;
      visit(element, at, Vec3(a * b * squeeze * (dX * along).cross(dX * across)));
    }
}

/// Calls visit(element, basis, rest position, volume) at the points of the body.
template <class Visit>
void for_each_point(const QuadraticMesh& mesh, const Visit& visit) {
  for (const std::vector<int>& element : mesh.elements) {
    const auto X = gathered(element, mesh.nodes);
    for (const auto& [xi, weight] : volume_points(element.size())) {
      const Basis at = basis(element.size(), xi);
      const Eigen::Matrix3d dX = X.transpose() * at.gradient;
      visit(element, at, Vec3(X.transpose() * at.value), weight * dX.determinant());
    }
  }
}

class MiddleNodes {
 public:
  explicit MiddleNodes(const NodalVectors& corners) : corners_(corners) {}

  int between(int a, int b) {
    const auto [at, is_new] = number_.try_emplace(std::minmax(a, b), int(corners_.rows() + middles_.size()));
    if (is_new) middles_.push_back((corners_.row(a) + corners_.row(b)) / 2);
    return at->second;
  }

  NodalVectors all_nodes() const {
    NodalVectors nodes(corners_.rows() + static_cast<Eigen::Index>(middles_.size()), 3);
    nodes.topRows(corners_.rows()) = corners_;
    for (std::size_t i = 0; i < middles_.size(); ++i) nodes.row(corners_.rows() + i) = middles_[i];
    return nodes;
  }

 private:
  const NodalVectors& corners_;
  std::map<std::pair<int, int>, int> number_;
  std::vector<Eigen::RowVector3d> middles_;
};

template <class Cell, class Edges>
std::vector<int> with_middles(const Cell& cell, const Edges& edges, MiddleNodes& middles) {
  std::vector<int> nodes(cell.begin(), cell.end());
  for (const auto& [i, j] : edges) nodes.push_back(middles.between(cell[i], cell[j]));
  return nodes;
}

Corners4 sorted(Corners4 nodes) {
  std::ranges::sort(nodes);
  return nodes;
}

/// Every side of every element, by its corner nodes.
std::map<Corners4, Side> sides_by_corners(const Mesh& mesh) {
  std::map<Corners4, Side> sides;
  int element = 0;
  const auto add = [&](const auto& cell, const auto& table) {
    for (std::size_t f = 0; f < table.size(); ++f) {
      Corners4 nodes;
      for (int i = 0; i < 4; ++i) nodes[i] = table[f][i] < 0 ? -1 : cell[table[f][i]];
      sides[sorted(nodes)] = {element, int(f) + 1};
    }
    ++element;
  };
  for (const Hexahedron& cell : mesh.hexahedra) add(cell, hexahedron_sides);
  for (const Tetrahedron& cell : mesh.tetrahedra) add(cell, tetrahedron_sides);
  return sides;
}

/// Nodes of a side, corners and middles: those whose shape function does not vanish on it.
void add_nodes_of(const QuadraticMesh& mesh, const Side& side, std::vector<int>& nodes) {
  const std::vector<int>& element = mesh.elements[side.element];
  const bool brick = element.size() == 20;
  const Corners4& corners = brick ? hexahedron_sides[side.face - 1] : tetrahedron_sides[side.face - 1];
  const auto on_side = [&](int corner) { return std::ranges::find(corners, corner) != corners.end(); };
  const auto visit = [&](const auto& edges, std::size_t first_middle) {
    for (std::size_t i = 0; i < first_middle; ++i)
      if (on_side(int(i))) nodes.push_back(element[i]);
    for (std::size_t e = 0; e < edges.size(); ++e)
      if (on_side(edges[e][0]) && on_side(edges[e][1])) nodes.push_back(element[first_middle + e]);
  };
  brick ? visit(hexahedron_edges, 8) : visit(tetrahedron_edges, 4);
}

struct PlaceInElement {
  std::size_t element;
  Vec3 xi;
};

std::optional<PlaceInElement> place_in_hexahedra(const Mesh& mesh, const Vec3& point) {
  const std::optional<Location> place = locate(mesh, point);
  if (!place) return {};
  // The trilinear shape functions yield the reference coordinates: each is the sum over the corners of one face.
  Vec3 xi = -Vec3::Ones();
  for (int corner = 0; corner < 8; ++corner)
    for (int d = 0; d < 3; ++d) xi[d] += 2 * hexahedron_corners[corner][d] * place->shape[corner];
  return PlaceInElement{place->cell, xi};
}

/// Finds the elements of points.
std::function<std::optional<PlaceInElement>(const Vec3&)> finder(const Mesh& mesh, double reach) {
  if (!mesh.hexahedra.empty()) return [&mesh](const Vec3& point) { return place_in_hexahedra(mesh, point); };
  const double size = (mesh.nodes.colwise().maxCoeff() - mesh.nodes.colwise().minCoeff()).norm();
  const auto locator = std::make_shared<TetrahedronLocator>(mesh.nodes, mesh.tetrahedra);
  return [locator, most = std::max(reach, 1e-9 * size)](const Vec3& point) -> std::optional<PlaceInElement> {
    const TetrahedronLocator::Place place = (*locator)(point);
    if (place.outside > most) return {};
    return PlaceInElement{place.cell, place.weights.tail<3>()};
  };
}

}  // namespace

Basis basis(std::size_t nodes, const Vec3& xi) { return nodes == 20 ? hexahedron_basis(xi) : tetrahedron_basis(xi); }

QuadraticMesh quadratic(const Mesh& mesh) {
  QuadraticMesh out;
  MiddleNodes middles(mesh.nodes);
  for (const Hexahedron& cell : mesh.hexahedra) out.elements.push_back(with_middles(cell, hexahedron_edges, middles));
  for (const Tetrahedron& cell : mesh.tetrahedra)
    out.elements.push_back(with_middles(cell, tetrahedron_edges, middles));
  out.nodes = middles.all_nodes();
  const std::map<Corners4, Side> sides = sides_by_corners(mesh);
  for (const Patch& p : mesh.patches) {
    QuadraticPatch patch{p.name, {}, {}};
    for (const auto& facet : p.facets) {
      patch.sides.push_back(sides.at(sorted(facet)));
      add_nodes_of(out, patch.sides.back(), patch.nodes);
    }
    std::ranges::sort(patch.nodes);
    patch.nodes.erase(std::unique(patch.nodes.begin(), patch.nodes.end()), patch.nodes.end());
    out.patches.push_back(std::move(patch));
  }
  return out;
}

Eigen::VectorXd nodal_areas(const QuadraticMesh& mesh, const QuadraticPatch& patch) {
  Eigen::VectorXd areas = Eigen::VectorXd::Zero(mesh.nodes.rows());
  for (const Side& side : patch.sides)
    for_each_point(mesh, side, [&](const auto& element, const Basis& at, const Vec3& area) {
      for (std::size_t i = 0; i < element.size(); ++i) areas[element[i]] += area.norm() * at.value[i];
    });
  return areas;
}

NodalVectors nodal_area_vectors(const QuadraticMesh& mesh, const QuadraticPatch& patch) {
  NodalVectors areas = NodalVectors::Zero(mesh.nodes.rows(), 3);
  for (const Side& side : patch.sides)
    for_each_point(mesh, side, [&](const auto& element, const Basis& at, const Vec3& area) {
      for (std::size_t i = 0; i < element.size(); ++i) areas.row(element[i]) += at.value[i] * area.transpose();
    });
  return areas;
}

NodalVectors nodal_body_forces(const QuadraticMesh& mesh, const std::function<Vec3(const Vec3&)>& body_force) {
  NodalVectors forces = NodalVectors::Zero(mesh.nodes.rows(), 3);
  for_each_point(mesh, [&](const auto& element, const Basis& at, const Vec3& X, double volume) {
    const Vec3 force = volume * body_force(X);
    for (std::size_t i = 0; i < element.size(); ++i) forces.row(element[i]) += at.value[i] * force.transpose();
  });
  return forces;
}

Eigen::VectorXd nodal_volumes(const QuadraticMesh& mesh) {
  Eigen::VectorXd volumes = Eigen::VectorXd::Zero(mesh.nodes.rows());
  for_each_point(mesh, [&](const auto& element, const Basis& at, const Vec3&, double volume) {
    for (std::size_t i = 0; i < element.size(); ++i) volumes[element[i]] += volume * at.value[i];
  });
  return volumes;
}

NodalWeights weights_at(const QuadraticMesh& mesh, const Mesh& linear, const NodalVectors& points, double reach) {
  std::vector<Eigen::Triplet<double>> entries;
  const auto find = finder(linear, reach);
  for (Eigen::Index p = 0; p < points.rows(); ++p) {
    const std::optional<PlaceInElement> place = find(points.row(p).transpose());
    if (!place)
      throw InputError(fmt::format("the point ({:.6g}, {:.6g}, {:.6g}) m lies in no element of the body", points(p, 0),
                                   points(p, 1), points(p, 2)));
    const std::vector<int>& nodes = mesh.elements[place->element];
    const Eigen::VectorXd shape = basis(nodes.size(), place->xi).value;
    for (std::size_t i = 0; i < nodes.size(); ++i)
      entries.emplace_back(static_cast<int>(p), nodes[i], shape[static_cast<Eigen::Index>(i)]);
  }
  NodalWeights weights(points.rows(), mesh.nodes.rows());
  weights.setFromTriplets(entries.begin(), entries.end());
  return weights;
}

VolumeChange volume_change(const QuadraticMesh& mesh, const NodalVectors& displacement) {
  double rest = 0, gained = 0, divergence = 0;
  for (const std::vector<int>& element : mesh.elements) {
    const auto X = gathered(element, mesh.nodes), u = gathered(element, displacement);
    for (const auto& [xi, weight] : volume_points(element.size())) {
      const Basis at = basis(element.size(), xi);
      const Eigen::Matrix3d dX = X.transpose() * at.gradient;
      const Eigen::Matrix3d H = u.transpose() * at.gradient * dX.inverse();
      const double volume = weight * dX.determinant();
      rest += volume;
      divergence += volume * H.trace();
      // det(I + H) - 1 without cancellation
      gained += volume * (H.trace() + (H.trace() * H.trace() - (H * H).trace()) / 2 + H.determinant());
    }
  }
  return {gained / rest, divergence / rest};
}

}  // namespace springproof::calculix
