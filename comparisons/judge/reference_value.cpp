#include "comparisons/judge/reference_value.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "problem/case_file/measures.h"

namespace springproof {
namespace {

const char* const equal = "equal on all grids to solver accuracy";
const char* const richardson = "Richardson, GCI";
const char* const lucky = "Richardson; order too high to be trusted";

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

/// Ratio of the finest grid's error to f3 - f2 at this order.
double by_last(double order, const GridRatios& r) { return 1 / std::expm1(order * std::log(r.fine)); }

/// Ratio of the finest grid's error to f2 - f1 at this order.
double by_first(double order, const GridRatios& r) {
  return std::pow(r.fine, -order) / std::expm1(order * std::log(r.coarse));
}

/// False where the limit would lie further from the finest grid than the three are apart.
bool is_fast_enough(double quotient, double order, const TrustedOrders& orders, const GridRatios& ratios) {
  return order >= orders.lowest && by_last(order, ratios) <= 1 + quotient;
}

std::string not_refined(const GridRatios& r) {
  return fmt::format("not refined: ratio {:.2f}; finest grid, {:g} times the spread of the three",
                     std::min(r.coarse, r.fine), coarse_safety_factor);
}

/// Weighted root mean square of a nodal scalar.
double weighted_rms(const Eigen::VectorXd& v, const Eigen::VectorXd& weights) {
  return std::sqrt(weights.dot(v.cwiseAbs2()) / weights.sum());
}

double weighted_product(const NodalVectors& u, const NodalVectors& v, const Eigen::VectorXd& weights) {
  return weights.dot(u.cwiseProduct(v).rowwise().sum()) / weights.sum();
}

double median(std::vector<double> values) {
  if (values.empty()) return 0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace

std::string without_component(const std::string& measure) {
  const std::string of_region = quantity_of_region(measure);
  if (!of_region.empty() && measure.ends_with(of_region)) return measure;  // a number
  return measure.substr(0, measure.rfind('.'));
}

double weighted_norm(const NodalVectors& u, const Eigen::VectorXd& weights) {
  return std::sqrt(weighted_product(u, u, weights));
}

TrustedOrders trusted_orders(const std::string& measure, const std::string& element, bool smooth) {
  const double degree = element.back() - '0';
  const std::string kind = kind_of(measure);
  if (kind == "displacement" || kind == "mean_displacement")
    return {.highest = smooth ? degree + 1 : clamped_order,
            .lowest = degree > 1 ? 1 : TrustedOrders{}.lowest,
            .first = degree + 1};
  if (smooth && kind == "stress") return {.highest = degree};
  return {};
}

bool are_refined(const GridRatios& ratios) { return std::min(ratios.coarse, ratios.fine) >= smallest_ratio; }

ReferenceValue extrapolate(const std::vector<double>& values, double noise, const TrustedOrders& orders,
                           const GridRatios& ratios) {
  if (values.size() < 3) throw std::invalid_argument("an uncertainty needs three grids");
  const double f1 = values[values.size() - 3], f2 = values[values.size() - 2], f3 = values.back();
  const double coarse = f2 - f1, fine = f3 - f2, spread = std::max({f1, f2, f3}) - std::min({f1, f2, f3});
  const auto finest = [&](double factor, double error, std::string note) {
    return ReferenceValue{f3, factor * error + noise, {}, std::move(note), Sequence::not_converging};
  };
  if (spread <= noise) return {f3, noise, {}, equal, Sequence::equal};
  if (!are_refined(ratios)) return finest(coarse_safety_factor, spread, not_refined(ratios));
  if (coarse * fine <= 0)
    return finest(safety_factor, std::max(std::abs(fine), std::abs(coarse) / (ratios.coarse * ratios.fine)),
                  "not converging monotonically: finest grid");
  const double order = order_of(coarse / fine, ratios);
  if (!is_fast_enough(coarse / fine, order, orders, ratios))
    return finest(safety_factor, std::max(spread, by_last(std::max(order, orders.lowest), ratios) * std::abs(fine)),
                  "not converging fast enough: finest grid");
  const double p = std::min(order, orders.highest), step = by_last(p, ratios) * fine,
               first = by_first(std::min(order, orders.first), ratios) * coarse;
  return {f3 + step, safety_factor * std::max(std::abs(step), std::abs(first)) + noise, order,
          order > p ? lucky : richardson};
}

ReferenceValue finest_of(const std::vector<double>& values, ReferenceValue limit) {
  const auto [least, most] = std::minmax_element(values.end() - 3, values.end());
  limit.uncertainty = std::max(limit.uncertainty, coarse_safety_factor * (*most - *least));
  limit.value = values.back();
  limit.observed_order.reset();
  return limit;
}

ReferenceValue extrapolate_two(double f1, double f2) {
  return {2 * f2 - f1, coarse_safety_factor * std::abs(f2 - f1), {}, "two grids, first order assumed"};
}

std::string kind_of(const std::string& measure) {
  if (const std::string of_region = quantity_of_region(measure); !of_region.empty())
    return of_region == "pressure" ? "mean_stress" : of_region == "displacement" ? "mean_displacement" : of_region;
  return measure.starts_with("volume_change") ? "volume_change" : measure.substr(0, measure.find('.'));
}

void raise_to_usual(std::map<std::string, ReferenceValue>& limits) {
  std::map<std::string, double> size;  // of the vector or tensor; a tensor's shear components count once
  for (const auto& [measure, limit] : limits)
    if (!measure.ends_with(".magnitude"))
      size[without_component(measure)] = std::hypot(size[without_component(measure)], limit.value);
  std::map<std::string, std::vector<double>> relative;
  for (const auto& [measure, limit] : limits)
    if (const double whole = size[without_component(measure)];
        limit.sequence != Sequence::equal && !measure.ends_with(".magnitude") && limit.uncertainty < whole)
      relative[kind_of(measure)].push_back(limit.uncertainty / whole);
  for (auto& [measure, limit] : limits)
    if (limit.sequence != Sequence::equal)
      limit.uncertainty =
          std::max(limit.uncertainty, median(relative[kind_of(measure)]) * size[without_component(measure)]);
  for (auto& [measure, limit] : limits)
    if (measure.ends_with(".magnitude")) limit.value = std::max(limit.value, 0.0);
}

double doubt_of(const std::map<std::string, ReferenceValue>& limits) {
  std::vector<double> relative;
  int balance = 0;
  for (const auto& [measure, limit] : limits) {
    if (!limit.matters || kind_of(measure) == "stress") continue;
    balance += limit.sequence == Sequence::not_converging ? -1 : 1;
    relative.push_back(limit.uncertainty / std::abs(limit.value));
  }
  return balance < 0 ? median(relative) : 0;
}

ReferenceField extrapolate(const std::vector<NodalVectors>& fields, const Eigen::VectorXd& weights,
                           const GridRatios& ratios, double doubt, const TrustedOrders& orders) {
  if (fields.size() < 3) throw std::invalid_argument("an uncertainty needs three grids");
  const NodalVectors &u1 = fields[fields.size() - 3], &u2 = fields[fields.size() - 2], &u3 = fields.back();
  const NodalVectors coarse = u2 - u1, fine = u3 - u2;
  const double size = weighted_norm(u3, weights), noise = solver_noise * size;
  const double c = weighted_norm(coarse, weights), f = weighted_norm(fine, weights);
  ReferenceField result;
  result.displacement = u3;
  const auto with = [&](const Eigen::VectorXd& nodal, Sequence sequence, std::string note) {
    result.nodal_uncertainty = nodal.array() + noise;
    result.uncertainty = size > 0 ? weighted_rms(result.nodal_uncertainty, weights) / size : 0;
    result.sequence = sequence;
    result.note = std::move(note);
    return result;
  };
  if (std::max(c, f) <= noise) return with(Eigen::VectorXd::Zero(u3.rows()), Sequence::equal, equal);
  if (std::min(c, f) > noise) result.correlation = weighted_product(coarse, fine, weights) / (c * f);
  const Eigen::VectorXd first = coarse.rowwise().norm(), last = fine.rowwise().norm();
  const Eigen::VectorXd spread = first.cwiseMax(last).cwiseMax((u3 - u1).rowwise().norm());
  const auto finest = [&](const Eigen::VectorXd& nodal, std::string note) {
    return with(nodal, Sequence::not_converging, std::move(note));
  };
  if (!are_refined(ratios)) return finest(coarse_safety_factor * spread, not_refined(ratios));
  const double along = result.correlation.value_or(0), quotient = f > 0 ? along * c / f : 0,
               order = order_of(quotient, ratios);
  // If the differences decrease at first order or faster, the remaining error is at most that of first order, whatever
  // their directions.
  const bool fall = f > 0 && c >= ratios.coarse * f;
  const Eigen::VectorXd left = safety_factor * (fall ? Eigen::VectorXd(by_last(1, ratios) * last) : spread);
  const auto doubtful = [&](ReferenceField own) {
    if (doubt <= own.uncertainty) return own;
    result.displacement = u3;
    result.observed_order.reset();
    return finest(left * std::max(1.0, doubt * size / weighted_rms(left, weights)),
                  fmt::format("not converging: most other values do not ({:.2g} %); finest grid", 100 * doubt));
  };
  if (along < smallest_correlation)
    return doubtful(with(left, fall ? Sequence::converging : Sequence::not_converging,
                         fmt::format("{}the grids' differences point apart (correlation {:.2f}): finest grid{}",
                                     fall ? "" : "not converging: ", along, fall ? ", at first order" : "")));
  if (!is_fast_enough(quotient, order, orders, ratios))
    return doubtful(finest(safety_factor * spread.cwiseMax(by_last(std::max(order, orders.lowest), ratios) * last),
                           "not converging fast enough: finest grid"));
  const double p = std::min(order, orders.highest), of_first = std::min(order, orders.first);
  result.displacement += by_last(p, ratios) * fine;
  result.observed_order = order;
  return doubtful(with(safety_factor * (by_last(p, ratios) * last).cwiseMax(by_first(of_first, ratios) * first),
                       Sequence::converging,
                       fmt::format("{}; correlation {:.2f}", order > p ? lucky : richardson, along)));
}

}  // namespace springproof
