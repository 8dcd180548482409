#include "comparisons/reference_value.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace springproof {
namespace {

constexpr double lowest_order = 0.5;

/// What f3 - f2 is multiplied by for the step to the limit, and for the uncertainty.
struct Factors {
  double limit, uncertainty;
};

/// Order p for which differences f2 - f1 and f3 - f2 of errors C h^p have this quotient: the root of
/// (coarse^p - 1) / (1 - fine^-p) = quotient, between 0 and 20.
double order_of(double quotient, const GridRatios& r) {
  double low = 0, high = 20;
  for (int step = 0; step < 100; ++step) {
    const double p = (low + high) / 2;
    (std::expm1(p * std::log(r.coarse)) < -quotient * std::expm1(-p * std::log(r.fine)) ? low : high) = p;
  }
  return (low + high) / 2;
}

Factors factors(double order, const TrustedOrder& trusted, const GridRatios& ratios) {
  const double limit = 1 / (std::pow(ratios.fine, std::min(order, trusted.highest)) - 1);
  return {limit, safety_factor * (order > trusted.suspicious ? 1 : limit)};
}

const char* note(double order, const TrustedOrder& trusted) {
  return order > trusted.suspicious ? "Richardson; order too high to be trusted, full last difference" : "Richardson, GCI";
}

}  // namespace

double weighted_norm(const NodalVectors& u, const Eigen::VectorXd& weights) {
  return std::sqrt((u.rowwise().squaredNorm().array() * weights.array()).sum() / weights.sum());
}

TrustedOrder trusted_order(const std::string& measure, const std::string& element, bool smooth) {
  if (!smooth) return {};
  const double degree = element.back() - '0', suspicious = 2 * degree + 0.5;
  if (measure.starts_with("displacement.") || measure.starts_with("mean_displacement.")) return {degree + 1, suspicious};
  if (measure.starts_with("stress.")) return {degree, suspicious};
  return {};
}

ReferenceValue extrapolate(const std::vector<double>& values, double noise, const TrustedOrder& trusted, const GridRatios& ratios) {
  if (values.size() < 3) throw std::invalid_argument("an uncertainty needs three grids");
  const double f1 = values[values.size() - 3], f2 = values[values.size() - 2], f3 = values.back();
  const double coarse = f2 - f1, fine = f3 - f2;
  if (std::max(std::abs(coarse), std::abs(fine)) <= noise) return {f3, noise, {}, "equal on all grids to solver accuracy"};
  const double order = coarse * fine > 0 ? order_of(coarse / fine, ratios) : 0;
  if (order < lowest_order) {
    const double spread = std::max({f1, f2, f3}) - std::min({f1, f2, f3});
    return {f3, safety_factor * spread + noise, {}, "not converging monotonically: finest grid, spread of the three"};
  }
  const Factors by = factors(order, trusted, ratios);
  return {f3 + by.limit * fine, by.uncertainty * std::abs(fine) + noise, order, note(order, trusted)};
}

ReferenceValue extrapolate_two(double f1, double f2) {
  return {2 * f2 - f1, 3 * std::abs(f2 - f1), {}, "two grids, first order assumed"};
}

ReferenceField extrapolate(const std::vector<NodalVectors>& fields, const Eigen::VectorXd& weights, const GridRatios& ratios) {
  if (fields.size() < 3) throw std::invalid_argument("an uncertainty needs three grids");
  const NodalVectors &u1 = fields[fields.size() - 3], &u2 = fields[fields.size() - 2], &u3 = fields.back();
  const double size = weighted_norm(u3, weights), noise = 1e-8 * size;
  const double coarse = weighted_norm(u2 - u1, weights), fine = weighted_norm(u3 - u2, weights);
  const auto result = [&](double limit, double factor, std::optional<double> order, const char* text) {
    const Eigen::VectorXd nodal = (factor * (u3 - u2).rowwise().norm()).array() + noise;
    return ReferenceField{u3 + limit * (u3 - u2), size > 0 ? (factor * fine + noise) / size : 0, nodal, order, text};
  };
  if (std::max(coarse, fine) <= noise) return result(0, 0, {}, "equal on all grids to solver accuracy");
  const double order = order_of(coarse / fine, ratios);
  if (order < lowest_order) return result(0, safety_factor * std::max(coarse, fine) / fine, {}, "not converging: finest grid, largest difference");
  const Factors by = factors(order, {}, ratios);
  return result(by.limit, by.uncertainty, order, note(order, {}));
}

}  // namespace springproof
