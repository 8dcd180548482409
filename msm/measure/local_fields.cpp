#include "msm/measure/local_fields.h"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "msm/algebra/dense.h"
#include "msm/laws/nodal_gradients.h"

namespace springproof {
namespace {

bool planar(const Network& network) {
  const auto z = network.X.col(2);
  return z.maxCoeff() - z.minCoeff() <= 1e-9 * network.X.col(0).cwiseAbs().maxCoeff();
}

/// Fraction of the segment from `a` to `a + d` that lies in the ball.
double fraction_inside(const Vec3& a, const Vec3& d, const Vec3& centre, double radius) {
  const Vec3 from = a - centre;
  const double dd = d.squaredNorm(), middle = -from.dot(d) / dd;
  const double half_squared = middle * middle - (from.squaredNorm() - radius * radius) / dd;
  if (half_squared <= 0) return 0;
  const double half = std::sqrt(half_squared);
  return std::max(0.0, std::min(1.0, middle + half) - std::max(0.0, middle - half));
}

constexpr double central = 0.8;

/// Displacement gradient of the affine field fitted to the displacements of the central nodes by least squares.
Eigen::Matrix3d central_gradient(const Network& network, const NodalVectors& u, const StretchedBlock& block) {
  const Vec3 middle = (block.lower + block.upper) / 2, reach = central / 2 * (block.upper - block.lower);
  std::vector<int> nodes;
  for (int n = 0; n < network.nodes(); ++n)
    if (((network.X.row(n).transpose() - middle).array().abs() <= reach.array() * (1 + 1e-9)).all()) nodes.push_back(n);
  Eigen::MatrixXd basis(nodes.size(), 4);
  basis << Eigen::VectorXd::Ones(static_cast<Eigen::Index>(nodes.size())),
      (network.X(nodes, Eigen::all).rowwise() - middle.transpose());
  const LeastSquares fit = least_squares(basis, u(nodes, Eigen::all));
  if (fit.rank < 4) throw std::invalid_argument("too few nodes in the central region of the block");
  return fit.X.bottomRows(3).transpose();
}

}  // namespace

std::vector<double> linear_tensions(const MassSpringModel& model, const NodalVectors& u) {
  const Network& network = model.network;
  std::vector<double> T;
  T.reserve(network.springs.size());
  for (const Spring& s : network.springs)
    T.push_back(s.stiffness * between(s, u).dot(between(s, network.X).normalized()));
  if (const MomentumDispersion* dispersion = dispersion_of(model)) {
    const MomentumDispersion::Coefficients c = dispersion->coefficients(network);
    Eigen::VectorXd J = Eigen::VectorXd::Zero(network.nodes());
    for (std::size_t n = 0; n < network.springs.size(); ++n) {
      const Spring& s = network.springs[n];
      const double elongation = between(s, u).dot(between(s, network.X).normalized());
      J[dispersion->sink(network, s.i)] += c.in[n][0] * elongation;
      J[dispersion->sink(network, s.j)] += c.in[n][1] * elongation;
    }
    const std::vector<double> dispersed = dispersion->tensions(network, J);
    for (std::size_t s = 0; s < T.size(); ++s) T[s] += dispersed[s];
  }
  return T;
}

Eigen::Matrix3d displacement_gradient(const Network& network, const NodalVectors& u, const Vec3& point, double radius) {
  std::vector<int> near;
  for (int n = 0; n < network.nodes(); ++n)
    if ((network.X.row(n).transpose() - point).squaredNorm() < radius * radius) near.push_back(n);
  const int directions = planar(network) ? 2 : 3;
  Eigen::MatrixXd basis(near.size(), 1 + directions), value(near.size(), 3);
  for (std::size_t m = 0; m < near.size(); ++m) {
    const Vec3 r = (network.X.row(near[m]).transpose() - point) / radius;
    const double root_weight = 1 - r.squaredNorm();
    const auto row = static_cast<Eigen::Index>(m);
    basis(row, 0) = root_weight;
    basis.row(row).tail(directions) = root_weight * r.head(directions).transpose();
    value.row(row) = root_weight * u.row(near[m]);
  }
  const LeastSquares fit = least_squares(basis, value);
  if (fit.rank <= directions)
    throw std::invalid_argument(
        fmt::format("{} nodes within {} m of ({}, {}, {}) do not determine a gradient; take a larger radius",
                    near.size(), radius, point[0], point[1], point[2]));
  Eigen::Matrix3d gradient = Eigen::Matrix3d::Zero();
  gradient.leftCols(directions) = fit.X.bottomRows(directions).transpose() / radius;
  return gradient;
}

Eigen::Matrix3d hardy_stress(const Network& network, const NodalVectors& x, const std::vector<double>& tensions,
                             const Vec3& point, double radius) {
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  for (std::size_t s = 0; s < tensions.size(); ++s) {
    const Vec3 d = between(network.springs[s], x);
    const double fraction = fraction_inside(x.row(network.springs[s].i).transpose(), d, point, radius);
    if (fraction > 0) sum += tensions[s] * fraction / d.norm() * d * d.transpose();
  }
  return sum / (4.0 / 3 * std::numbers::pi * radius * radius * radius);
}

double momentum_flow(const Network& network, const NodalVectors& x, const std::vector<double>& tensions,
                     const Vec3& point, const Vec3& normal) {
  const auto beyond = [&](int n) { return (x.row(n).transpose() - point).dot(normal) >= 0; };
  double sum = 0;
  for (std::size_t s = 0; s < tensions.size(); ++s) {
    const Spring& spring = network.springs[s];
    if (beyond(spring.i) != beyond(spring.j))
      sum += tensions[s] * std::abs(between(spring, x).normalized().dot(normal));
  }
  return sum;
}

double poisson_ratio_of(const Eigen::Matrix3d& e, const Eigen::Matrix3d& s) {
  return (e(0, 0) * s(1, 1) - e(1, 1) * s(0, 0)) / (e(0, 0) * (s(0, 0) + s(2, 2)) - e(1, 1) * (s(1, 1) + s(2, 2)));
}

double poisson_ratio_as_printed(const Eigen::Matrix3d& e, const Eigen::Matrix3d& s) {
  return (e(0, 0) * s(1, 1) - e(1, 1) * s(0, 0)) / (e(0, 0) * (s(0, 0) + s(1, 1)) - e(1, 1) * (s(0, 0) + s(2, 2)));
}

BlockModuli measure_block(const MassSpringModel& model, const NodalVectors& u, const StretchedBlock& block,
                          double radius) {
  const Network& network = model.network;
  const std::vector<double> tensions = linear_tensions(model, u);
  const Vec3 size = block.upper - block.lower, middle = (block.lower + block.upper) / 2;
  const Eigen::Matrix3d mean = central_gradient(network, u, block);

  BlockModuli m{};
  m.force = momentum_flow(network, network.X, tensions, middle, Vec3::UnitX());
  const double stress = m.force / (size[1] * size[2]);
  m.youngs_modulus_nominal = stress / (block.elongation / size[0]);
  m.youngs_modulus_local = stress / mean(0, 0);
  m.poisson_ratio = -(mean(1, 1) + mean(2, 2)) / (2 * mean(0, 0));

  const Vec3 reach = (central / 2 * size.array()).min(size.array() / 2 - radius).max(0.0);
  const int points = 7 * 3 * 3;
  for (int i = -3; i <= 3; ++i)
    for (int j = -1; j <= 1; ++j)
      for (int k = -1; k <= 1; ++k) {
        const Vec3 at = middle + reach.cwiseProduct(Vec3(i / 3.0, j, k));
        const Eigen::Matrix3d gradient = displacement_gradient(network, u, at, radius);
        const Eigen::Matrix3d strain = (gradient + gradient.transpose()) / 2;
        const Eigen::Matrix3d local_stress = hardy_stress(network, network.X, tensions, at, radius);
        m.poisson_ratio_of_fields += poisson_ratio_of(strain, local_stress) / points;
        m.poisson_ratio_as_printed += poisson_ratio_as_printed(strain, local_stress) / points;
      }
  return m;
}

}  // namespace springproof
