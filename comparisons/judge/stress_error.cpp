#include "comparisons/judge/stress_error.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace springproof {
namespace {

constexpr double known_peak = 0.1;  // largest uncertainty of a peak that does not converge, but hardly changes
constexpr double least = 0.1;       // of von Mises' norm

/// All but one column are 0.
NodalVectors only(int column, const NodalVectors& all) {
  NodalVectors one = NodalVectors::Zero(all.rows(), 3);
  one.col(column) = all.col(column);
  return one;
}

/// Of differences that point apart, as of meshes that are not nested: the last holds the errors of both its meshes; as
/// extrapolate() takes scalars that do not converge monotonically.
Eigen::VectorXd what_is_left(const Eigen::VectorXd& first, const Eigen::VectorXd& last, const GridRatios& ratios) {
  return safety_factor * last.cwiseAbs().cwiseMax(first.cwiseAbs() / (ratios.coarse * ratios.fine));
}

Eigen::Vector3d norms(const NodalVectors& invariants, const Eigen::VectorXd& volumes) {
  return (invariants.cwiseAbs2().transpose() * volumes).cwiseSqrt();
}

}  // namespace

NodalVectors invariants(const ProbeStresses& stress) {
  NodalVectors out(stress.rows(), 3);
  for (Eigen::Index n = 0; n < stress.rows(); ++n) {
    const auto& s = stress.row(n);
    Eigen::Matrix3d S;
    S << s[0], s[3], s[5], s[3], s[1], s[4], s[5], s[4], s[2];
    const double mean = S.trace() / 3;
    out.row(n) << std::sqrt(1.5) * (S - mean * Eigen::Matrix3d::Identity()).norm(), mean,
        Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(S, Eigen::EigenvaluesOnly).eigenvalues()[2];
  }
  return out;
}

std::array<double, 3> StressLimit::peaks() const {
  return {of_grids[0].col(0).maxCoeff(), of_grids[1].col(0).maxCoeff(), of_grids[2].col(0).maxCoeff()};
}

bool StressLimit::peak_is_singular() const {
  const auto [coarse, middle, fine] = peaks();
  return coarse < middle && middle < fine && peak.sequence == Sequence::not_converging &&
         peak.uncertainty > known_peak * peak.value;
}

StressLimit stress_limit(const std::array<ProbeStresses, 3>& grids, const Eigen::VectorXd& volumes,
                         const GridRatios& ratios, double doubt) {
  StressLimit out;
  auto& of_grids = out.of_grids;
  std::transform(grids.begin(), grids.end(), of_grids.begin(), invariants);
  out.of_points.resize(of_grids[2].rows(), 3);
  for (int k = 0; k < 3; ++k) {
    ReferenceField& field = out.fields[k];
    field = extrapolate({only(k, of_grids[0]), only(k, of_grids[1]), only(k, of_grids[2])}, volumes, ratios, doubt);
    if (doubt == 0 && are_refined(ratios) && field.correlation.value_or(1) < smallest_correlation) {
      field.nodal_uncertainty =
          what_is_left(of_grids[1].col(k) - of_grids[0].col(k), of_grids[2].col(k) - of_grids[1].col(k), ratios);
      field.note = "the grids' differences point apart: finest grid, uncertain by the last difference";
    }
    out.of_points.col(k) = field.displacement.col(k);
  }
  of_grids[2].col(0).maxCoeff(&out.place);
  const auto peaks = out.peaks();
  out.peak = extrapolate({peaks.begin(), peaks.end()}, solver_noise * peaks[2], {}, ratios);
  return out;
}

Eigen::Vector3d stress_errors(const NodalVectors& off, const StressLimit& limit, const Eigen::VectorXd& volumes) {
  const Eigen::Vector3d sizes = norms(limit.of_points, volumes);
  return norms(off, volumes).cwiseQuotient(sizes.cwiseMax(least * sizes[0]));
}

}  // namespace springproof
