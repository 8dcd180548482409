#include "comparisons/judge/stress_error.h"

#include <algorithm>
#include <cmath>

#include "comparisons/results/picture.h"

namespace springproof {
namespace {

constexpr double slowest = 0.8;     // ratio of two steps of a sequence that has a limit
constexpr double certain = 0.01;    // a last step that is small however it came about
constexpr double least_mean = 0.1;  // of von Mises' norm

Eigen::VectorXd von_mises_of(const ProbeStresses& stress) {
  const std::vector<float> values = von_mises(stress);
  return Eigen::Map<const Eigen::VectorXf>(values.data(), static_cast<Eigen::Index>(values.size())).cast<double>();
}

double norm(const Eigen::VectorXd& values, const Eigen::VectorXd& volumes) {
  return std::sqrt(values.cwiseAbs2().dot(volumes));
}

}  // namespace

StressDifference stress_difference(const ProbeStresses& stress, const ProbeStresses& truth,
                                   const Eigen::VectorXd& volumes) {
  const Eigen::VectorXd mises = von_mises_of(stress), true_mises = von_mises_of(truth),
                        mean = stress.leftCols<3>().rowwise().mean(), true_mean = truth.leftCols<3>().rowwise().mean();
  const double size = norm(true_mises, volumes);
  StressDifference out;
  const double peak = true_mises.maxCoeff(&out.place);
  out.von_mises = norm(mises - true_mises, volumes) / size;
  out.hydrostatic = norm(mean - true_mean, volumes) / std::max(norm(true_mean, volumes), least_mean * size);
  out.peak = mises.maxCoeff() / peak - 1;
  return out;
}

double peak_stress(const ProbeStresses& stress) { return von_mises_of(stress).maxCoeff(); }

bool peaks_converge(double coarse, double middle, double fine) {
  const double last = std::abs(fine - middle);
  return last <= certain * fine || last <= slowest * std::abs(middle - coarse);
}

}  // namespace springproof
