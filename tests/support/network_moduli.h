// Moduli of a linear spring network, by its own small assembly: independent of the library's solvers.
#pragma once

#include <Eigen/Geometry>
#include <Eigen/IterativeLinearSolvers>
#include <Eigen/SparseCore>
#include <algorithm>
#include <vector>

#include "msm/topology/network.h"

namespace springproof::test {

/// Number of the node that carries the unknowns of node n.
inline int carrier(const Network& network, int n) { return network.image_of.empty() ? n : network.image_of[n]; }

inline Eigen::SparseMatrix<double> stiffness(const Network& network, const std::vector<char>& fixed) {
  std::vector<Eigen::Triplet<double>> entries;
  const auto add = [&](int row, int column, double value) {
    if (!fixed[row] && !fixed[column]) entries.emplace_back(row, column, value);
  };
  for (const Spring& s : network.springs) {
    const Vec3 n = (network.X.row(s.j) - network.X.row(s.i)).transpose() / s.rest_length;
    const int i = 3 * carrier(network, s.i), j = 3 * carrier(network, s.j);
    for (int a = 0; a < 3; ++a)
      for (int b = 0; b < 3; ++b) {
        const double k = s.stiffness * n[a] * n[b];
        add(i + a, i + b, k);
        add(j + a, j + b, k);
        add(i + a, j + b, -k);
        add(j + a, i + b, -k);
      }
  }
  for (std::size_t u = 0; u < fixed.size(); ++u)
    if (fixed[u]) entries.emplace_back(u, u, 1.0);
  Eigen::SparseMatrix<double> K(3 * network.nodes(), 3 * network.nodes());
  K.setFromTriplets(entries.begin(), entries.end());
  return K;
}

inline Eigen::VectorXd solve(const Eigen::SparseMatrix<double>& K, const Eigen::VectorXd& f) {
  Eigen::ConjugateGradient<Eigen::SparseMatrix<double>, Eigen::Lower | Eigen::Upper> solver(K);
  solver.setTolerance(1e-9);
  solver.setMaxIterations(20000);
  return solver.solve(f);
}

/// Forces that hold the network in place under affine displacement grad * X, on the carriers.
inline Eigen::VectorXd affine_forces(const Network& network, const Eigen::Matrix3d& grad) {
  Eigen::VectorXd f = Eigen::VectorXd::Zero(3 * network.nodes());
  for (const Spring& s : network.springs) {
    const Vec3 d = (network.X.row(s.j) - network.X.row(s.i)).transpose(), n = d / s.rest_length;
    const Vec3 pull = s.stiffness * n.dot(grad * d) * n;
    f.segment<3>(3 * carrier(network, s.i)) -= pull;
    f.segment<3>(3 * carrier(network, s.j)) += pull;
  }
  return f;
}

/// sum k (n.grad d)^2 for two gradients.
inline double affine_product(const Network& network, const Eigen::Matrix3d& a, const Eigen::Matrix3d& b) {
  double sum = 0;
  for (const Spring& s : network.springs) {
    const Vec3 d = (network.X.row(s.j) - network.X.row(s.i)).transpose(), n = d / s.rest_length;
    sum += s.stiffness * n.dot(a * d) * n.dot(b * d);
  }
  return sum;
}

struct Moduli {
  double E, nu;
};

/// Isotropic part of the stiffness of a periodic network, nodes relaxed.
inline Moduli periodic_moduli(const Network& network) {
  std::vector<char> fixed(3 * network.nodes(), 0);
  for (int n = 0; n < network.nodes(); ++n)
    if (n == 0 || carrier(network, n) != n) fixed[3 * n] = fixed[3 * n + 1] = fixed[3 * n + 2] = 1;
  const auto K = stiffness(network, fixed);
  std::vector<Eigen::Matrix3d> strains(6, Eigen::Matrix3d::Zero());
  for (int a = 0; a < 3; ++a) {
    strains[a](a, a) = 1;
    strains[3 + a](a, (a + 1) % 3) = strains[3 + a]((a + 1) % 3, a) = 0.5;
  }
  std::vector<Eigen::VectorXd> f, u;
  for (const auto& strain : strains) {
    f.push_back(affine_forces(network, strain));
    for (std::size_t i = 0; i < fixed.size(); ++i)
      if (fixed[i]) f.back()[i] = 0;
    u.push_back(solve(K, f.back()));
  }
  const double V = network.volume.sum();
  const auto C = [&](int a, int b) { return (affine_product(network, strains[a], strains[b]) - f[a].dot(u[b])) / V; };
  const double c11 = (C(0, 0) + C(1, 1) + C(2, 2)) / 3, c12 = (C(0, 1) + C(1, 2) + C(0, 2)) / 3,
               c44 = (C(3, 3) + C(4, 4) + C(5, 5)) / 3;
  const double mu = (c11 - c12 + 3 * c44) / 5, bulk = (c11 + 2 * c12) / 3, lambda = bulk - 2 * mu / 3;
  return {mu * (3 * lambda + 2 * mu) / (lambda + mu), lambda / (2 * (lambda + mu))};
}

/// Uniaxial strain 1 along x between slipping plates on the faces of the box [lower, upper]: E from the end force;
/// nu from the mean lateral displacement of the y and z faces.
inline Moduli block_moduli(const Network& network, const Vec3& lower, const Vec3& upper) {
  const double tolerance = 1e-9 * (upper - lower).norm();
  std::vector<char> fixed(3 * network.nodes(), 0);
  Eigen::VectorXd given = Eigen::VectorXd::Zero(3 * network.nodes());
  std::vector<int> bottom, top;
  for (int n = 0; n < network.nodes(); ++n) {
    if (network.X(n, 0) < lower[0] + tolerance) bottom.push_back(n);
    if (network.X(n, 0) > upper[0] - tolerance) top.push_back(n);
  }
  for (const int n : bottom) fixed[3 * n] = 1;
  for (const int n : top) {
    fixed[3 * n] = 1;
    given[3 * n] = upper[0] - lower[0];
  }
  const auto by_y = [&](int a, int b) { return network.X(a, 1) < network.X(b, 1); };
  const int near = *std::min_element(bottom.begin(), bottom.end(), by_y),
            far = *std::max_element(bottom.begin(), bottom.end(), by_y);
  fixed[3 * near + 1] = fixed[3 * near + 2] = fixed[3 * far + 2] = 1;  // rigid motions, no force
  const auto full = stiffness(network, std::vector<char>(fixed.size(), 0));
  Eigen::VectorXd load = -full * given;
  for (std::size_t i = 0; i < fixed.size(); ++i)
    if (fixed[i]) load[i] = given[i];
  const Eigen::VectorXd u = solve(stiffness(network, fixed), load);
  const Eigen::VectorXd force = full * u;
  double F = 0;
  for (const int n : top) F += force[3 * n];
  const Vec3 size = upper - lower;
  double lateral = 0;
  for (const int axis : {1, 2}) {
    double low = 0, high = 0;
    int lows = 0, highs = 0;
    for (int n = 0; n < network.nodes(); ++n) {
      if (network.X(n, axis) < lower[axis] + tolerance) low += u[3 * n + axis], ++lows;
      if (network.X(n, axis) > upper[axis] - tolerance) high += u[3 * n + axis], ++highs;
    }
    lateral += (high / highs - low / lows) / size[axis] / 2;
  }
  return {F / (size[1] * size[2]), -lateral};
}

}  // namespace springproof::test
