#include "msm/embedding/supports.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

namespace springproof {
namespace {

constexpr double least_spread = 1e-6;  // of an edge: below it the quotient of moments is round-off

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

/// The rows G of a part, 2 x 8, from the numbers of the parts at its cell's nodes.
Eigen::Matrix<double, 2, 8> moment_rows(const std::vector<Part>& parts, int number, const std::vector<int>& near,
                                        double edge) {
  const Part& part = parts[number];
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(part.second);  // ascending
  const Eigen::Matrix<double, 3, 2> plane = axes.eigenvectors().rightCols<2>();
  const Eigen::Vector2d spread = axes.eigenvalues().tail<2>().cwiseMax(0).cwiseSqrt();
  Eigen::Vector2d inverse;
  for (int j = 0; j < 2; ++j) inverse[j] = spread[j] > least_spread * edge ? 1 / (spread[j] * spread[j]) : 0;
  SharedMoments moments(parts, near, plane);
  moments.common += std::pow(least_spread * edge, 2) * Eigen::Matrix2d::Identity();
  const Eigen::Matrix2d gain = spread.asDiagonal() * moments.common.inverse() * moments.own * inverse.asDiagonal();
  Eigen::Matrix<double, 2, 8> G;
  for (int n = 0; n < 8; ++n) G.col(n) = gain * (plane.transpose() * part.first[n]);
  return G;
}

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

}  // namespace

std::vector<Anchor> anchors_of_patch(const CutBody& body, const std::string& patch, double youngs_modulus) {
  std::vector<Part> parts;
  for (const PatchInCell& p : body.patches.at(patch)) parts.emplace_back(body, p);
  const std::vector<std::vector<int>> near = parts_nearby(parts);
  std::vector<Anchor> anchors;
  for (std::size_t p = 0; p < parts.size(); ++p) {
    const Part& part = parts[p];
    const double edge = body.grid.edge * part.cell.size;
    const Eigen::Matrix<double, 2, 8> G = moment_rows(parts, static_cast<int>(p), near[p], edge);
    for (std::size_t q = 0; q < anchors_of_part; ++q) {
      const double theta = 2 * std::numbers::pi * static_cast<double>(q) / anchors_of_part;
      Anchor& anchor = anchors.emplace_back();
      anchor.corners = part.cell.corners;
      anchor.node = -1;
      anchor.stiffness = anchor_stiffness / anchors_of_part * youngs_modulus * part.area / edge;
      for (int n = 0; n < 8; ++n)
        anchor.weights[n] =
            part.of.area[n] / part.area + std::numbers::sqrt2 * (std::cos(theta) * G(0, n) + std::sin(theta) * G(1, n));
    }
  }
  return anchors;
}

}  // namespace springproof
