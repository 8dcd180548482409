#include "comparisons/reference_value.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace springproof {
namespace {

double gain(double order) { return std::pow(2.0, order) - 1; }

}  // namespace

double weighted_norm(const NodalVectors& u, const Eigen::VectorXd& weights) {
  return std::sqrt((u.rowwise().squaredNorm().array() * weights.array()).sum() / weights.sum());
}

ReferenceValue extrapolate(const std::vector<double>& values, double noise, double highest_order) {
  if (values.size() < 3) throw std::invalid_argument("an uncertainty needs three grids");
  const double f1 = values[values.size() - 3], f2 = values[values.size() - 2], f3 = values.back();
  const double coarse = f2 - f1, fine = f3 - f2;
  if (std::max(std::abs(coarse), std::abs(fine)) <= noise) return {f3, noise, {}, "equal on all grids to solver accuracy"};
  if (coarse * fine <= 0 || std::abs(fine) >= std::abs(coarse)) {
    const double spread = std::max({f1, f2, f3}) - std::min({f1, f2, f3});
    return {f3, safety_factor * spread + noise, {}, "not monotone: finest grid, spread of the three grids"};
  }
  const double order = std::log2(coarse / fine), used = std::clamp(order, 0.5, highest_order);
  return {f3 + fine / gain(used), safety_factor * std::abs(fine) / gain(used) + noise, order, "Richardson, GCI"};
}

ReferenceField extrapolate(const std::vector<NodalVectors>& fields, const Eigen::VectorXd& weights,
                           double highest_order) {
  if (fields.size() < 3) throw std::invalid_argument("an uncertainty needs three grids");
  const NodalVectors &u1 = fields[fields.size() - 3], &u2 = fields[fields.size() - 2], &u3 = fields.back();
  const double size = weighted_norm(u3, weights);
  const double coarse = weighted_norm(u2 - u1, weights), fine = weighted_norm(u3 - u2, weights);
  if (size == 0) return {u3, 0, {}, "no displacement"};
  if (std::max(coarse, fine) <= 1e-8 * size) return {u3, 1e-8, {}, "equal on all grids to solver accuracy"};
  if (fine >= coarse) return {u3, safety_factor * std::max(coarse, fine) / size, {}, "not converging: finest grid, largest difference"};
  const double order = std::log2(coarse / fine), used = std::clamp(order, 0.5, highest_order);
  return {u3 + (u3 - u2) / gain(used), safety_factor * fine / gain(used) / size, order, "Richardson, GCI"};
}

}  // namespace springproof
