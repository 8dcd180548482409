#include "msm/cells/dispersion_weights.h"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <cmath>
#include <limits>
#include <set>
#include <stdexcept>
#include <utility>

#include "msm/algebra/krylov.h"

namespace springproof {
namespace {

// Conditions of a node: six for xx yy zz yz xz xy of sum w L n n^T = V I, three for the gradient of sum J.
constexpr int per_node = 9;
constexpr double smallest_slack = 1e-3;
constexpr double largest_residual = 0.2;
constexpr double near_exponent = 4;
constexpr double largest_lean =
    0.3;  // |sum k d| / sum k |d| of a node: 0 in the middle of a lattice, some 0.5 on its faces
using Block = Eigen::Matrix<double, per_node, per_node>;
using Condition = Eigen::Matrix<double, per_node, 1>;

/// The linear conditions on the weights of spring ends, matrix-free.  Lengths in units of `unit`.
struct Conditions {
  const Network& network;
  std::vector<int> group;
  double unit;
  std::vector<Vec3> direction;  ///< of each spring, i to j

  Conditions(const Network& n, std::vector<int> groups)
      : network(n),
        group(std::move(groups)),
        unit(std::cbrt(n.volume.sum() / std::max<double>(1, static_cast<double>((n.volume.array() > 0).count())))) {
    for (const Spring& s : n.springs) direction.push_back((n.X.row(s.j) - n.X.row(s.i)).transpose().normalized());
  }

  double length(std::size_t s) const { return network.springs[s].rest_length / unit; }

  /// Contribution of a unit weight to the six conditions of its own node.
  Eigen::Matrix<double, 6, 1> moment(std::size_t s) const {
    const Vec3& e = direction[s];
    Eigen::Matrix<double, 6, 1> m;
    m << e[0] * e[0], e[1] * e[1], e[2] * e[2], e[1] * e[2], e[0] * e[2], e[0] * e[1];
    return length(s) * m;
  }

  int end(std::size_t s, int side) const {
    return network.master(side == 0 ? network.springs[s].i : network.springs[s].j);
  }
  int sink(std::size_t s, int side) const { return group[end(s, side)]; }

  Eigen::VectorXd target(const NodalVectors& volume_gradient, int dimensions) const {
    Eigen::VectorXd t = Eigen::VectorXd::Zero(per_node * network.nodes());
    for (int n = 0; n < network.nodes(); ++n) {
      const int master = network.master(n), to = group[master];
      for (int d = 0; d < dimensions; ++d) t[per_node * to + d] += network.volume[n] / std::pow(unit, 3);
      t.segment<3>(per_node * master + 6) += volume_gradient.row(n).transpose() / (unit * unit);
    }
    return t;
  }

  /// |target - A w| / |target|.
  double residual(const std::vector<double>& w, const Eigen::VectorXd& target) const {
    Eigen::VectorXd met;
    apply(w, met);
    return (target - met).norm() / target.norm();
  }

  /// r = A w.
  void apply(const std::vector<double>& w, Eigen::VectorXd& r) const {
    r.setZero(per_node * network.nodes());
    for (std::size_t s = 0; s < direction.size(); ++s) {
      const int i = end(s, 0), j = end(s, 1);
      const auto m = moment(s);
      r.segment<6>(per_node * sink(s, 0)) += w[2 * s] * m;
      r.segment<6>(per_node * sink(s, 1)) += w[2 * s + 1] * m;
      const Vec3 pull = (w[2 * s] + w[2 * s + 1]) * direction[s];
      r.segment<3>(per_node * i + 6) -= pull;
      r.segment<3>(per_node * j + 6) += pull;
    }
  }

  /// w = D A^T y.
  void transpose(const Eigen::VectorXd& y, const std::vector<double>& D, std::vector<double>& w) const {
    w.resize(2 * direction.size());
    for (std::size_t s = 0; s < direction.size(); ++s) {
      const int i = end(s, 0), j = end(s, 1);
      const auto m = moment(s);
      const double both = direction[s].dot(y.segment<3>(per_node * j + 6) - y.segment<3>(per_node * i + 6));
      w[2 * s] = D[2 * s] * (m.dot(y.segment<6>(per_node * sink(s, 0))) + both);
      w[2 * s + 1] = D[2 * s + 1] * (m.dot(y.segment<6>(per_node * sink(s, 1))) + both);
    }
  }

  /// Inverses of the node blocks of A D A^T + slack diag(A D A^T), which may be singular for slack = 0, and the
  /// diagonal of A D A^T.
  std::vector<Block> inverse_blocks(const std::vector<double>& D, double slack, Eigen::VectorXd& diagonal) const {
    std::vector<Block> blocks(network.nodes(), Block::Zero());
    for (std::size_t s = 0; s < direction.size(); ++s)
      for (int side = 0; side < 2; ++side) {
        Condition own;
        own << moment(s), (side == 0 ? -1.0 : 1.0) * direction[s];
        Condition pull = Condition::Zero();
        pull.tail<3>() = direction[s];
        if (sink(s, side) != end(s, side)) {  // the moment belongs to another node's conditions
          Condition elsewhere = own;
          elsewhere.tail<3>().setZero();
          blocks[sink(s, side)] += D[2 * s + side] * elsewhere * elsewhere.transpose();
          own.head<6>().setZero();
        }
        blocks[end(s, side)] += D[2 * s + side] * own * own.transpose();
        blocks[end(s, side)] += D[2 * s + 1 - side] * pull * pull.transpose();  // the far end's weight adds here too
      }
    for (int n = 0; n < network.nodes(); ++n) diagonal.segment<per_node>(per_node * n) = blocks[n].diagonal();
    for (Block& b : blocks) {
      const double floor = 1e-10 * b.trace() + 1e-300;
      b.diagonal() += slack * b.diagonal() + Condition::Constant(floor);
      b = b.inverse().eval();
    }
    return blocks;
  }
};

/// A lattice has springs of three lengths at most.
bool is_lattice(const Network& network) {
  std::set<long> lengths;
  for (const Spring& s : network.springs)
    if (lengths.insert(std::lround(1e6 * std::log(s.rest_length))).second && lengths.size() > 3) return false;
  return true;
}

/// Weights that assign an eighth of each cell's volume to each of its corners, by the three edges there: per spring end
/// proportional to k for edges, 0 for diagonals.
std::vector<double> edge_weights(const Network& network, double unit) {
  std::vector<double> w;
  double sum = 0;
  for (const Spring& s : network.springs) {
    const double k = s.rest_length < 1.1 * network.cells.edge ? s.stiffness : 0;
    w.insert(w.end(), 2, k);
    sum += 2 * k * s.rest_length;
  }
  const double scale = 3 * network.volume.sum() / (unit * unit * sum);
  for (double& e : w) e *= scale;
  return w;
}

/// Weights k L, or those of near springs, scaled at each node to its volume: trace of sum w L n n^T = d V_n.
std::vector<double> first_weights(const Conditions& A, WeightStart start, const Eigen::VectorXd& target,
                                  int dimensions) {
  const auto& springs = A.network.springs;
  const auto unscaled = [&](std::size_t s) {
    return start == WeightStart::near_springs ? std::pow(A.length(s), -near_exponent)
                                              : springs[s].stiffness * A.length(s);
  };
  Eigen::VectorXd share = Eigen::VectorXd::Zero(A.network.nodes());
  for (std::size_t s = 0; s < springs.size(); ++s)
    for (int side = 0; side < 2; ++side) share[A.sink(s, side)] += unscaled(s) * A.length(s);
  std::vector<double> w;
  for (std::size_t s = 0; s < springs.size(); ++s)
    for (int side = 0; side < 2; ++side) {
      const int n = A.sink(s, side);
      w.push_back(dimensions * target[per_node * n] / share[n] * unscaled(s));
    }
  return w;
}

/// Applies the smallest change of w, relative to w, that meets the conditions.  Returns the number of iterations.
int correct(const Conditions& A, const Eigen::VectorXd& target, std::vector<double>& w) {
  const std::vector<double> D = w;
  Eigen::VectorXd met, diagonal(target.size());
  A.apply(w, met);
  const Eigen::VectorXd missing = target - met;
  if (!(missing.norm() > 1e-13 * target.norm())) return 0;
  std::vector<double> change;
  double slack = 0;  // regularisation, as a fraction of the diagonal of A D A^T
  std::vector<Block> inverse = A.inverse_blocks(D, slack, diagonal);
  const Operator normal = [&](const Eigen::VectorXd& y, Eigen::VectorXd& r) {
    A.transpose(y, D, change);
    A.apply(change, r);
    if (slack > 0) r += slack * diagonal.cwiseProduct(y);
  };
  const Operator jacobi = [&](const Eigen::VectorXd& r, Eigen::VectorXd& z) {
    z.resize(r.size());
    for (int n = 0; n < A.network.nodes(); ++n)
      z.segment<per_node>(per_node * n) = inverse[n] * r.segment<per_node>(per_node * n);
  };
  // At a disordered surface some conditions contradict each other; on a lattice or without a surface they do not.
  const bool consistent = is_lattice(A.network) || !A.network.image_of.empty();
  Eigen::VectorXd y = Eigen::VectorXd::Zero(target.size());
  KrylovResult k;
  k.residual = 1;
  if (consistent) k = conjugate_gradients(normal, jacobi, missing, 1e-12 * target.norm() / missing.norm(), 2000, y);
  if (!(k.residual < 1e-6)) {
    slack = smallest_slack;
    inverse = A.inverse_blocks(D, slack, diagonal);
    y.setZero();
    k = conjugate_gradients(normal, jacobi, missing, 1e-6, 2000, y);
  }
  A.transpose(y, D, change);
  for (std::size_t e = 0; e < w.size(); ++e) w[e] += change[e];
  return k.iterations;
}

/// Each node for itself.
std::vector<int> own_groups(const Network& network) {
  std::vector<int> group(network.nodes());
  for (int n = 0; n < network.nodes(); ++n) group[n] = network.master(n);
  return group;
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
  std::vector<int> group = own_groups(network);
  std::vector<double> shortest(network.nodes(), std::numeric_limits<double>::infinity());
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

DispersionWeights volume_weights(const Network& network, const NodalVectors& volume_gradient, double shear_modulus,
                                 WeightStart start) {
  const Conditions A(network, start == WeightStart::near_springs ? own_groups(network) : volume_groups(network));
  const int dimensions = network.triangles.empty() ? 3 : 2;
  const Eigen::VectorXd target = A.target(volume_gradient, dimensions);
  DispersionWeights result;
  result.group = A.group;
  result.weight = edge_weights(network, A.unit);
  result.residual = A.residual(result.weight, target);
  if (!(result.residual < 1e-9)) {
    result.weight = first_weights(A, start, target, dimensions);
    result.iterations = correct(A, target, result.weight);
    result.residual = A.residual(result.weight, target);
  }
  if (!(result.residual < largest_residual))
    throw std::runtime_error(
        fmt::format("the dispersion weights cannot be made exact (residual {:.1e}): too few springs at too many nodes",
                    result.residual));
  const double scale = 2 * (dimensions + 2) * shear_modulus * A.unit * A.unit;
  for (double& e : result.weight) e *= scale;
  return result;
}

}  // namespace springproof
