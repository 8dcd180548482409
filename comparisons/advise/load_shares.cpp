#include "comparisons/advise/pilot.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

#include "msm/algebra/dense.h"

namespace springproof {
namespace {

/// A cell's centre and mean strain, and how its strain varies: mixed second derivatives of the trilinear displacement,
/// (p, q): d2 u_p / dx_p dx_q, the tilt of its faces across p, and twist_p, d2 u_p / dx_q dx_r.
struct CellStrain {
  Vec3 centre, edge;
  Eigen::Matrix3d strain, tilt;
  Vec3 twist;
};

CellStrain strain_of(const Mesh& mesh, const Hexahedron& cell, const NodalVectors& u) {
  const Vec3 edge = (mesh.nodes.row(cell[6]) - mesh.nodes.row(cell[0])).transpose();
  CellStrain out{Vec3::Zero(), edge, Eigen::Matrix3d::Zero(), Eigen::Matrix3d::Zero(), Vec3::Zero()};
  for (int n = 0; n < 8; ++n) {
    out.centre += mesh.nodes.row(cell[n]).transpose() / 8;
    const auto side = [&](int d) { return hexahedron_corners[n][d] ? 1 : -1; };
    for (int p = 0; p < 3; ++p) {
      const int q = (p + 1) % 3, r = (p + 2) % 3;
      out.strain.col(p) += side(p) / (4 * edge[p]) * u.row(cell[n]).transpose();
      for (const int across : {q, r})
        out.tilt(p, across) += side(p) * side(across) / (2 * edge[p] * edge[across]) * u(cell[n], p);
      out.twist[p] += side(q) * side(r) / (2 * edge[q] * edge[r]) * u(cell[n], p);
    }
  }
  out.strain = ((out.strain + out.strain.transpose()) / 2).eval();
  return out;
}

/// Per volume: of the mean strain, and of bending and torsion within the cell.
double energy_of(const CellStrain& c, const IsotropicMaterial& m) {
  const Eigen::Matrix3d& e = c.strain;
  double sum = shear_modulus(m) * e.squaredNorm() + lame_lambda(m) / 2 * e.trace() * e.trace();
  for (int p = 0; p < 3; ++p) {
    const int q = (p + 1) % 3, r = (p + 2) % 3;
    sum += m.youngs_modulus / 24 * c.tilt.row(p).transpose().cwiseProduct(c.edge).squaredNorm();
    sum += shear_modulus(m) / 24 * std::pow((c.twist[q] + c.twist[r]) * c.edge[p], 2);
  }
  return sum;
}

/// Sum over the cells of a section, per unit of a cell's volume.
LoadShares section_energies(const std::vector<CellStrain>& cells, int axis, const IsotropicMaterial& m) {
  const int y = (axis + 1) % 3, z = (axis + 2) % 3;
  const double count = static_cast<double>(cells.size());
  Vec3 centre = Vec3::Zero(), mean = Vec3::Zero();
  for (const CellStrain& c : cells) {
    centre += c.centre / count;
    mean += Vec3(c.strain(axis, axis), 2 * c.strain(axis, y), 2 * c.strain(axis, z)) / count;
  }
  Eigen::Matrix2d second = Eigen::Matrix2d::Zero();
  Eigen::Vector2d first = Eigen::Vector2d::Zero();
  double polar = 0, turn = 0;
  for (const CellStrain& c : cells) {
    const Eigen::Vector2d r(c.centre[y] - centre[y], c.centre[z] - centre[z]);
    const Eigen::Vector2d own = Eigen::Vector2d(c.edge[y], c.edge[z]).array().square() / 12;  // of the cell's section
    second += r * r.transpose();
    second.diagonal() += own;
    first += r * (c.strain(axis, axis) - mean[0]) + own.cwiseProduct(Eigen::Vector2d(c.tilt(axis, y), c.tilt(axis, z)));
    polar += r.squaredNorm() + own.sum();
    turn += 2 * (c.strain(axis, z) * r[0] - c.strain(axis, y) * r[1]) + own[0] * (c.twist[z] + c.twist[axis]) -
            own[1] * (c.twist[y] + c.twist[axis]);
  }
  const double E = m.youngs_modulus, G = shear_modulus(m);
  LoadShares out;
  out.axial = E / 2 * mean[0] * mean[0] * count;
  out.shear = G / 2 * (mean[1] * mean[1] + mean[2] * mean[2]) * count;
  if (polar > 0) out.torsion = G / 2 * turn * turn / polar;
  const Eigen::Vector2d tilt = least_squares(second, first).X;
  out.bending = E / 2 * tilt.dot(second * tilt);
  return out;
}

LoadShares shares_about(const Mesh& mesh, const std::vector<CellStrain>& cells, const IsotropicMaterial& material,
                        int axis) {
  std::map<long, std::vector<CellStrain>> sections;
  const double edge = std::abs(mesh.nodes(mesh.hexahedra[0][6], axis) - mesh.nodes(mesh.hexahedra[0][0], axis));
  double whole = 0;
  for (const CellStrain& c : cells) {
    whole += energy_of(c, material);
    sections[std::lround(2 * c.centre[axis] / edge)].push_back(c);
  }
  LoadShares sum;
  for (const auto& [place, section] : sections) {
    const LoadShares s = section_energies(section, axis, material);
    sum.axial += s.axial;
    sum.bending += s.bending;
    sum.torsion += s.torsion;
    sum.shear += s.shear;
  }
  const double named = sum.axial + sum.bending + sum.torsion + sum.shear, all = std::max(whole, named);
  if (!(all > 0)) return {0, 0, 0, 0, 1, axis};
  return {sum.axial / all, sum.bending / all, sum.torsion / all, sum.shear / all, 1 - named / all, axis};
}

}  // namespace

std::string LoadShares::largest() const {
  const std::pair<double, const char*> all[] = {
      {axial, "axial"}, {bending, "bending"}, {torsion, "torsion"}, {shear, "shear"}};
  return std::max_element(std::begin(all), std::end(all), [](auto& a, auto& b) { return a.first < b.first; })->second;
}

LoadShares load_shares(const Mesh& mesh, const NodalVectors& u, const IsotropicMaterial& material) {
  constexpr double clearly = 0.01;
  std::vector<CellStrain> cells;
  for (const Hexahedron& cell : mesh.hexahedra) cells.push_back(strain_of(mesh, cell, u));
  const Vec3 span = (mesh.nodes.colwise().maxCoeff() - mesh.nodes.colwise().minCoeff()).transpose();
  std::array<int, 3> axes = {0, 1, 2};
  std::ranges::sort(axes, [&](int a, int b) { return span[a] < span[b]; });
  LoadShares best = shares_about(mesh, cells, material, axes[0]);
  for (const int axis : {axes[1], axes[2]})
    if (const LoadShares s = shares_about(mesh, cells, material, axis); s.local < best.local - clearly) best = s;
  return best;
}

}  // namespace springproof
