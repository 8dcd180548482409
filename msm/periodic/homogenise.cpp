#include "msm/periodic/homogenise.h"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <array>
#include <cmath>
#include <stdexcept>

#include "msm/algebra/krylov.h"
#include "msm/laws/capabilities.h"
#include "msm/statics/stiffness_solver.h"

namespace springproof {
namespace {

constexpr double companion_tolerance = 1e-6;  // of the companion's solves; GMRES removes their error after a restart

using Strains = std::vector<Eigen::Matrix3d>;

/// Unit strain; shears are engineering strains.
Eigen::Matrix3d unit_strain(int i, int j) {
  Eigen::Matrix3d strain = Eigen::Matrix3d::Zero();
  strain(i, j) += 0.5;
  strain(j, i) += 0.5;
  return strain;
}

/// The tangent at rest as an operator on the masters: w -> P^T K P w.
class PeriodicStiffness {
 public:
  explicit PeriodicStiffness(const MassSpringModel& model)
      : network_(model.network), K_(tangent(model, model.network.X)) {
    inverse_diagonal_ = gather(K_.diagonal());
    for (double& d : inverse_diagonal_) d = d > 0 ? 1 / d : 0;
  }

  void multiply(const Eigen::VectorXd& u, Eigen::VectorXd& Ku) const { K_.multiply(u, Ku); }

  /// P^T f: adds the forces on images to their masters.
  Eigen::VectorXd gather(Eigen::VectorXd f) const {
    for (int n = 0; n < network_.nodes(); ++n) {
      const int master = network_.master(n);
      if (master == n) continue;
      f.segment<3>(3 * master) += f.segment<3>(3 * n);
      f.segment<3>(3 * n).setZero();
    }
    return f;
  }

  /// P w: images move as their masters.
  Eigen::VectorXd spread(Eigen::VectorXd w) const {
    for (int n = 0; n < network_.nodes(); ++n) w.segment<3>(3 * n) = w.segment<3>(3 * network_.master(n)).eval();
    return w;
  }

  Operator operation() const {
    return [this](const Eigen::VectorXd& w, Eigen::VectorXd& y) {
      Eigen::VectorXd f;
      K_.multiply(spread(w), f);
      y = gather(std::move(f));
    };
  }

  Operator jacobi() const {
    return [this](const Eigen::VectorXd& r, Eigen::VectorXd& z) { z = inverse_diagonal_.cwiseProduct(r); };
  }

  /// Removes the net force, which cannot be in equilibrium: round-off in exact loads.
  Eigen::VectorXd balanced(Eigen::VectorXd f) const {
    Vec3 net = Vec3::Zero();
    int masters = 0;
    for (int n = 0; n < network_.nodes(); ++n) {
      net += f.segment<3>(3 * n);
      masters += network_.master(n) == n;
    }
    for (int n = 0; n < network_.nodes(); ++n)
      if (network_.master(n) == n) f.segment<3>(3 * n) -= net / masters;
    return f;
  }

  /// Magnitude of the forces that a displacement causes before they cancel.
  double force_scale(const Eigen::VectorXd& u) const { return K_.diagonal().cwiseProduct(u).norm(); }

 private:
  const Network& network_;
  Tangent K_;
  Eigen::VectorXd inverse_diagonal_;
};

KrylovResult relax(const PeriodicStiffness& K, const PeriodicStiffness* companion, const Eigen::VectorXd& b,
                   const HomogeniseOptions& options, Eigen::VectorXd& w) {
  const auto solve = [&](const PeriodicStiffness& matrix, double tolerance, const Eigen::VectorXd& load,
                         Eigen::VectorXd& x) {
    const KrylovResult result = conjugate_gradients(matrix.operation(), matrix.jacobi(), matrix.balanced(load),
                                                    tolerance, options.max_iterations, x);
    if (result.negative_curvature)
      throw std::runtime_error("the network is unstable: a periodic mode has negative energy");
    return result;
  };
  if (!companion) return solve(K, options.tolerance, b, w);
  int inner = 0;
  const Operator precondition = [&](const Eigen::VectorXd& r, Eigen::VectorXd& z) {
    z = Eigen::VectorXd::Zero(r.size());
    inner += solve(*companion, companion_tolerance, r, z).iterations;
  };
  KrylovResult result = gmres(K.operation(), precondition, b, options.tolerance, 200, 100, w);
  result.iterations += inner;
  return result;
}

/// The stiffness, and what it took to find it.
Homogenised effective_stiffness(const MassSpringModel& model, const Strains& strains,
                                const HomogeniseOptions& options) {
  const Network& network = model.network;
  if (network.image_of.empty()) throw std::invalid_argument("homogenisation needs a periodic network");
  const PeriodicStiffness K(model);
  std::unique_ptr<PeriodicStiffness> companion;
  const MassSpringModel energy_form = symmetric_companion(model);
  if (!can(model, Capability::energy)) companion = std::make_unique<PeriodicStiffness>(energy_form);

  const auto size = static_cast<Eigen::Index>(strains.size());
  Eigen::MatrixXd affine(3 * network.nodes(), size);
  for (Eigen::Index a = 0; a < size; ++a) {
    const NodalVectors u = network.X * strains[a];
    affine.col(a) = flat(u);
  }
  Homogenised effective{};
  effective.C.resize(size, size);
  Eigen::VectorXd force;
  for (Eigen::Index b = 0; b < size; ++b) {
    K.multiply(affine.col(b), force);
    const Eigen::VectorXd load = -K.gather(force);
    Eigen::VectorXd w = Eigen::VectorXd::Zero(load.size());
    if (load.norm() > 1e-13 * K.force_scale(affine.col(b))) {  // else round-off: the affine state is in equilibrium
      const KrylovResult result = relax(K, companion.get(), load, options, w);
      if (!result.converged)
        throw std::runtime_error(fmt::format("homogenisation did not converge: residual {:.1e} after {} iterations",
                                             result.residual, result.iterations));
      effective.iterations += result.iterations;
      effective.residual = std::max(effective.residual, result.residual);
    }
    K.multiply(affine.col(b) + K.spread(w), force);
    effective.C.col(b) = affine.transpose() * force / network.volume.sum();
  }
  return effective;
}

/// Factors that turn Voigt's matrix into Kelvin's, whose Frobenius norm is the tensor's.
Eigen::MatrixXd kelvin(Eigen::MatrixXd C, int normal_strains) {
  const Eigen::Index shears = C.rows() - normal_strains;
  C.bottomRows(shears) *= std::sqrt(2.0);
  C.rightCols(shears) *= std::sqrt(2.0);
  return C;
}

}  // namespace

Eigen::MatrixXd isotropic_stiffness(double K, double G, int dimensions) {
  const int shears = dimensions * (dimensions - 1) / 2;
  Eigen::MatrixXd C = Eigen::MatrixXd::Zero(dimensions + shears, dimensions + shears);
  C.topLeftCorner(dimensions, dimensions).setConstant(K - 2 * G / dimensions);
  C.diagonal().head(dimensions).array() += 2 * G;
  C.diagonal().tail(shears).setConstant(G);
  return C;
}

Homogenised homogenise(const MassSpringModel& model, const HomogeniseOptions& options) {
  const bool planar = !model.network.triangles.empty();
  Strains strains = {unit_strain(0, 0), unit_strain(1, 1), unit_strain(0, 1)};
  if (!planar)
    strains = {unit_strain(0, 0), unit_strain(1, 1), unit_strain(2, 2),
               unit_strain(1, 2), unit_strain(2, 0), unit_strain(0, 1)};
  Homogenised h = effective_stiffness(model, strains, options);
  // The eigenvalues of an isotropic tensor of d dimensions are d K and, all others, 2 G: projections of the tensor and
  // of its trace.
  const int d = planar ? 2 : 3;
  const Eigen::MatrixXd C = kelvin(h.C, d);
  const double K = h.C.topLeftCorner(d, d).sum() / (d * d), G = (C.trace() - d * K) / (d * (d + 1) - 2);
  const double scale = d * (d - 1) * K + 2 * G;
  h.bulk_modulus = K;
  h.shear_modulus = G;
  h.youngs_modulus = 2 * d * d * K * G / scale;
  h.poisson_ratio = (d * K - 2 * G) / scale;
  h.anisotropy = (C - kelvin(isotropic_stiffness(K, G, d), d)).norm() / C.norm();
  h.asymmetry = (C - C.transpose()).norm() / C.norm();
  return h;
}

}  // namespace springproof
