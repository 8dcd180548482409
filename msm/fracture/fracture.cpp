#include "msm/fracture/fracture.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <stdexcept>

#include "msm/fracture/cracks.h"
#include "msm/topology/point_cells.h"
#include "msm/topology/random/random_addition.h"
#include "problem/system/progress.h"

namespace springproof {
namespace {

// The balance of energy is of the first order in the residual.
constexpr double equilibrium_tolerance = 1e-7;
constexpr int most_iterations = 20000;

void check_fracture(const Fracture& f, const std::vector<char>& held) {
  if (!(f.threshold > 0) || !(f.scatter >= 0 && f.scatter <= 0.5) || !(f.shrinkage >= 0 && f.shrinkage <= 0.5) ||
      f.steps < 1 || !(f.depth > 0) || !(f.apart >= 0))
    throw std::invalid_argument("run_fracture: a parameter is out of range");
  if (std::none_of(held.begin(), held.end(), [](char h) { return h; }))
    throw std::invalid_argument("run_fracture: no node is held");
}

double mean_length(const Network& network) {
  double sum = 0;
  for (const Spring& s : network.springs) sum += s.rest_length;
  return sum / static_cast<double>(network.springs.size());
}

/// The drying of one network.
class Drying {
 public:
  Drying(const Network& network, const std::vector<char>& held, const Fracture& fracture, std::uint64_t seed)
      : network_(network),
        fracture_(fracture),
        limits_(thresholds(fracture, network.springs.size(), seed)),
        profile_(drying_profile(fracture, network)),
        springs_(network, held, profile_),
        apart_(fracture.apart * mean_length(network)),
        lower_(network.X.colwise().minCoeff().transpose()),
        upper_(network.X.colwise().maxCoeff().transpose()) {
    result_.broken_at.assign(network.springs.size(), 0);
    result_.held = held;
  }

  FractureResult run() {
    for (int step = 1; step <= fracture_.steps; ++step) {
      progress::detail(
          [&] { return fmt::format("step {} of {}, {} springs broken", step, fracture_.steps, now_.broken); });
      shrink(fracture_.shrinkage * step / fracture_.steps);
      for (std::vector<int> next = next_to_break(); !next.empty(); next = next_to_break()) break_springs(next, step);
      now_.stored = springs_.energy();
      now_.fragments = count_fragments();
      result_.steps.push_back(now_);
    }
    result_.stretch.resize(network_.springs.size(), 0);
    for (std::size_t s = 0; s < result_.stretch.size(); ++s)
      if (springs_.present(static_cast<int>(s))) result_.stretch[s] = springs_.stretch(static_cast<int>(s));
    result_.displacement = Eigen::Map<const NodalVectors>(springs_.displacement().data(), network_.nodes(), 3);
    return std::move(result_);
  }

 private:
  void shrink(double to) {
    const double from = springs_.amplitude(), before = springs_.eigen_power();
    springs_.set_amplitude(to);
    equilibrate();
    now_.work += (before + springs_.eigen_power()) / 2 * (to - from);
    now_.shrinkage = to;
  }

  void break_springs(const std::vector<int>& broken, int step) {
    for (const int s : broken) {
      now_.broken_energy += springs_.energy_of(s);
      springs_.remove(s);
      result_.broken_at[s] = step;
    }
    now_.broken += static_cast<int>(broken.size());
    const Eigen::VectorXd before = springs_.displacement(), released = springs_.forces();
    equilibrate();
    now_.relaxed += released.dot(springs_.displacement() - before) / 2;
  }

  void equilibrate() {
    const KrylovResult solved = springs_.solve(equilibrium_tolerance, most_iterations);
    if (!solved.converged)
      throw std::runtime_error(
          fmt::format("no equilibrium at a shrinkage of {:.4g} with {} springs broken: residual {:.1e} "
                      "after {} iterations",
                      springs_.amplitude(), now_.broken, solved.residual, solved.iterations));
    ++result_.solves;
    result_.iterations += solved.iterations;
    result_.worst_residual = std::max(result_.worst_residual, solved.residual);
  }

  int count_fragments() const {
    std::vector<double> shrinkage = profile_;
    for (double& s : shrinkage) s *= springs_.amplitude();
    return fragments(network_, springs_.displacement(), shrinkage, 2 * fracture_.threshold);
  }

  Vec3 middle(int s) const {
    const Spring& spring = network_.springs[s];
    return (network_.X.row(spring.i) + network_.X.row(spring.j)).transpose() / 2;
  }

  /// The overloaded springs of one round, the most overloaded first.
  std::vector<int> next_to_break() const {
    std::vector<std::pair<double, int>> overloaded;
    for (std::size_t n = 0; n < limits_.size(); ++n) {
      const int s = static_cast<int>(n);
      if (!springs_.present(s)) continue;
      if (const double load = springs_.stretch(s) / limits_[n]; load >= 1) overloaded.emplace_back(-load, s);
    }
    std::sort(overloaded.begin(), overloaded.end());
    std::vector<int> chosen;
    if (overloaded.empty()) return chosen;
    PointCells cells(lower_, upper_ + Vec3::Constant(1e-9 * apart_),
                     std::max(apart_, (upper_ - lower_).maxCoeff() / 100), false);
    for (const auto& [load, s] : overloaded) {
      const Vec3 at = middle(s);
      if (cells.any_near(at, [&](int p) { return (middle(chosen[p]) - at).norm() < apart_; })) continue;
      cells.add(at);
      chosen.push_back(s);
    }
    return chosen;
  }

  const Network& network_;
  const Fracture& fracture_;
  std::vector<double> limits_;
  std::vector<double> profile_;
  ShrinkingSprings springs_;
  double apart_;  ///< [m]
  Vec3 lower_, upper_;
  FractureStep now_;
  FractureResult result_;
};

}  // namespace

double FractureResult::imbalance() const {
  double most = 0;
  for (const FractureStep& s : steps)
    most = std::max(most, std::abs(s.stored - (s.work - s.broken_energy - s.relaxed)));
  return steps.empty() || steps.back().work == 0 ? 0 : most / steps.back().work;
}

std::vector<double> thresholds(const Fracture& fracture, std::size_t springs, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::vector<double> all(springs);
  for (double& t : all) t = fracture.threshold * (1 + fracture.scatter * std::sqrt(12.0) * (uniform(random) - 0.5));
  return all;
}

std::vector<double> drying_profile(const Fracture& fracture, const Network& network) {
  const double top = network.X.col(2).maxCoeff();
  std::vector<double> profile;
  for (const Spring& s : network.springs)
    profile.push_back(std::exp(-(top - (network.X(s.i, 2) + network.X(s.j, 2)) / 2) / fracture.depth));
  return profile;
}

FractureResult run_fracture(const Network& network, const std::vector<char>& held, const Fracture& fracture,
                            std::uint64_t seed) {
  check_fracture(fracture, held);
  return Drying(network, held, fracture, seed).run();
}

}  // namespace springproof
