#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "meshes/volume.h"
#include "msm/solve/cell_stiffness.h"
#include "msm/solve/cost.h"
#include "msm/solve/equilibrium.h"
#include "msm/solve/krylov.h"
#include "msm/solve/multigrid.h"

namespace springproof {
namespace {

Eigen::Map<const Eigen::VectorXd> flat(const NodalVectors& v) { return {v.data(), v.size()}; }

constexpr int cholesky_limit = 8000;  // free unknowns; above it CG with the rest state's multigrid

/// One load step either lands on a stable state or says why not.
enum class Outcome { accepted, unstable, inverted, not_converged };

struct Newton {
  const MassSpringModel& model;
  const LoadPath& path;
  const NewtonOptions& options;
  const std::vector<char> fixed;
  std::unique_ptr<Multigrid> multigrid;  ///< of the rest state, kept throughout; empty: direct solves
  BlockMatrix K;                         ///< tangent at the last factored state
  DirectSolver direct;                   ///< its factors
  double stiffness = 0;                  ///< largest diagonal entry at rest [N/m]
  int iterations = 0;

  Newton(const MassSpringModel& m, const LoadPath& p, const NewtonOptions& o, const std::vector<char>& fixed_unknowns)
      : model(m), path(p), options(o), fixed(fixed_unknowns), K(coupled_nodes(m.network)) {
    if (unknowns() > cholesky_limit && m.network.grid)
      multigrid = std::make_unique<Multigrid>(lattice_levels(m.network, fixed), cell_stiffness(m).total);
  }

  long unknowns() const { return std::count(fixed.begin(), fixed.end(), 0); }

  /// Unbalanced force on free unknowns, relative to the forces that are in balance (or, for motions that need next
  /// to none, a thousandth of stiffness times displacement).
  double residual(const NodalVectors& x, const NodalVectors& external, Eigen::VectorXd& r) const {
    r = flat(forces(model, x)) + flat(external);
    double on_fixed = 0, on_free = 0;
    for (Eigen::Index i = 0; i < r.size(); ++i) {
      (fixed[i] ? on_fixed : on_free) += r[i] * r[i];
      if (fixed[i]) r[i] = 0;
    }
    const double floor = 1e-3 * stiffness * (x - model.network.X).cwiseAbs().maxCoeff();
    const double scale = std::max({std::sqrt(on_fixed), external.norm(), floor});
    return scale > 0 ? std::sqrt(on_free) / scale : std::sqrt(on_free);
  }

  /// Takes over the tangent at x; false if it is seen not to be positive definite.
  bool factor(const NodalVectors& x) {
    update_tangent(model, x, K);
    return multigrid || direct.factor(K, fixed);
  }

  /// x = K^-1 b on the free unknowns; false if K is not positive definite.
  bool solve(const Eigen::VectorXd& b, double tolerance, Eigen::VectorXd& x) const {
    if (!multigrid) {
      direct.solve(b, x);
      return true;
    }
    const Operator apply = [&](const Eigen::VectorXd& v, Eigen::VectorXd& y) {
      K.multiply(v, y);
      clear_fixed(y);
    };
    x.setZero(b.size());
    Eigen::VectorXd free = b;
    clear_fixed(free);
    return !conjugate_gradients(apply, [&](const auto& r, auto& z) { multigrid->apply(r, z); }, free, tolerance, 4000, x)
                .negative_curvature;
  }

  /// Positive definiteness of the tangent taken over last: the factors tell; without them, conjugate gradients on an
  /// arbitrary right-hand side meet a direction of negative curvature if there is one (Lanczos).
  bool stable() const {
    if (!multigrid) return direct.negative_pivots() == 0;
    Eigen::VectorXd b(static_cast<Eigen::Index>(fixed.size())), x;
    unsigned state = 1;
    for (double& value : b) value = static_cast<double>(state = 1664525u * state + 1013904223u) / 4294967296.0 - 0.5;
    return solve(b, 1e-6, x);
  }

  void clear_fixed(Eigen::VectorXd& v) const {
    for (std::size_t i = 0; i < fixed.size(); ++i)
      if (fixed[i]) v[i] = 0;
  }

  double potential(const NodalVectors& x, const NodalVectors& external) const {
    return energy(model, x) - (x - model.network.X).cwiseProduct(external).sum();
  }

  /// First guess: the linear response to the increment of everything prescribed.
  NodalVectors predict(const NodalVectors& x, const BoundaryConditions& bc) const {
    NodalVectors du = NodalVectors::Zero(x.rows(), 3);
    for (Eigen::Index i = 0; i < du.size(); ++i)
      if (fixed[i]) du.data()[i] = model.network.X.data()[i] + bc.prescribed.data()[i] - x.data()[i];
    Eigen::VectorXd r, Kdu, correction;
    K.multiply(flat(du), Kdu);
    residual(x, bc.external, r);
    solve(r - Kdu, 1e-3, correction);
    return x + du + Eigen::Map<const NodalVectors>(correction.data(), x.rows(), 3);
  }

  /// Moves x along du by the largest of 1, 1/2, 1/4 ... that lowers the potential (or the residual, at round-off).
  bool line_search(const Eigen::VectorXd& r, double relative, const Eigen::VectorXd& du, const NodalVectors& external,
                   NodalVectors& x) const {
    const double start = potential(x, external), slope = -r.dot(du);
    const double noise = 1e-12 * (std::abs(start) + std::abs(slope));
    for (double t = 1; t > 1e-4; t /= 2) {
      const NodalVectors trial = x + t * Eigen::Map<const NodalVectors>(du.data(), x.rows(), 3);
      const double now = potential(trial, external);
      Eigen::VectorXd ignored;
      const bool lower = now <= start + 1e-4 * t * slope;
      const bool at_noise = std::abs(now - start) <= noise && residual(trial, external, ignored) < relative;
      if (std::isfinite(now) && (lower || at_noise)) {
        x = trial;
        return true;
      }
    }
    return false;
  }

  Outcome step(double factor_of_load, NodalVectors& x, double& relative) {
    const BoundaryConditions bc = path(factor_of_load);
    NodalVectors trial = predict(x, bc);
    for (int i = 0; i < options.max_iterations; ++i) {
      Eigen::VectorXd r, du;
      relative = residual(trial, bc.external, r);
      if (!std::isfinite(relative)) return Outcome::not_converged;
      const bool definite = factor(trial);
      if (relative <= options.tolerance) {
        if (!definite || !stable()) return Outcome::unstable;
        if (min_relative_jacobian({model.network.X, model.network.cells, {}, {}, {}, {}}, trial) <= 0)
          return Outcome::inverted;
        x = trial;
        return Outcome::accepted;
      }
      ++iterations;
      if (!definite) return Outcome::unstable;
      if (!solve(r, std::clamp(1e-2 * relative, 1e-8, 1e-3), du)) return Outcome::unstable;
      if (!line_search(r, relative, du, bc.external, trial)) return Outcome::not_converged;
    }
    return Outcome::not_converged;
  }
};

std::string describe(Outcome outcome, double reached) {
  const char* why = outcome == Outcome::unstable   ? "the tangent stiffness is no longer positive definite (limit point or buckling)"
                    : outcome == Outcome::inverted ? "a cell is turned inside out"
                                                   : "Newton's method does not converge";
  return fmt::format("no stable equilibrium beyond {:.4g} of the load: {}", reached, why);
}

}  // namespace

Equilibrium solve_finite(const MassSpringModel& model, const LoadPath& load_path, const NewtonOptions& options) {
  const double start = cpu_seconds();
  const BoundaryConditions full = load_path(1.0);
  Newton newton(model, load_path, options, full.fixed);
  Equilibrium result;
  result.load_reached = 0;
  NodalVectors x = model.network.X;
  int steps = 0;
  if (model.small_displacements_only) {
    result.message = "this model holds for linear kinematics only";
  } else if (!newton.factor(x)) {
    result.message = "the stiffness at rest is not positive definite: the model has zero-energy or unstable modes";
  } else {
    newton.stiffness = newton.K.diagonal().maxCoeff();
    double step = options.first_step;
    while (result.load_reached < 1 && step >= options.smallest_step) {
      const double next = std::min(1.0, result.load_reached + step);
      const Outcome outcome = newton.step(next, x, result.residual);
      if (outcome == Outcome::accepted) {
        result.load_reached = next;
        ++steps;
        step *= 1.5;
      } else {
        newton.factor(x);
        step = std::min(step, next - result.load_reached) / 2;
        result.message = describe(outcome, result.load_reached);
      }
    }
  }
  result.ok = result.load_reached >= 1;
  if (result.ok) result.message.clear();
  const BoundaryConditions reached = load_path(result.load_reached);
  result.displacement = x - model.network.X;
  result.support = -forces(model, x) - reached.external;
  for (Eigen::Index i = 0; i < result.support.size(); ++i)
    if (!full.fixed[i]) result.support.data()[i] = 0;
  result.solver = fmt::format("Newton + {}, {} load step{}", newton.multigrid ? "CG with multigrid" : "Cholesky", steps,
                              steps == 1 ? "" : "s");
  result.iterations = newton.iterations;
  result.unknowns = newton.unknowns();
  result.seconds = cpu_seconds() - start;
  result.memory_MiB = peak_memory_MiB();
  return result;
}

}  // namespace springproof
