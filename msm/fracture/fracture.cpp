#include "msm/fracture/fracture.h"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
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

ShrinkingSprings::ShrinkingSprings(const Network& network, const std::vector<char>& held,
                                   const std::vector<double>& profile)
    : is_held_(held), first_(network.nodes() + 1, 0), u_(Eigen::VectorXd::Zero(3 * network.nodes())) {
  if (held.size() != std::size_t(network.nodes()) || profile.size() != network.springs.size())
    throw std::invalid_argument("ShrinkingSprings: one flag per node, one number per spring");
  for (std::size_t n = 0; n < network.springs.size(); ++n) {
    const Spring& s = network.springs[n];
    const Eigen::RowVector3d w = std::sqrt(s.stiffness) * (network.X.row(s.j) - network.X.row(s.i)).normalized();
    const double root_length = std::sqrt(s.stiffness) * s.rest_length;
    const bool support = held[s.i] && held[s.j];
    present_.push_back(!support);
    root_length_.push_back(root_length);
    shrinkage_.push_back(support ? 0 : profile[n] * root_length);
    springs_.push_back(support ? Scaled{0, 0, 0, s.i, s.j} : Scaled{w[0], w[1], w[2], s.i, s.j});
    ++first_[s.i + 1];
    ++first_[s.j + 1];
  }
  for (int n = 0; n < network.nodes(); ++n) first_[n + 1] += first_[n];
  springs_of_.resize(2 * springs_.size());
  std::vector<int> next(first_.begin(), first_.end() - 1);
  for (std::size_t s = 0; s < springs_.size(); ++s)
    for (const int node : {springs_[s].i, springs_[s].j}) springs_of_[next[node]++] = static_cast<int>(s);
  block_.resize(network.nodes());
  for (int n = 0; n < network.nodes(); ++n) {
    if (held[n]) held_.push_back(n);
    set_block(n);
  }
}

void ShrinkingSprings::set_block(int node) {
  Eigen::Matrix3d& block = block_[node];
  block.setZero();
  if (is_held_[node]) return;
  for (int at = first_[node]; at < first_[node + 1]; ++at) {
    const Scaled& s = springs_[springs_of_[at]];
    const Vec3 w(s.x, s.y, s.z);
    block += w * w.transpose();
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(block);
  constexpr double round_off = 1e-10;
  Vec3 inverse = Vec3::Zero();
  for (int a = 0; a < 3; ++a)
    if (eigen.eigenvalues()[a] > round_off * eigen.eigenvalues()[2]) inverse[a] = 1 / eigen.eigenvalues()[a];
  block = eigen.eigenvectors() * inverse.asDiagonal() * eigen.eigenvectors().transpose();
}

void ShrinkingSprings::set_amplitude(double amplitude) {
  if (amplitude_ != 0) u_ *= amplitude / amplitude_;
  amplitude_ = amplitude;
}

void ShrinkingSprings::remove(int spring) {
  Scaled& s = springs_[spring];
  present_[spring] = false;
  s.x = s.y = s.z = shrinkage_[spring] = 0;
  set_block(s.i);
  set_block(s.j);
}

double ShrinkingSprings::scaled_tension(int spring) const {
  const Scaled& s = springs_[spring];
  const double *a = u_.data() + 3 * s.i, *b = u_.data() + 3 * s.j;
  return s.x * (b[0] - a[0]) + s.y * (b[1] - a[1]) + s.z * (b[2] - a[2]) + amplitude_ * shrinkage_[spring];
}

void ShrinkingSprings::multiply(const Eigen::VectorXd& u, Eigen::VectorXd& f) const {
  f.setZero(u.size());
  for (std::size_t n = 0; n < springs_.size();) {
    const int i = springs_[n].i;
    const double *a = u.data() + 3 * i, ax = a[0], ay = a[1], az = a[2];
    double x = 0, y = 0, z = 0;
    for (; n < springs_.size() && springs_[n].i == i; ++n) {  // springs are sorted by their first node
      const Scaled& s = springs_[n];
      const double* b = u.data() + 3 * s.j;
      const double t = s.x * (b[0] - ax) + s.y * (b[1] - ay) + s.z * (b[2] - az);
      double* g = f.data() + 3 * s.j;
      x += t * s.x;
      y += t * s.y;
      z += t * s.z;
      g[0] += t * s.x;
      g[1] += t * s.y;
      g[2] += t * s.z;
    }
    f[3 * i] -= x;
    f[3 * i + 1] -= y;
    f[3 * i + 2] -= z;
  }
  for (const int n : held_) f.segment<3>(3 * n).setZero();
}

void ShrinkingSprings::precondition(const Eigen::VectorXd& r, Eigen::VectorXd& z) const {
  for (std::size_t n = 0; n < block_.size(); ++n) {
    const auto at = static_cast<Eigen::Index>(3 * n);
    z.segment<3>(at).noalias() = block_[n] * r.segment<3>(at);
  }
}

Eigen::VectorXd ShrinkingSprings::nodal_forces(const std::function<double(int)>& scaled) const {
  Eigen::VectorXd f = Eigen::VectorXd::Zero(u_.size());
  for (std::size_t n = 0; n < springs_.size(); ++n) {
    const Scaled& s = springs_[n];
    const Vec3 pull = scaled(static_cast<int>(n)) * Vec3(s.x, s.y, s.z);
    f.segment<3>(3 * s.i) += pull;
    f.segment<3>(3 * s.j) -= pull;
  }
  for (const int n : held_) f.segment<3>(3 * n).setZero();
  return f;
}

Eigen::VectorXd ShrinkingSprings::forces() const {
  return nodal_forces([this](int s) { return scaled_tension(s); });
}

KrylovResult ShrinkingSprings::solve(double tolerance, int max_iterations) {
  const Eigen::VectorXd b = nodal_forces([this](int s) { return amplitude_ * shrinkage_[s]; });
  return conjugate_gradients([this](const auto& x, auto& y) { multiply(x, y); },
                             [this](const auto& r, auto& z) { precondition(r, z); }, b, tolerance, max_iterations, u_);
}

double ShrinkingSprings::stretch(int spring) const { return scaled_tension(spring) / root_length_[spring]; }

double ShrinkingSprings::energy_of(int spring) const {
  const double t = scaled_tension(spring);
  return t * t / 2;
}

double ShrinkingSprings::energy() const {
  double sum = 0;
  for (std::size_t s = 0; s < springs_.size(); ++s) sum += energy_of(static_cast<int>(s));
  return sum;
}

double ShrinkingSprings::eigen_power() const {
  double sum = 0;
  for (std::size_t s = 0; s < springs_.size(); ++s) sum += scaled_tension(static_cast<int>(s)) * shrinkage_[s];
  return sum;
}

}  // namespace springproof
