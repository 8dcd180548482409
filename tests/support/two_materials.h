// Bodies of two materials, and exact fields in them.
#pragma once

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "problem/material.h"
#include "support/solids.h"

namespace springproof::test {

/// Materials by a rule on the middle of a tetrahedron.
template <class Rule>
Mesh with_materials(Mesh body, const Rule& material) {
  for (const Tetrahedron& t : body.tetrahedra) {
    Vec3 middle = Vec3::Zero();
    for (const int n : t) middle += body.nodes.row(n).transpose() / 4;
    body.materials.push_back(static_cast<std::uint8_t>(material(middle)));
  }
  return body;
}

/// A block of two layers across an axis, material 0 below `at` and 1 above; `cells` along each axis, of which those
/// along the axis are halved between the layers.
inline Mesh layered_block(const Vec3& size, const std::array<int, 3>& cells, int axis, double at) {
  const Mesh even = solid_of(block_mesh(size, cells));
  const double half = size[axis] / 2;
  const Mesh body = mapped(even, [&](Vec3 x) -> Vec3 {
    x[axis] = x[axis] < half ? x[axis] * at / half : at + (x[axis] - half) * (size[axis] - at) / half;
    return x;
  });
  return with_materials(body, [&](const Vec3& x) { return x[axis] > at; });
}

/// A cube of edge 4 about zero with a ball of radius 1, material 1, about `centre`, in both of which `across` cells of
/// the mesh lie along an axis.
inline Mesh ball_in_cube(int across, const Vec3& centre) {
  const Mesh block = solid_of(block_mesh({2, 2, 2}, {2 * across, 2 * across, 2 * across}));
  const auto on_ball = [](const Vec3& q) {
    const Vec3 s = q.cwiseProduct(q);
    Vec3 x;
    for (int i = 0; i < 3; ++i) {
      const double a = s[(i + 1) % 3], b = s[(i + 2) % 3];
      x[i] = q[i] * std::sqrt(1 - a / 2 - b / 2 + a * b / 3);
    }
    return x;
  };
  const Mesh body = mapped(block, [&](const Vec3& p) -> Vec3 {
    const Vec3 q = p - Vec3::Ones();
    const double m = q.cwiseAbs().maxCoeff();
    if (m <= 0.5 + 1e-9) return centre + on_ball(2 * q);
    const double t = 2 * m - 1;
    return (1 - t) * (centre + on_ball(q / m)) + t * 2 * q / m;
  });
  std::vector<char> inside(body.nodes.rows());
  for (Eigen::Index n = 0; n < block.nodes.rows(); ++n)
    inside[n] = (block.nodes.row(n).transpose() - Vec3::Ones()).cwiseAbs().maxCoeff() <= 0.5 + 1e-9;
  Mesh out = body;
  for (const Tetrahedron& t : body.tetrahedra)
    out.materials.push_back(inside[t[0]] && inside[t[1]] && inside[t[2]] && inside[t[3]]);
  return out;
}

/// A part of a rod that moves along itself alone.
struct RodPart {
  double modulus;  ///< [Pa]
  double density;  ///< [kg/m^3]
  double length;   ///< [m]
};

/// First natural frequency [Hz] of a rod of two parts, the first of which is held at its end: tan(w L1/c1) tan(w L2/c2)
/// = Z1/Z2, c^2 = modulus / density, Z^2 = modulus * density.
inline double first_frequency(const RodPart& held, const RodPart& free) {
  constexpr double pi = 3.14159265358979323846;
  const auto time = [](const RodPart& p) { return p.length * std::sqrt(p.density / p.modulus); };
  const auto impedance = [](const RodPart& p) { return std::sqrt(p.modulus * p.density); };
  double low = 0, high = pi / 2 / std::max(time(held), time(free));
  for (int step = 0; step < 100; ++step) {
    const double w = (low + high) / 2;
    const bool below = impedance(free) * std::sin(w * time(held)) * std::sin(w * time(free)) <
                       impedance(held) * std::cos(w * time(held)) * std::cos(w * time(free));
    (below ? low : high) = w;
  }
  return low / (2 * pi);
}

/// A ball of radius 1 about zero in an unbounded body under a strain far away (Eshelby 1957).
struct BallInSpace {
  IsotropicMaterial around, inside;
  Eigen::Matrix3d far;  ///< strain [1]

  /// Strain inside, which is uniform.
  Eigen::Matrix3d strain() const {
    const double nu = around.poisson_ratio, alpha = (1 + nu) / (3 * (1 - nu)),
                 beta = 2 * (4 - 5 * nu) / (15 * (1 - nu));
    const Eigen::Matrix3d mean = far.trace() / 3 * Eigen::Matrix3d::Identity();
    return mean / (1 + alpha * (bulk_modulus(inside) / bulk_modulus(around) - 1)) +
           (far - mean) / (1 + beta * (shear_modulus(inside) / shear_modulus(around) - 1));
  }
  Eigen::Matrix3d stress() const {
    const Eigen::Matrix3d e = strain();
    return lame_lambda(inside) * e.trace() * Eigen::Matrix3d::Identity() + 2 * shear_modulus(inside) * e;
  }
  /// Displacement outside.
  Vec3 displacement(const Vec3& x) const {
    const double nu = around.poisson_ratio, r = x.norm();
    const Eigen::Matrix3d e = strain(), mean = e.trace() / 3 * Eigen::Matrix3d::Identity();
    const double of_mean = e.trace() / 3 * (1 - bulk_modulus(inside) / bulk_modulus(around));
    const Eigen::Matrix3d dev = (1 - shear_modulus(inside) / shear_modulus(around)) * (e - mean);  // eigenstrain
    const Vec3 ex = dev * x;
    const double q = x.dot(ex), r3 = r * r * r, r5 = r3 * r * r, r7 = r5 * r * r;
    return far * x + (1 + nu) / (3 * (1 - nu)) * of_mean / r3 * x +
           (-2 / r3 * ex + 3 * q / r5 * x + (6 / r5 * ex - 15 * q / r7 * x) / 5 + 4 * (1 - nu) / r3 * ex) /
               (6 * (1 - nu));
  }
};

}  // namespace springproof::test
