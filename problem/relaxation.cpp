#include "problem/relaxation.h"

#include <Eigen/Eigenvalues>
#include <cmath>

namespace springproof {

double Relaxation::instantaneous() const { return modulus_after(0); }

double Relaxation::modulus_after(double time) const {
  double modulus = 1;
  for (const RelaxationBranch& b : branches) modulus += b.share * std::exp(-time / b.time);
  return modulus;
}

// Q' = A Q, A = d d^T / sudden - 1 / time in the components sqrt(share / time) Q = d Q, from Q = E = 1 / sudden on.
double Relaxation::creep_after(double time) const {
  if (!acts() || !std::isfinite(time)) return 1;
  const double sudden = instantaneous();
  const auto n = static_cast<Eigen::Index>(branches.size());
  Eigen::VectorXd d(n), share(n), rate(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    share[i] = branches[i].share;
    rate[i] = 1 / branches[i].time;
    d[i] = std::sqrt(share[i] * rate[i]);
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> A(d * d.transpose() / sudden -
                                                         Eigen::MatrixXd(rate.asDiagonal()));
  const Eigen::VectorXd of_modes = A.eigenvectors().transpose() * d / sudden;
  const Eigen::VectorXd Q = A.eigenvectors() * (time * A.eigenvalues()).array().exp().matrix().cwiseProduct(of_modes);
  return 1 - share.dot(Q.cwiseQuotient(d));
}

double Relaxation::storage(double rate) const {
  double modulus = 1;
  for (const auto& [share, time] : branches)
    modulus += share * std::pow(rate * time, 2) / (1 + std::pow(rate * time, 2));
  return modulus;
}

double Relaxation::loss(double rate) const {
  double modulus = 0;
  for (const auto& [share, time] : branches) modulus += share * rate * time / (1 + std::pow(rate * time, 2));
  return modulus;
}

IsotropicMaterial with_shear(const IsotropicMaterial& material, double factor) {
  const double G = factor * shear_modulus(material), K = bulk_modulus(material);
  return {9 * K * G / (3 * K + G), (3 * K - 2 * G) / (2 * (3 * K + G)), material.density};
}

BranchStep BranchStep::of(double x) {
  constexpr double small = 1e-3;  // below, the difference loses more digits than the series leaves out
  const double phi = x > 0 ? -std::expm1(-x) / x : 1;
  return {std::exp(-x), phi, x < small ? 0.5 - x / 6 + x * x / 24 : (1 - phi) / x};
}

}  // namespace springproof
