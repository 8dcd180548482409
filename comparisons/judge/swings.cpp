#include "comparisons/judge/swings.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "msm/algebra/dense.h"

namespace springproof {
namespace {

constexpr double hysteresis = 0.1;  // of the largest deviation: a crossing counts after the value was so far below
constexpr std::size_t least_samples = 8;

/// An upward crossing of a level, between two samples.
struct Crossing {
  std::size_t after;  ///< last sample before it
  double time;
};

std::vector<Crossing> upward_crossings(const std::vector<double>& t, const std::vector<double>& u, double level) {
  double largest = 0;
  for (const double value : u) largest = std::max(largest, std::abs(value - level));
  std::vector<Crossing> all;
  bool armed = false;
  for (std::size_t i = 1; i < u.size(); ++i) {
    armed = armed || u[i - 1] < level - hysteresis * largest;
    if (!armed || u[i - 1] > level || u[i] <= level) continue;
    all.push_back({i - 1, t[i - 1] + (level - u[i - 1]) / (u[i] - u[i - 1]) * (t[i] - t[i - 1])});
    armed = false;
  }
  return all;
}

double mean_between(const std::vector<double>& t, const std::vector<double>& u, std::size_t begin, std::size_t end) {
  double sum = 0;
  for (std::size_t i = begin; i < end; ++i) sum += (u[i] + u[i + 1]) / 2 * (t[i + 1] - t[i]);
  return sum / (t[end] - t[begin]);
}

}  // namespace

std::optional<Swings> swings_of(const std::vector<double>& t, const std::vector<double>& u) {
  if (t.size() < 2 * least_samples) return {};
  Swings swings;
  swings.mean = mean_between(t, u, 0, t.size() - 1);
  std::vector<Crossing> crossings;
  for (int pass = 0; pass < 3; ++pass) {  // the mean is that of whole swings
    crossings = upward_crossings(t, u, swings.mean);
    if (crossings.size() < 3 ||
        crossings.back().after - crossings.front().after < least_samples * (crossings.size() - 1))
      return {};
    swings.mean = mean_between(t, u, crossings.front().after, crossings.back().after);
  }
  swings.count = static_cast<int>(crossings.size()) - 1;
  swings.period = (crossings.back().time - crossings.front().time) / swings.count;
  swings.begin = crossings.front().time;
  for (int s = 0; s < swings.count; ++s) {
    const auto [least, most] = std::minmax_element(u.begin() + static_cast<long>(crossings[s].after),
                                                   u.begin() + static_cast<long>(crossings[s + 1].after) + 1);
    swings.amplitude += (*most - *least) / 2 / swings.count;
  }
  return swings;
}

std::optional<DampedSwings> damped_swings_of(const std::vector<double>& time, const std::vector<double>& value,
                                             const Swings& swings, const Relaxation& creep) {
  const auto first = std::lower_bound(time.begin(), time.end(), swings.begin) - time.begin();
  const auto n = static_cast<Eigen::Index>(time.size()) - first;
  const Eigen::ArrayXd t = Eigen::Map<const Eigen::ArrayXd>(time.data() + first, n) - swings.begin;
  const Eigen::VectorXd u = Eigen::Map<const Eigen::VectorXd>(value.data() + first, n);
  // What is left of u beside the best amplitudes at decay d and frequency w of the zeros [1/s].
  const auto rest = [&](double d, double w) -> Eigen::VectorXd {
    Eigen::MatrixXd A(n, 3 + static_cast<Eigen::Index>(creep.branches.size()));
    A.leftCols(3) << (-d * t).exp() * (w * t).cos(), (-d * t).exp() * (w * t).sin(), Eigen::ArrayXd::Ones(n);
    for (std::size_t i = 0; i < creep.branches.size(); ++i)
      A.col(3 + static_cast<Eigen::Index>(i)) = (-t / creep.branches[i].time).exp();
    return u - A * least_squares(A, u).X;
  };
  double w = 2 * std::numbers::pi / swings.period, d = 0;
  for (int i = 0; i < 50; ++i) {  // Gauss-Newton
    const double h = 1e-6 * w;
    const Eigen::VectorXd r = rest(d, w);
    Eigen::MatrixXd J(n, 2);
    J << (rest(d + h, w) - rest(d - h, w)) / (2 * h), (rest(d, w + h) - rest(d, w - h)) / (2 * h);
    const Eigen::Vector2d step = least_squares(J, -r).X;
    if (!step.allFinite()) return {};
    d += std::clamp(step[0], -0.1 * w, 0.1 * w);
    w += std::clamp(step[1], -0.1 * w, 0.1 * w);
    if (step.norm() < 1e-8 * w) return DampedSwings{2 * std::numbers::pi / w, d / std::hypot(d, w)};
  }
  return {};
}

std::optional<double> arrival_of(const std::vector<double>& t, const std::vector<double>& u) {
  const auto departure = [&](std::size_t i) { return std::abs(u[i] - u[0]); };
  double largest = 0;
  for (std::size_t i = 0; i < u.size(); ++i) largest = std::max(largest, departure(i));
  for (std::size_t i = 1; i < u.size(); ++i)
    if (const double level = largest / 10; largest > 0 && departure(i) >= level)
      return t[i - 1] + (t[i] - t[i - 1]) * (level - departure(i - 1)) / (departure(i) - departure(i - 1));
  return {};
}

}  // namespace springproof
