#include "fem_reference/elements/laws.h"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

#include "problem/large_strain.h"

namespace springproof::fem {
namespace {

// Stress and its derivatives in the frame of the eigenvectors of C; c are the eigenvalues.
struct Principal {
  Eigen::Vector3d s, q, g;  // S, dS/dp, dg/dc
  Eigen::Matrix3d d;        // ds_a / dc_b
};

// S = tau / c from principal Kirchhoff stresses tau, which depend on their own c_a (derivative `slope`) and on J
// (through p J).
Principal from_kirchhoff(const Eigen::Vector3d& tau, const Eigen::Vector3d& slope, double pJ, double J,
                         const Eigen::Vector3d& c) {
  const Eigen::Vector3d inverse = c.cwiseInverse();
  Principal r;
  r.s = tau.cwiseProduct(inverse);
  r.q = J * inverse;
  r.g = r.q / 2;
  r.d = (slope - r.s).cwiseProduct(inverse).asDiagonal();
  r.d += pJ / 2 * inverse * inverse.transpose();
  return r;
}

// K = lambda + 2 mu/3: only lambda (J - 1) goes into the pressure, as in the other laws, so that at zero
// pressure the tangent is that of a solid with nu = 0.
Principal isochoric(double mu, double p, double J, const Eigen::Vector3d& c) {
  const double third = c.mean(), scaled = mu / std::cbrt(J * J), rest = 2 * mu / 3;
  const Eigen::Vector3d tau = (scaled * (c.array() - third) + (rest * (J - 1) + p) * J).matrix();
  Principal r = from_kirchhoff(tau, Eigen::Vector3d::Constant(scaled), (rest * (2 * J - 1) + p) * J, J, c);
  const Eigen::Vector3d inverse = c.cwiseInverse(), ones = Eigen::Vector3d::Ones();
  r.d += scaled / 3 * (third * inverse * inverse.transpose() - inverse * ones.transpose() - ones * inverse.transpose());
  return r;
}

Principal principal(Law law, double mu, double p, const Eigen::Vector3d& c) {
  const double J = std::sqrt(c.prod());
  const Eigen::Array3d log_c = c.array().log();
  switch (law) {
    case Law::hencky:
      return from_kirchhoff(mu * log_c + p * J, mu * c.cwiseInverse(), p * J, J, c);
    case Law::neo_hooke:
      return from_kirchhoff(mu * (c.array() - 1) + p * J, Eigen::Vector3d::Constant(mu), p * J, J, c);
    case Law::neo_hooke_isochoric:
      return isochoric(mu, p, J, c);
    case Law::log_cauchy: {
      Principal r = from_kirchhoff(J * (mu * log_c + p), J * mu * c.cwiseInverse(), 0, J, c);
      r.d += r.s * c.cwiseInverse().transpose() / 2;
      return r;
    }
    case Law::st_venant_kirchhoff:
      break;
  }
  return {(mu * (c.array() - 1) + p).matrix(), Eigen::Vector3d::Ones(), Eigen::Vector3d::Constant(0.5),
          mu * Eigen::Matrix3d::Identity()};
}

// (s_a - s_b) / (c_a - c_b); for nearly equal c by the mean of its limits at both ends.
double divided_difference(const Principal& r, const Eigen::Vector3d& c, int a, int b) {
  const double difference = c[a] - c[b];
  if (std::abs(difference) > 1e-4 * c[a]) return (r.s[a] - r.s[b]) / difference;
  return (r.d(a, a) - r.d(a, b) + r.d(b, b) - r.d(b, a)) / 2;
}

Voigt symmetric_product(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  Voigt v;
  v << a[0] * b[0], a[1] * b[1], a[2] * b[2], (a[0] * b[1] + a[1] * b[0]) / 2, (a[1] * b[2] + a[2] * b[1]) / 2,
      (a[0] * b[2] + a[2] * b[0]) / 2;
  return v;
}

bool is_linear_in_dilatation(Law law) { return law == Law::st_venant_kirchhoff || law == Law::neo_hooke_isochoric; }

// N_a N_a of the eigenvectors N
Eigen::Matrix<double, 6, 3> squares(const Eigen::Matrix3d& N) {
  Eigen::Matrix<double, 6, 3> M;
  for (int a = 0; a < 3; ++a) M.col(a) = symmetric_product(N.col(a), N.col(a));
  return M;
}

}  // namespace

std::optional<Law> law_named(const std::string& name) {
  const auto at = std::find(laws_of_large_strain.begin(), laws_of_large_strain.end(), name);
  if (at == laws_of_large_strain.end()) return {};
  return static_cast<Law>(at - laws_of_large_strain.begin());
}

std::string law_names() {
  std::string all;
  for (const char* name : laws_of_large_strain) all += (all.empty() ? "" : ", ") + std::string(name);
  return all;
}

double dilatation(Law law, const Eigen::Matrix3d& F) {
  return law == Law::st_venant_kirchhoff ? (F.squaredNorm() - 3) / 2 : F.determinant() - 1;
}

ValueAndSlope pressure(Law law, double lambda, double g) {
  if (is_linear_in_dilatation(law)) return {lambda * g, lambda};
  const double J = 1 + g, log_J = std::log1p(g);
  if (law == Law::log_cauchy) return {lambda * log_J, lambda / J};
  return {lambda * log_J / J, lambda * (1 - log_J) / (J * J)};
}

ValueAndSlope dilatation_at_pressure(Law law, double lambda, double p) {
  const double ratio = p / lambda;
  if (is_linear_in_dilatation(law)) return {ratio, 1 / lambda};
  double log_J = ratio;
  if (law != Law::log_cauchy) {
    // x exp(-x) = ratio, x < 1, by Newton's method on x - ratio exp(x)
    const double bounded = std::min(ratio, 0.999 * std::exp(-1));
    for (int i = 0; i < 30; ++i) {
      const double excess = log_J - bounded * std::exp(log_J), slope = 1 - bounded * std::exp(log_J);
      log_J = std::min(log_J - excess / slope, 0.999);
      if (std::abs(excess) < 1e-16) break;
    }
  }
  const double g = std::expm1(log_J);
  return {g, 1 / pressure(law, lambda, g).slope};
}

double shear_energy(Law law, double mu, const Eigen::Matrix3d& F) {
  const Eigen::Matrix3d C = F.transpose() * F;
  const double J = F.determinant();
  switch (law) {
    case Law::hencky:
      return mu / 4 * Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(C).eigenvalues().array().log().square().sum();
    case Law::neo_hooke:
      return mu / 2 * (C.trace() - 3 - 2 * std::log(J));
    case Law::neo_hooke_isochoric:
      return mu / 2 * (C.trace() / std::cbrt(J * J) - 3) + mu / 3 * (J - 1) * (J - 1);
    case Law::st_venant_kirchhoff:
      return mu / 4 * (C - Eigen::Matrix3d::Identity()).squaredNorm();
    case Law::log_cauchy:
      break;
  }
  return std::numeric_limits<double>::quiet_NaN();
}

double dilatation_energy(Law law, double lambda, double g) {
  if (law == Law::log_cauchy) return std::numeric_limits<double>::quiet_NaN();
  const double measure = is_linear_in_dilatation(law) ? g : std::log1p(g);
  return lambda / 2 * measure * measure;
}

LawResponse respond(Law law, double mu, double p, const Eigen::Matrix3d& F) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(F.transpose() * F);
  const Eigen::Vector3d c = eigen.eigenvalues();
  const Eigen::Matrix3d& N = eigen.eigenvectors();
  const Principal r = principal(law, mu, p, c);

  const Eigen::Matrix<double, 6, 3> M = squares(N);
  Eigen::Matrix<double, 6, 3> pairs;  // N_a N_b
  Eigen::Vector3d of_pairs;
  for (int a = 0; a < 3; ++a) {
    const int b = (a + 1) % 3;
    pairs.col(a) = symmetric_product(N.col(a), N.col(b));
    of_pairs[a] = 2 * divided_difference(r, c, std::min(a, b), std::max(a, b));
  }
  return {M * r.s, M * r.q, M * r.g, M * r.d * M.transpose() + pairs * of_pairs.asDiagonal() * pairs.transpose()};
}

Voigt stress(Law law, double mu, double p, const Eigen::Matrix3d& C) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(C);
  return squares(eigen.eigenvectors()) * principal(law, mu, p, eigen.eigenvalues()).s;
}

}  // namespace springproof::fem
