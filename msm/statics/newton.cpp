#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "meshes/volume.h"
#include "msm/algebra/direct_solver.h"
#include "msm/algebra/fixed.h"
#include "msm/algebra/noise.h"
#include "msm/laws/capabilities.h"
#include "msm/statics/equilibrium.h"
#include "msm/statics/mixed_form.h"
#include "msm/statics/mixed_newton.h"
#include "msm/statics/stiffness_solver.h"
#include "problem/system/progress.h"
#include "problem/system/run_cost.h"

namespace springproof {
namespace {

constexpr int most_newton_steps = 30;
constexpr double settled = 1e-3;  // relative change of the stiffness

/// Per axis sum |u_j - u_i|^2 over sum |u_i|^2 + |u_j|^2 of the edges of all cells.
Vec3 alternation_of(const Network& network, const NodalVectors& u) {
  Vec3 change = Vec3::Zero(), size = Vec3::Zero();
  for (const Hexahedron& cell : network.cells.corners)
    for (int a = 0; a < 8; ++a)
      for (int b = a + 1; b < 8; ++b) {
        const auto &p = hexahedron_corners[a], &q = hexahedron_corners[b];
        const std::array<bool, 3> apart = {p[0] != q[0], p[1] != q[1], p[2] != q[2]};
        if (apart[0] + apart[1] + apart[2] != 1) continue;
        const int axis = apart[0] ? 0 : apart[1] ? 1 : 2;
        change[axis] += (u.row(cell[b]) - u.row(cell[a])).squaredNorm();
        size[axis] += u.row(cell[a]).squaredNorm() + u.row(cell[b]).squaredNorm();
      }
  return (size.array() > 0).select(change.cwiseQuotient(size), 0.0);
}

/// By inverse iteration with the tangent K of the state against that at rest, on the free unknowns: a state that is
/// about to be lost has a stiffness near 0, and the motion that grows there.
/// @param model a conservative one
/// @param K its tangent at the state, positive definite
/// @param fixed unknowns
SoftestMotion softest_motion(const MassSpringModel& model, const StiffnessSolver& K, const std::vector<char>& fixed) {
  const Tangent rest = tangent(model, model.network.X);
  Eigen::VectorXd u(static_cast<Eigen::Index>(fixed.size())), Ku, Ru;
  fill_with_noise(u);
  clear_fixed(fixed, u);
  double stiffness = std::numeric_limits<double>::infinity();
  for (int i = 0; i < most_newton_steps; ++i) {
    rest.multiply(u, Ru);
    Eigen::VectorXd next;
    if (!K.solve(Ru / Ru.norm(), 1e-4, 4000, next).converged) break;
    u = next / next.norm();
    K.multiply(u, Ku);
    rest.multiply(u, Ru);
    const double before = std::exchange(stiffness, u.dot(Ku) / u.dot(Ru));
    if (std::abs(stiffness - before) < settled * stiffness) break;
  }
  return {stiffness, alternation_of(model.network, by_point(u))};
}

constexpr long dispersive_limit = 4000;  // the factors of momentum dispersion are several times as large

/// Whether a corner of a cell is turned inside out; of cut cells, which have corners outside of the body, the filled
/// part as a whole.
bool has_inverted_cell(const Network& network, NodalVectors x) {
  carry(network.cells.carried, x);
  if (!network.cells.cut()) return min_relative_jacobian({network.X, network.cells.corners, {}, {}, {}, {}}, x) <= 0;
  for (std::size_t c = 0; c < network.cells.size(); ++c)
    if (cell_volume(network, c, x).value <= 0) return true;
  return false;
}

struct Newton {
  const MassSpringModel& model;
  const LoadPath& path;
  const NewtonOptions& options;
  const std::vector<char> fixed;
  const std::unique_ptr<StiffnessSolver> K;  ///< tangent at the state of the last take()
  std::unique_ptr<MixedNewton> mixed;        ///< near nu = 1/2; null: the form without pressures
  double stiffness = 0;                      ///< largest diagonal entry at rest [N/m]
  int iterations = 0;

  Newton(const MassSpringModel& m, const LoadPath& p, const NewtonOptions& o, const std::vector<char>& fixed_unknowns)
      : model(m),
        path(p),
        options(o),
        fixed(fixed_unknowns),
        K(solver_for(m, fixed_unknowns, dispersion_of(m) ? dispersive_limit : cholesky_limit)) {
    if (K->unknowns() > cholesky_limit && !dispersion_of(m) && mixed_form_pays(m))
      mixed = std::make_unique<MixedNewton>(m, fixed_unknowns);
  }

  /// Unbalanced force on free unknowns, relative to the reactions and external forces (or, for motions that need almost
  /// none, a thousandth of stiffness times displacement).
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

  /// Whether an unbalanced force is that of the rounding of positions, ten times over, in the stiffest cells: a body a
  /// part of which is far stiffer than another has it above the tolerance under small loads.
  bool is_round_off(const Eigen::VectorXd& r) const {
    const double rounding = 10 * std::numeric_limits<double>::epsilon() * model.network.X.cwiseAbs().maxCoeff();
    return r.norm() <= stiffness * rounding * std::sqrt(static_cast<double>(r.size()));
  }

  /// du = K^-1 b; false if K is found not to be positive definite.
  bool solve(const Eigen::VectorXd& b, double tolerance, Eigen::VectorXd& du) const {
    return !K->solve(b, tolerance, 4000, du).negative_curvature;
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
    K->multiply(flat(du), Kdu);
    residual(x, bc.external, r);
    solve(r - Kdu, 1e-3, correction);
    return x + du + by_point(correction);
  }

  /// Moves x along du by the largest of 1, 1/2, 1/4 ... that lowers the potential (or the residual, at round-off and
  /// for forces without a potential).
  bool line_search(const Eigen::VectorXd& r, double relative, const Eigen::VectorXd& du, const NodalVectors& external,
                   NodalVectors& x) const {
    const double start = potential(x, external), slope = -r.dot(du);
    const bool has_potential = can(model, Capability::energy);
    const double noise = 1e-12 * (std::abs(start) + std::abs(slope));
    for (double t = 1; t > 1e-4; t /= 2) {
      const NodalVectors trial = x + t * by_point(du);
      const double now = potential(trial, external);
      Eigen::VectorXd ignored;
      const bool lower = has_potential && now <= start + 1e-4 * t * slope;
      const bool at_noise = !has_potential || std::abs(now - start) <= noise;
      if (std::isfinite(now) && (lower || (at_noise && residual(trial, external, ignored) < relative))) {
        x = trial;
        return true;
      }
    }
    return false;
  }

  /// Checks the stability of a state in equilibrium; x becomes it if it is accepted.
  Loss judge(const NodalVectors& trial, bool definite, NodalVectors& x) const {
    if (!definite || !K->stable()) return Loss::unstable;
    if (has_inverted_cell(model.network, trial)) return Loss::inverted_cell;
    x = trial;
    return Loss::none;
  }

  Loss mixed_step(const BoundaryConditions& bc, NodalVectors& x, double& relative) {
    NodalVectors trial = x;
    const int before = mixed->iterations();
    const bool balanced = mixed->step(bc, options.tolerance, options.max_iterations, trial);
    iterations += mixed->iterations() - before;
    if (!balanced) return Loss::no_convergence;
    Eigen::VectorXd r;
    relative = residual(trial, bc.external, r);
    const bool definite = K->take(trial);
    const Loss loss = judge(trial, definite, x);
    if (loss == Loss::none) mixed->accept();
    return loss;
  }

  Loss step(double factor_of_load, NodalVectors& x, double& relative) {
    const BoundaryConditions bc = path(factor_of_load);
    progress::detail([&] {
      return fmt::format("{} unknowns, load step to {:.3g} %, {} Newton steps so far", K->unknowns(),
                         100 * factor_of_load, iterations);
    });
    if (mixed)
      if (const Loss loss = mixed_step(bc, x, relative); loss != Loss::no_convergence) return loss;
    NodalVectors trial = predict(x, bc);
    double before = std::numeric_limits<double>::infinity();  // the residual
    for (int i = 0; i < options.max_iterations; ++i) {
      Eigen::VectorXd r, du;
      relative = residual(trial, bc.external, r);
      if (!std::isfinite(relative)) return Loss::no_convergence;
      const bool definite = K->take(trial);
      const bool no_less = relative > 0.5 * std::exchange(before, relative);
      if (relative <= options.tolerance || (no_less && is_round_off(r))) return judge(trial, definite, x);
      ++iterations;
      progress::detail([&] {
        return fmt::format("{} unknowns, load step to {:.3g} %, Newton step {}, residual {:.1e}", K->unknowns(),
                           100 * factor_of_load, i + 1, relative);
      });
      if (!definite) return Loss::unstable;
      if (!solve(r, std::clamp(1e-2 * relative, 1e-8, 1e-3), du)) return Loss::unstable;
      if (!line_search(r, relative, du, bc.external, trial)) return Loss::no_convergence;
    }
    return Loss::no_convergence;
  }
};

std::string describe(Loss loss, double reached) {
  if (loss == Loss::no_convergence)
    return fmt::format(
        "no state was found beyond {:.4g} of the load: Newton's method does not converge, which proves "
        "no loss of equilibrium",
        reached);
  return fmt::format("no stable equilibrium beyond {:.4g} of the load: {}", reached,
                     loss == Loss::unstable
                         ? "the tangent stiffness is no longer positive definite (limit point or buckling)"
                         : "a cell is turned inside out");
}

}  // namespace

Equilibrium solve_finite(const MassSpringModel& model, const LoadPath& load_path, const NewtonOptions& options) {
  const double start = cpu_seconds();
  const BoundaryConditions full = load_path(1.0);
  Newton newton(model, load_path, options, fixed_or_carried(model.network, full.fixed));
  Equilibrium result;
  result.load_reached = 0;
  NodalVectors x = model.network.X;
  int steps = 0;
  if (model.small_displacements_only) {
    result.message = "this model holds for linear kinematics only";
  } else if (!newton.K->take(x)) {
    result.message = "the stiffness at rest is not positive definite: the model has zero-energy or unstable modes";
  } else {
    newton.stiffness = newton.K->diagonal().maxCoeff();
    double step = options.first_step;
    while (result.load_reached < 1 && step >= options.smallest_step) {
      const double next = std::min(1.0, result.load_reached + step);
      const Loss loss = newton.step(next, x, result.residual);
      if (loss == Loss::none) {
        result.load_reached = next;
        ++steps;
        step *= 1.5;
      } else {
        newton.K->take(x);
        step = std::min(step, next - result.load_reached) / 2;
        result.message = describe(loss, result.load_reached);
        result.loss = loss;
      }
    }
  }
  result.ok = result.load_reached >= 1;
  if (result.ok) result.message.clear(), result.loss = Loss::none;
  if (options.softest_motion && newton.stiffness > 0 && can(model, Capability::energy))
    result.softest = softest_motion(model, *newton.K, full.fixed);
  const BoundaryConditions reached = load_path(result.load_reached);
  result.displacement = x - model.network.X;
  carry(model.network.cells.carried, result.displacement);
  result.support = support_forces(model, x, reached);
  result.solver =
      fmt::format("Newton + {}, {} load step{}", newton.mixed ? "GMRES + mixed multigrid" : newton.K->name(), steps,
                  steps == 1 ? "" : "s");
  result.iterations = newton.iterations;
  result.unknowns = newton.K->unknowns();
  result.seconds = cpu_seconds() - start;
  result.memory_MiB = peak_memory_MiB();
  return result;
}

}  // namespace springproof
