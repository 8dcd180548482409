#include "msm/fracture/shrinking_springs.h"

#include <Eigen/Eigenvalues>
#include <cmath>
#include <stdexcept>

namespace springproof {

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
