#include "msm/embedding/supports.h"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <numbers>
#include <numeric>
#include <stdexcept>

namespace springproof {
namespace {

constexpr double least_spread = 1e-6;    // of an edge: below it the quotient of moments is round-off
constexpr double least_of_E = 1e-3;      // of E: what holds the node of an anchor across where it is free
constexpr double confined_above = 0.45;  // Poisson's ratio from which bonds are stiffer across an interface

/// The part of a patch in a cell as a plate: moments of its area, of the first and second order.
struct Part {
  const PatchInCell& of;
  const CutCell& cell;
  double area = 0;
  Vec3 centroid = Vec3::Zero();                      ///< [m]
  Eigen::Matrix3d second = Eigen::Matrix3d::Zero();  ///< about it, over the area [m^2]
  std::array<Vec3, 8> first;                         ///< R_a [m]

  Part(const CutBody& body, const PatchInCell& p) : of(p), cell(body.cells[p.cell]), area(p.total_area()) {
    const Vec3 centre = body.centre(p.cell);
    Vec3 from_centre = Vec3::Zero();
    for (const Vec3& m : p.moment) from_centre += m / area;
    centroid = centre + from_centre;
    for (int n = 0; n < 8; ++n) {
      first[n] = (p.moment[n] - p.area[n] * from_centre) / area;
      // x = sum N_a X_a in a cell
      second += (body.points.row(cell.corners[n]).transpose() - centroid) * first[n].transpose();
    }
    second = (second + second.transpose()).eval() / 2;
  }

  /// Weights m of the corners.
  std::array<double, 8> mean() const {
    std::array<double, 8> m;
    for (int n = 0; n < 8; ++n) m[n] = of.area[n] / area;
    return m;
  }
};

/// Second moments of some parts in a plane: of each about its own centroid, and about the common one.
struct SharedMoments {
  Eigen::Matrix2d own = Eigen::Matrix2d::Zero(), common = Eigen::Matrix2d::Zero();

  SharedMoments(const std::vector<Part>& parts, const std::vector<int>& some,
                const Eigen::Matrix<double, 3, 2>& plane) {
    double area = 0;
    Vec3 centroid = Vec3::Zero();
    for (const int p : some) {
      area += parts[p].area;
      centroid += parts[p].area * parts[p].centroid;
    }
    centroid /= area;
    for (const int p : some) {
      const Eigen::Vector2d d = plane.transpose() * (parts[p].centroid - centroid);
      own += parts[p].area / area * plane.transpose() * parts[p].second * plane;
      common += parts[p].area / area * d * d.transpose();
    }
    common += own;
  }
};

/// What the moments of a part are held by: the rows G are gain T^T R_a.
struct Gain {
  Eigen::Matrix<double, 3, 2> plane;
  Eigen::Matrix2d gain;

  /// From the numbers of the parts at its cell's nodes.
  Gain(const std::vector<Part>& parts, int number, const std::vector<int>& near, double edge) {
    const Part& part = parts[number];
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(part.second);  // ascending
    plane = axes.eigenvectors().rightCols<2>();
    const Eigen::Vector2d spread = axes.eigenvalues().tail<2>().cwiseMax(0).cwiseSqrt();
    Eigen::Vector2d inverse;
    for (int j = 0; j < 2; ++j) inverse[j] = spread[j] > least_spread * edge ? 1 / (spread[j] * spread[j]) : 0;
    SharedMoments moments(parts, near, plane);
    moments.common += std::pow(least_spread * edge, 2) * Eigen::Matrix2d::Identity();
    gain = spread.asDiagonal() * moments.common.inverse() * moments.own * inverse.asDiagonal();
  }

  /// Weights of the corners of the cell of a part in its spring number q.
  std::array<double, 8> weights(const Part& part, std::size_t q) const {
    const double theta = 2 * std::numbers::pi * static_cast<double>(q) / bonds_of_part;
    std::array<double, 8> w;
    for (int n = 0; n < 8; ++n) {
      const Eigen::Vector2d G = gain * (plane.transpose() * part.first[n]);
      w[n] = part.of.area[n] / part.area + std::numbers::sqrt2 * (std::cos(theta) * G[0] + std::sin(theta) * G[1]);
    }
    return w;
  }
};

/// Per part, those that have a corner of its cell, itself among them.
std::vector<std::vector<int>> parts_nearby(const std::vector<Part>& parts) {
  std::map<int, std::vector<int>> at;  // node -> parts
  for (std::size_t p = 0; p < parts.size(); ++p)
    for (const int n : parts[p].cell.corners) at[n].push_back(static_cast<int>(p));
  std::vector<std::vector<int>> near(parts.size());
  for (std::size_t p = 0; p < parts.size(); ++p) {
    for (const int n : parts[p].cell.corners) near[p].insert(near[p].end(), at[n].begin(), at[n].end());
    std::sort(near[p].begin(), near[p].end());
    near[p].erase(std::unique(near[p].begin(), near[p].end()), near[p].end());
  }
  return near;
}

Vec3 mean_normal(const Part& part) {
  return std::accumulate(part.of.normal.begin(), part.of.normal.end(), Vec3(0, 0, 0)) / part.area;
}

/// Of a confined strain [Pa]: lambda + 2 G.
double modulus_across(const IsotropicMaterial& m) { return lame_lambda(m) + 2 * shear_modulus(m); }

double harmonic_mean(double a, double b) { return 2 / (1 / a + 1 / b); }

/// Of an interface between two materials, times the edge of the cell [N].
Eigen::Matrix3d bond_stiffness(const Part& part, const IsotropicMaterial& a, const IsotropicMaterial& b) {
  const double along = harmonic_mean(a.youngs_modulus, b.youngs_modulus);
  Eigen::Matrix3d K = along * Eigen::Matrix3d::Identity();
  if (std::max(a.poisson_ratio, b.poisson_ratio) > confined_above) {
    const Vec3 n = mean_normal(part);
    K += (harmonic_mean(modulus_across(a), modulus_across(b)) - along) * n * n.transpose();
  }
  return anchor_stiffness * part.area * K;
}

}  // namespace

void require_materials(const CutBody& body, std::size_t materials) {
  for (const CutCell& cell : body.cells)
    if (static_cast<std::size_t>(cell.material) >= materials)
      throw std::invalid_argument(fmt::format("the body has a material of number {}; {} {} given", cell.material,
                                              materials, materials == 1 ? "material is" : "materials are"));
}

std::vector<Anchor> anchors_of_patch(const CutBody& body, const std::string& patch,
                                     const std::vector<IsotropicMaterial>& materials) {
  require_materials(body, materials.size());
  return anchors_of_patch(body, patch, [&](int cell) { return materials[body.cells[cell].material]; });
}

std::vector<Anchor> anchors_of_patch(const CutBody& body, const std::string& patch,
                                     const std::function<IsotropicMaterial(int cell)>& material_of) {
  std::vector<Part> parts;
  for (const PatchInCell& p : body.patches.at(patch)) parts.emplace_back(body, p);
  const std::vector<std::vector<int>> near = parts_nearby(parts);
  std::vector<Anchor> anchors;
  for (std::size_t p = 0; p < parts.size(); ++p) {
    const Part& part = parts[p];
    const double edge = body.grid.edge * part.cell.size;
    const Gain gain(parts, static_cast<int>(p), near[p], edge);
    const IsotropicMaterial material = material_of(part.of.cell);
    const double k = anchor_stiffness * part.area / edge;
    const Eigen::Matrix3d E = material.youngs_modulus * Eigen::Matrix3d::Identity();
    for (std::size_t q = 0; q < bonds_of_part; ++q)
      anchors.push_back({part.cell.corners, gain.weights(part, q), -1, k / bonds_of_part * E});
    const Vec3 n = mean_normal(part);
    anchors.push_back(
        {part.cell.corners, part.mean(), -1,
         k * ((modulus_across(material) - material.youngs_modulus) * n * n.transpose() + least_of_E * E)});
  }
  return anchors;
}

std::vector<InterfaceBond> bonds_of_interfaces(const CutBody& body, const std::vector<IsotropicMaterial>& materials) {
  std::array<std::vector<Part>, 2> parts;
  for (const InterfaceInCells& i : body.interfaces)
    for (int side = 0; side < 2; ++side) parts[side].emplace_back(body, i.sides[side]);
  const std::vector<std::vector<int>> near[2] = {parts_nearby(parts[0]), parts_nearby(parts[1])};
  std::vector<InterfaceBond> bonds;
  for (std::size_t p = 0; p < body.interfaces.size(); ++p) {
    const Part &first = parts[0][p], &second = parts[1][p];
    std::vector<int> either;
    std::set_union(near[0][p].begin(), near[0][p].end(), near[1][p].begin(), near[1][p].end(),
                   std::back_inserter(either));
    const double edge = body.grid.edge * std::max(first.cell.size, second.cell.size);
    const Gain gain(parts[0], static_cast<int>(p), either, edge);
    const Eigen::Matrix3d K = bond_stiffness(first, materials[first.cell.material], materials[second.cell.material]);
    for (std::size_t q = 0; q < bonds_of_part; ++q)
      bonds.push_back({{first.cell.corners, second.cell.corners},
                       {gain.weights(first, q), gain.weights(second, q)},
                       K / (edge * bonds_of_part)});
  }
  return bonds;
}

}  // namespace springproof
