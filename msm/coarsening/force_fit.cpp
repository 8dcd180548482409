#include "msm/coarsening/force_fit.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "msm/algebra/dense.h"

namespace springproof {
namespace {

constexpr int strains = 6;
constexpr double least_scalar = 0.05, largest_scalar = 5;

/// L of a metric.  Strains and patterns are apart in the form of averaged springs, and so in L.
Eigen::MatrixXd scaled_root(const DeformationForm& averaged, const Eigen::MatrixXd& y, const Eigen::MatrixXd& s) {
  Eigen::MatrixXd L = Eigen::MatrixXd(averaged.llt().matrixL());
  const Eigen::MatrixXd z = L.transpose() * y, t = L.triangularView<Eigen::Lower>().solve(s);
  for (const auto& [first, count] : {std::pair(0, strains), std::pair(strains, deformations_of_cell - strains)}) {
    const auto own = z.middleRows(first, count);
    const double norm = own.squaredNorm();
    const double scalar = norm > 0 ? own.cwiseProduct(t.middleRows(first, count)).sum() / norm : 1;
    L.middleRows(first, count) *= std::sqrt(std::clamp(scalar, least_scalar, largest_scalar));
  }
  return L;
}

}  // namespace

DeformationForm fit_form(const DeformationForm& averaged, const Eigen::MatrixXd& y, const Eigen::MatrixXd& s,
                         const FitSettings& settings) {
  const Eigen::MatrixXd L =
      settings.of_scalars ? scaled_root(averaged, y, s) : Eigen::MatrixXd(averaged.llt().matrixL());
  const Eigen::MatrixXd z = L.transpose() * y, t = L.triangularView<Eigen::Lower>().solve(s);
  Eigen::MatrixXd A = z * z.transpose(), N = t * z.transpose();
  const double rho = settings.ridge * A.trace() / deformations_of_cell;
  if (!(rho > 0)) return averaged;
  A.diagonal().array() += rho;
  N.diagonal().array() += rho;
  const Eigenpairs of_A = symmetric_eigenpairs(A);  // C A + A C = N + N^T
  Eigen::MatrixXd C = of_A.vectors.transpose() * (N + N.transpose()) * of_A.vectors;
  for (int i = 0; i < deformations_of_cell; ++i)
    for (int j = 0; j < deformations_of_cell; ++j) C(i, j) /= of_A.values[i] + of_A.values[j];
  C = of_A.vectors * C * of_A.vectors.transpose();
  const Eigenpairs of_C = symmetric_eigenpairs((C + C.transpose()) / 2);
  const Eigen::VectorXd values = of_C.values.cwiseMax(settings.least).cwiseMin(settings.largest);
  const Eigen::MatrixXd root = L * of_C.vectors;
  return root * values.asDiagonal() * root.transpose();
}

}  // namespace springproof
