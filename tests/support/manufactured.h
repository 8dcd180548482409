// Motions known in closed form, and the body forces that cause them.
#pragma once

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <functional>
#include <numbers>

#include "problem/material.h"
#include "problem/vector.h"

namespace springproof::test {

/// Positions x(X, t) [m], smooth over lengths of 1 m and times of 1 s.
using ClosedMotion = std::function<Vec3(const Vec3& X, double t)>;

/// First Piola-Kirchhoff stress [Pa] at a deformation gradient.
using PiolaStress = std::function<Eigen::Matrix3d(const Eigen::Matrix3d& F)>;

/// Hyperelastic laws by their Kirchhoff stress, P = tau F^-T.
inline PiolaStress neo_hookean(const IsotropicMaterial& m) {
  return [G = shear_modulus(m), lambda = lame_lambda(m)](const Eigen::Matrix3d& F) -> Eigen::Matrix3d {
    const Eigen::Matrix3d I = Eigen::Matrix3d::Identity();
    return (G * (F * F.transpose() - I) + lambda * std::log(F.determinant()) * I) * F.inverse().transpose();
  };
}
inline PiolaStress hencky(const IsotropicMaterial& m) {
  return [G = shear_modulus(m), lambda = lame_lambda(m)](const Eigen::Matrix3d& F) -> Eigen::Matrix3d {
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> b(F * F.transpose());
    const Eigen::Matrix3d& n = b.eigenvectors();
    const Eigen::Matrix3d tau = n * (G * b.eigenvalues().array().log()).matrix().asDiagonal() * n.transpose();
    return (tau + lambda * std::log(F.determinant()) * Eigen::Matrix3d::Identity()) * F.inverse().transpose();
  };
}

/// Of small strains: Hooke's.
inline PiolaStress linear_elastic(const IsotropicMaterial& m) {
  return [G = shear_modulus(m), lambda = lame_lambda(m)](const Eigen::Matrix3d& F) -> Eigen::Matrix3d {
    const Eigen::Matrix3d I = Eigen::Matrix3d::Identity();
    return G * (F + F.transpose() - 2 * I) + lambda * (F.trace() - 3) * I;
  };
}

/// Order of two errors, the second with half of the first's edges or steps; docs/scripts/orders.sh makes a row of a
/// page of it.
inline double recorded_order(const std::string& what, const std::string& field, double expected, double coarse,
                             double fine) {
  const double order = std::log2(coarse / fine);
  testing::Test::RecordProperty("order",
                                fmt::format("| {} | {} | {} | {:.1f} | {:.2g} % |", what, field,
                                            expected > 0 ? fmt::format("{:g}", expected) : "none", order, 100 * fine));
  return order;
}

/// df/ds at 0 by central differences of eighth order: 1e-9 of what varies over a length of 1.
template <class Function>
auto derivative(const Function& f) {
  constexpr double weight[] = {4. / 5, -1. / 5, 4. / 105, -1. / 280}, h = 1e-2;
  std::decay_t<decltype(f(h))> sum = weight[0] / h * (f(h) - f(-h));
  for (int k = 2; k <= 4; ++k) sum += weight[k - 1] / h * (f(k * h) - f(-k * h));
  return sum;
}

inline Eigen::Matrix3d deformation_gradient(const ClosedMotion& x, const Vec3& X, double t) {
  Eigen::Matrix3d F;
  for (int j = 0; j < 3; ++j) F.col(j) = derivative([&](double s) { return Vec3(x(X + s * Vec3::Unit(j), t)); });
  return F;
}

/// rho d2x/dt2 - Div P [N/m^3 of the body at rest].
inline Vec3 body_force(const ClosedMotion& x, const PiolaStress& P, double density, const Vec3& X, double t) {
  const auto velocity = [&](double at) { return derivative([&](double s) { return Vec3(x(X, at + s)); }); };
  Vec3 f = density * derivative([&](double s) { return Vec3(velocity(t + s)); });
  for (int j = 0; j < 3; ++j)
    f -= derivative([&](double s) { return Vec3(P(deformation_gradient(x, X + s * Vec3::Unit(j), t)).col(j)); });
  return f;
}

/// Of the unit cube, whose surface stays: strains of some 0.3 at `growth` 1.
inline ClosedMotion bulge(std::function<double(double)> growth) {
  return [growth](const Vec3& X, double t) -> Vec3 {
    const auto s = [](double a) { return std::sin(std::numbers::pi * a); };
    const double S = s(X[0]) * s(X[1]) * s(X[2]);
    return X + growth(t) * Vec3(0.1 * S, -0.05 * s(2 * X[0]) * s(X[1]) * s(X[2]), 0.06 * S);
  };
}

/// Turned about z by an angle that grows along it: no change of volume, at any angle.
inline ClosedMotion twist(double angle) {
  return [angle](const Vec3& X, double) -> Vec3 {
    const double a = angle * std::sin(std::numbers::pi * X[2] / 2);
    return {std::cos(a) * X[0] - std::sin(a) * X[1], std::sin(a) * X[0] + std::cos(a) * X[1], X[2]};
  };
}

/// A block along x bent to an arc about z, fibres of y = 0 unstretched.
inline ClosedMotion bent(double curvature) {
  return [curvature](const Vec3& X, double) -> Vec3 {
    const double r = 1 / curvature - X[1], a = curvature * X[0];
    return {r * std::sin(a), 1 / curvature - r * std::cos(a), X[2]};
  };
}

/// A spin about z with a stretch along x that comes and goes: the same F everywhere.
inline ClosedMotion spin(double turns_per_second) {
  return [turns_per_second](const Vec3& X, double t) -> Vec3 {
    const double a = 2 * std::numbers::pi * turns_per_second * t, x = X[0] * (1 + 0.1 * (1 - std::cos(3 * t)));
    return {std::cos(a) * x - std::sin(a) * X[1], std::sin(a) * x + std::cos(a) * X[1], X[2]};
  };
}

}  // namespace springproof::test
