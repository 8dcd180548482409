#include "msm/coarsening/states.h"

#include <Eigen/Dense>
#include <cmath>
#include <stdexcept>

#include "msm/algebra/direct_solver.h"
#include "msm/algebra/noise.h"
#include "msm/embedding/boundary.h"
#include "msm/embedding/cut_lattice.h"
#include "msm/embedding/rigid_motions.h"
#include "msm/embedding/supports.h"
#include "msm/statics/stiffness_solver.h"

namespace springproof {
namespace {

constexpr int body_forces = 24, marks = 24, wrenches = 2 * marks;
constexpr double tolerance = 1e-5;

/// Numbers from [-1/2, 1/2), one after the other.
class Noise {
 public:
  Noise(unsigned series, std::size_t most) : values_((series + 1) * most) {
    fill_with_noise(values_);
    next_ = series * most;
  }
  double number() { return values_[next_++]; }
  Vec3 direction() {
    const double x = number(), y = number(), z = number();
    return Vec3(x, y, z).normalized();
  }
  int below(int n) { return std::min(n - 1, static_cast<int>((number() + 0.5) * n)); }

 private:
  std::vector<double> values_;
  std::size_t next_;
};

/// Nodes far from each other: the next is the farthest from all before.
std::vector<int> farthest_nodes(const NodalVectors& X, int count) {
  const Eigen::RowVector3d middle = X.colwise().mean();
  Eigen::VectorXd distance = (X.rowwise() - middle).rowwise().norm();
  std::vector<int> found;
  for (int m = 0; m < count; ++m) {
    Eigen::Index farthest;
    distance.maxCoeff(&farthest);
    found.push_back(static_cast<int>(farthest));
    const Eigen::VectorXd own = (X.rowwise() - X.row(farthest)).rowwise().norm();
    distance = m == 0 ? own : Eigen::VectorXd(distance.cwiseMin(own));
  }
  return found;
}

class Loads {
 public:
  explicit Loads(const Network& network) : X_(network.X), volume_(network.volume) {
    const double all = volume_.sum();
    middle_ = X_.transpose() * volume_ / all;
    inertia_.setZero();
    for (Eigen::Index n = 0; n < X_.rows(); ++n) {
      const Vec3 r = X_.row(n).transpose() - middle_;
      inertia_ += volume_[n] * (r.squaredNorm() * Eigen::Matrix3d::Identity() - r * r.transpose());
    }
  }

  /// f += force and torque spread over a Gaussian about a point.
  void add(const Vec3& at, double width, const Vec3& force, const Vec3& torque, NodalVectors& f) const {
    Eigen::VectorXd g(X_.rows());
    for (Eigen::Index n = 0; n < X_.rows(); ++n)
      g[n] = volume_[n] * std::exp(-(X_.row(n).transpose() - at).squaredNorm() / (2 * width * width));
    g /= g.sum();
    for (Eigen::Index n = 0; n < X_.rows(); ++n)
      f.row(n) += g[n] * (force + torque.cross(X_.row(n).transpose() - at) / (width * width)).transpose();
  }

  /// Takes the forces off that would accelerate the body.
  void balance(NodalVectors& f) const {
    Vec3 torque = Vec3::Zero();
    for (Eigen::Index n = 0; n < X_.rows(); ++n)
      torque += (X_.row(n).transpose() - middle_).cross(f.row(n).transpose());
    const Vec3 straight = f.colwise().sum().transpose() / volume_.sum(), turning = inertia_.ldlt().solve(torque);
    for (Eigen::Index n = 0; n < X_.rows(); ++n)
      f.row(n) -= volume_[n] * (straight + turning.cross(X_.row(n).transpose() - middle_)).transpose();
  }

 private:
  const NodalVectors& X_;
  const Eigen::VectorXd& volume_;
  Vec3 middle_;
  Eigen::Matrix3d inertia_;
};

/// Takes the rigid motions from fields of the nodes, one per column.
void remove_rigid_motions(const Network& network, Eigen::MatrixXd& fields) {
  const RigidMotions rigid{network.X};
  Eigen::MatrixXd R(fields.rows(), 6), weighted(fields.rows(), 6);
  for (int i = 0; i < fields.rows(); ++i) {
    R.row(i) = rigid.at(i).transpose();
    weighted.row(i) = network.volume[i / 3] * R.row(i);
  }
  const Eigen::Matrix<double, 6, 6> A = weighted.transpose() * R;
  fields -= R * A.ldlt().solve(weighted.transpose() * fields);
}

}  // namespace

std::vector<IsotropicMaterial> materials_of(const AveragedSprings& law) {
  std::vector<IsotropicMaterial> materials;
  for (std::size_t m = 0; m <= law.regions.size(); ++m) {
    const AveragedSprings& of = law.in(static_cast<int>(m));
    const double G = of.shear_modulus, lambda = of.lame_lambda, nu = lambda / (2 * (lambda + G));
    materials.push_back({2 * G * (1 + nu), nu, 1});
  }
  return materials;
}

MassSpringModel held_fine_cells(const FineCells& fine, const std::vector<std::string>& held,
                                const AveragedSprings& law) {
  return {cut_lattice(fine.body, held, materials_of(law)), {law, Anchors{}}};
}

void set_anchors(const CutBody& body, const std::vector<std::string>& held, const FineCells& fine,
                 const AveragedSprings& law, Network& network) {
  if (law.regions.empty()) return;
  const auto material_of = [&](int cell) { return materials_of(springs_in_cell(fine, cell, law)).front(); };
  auto anchor = network.anchors.begin();
  for (const std::string& name : held)
    for (const Anchor& there : anchors_of_patch(body, name, material_of)) (anchor++)->stiffness = there.stiffness;
}

Eigen::MatrixXd loads_all_over(const Network& network, unsigned series) {
  const NodalVectors& X = network.X;
  const double l = network.cells.edge;
  const Loads loads(network);
  Noise noise(series, 16 * (body_forces + wrenches));
  const std::vector<int> mark = farthest_nodes(X, marks);
  Eigen::MatrixXd all(X.size(), body_forces + wrenches);
  for (int i = 0; i < body_forces + wrenches; ++i) {
    NodalVectors f = NodalVectors::Zero(X.rows(), 3);
    if (i < body_forces) {
      const Vec3 at = X.row(noise.below(static_cast<int>(X.rows()))).transpose();
      loads.add(at, l * (2 + 2 * noise.number()), noise.direction(), Vec3::Zero(), f);
    } else {
      const int from = (i - body_forces) % marks, to = (from + 1 + noise.below(marks - 1)) % marks, kind = i % 3;
      const double width = l * (1.5 + noise.number());
      const Vec3 force = kind == 0 ? Vec3::Zero() : noise.direction();
      const Vec3 torque = kind == 1 ? Vec3::Zero() : Vec3(l * noise.direction());
      loads.add(X.row(mark[from]).transpose(), width, force, torque, f);
      loads.add(X.row(mark[to]).transpose(), width, -force, -torque, f);
    }
    if (network.anchors.empty()) loads.balance(f);
    all.col(i) = Eigen::Map<const Eigen::VectorXd>(f.data(), f.size());
  }
  return all;
}

Eigen::MatrixXd displacements_under(const MassSpringModel& model, const Eigen::MatrixXd& loads) {
  const Network& network = model.network;
  BoundaryConditions conditions;
  conditions.fixed.assign(network.X.size(), 0);
  conditions.owner.assign(network.X.size(), -1);
  conditions.prescribed = conditions.external = NodalVectors::Zero(network.X.rows(), 3);
  for (const Anchor& a : network.anchors) std::fill_n(conditions.fixed.begin() + 3 * a.node, 3, 1);
  const bool free = network.anchors.empty();
  if (free) hold_free_motions(network.X, conditions);
  const auto K = solver_for(model, conditions.fixed, cholesky_limit);
  if (!K->take(network.X)) throw std::runtime_error("the stiffness of the body is not positive definite");
  Eigen::MatrixXd states(loads.rows(), loads.cols());
  Eigen::VectorXd u;
  for (Eigen::Index i = 0; i < loads.cols(); ++i) {
    if (!K->solve(loads.col(i), tolerance, 2000, u).converged)
      throw std::runtime_error("a state of the body was not found");
    states.col(i) = u;
  }
  if (free) remove_rigid_motions(network, states);
  return states;
}

}  // namespace springproof
