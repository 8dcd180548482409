#include "msm/dispersion_weights.h"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <cmath>
#include <limits>
#include <set>
#include <stdexcept>

#include "msm/solve/krylov.h"

namespace springproof {
namespace {

constexpr double smallest_slack = 1e-3;
constexpr double largest_residual = 0.2;
constexpr double largest_lean = 0.3;  // |sum k d| / sum k |d| of a node: 0 in the middle of a lattice, some 0.5 on its faces
using Vector6 = Eigen::Matrix<double, 6, 1>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;

/// Values of the conditions: per node six moments, xx yy zz yz xz xy of sum w L n n^T = V I, and three pulls, the gradient
/// of sum J.
struct Values {
  Eigen::VectorXd moment, pull;

  explicit Values(int nodes) : moment(Eigen::VectorXd::Zero(6 * nodes)), pull(Eigen::VectorXd::Zero(3 * nodes)) {}
  double norm() const { return std::hypot(moment.norm(), pull.norm()); }
};

/// What the iterations need of a spring.
struct Ends {
  int node[2], sink[2];
  Vec3 direction;  ///< i to j
  double length;
  double D[2];     ///< how far each end's weight follows

  Vector6 moment() const {  ///< of a unit weight
    const Vec3& e = direction;
    Vector6 m;
    m << e[0] * e[0], e[1] * e[1], e[2] * e[2], e[1] * e[2], e[0] * e[2], e[0] * e[1];
    return length * m;
  }
};

/// Inverse on the range.
Matrix6 pseudo_inverse(const Matrix6& A) {
  const Eigen::LDLT<Matrix6> factors(A);
  const Vector6 pivots = factors.vectorD();
  if (factors.info() == Eigen::Success && pivots.minCoeff() > 1e-10 * pivots.maxCoeff()) return factors.solve(Matrix6::Identity());
  return A.completeOrthogonalDecomposition().pseudoInverse();
}

/// The linear conditions A w on the weights of spring ends, and the normal equations A D A^T y = r of the smallest change of
/// w that meets them; the moments of a node share no weight with another's, so their part of y is eliminated.
/// Lengths in units of `unit`.
struct Conditions {
  int nodes;
  std::vector<int> group;
  double unit;
  std::vector<Ends> springs;
  std::vector<Matrix6> moment_inverse;  ///< per node
  Eigen::VectorXd pull_diagonal;        ///< times the slack
  std::vector<Eigen::Matrix3d> pull_inverse;

  explicit Conditions(const Network& n)
      : nodes(n.nodes()), group(volume_groups(n)), unit(std::cbrt(n.volume.sum() / std::max<double>(1, static_cast<double>((n.volume.array() > 0).count())))) {
    for (const Spring& s : n.springs) {
      const int i = n.master(s.i), j = n.master(s.j);
      springs.push_back({{i, j}, {group[i], group[j]}, (n.X.row(s.j) - n.X.row(s.i)).transpose().normalized(), s.rest_length / unit, {0, 0}});
    }
  }

  void apply(const std::vector<double>& w, Values& r) const {
    r.moment.setZero();
    r.pull.setZero();
    for (std::size_t s = 0; s < springs.size(); ++s) {
      const Ends& ends = springs[s];
      const Vector6 m = ends.moment();
      for (int side = 0; side < 2; ++side) r.moment.segment<6>(6 * ends.sink[side]) += w[2 * s + side] * m;
      const Vec3 pull = (w[2 * s] + w[2 * s + 1]) * ends.direction;
      r.pull.segment<3>(3 * ends.node[0]) -= pull;
      r.pull.segment<3>(3 * ends.node[1]) += pull;
    }
  }

  /// w += D A^T y.
  void add_transpose(const Values& y, std::vector<double>& w) const {
    for (std::size_t s = 0; s < springs.size(); ++s) {
      const Ends& ends = springs[s];
      const Vector6 m = ends.moment();
      const double both = stretch(ends, y.pull);
      for (int side = 0; side < 2; ++side) w[2 * s + side] += ends.D[side] * (m.dot(y.moment.segment<6>(6 * ends.sink[side])) + both);
    }
  }

  static double stretch(const Ends& ends, const Eigen::VectorXd& v) {
    return ends.direction.dot(v.segment<3>(3 * ends.node[1]) - v.segment<3>(3 * ends.node[0]));
  }

  /// Takes D, and a slack of all conditions as a fraction of what a unit change of a node's weights does to them.
  void prepare(const std::vector<double>& D, double slack) {
    moment_inverse.assign(nodes, Matrix6::Zero());
    pull_inverse.assign(nodes, Eigen::Matrix3d::Zero());
    for (std::size_t s = 0; s < springs.size(); ++s) {
      Ends& ends = springs[s];
      const Vector6 m = ends.moment();
      for (int side = 0; side < 2; ++side) {
        ends.D[side] = D[2 * s + side];
        moment_inverse[ends.sink[side]] += ends.D[side] * m * m.transpose();
        pull_inverse[ends.node[side]] += (D[2 * s] + D[2 * s + 1]) * ends.direction * ends.direction.transpose();
      }
    }
    pull_diagonal.resize(3 * nodes);
    for (int n = 0; n < nodes; ++n) {
      pull_diagonal.segment<3>(3 * n) = slack * pull_inverse[n].diagonal();
      pull_inverse[n].diagonal() *= 1 + slack;
      pull_inverse[n].diagonal().array() += 1e-10 * pull_inverse[n].trace() + 1e-300;
      pull_inverse[n] = pull_inverse[n].inverse().eval();
      moment_inverse[n].diagonal() *= 1 + slack;
      if (moment_inverse[n].trace() > 0) moment_inverse[n] = pseudo_inverse(moment_inverse[n]);
    }
  }

  /// y = inverse x of the moments.
  void solve_moments(Eigen::VectorXd& x) const {
    for (int n = 0; n < nodes; ++n) x.segment<6>(6 * n) = (moment_inverse[n] * x.segment<6>(6 * n)).eval();
  }

  /// Moments that pulls v cause.
  void moments_of(const Eigen::VectorXd& v, Eigen::VectorXd& moment) const {
    moment.setZero(6 * nodes);
    for (const Ends& ends : springs) {
      const double both = stretch(ends, v);
      const Vector6 m = ends.moment();
      for (int side = 0; side < 2; ++side) moment.segment<6>(6 * ends.sink[side]) += ends.D[side] * both * m;
    }
  }

  /// r = (pulls of both) - (pulls of moments), minus what the moments take back.
  void reduced(const Eigen::VectorXd& v, Eigen::VectorXd& moment, Eigen::VectorXd& r) const {
    moments_of(v, moment);
    solve_moments(moment);
    moment = -moment;
    pulls_of(moment, v, r);
    r += pull_diagonal.cwiseProduct(v);
  }

  /// Pulls that moments and pulls cause.
  void pulls_of(const Eigen::VectorXd& moment, const Eigen::VectorXd& v, Eigen::VectorXd& r) const {
    r.setZero(3 * nodes);
    for (const Ends& ends : springs) {
      const Vector6 m = ends.moment();
      const double both = stretch(ends, v);
      const double w = ends.D[0] * (both + m.dot(moment.segment<6>(6 * ends.sink[0]))) + ends.D[1] * (both + m.dot(moment.segment<6>(6 * ends.sink[1])));
      r.segment<3>(3 * ends.node[0]) -= w * ends.direction;
      r.segment<3>(3 * ends.node[1]) += w * ends.direction;
    }
  }

  /// y of A D A^T y = r, the residual at most `tolerance` in the unit of r.
  KrylovResult solve(const Values& r, double tolerance, int max_iterations, Values& y) const {
    Eigen::VectorXd b, moment = r.moment, none = Eigen::VectorXd::Zero(3 * nodes);
    solve_moments(moment);
    pulls_of(moment, none, b);
    b = r.pull - b;
    const Operator normal = [&](const Eigen::VectorXd& v, Eigen::VectorXd& out) { reduced(v, moment, out); };
    const Operator jacobi = [&](const Eigen::VectorXd& in, Eigen::VectorXd& z) {
      z.resize(in.size());
      for (int n = 0; n < nodes; ++n) z.segment<3>(3 * n) = pull_inverse[n] * in.segment<3>(3 * n);
    };
    y.pull.setZero();
    const KrylovResult k = conjugate_gradients(normal, jacobi, b, b.norm() > 0 ? tolerance / b.norm() : 1, max_iterations, y.pull);
    moments_of(y.pull, moment);
    y.moment = r.moment - moment;
    solve_moments(y.moment);
    return k;
  }
};

}  // namespace

namespace {

/// A lattice has springs of three lengths at most.
bool is_lattice(const Network& network) {
  std::set<long> lengths;
  for (const Spring& s : network.springs)
    if (lengths.insert(std::lround(1e6 * std::log(s.rest_length))).second && lengths.size() > 3) return false;
  return true;
}

}  // namespace

std::vector<int> volume_groups(const Network& network) {
  NodalVectors lean = NodalVectors::Zero(network.nodes(), 3);
  Eigen::VectorXd springs = Eigen::VectorXd::Zero(network.nodes());
  for (const Spring& s : network.springs) {
    const Eigen::RowVector3d pull = s.stiffness * (network.X.row(s.j) - network.X.row(s.i));
    lean.row(network.master(s.i)) += pull;
    lean.row(network.master(s.j)) -= pull;
    springs[network.master(s.i)] += pull.norm();
    springs[network.master(s.j)] += pull.norm();
  }
  const auto one_sided = [&](int n) { return lean.row(n).norm() > largest_lean * springs[n]; };
  std::vector<int> group(network.nodes());
  std::vector<double> shortest(network.nodes(), std::numeric_limits<double>::infinity());
  for (int n = 0; n < network.nodes(); ++n) group[n] = network.master(n);
  const auto join = [&](int n, int other, double length) {
    if (!one_sided(n) || one_sided(other) || length >= shortest[n]) return;
    shortest[n] = length;
    group[n] = other;
  };
  for (const Spring& s : network.springs) {
    join(network.master(s.i), network.master(s.j), s.rest_length);
    join(network.master(s.j), network.master(s.i), s.rest_length);
  }
  return group;
}

DispersionWeights volume_weights(const Network& network, const NodalVectors& volume_gradient, double shear_modulus) {
  Conditions A(network);
  const int dimensions = network.triangles.empty() ? 3 : 2;
  const std::size_t springs = network.springs.size();
  // Start from k L, each node's scaled to its volume: trace of sum w L n n^T = d V_n.
  Eigen::VectorXd share = Eigen::VectorXd::Zero(network.nodes()), volume = share;
  for (int n = 0; n < network.nodes(); ++n) volume[A.group[network.master(n)]] += network.volume[n] / std::pow(A.unit, 3);
  const auto kL = [&](std::size_t s) { return network.springs[s].stiffness * A.springs[s].length; };
  for (std::size_t s = 0; s < springs; ++s)
    for (int sink : A.springs[s].sink) share[sink] += kL(s) * A.springs[s].length;
  std::vector<double> w(2 * springs);
  for (std::size_t s = 0; s < springs; ++s)
    for (int side = 0; side < 2; ++side) {
      const int n = A.springs[s].sink[side];
      w[2 * s + side] = dimensions * volume[n] / share[n] * kL(s);
    }
  const std::vector<double> start = w;
  Values target(network.nodes()), met = target, missing = target, y = target;
  for (int n = 0; n < network.nodes(); ++n) {
    if (A.group[network.master(n)] == n)
      for (int d = 0; d < dimensions; ++d) target.moment[6 * n + d] = volume[n];
    target.pull.segment<3>(3 * network.master(n)) += volume_gradient.row(n).transpose() / (A.unit * A.unit);
  }
  const auto take_missing = [&] {
    A.apply(w, met);
    missing.moment = target.moment - met.moment;
    missing.pull = target.pull - met.pull;
    return missing.norm();
  };
  const double first = take_missing();
  DispersionWeights result;
  const auto correct = [&](double slack, double tolerance, int max_iterations) {
    w = start;
    take_missing();
    A.prepare(start, slack);
    result.iterations = A.solve(missing, tolerance, max_iterations, y).iterations;
    A.add_transpose(y, w);
    return take_missing();
  };
  if (first > 1e-13 * target.norm()) {
    // At a disordered surface some conditions contradict each other; on a lattice or without a surface they do not.
    const bool consistent = is_lattice(network) || !network.image_of.empty();
    if (!consistent || !(correct(0, 1e-12 * target.norm(), 2000) < 1e-6 * first)) correct(smallest_slack, 1e-6 * first, 2000);
  }
  result.residual = missing.norm() / target.norm();
  if (!(result.residual < largest_residual))
    throw std::runtime_error(fmt::format("the dispersion weights cannot be made exact (residual {:.1e}): too few springs at too many nodes", result.residual));
  const double scale = 2 * (dimensions + 2) * shear_modulus * A.unit * A.unit;
  for (double& e : w) e *= scale;
  result.weight = std::move(w);
  result.group = A.group;
  return result;
}

}  // namespace springproof
