#include "comparisons/advise/table_prediction.h"

#include <algorithm>
#include <cmath>

#include "problem/material.h"

namespace springproof {
namespace {

constexpr double fastest_fall = 2.2;     // order at which an error may fall beyond the finest lattice measured
constexpr double measured_strain = 0.2;  // of the rows at large strain
constexpr double most_by_length = 1.5;   // power of the slenderness by which an error may change
constexpr double least_error = 1e-5;     // below which an error is the solvers'

double measure_of(double poisson_ratio) { return -std::log(1 - 2 * poisson_ratio); }

double between(double a, double b, double part) { return a + part * (b - a); }

}  // namespace

ErrorTable::ErrorTable(const std::vector<Measurement>& all, const Loading& loading, const std::string& model)
    : slenderness_(loading.slenderness),
      by_length_(loading.load == "bending" ? 0
                 : loading.load == "shear" ? 1
                                           : -1) {
  for (const Measurement& m : all) {
    if (m.load != loading.load || m.body != loading.body || m.model != model ||
        std::abs(m.strain - loading.strain) > 1e-9)
      continue;
    const auto same = [&](const Curve& c) {
      return c.slenderness == m.slenderness && same_poisson_ratio(c.poisson_ratio, m.poisson_ratio);
    };
    auto at = std::find_if(curves_.begin(), curves_.end(), same);
    if (at == curves_.end()) at = curves_.insert(at, {m.slenderness, m.poisson_ratio, {}});
    at->points.emplace_back(m.cells_across, std::max({m.error, m.uncertainty / 2, least_error}));
  }
  for (Curve& c : curves_) std::sort(c.points.begin(), c.points.end());
  std::erase_if(curves_, [](const Curve& c) { return c.points.size() < 2; });
  std::sort(curves_.begin(), curves_.end(), [](const Curve& a, const Curve& b) {
    return std::pair(a.slenderness, a.poisson_ratio) < std::pair(b.slenderness, b.poisson_ratio);
  });
  factor_ = residual_factor();
}

Prediction ErrorTable::on(const Curve& curve, double n, int without) {
  std::vector<std::pair<double, double>> p = curve.points;
  if (without >= 0) p.erase(p.begin() + without);
  if (n > p.back().first * 1.001) {
    const auto& a = p[p.size() > 2 ? p.size() - 3 : 0];
    const double fall = std::log(a.second / p.back().second) / std::log(p.back().first / a.first);
    return {p.back().second * std::pow(p.back().first / n, std::clamp(fall, 0.0, fastest_fall)), 1, true};
  }
  std::size_t i = 1;
  while (i + 1 < p.size() && p[i].first < n) ++i;
  const double part = std::log(n / p[i - 1].first) / std::log(p[i].first / p[i - 1].first);
  return {std::exp(between(std::log(p[i - 1].second), std::log(p[i].second), part)), 1, part < -0.01};
}

Prediction ErrorTable::in(double slenderness, double nu, double n, const Curve* without) const {
  std::vector<const Curve*> at;
  for (const Curve& c : curves_)
    if (c.slenderness == slenderness && &c != without) at.push_back(&c);
  if (at.size() == 1) {
    Prediction only = on(*at.front(), n);
    only.beyond |= !same_poisson_ratio(nu, at.front()->poisson_ratio);
    return only;
  }
  std::size_t i = 1;
  while (i + 1 < at.size() && at[i]->poisson_ratio < nu) ++i;
  const double low = measure_of(at[i - 1]->poisson_ratio), high = measure_of(at[i]->poisson_ratio),
               part = (measure_of(nu) - low) / (high - low);
  const Prediction a = on(*at[i - 1], n), b = on(*at[i], n);
  const double error = between(a.error, b.error, std::clamp(part, 0.0, 1.0));
  return {error, 1, a.beyond || b.beyond || part < -1e-9 || part > 1 + 1e-9};
}

double ErrorTable::residual_factor() const {
  std::vector<double> off;
  for (const Curve& c : curves_) {
    for (std::size_t i = 1; i + 1 < c.points.size(); ++i)
      off.push_back(std::abs(std::log(on(c, c.points[i].first, static_cast<int>(i)).error / c.points[i].second)));
    const auto at_end = [&](auto compare) {
      return std::none_of(curves_.begin(), curves_.end(), [&](const Curve& other) {
        return other.slenderness == c.slenderness && compare(other.poisson_ratio, c.poisson_ratio);
      });
    };
    if (at_end(std::less<>()) || at_end(std::greater<>())) continue;
    for (const auto& [n, e] : c.points)
      off.push_back(std::abs(std::log(in(c.slenderness, c.poisson_ratio, n, &c).error / e)));
  }
  if (off.empty()) return 2;
  std::sort(off.begin(), off.end());
  return std::exp(off[std::min(off.size() - 1, off.size() * 9 / 10)]);
}

double ErrorTable::exponent(double shorter, double longer, double nu, double n) const {
  double low = -1, high = 0.5;  // the Poisson's ratios that both were measured at
  for (const double length : {shorter, longer}) {
    std::vector<double> ratios;
    for (const Curve& c : curves_)
      if (c.slenderness == length) ratios.push_back(c.poisson_ratio);
    low = std::max(low, ratios.front());
    high = std::min(high, ratios.back());
  }
  const double at = std::clamp(nu, low, std::max(low, high));
  const double fall = std::log(in(longer, at, n).error / in(shorter, at, n).error) / std::log(longer / shorter);
  return std::clamp(fall, -most_by_length, most_by_length);
}

std::optional<Prediction> ErrorTable::at(double nu, double n) const {
  if (curves_.empty()) return {};
  std::vector<double> lengths;
  for (const Curve& c : curves_)
    if (lengths.empty() || lengths.back() != c.slenderness) lengths.push_back(c.slenderness);
  // That with the most Poisson's ratios.
  const auto count = [&](double length) {
    return std::count_if(curves_.begin(), curves_.end(), [&](const Curve& c) { return c.slenderness == length; });
  };
  const double base =
      *std::max_element(lengths.begin(), lengths.end(), [&](double a, double b) { return count(a) < count(b); });
  Prediction out = in(base, nu, n);
  const double by_length = lengths.size() > 1 ? exponent(lengths.front(), lengths.back(), nu, n) : by_length_;
  out.error *= std::pow(slenderness_ / base, by_length);
  out.beyond |= slenderness_ < lengths.front() / 1.01 || slenderness_ > lengths.back() * 1.01;
  out.factor = factor_ * (out.beyond ? 1.5 : 1);
  return out;
}

std::optional<Prediction> predict(const std::vector<Measurement>& all, const Loading& loading, const std::string& model,
                                  double nu, double n) {
  Loading small = loading, large = loading;
  small.strain = 0;
  large.strain = measured_strain;
  auto out = ErrorTable(all, small, model).at(nu, n);
  if (!out || loading.strain <= 0) return out;
  const auto at_strain = ErrorTable(all, large, model).at(nu, n);
  if (!at_strain) return {};
  for (const Measurement& m : all)
    if (m.load == loading.load && m.body == loading.body && m.model == model && m.strain == measured_strain)
      small.slenderness = m.slenderness;
  const double added = at_strain->error - ErrorTable(all, small, model).at(nu, n)->error;
  out->error = std::max(out->error / 2, out->error + added * loading.strain / measured_strain);
  out->factor = std::max(out->factor, at_strain->factor);
  out->beyond |= loading.strain > 1.5 * measured_strain;
  return out;
}

}  // namespace springproof
