// Newton's method with load steps, for any operator that multiplies by the tangent.  Part of each solver, like
// mixed_field.h.
#pragma once

#include <deal.II/grid/grid_tools.h>
#include <fmt/format.h>

#include "fem_reference/solvers/block_triangular.h"
#include "fem_reference/solvers/krylov.h"
#include "fem_reference/solvers/mixed_field.h"
#include "fem_reference/system/elastic_system.h"
#include "problem/system/progress.h"

namespace springproof::fem::SPRINGPROOF_SOLVER_NAMESPACE {

// Operator: as for solve_linear, and
//   linearise(f, x)            residual at x on all degrees of freedom, and the tangent used from then on; returns the
//                              smallest det F; f and the tangent are valid only if it is positive
//   prepare(x)                 makes the preconditioner fit the state x
//   precondition_pressure(y, x)  its pressure part
// Where GMRES stalls, factorise() is tried once.
template <typename Operator>
class Newton {
 public:
  Newton(Operator& K, const ElasticSystem& system, const FiniteProblem& problem, const DofVector& load)
      : K_(K),
        system_(system),
        problem_(problem),
        load_(load),
        dot_(system),
        x_(K.vector()),
        r_(x_),
        f_(x_),
        dx_(x_),
        z_(x_),
        round_off_(round_off(system)) {}

  FiniteAnswer solve(DofVector& displacement) {
    FiniteAnswer answer;
    answer.load_reached = 0;
    double step = problem_.first_step;
    MixedField accepted = x_;
    while (answer.load_reached < 1) {
      const double target = std::min(1.0, answer.load_reached + step);
      x_ = accepted;
      if (equilibrate(answer.load_reached, target, answer)) {
        accepted = x_;
        answer.load_reached = target > 1 - 1e-12 ? 1 : target;
        ++answer.load_steps;
        step *= 1.5;
      } else {
        step /= 2;
        if (step < problem_.smallest_step) break;
      }
    }
    answer.converged = answer.load_reached == 1;
    x_ = accepted;
    answer.min_jacobian = K_.linearise(f_, x_);
    answer.residual = residual(answer.load_reached);
    answer.internal_force = f_.u;
    displacement = x_.u;
    if (system_.form == Form::mixed) answer.pressure = K_.pressures(x_);
    return answer;
  }

 private:
  // r_ = load - internal force where unconstrained, and minus the pressure's residual; f_ is the residual at x_.
  // Returns the norm of the force residual relative to load and reactions.
  double residual(double factor) {
    r_ = f_;
    r_.sadd(-1, 0, r_);
    r_.u.add(factor, load_);
    const double at_work = std::max(r_.u.l2_norm(), factor * load_.l2_norm());
    K_.clear_constrained(r_.u);
    return r_.u.l2_norm() / std::max(at_work, round_off_ / system_.tolerance);
  }

  bool equilibrate(double from, double to, FiniteAnswer& answer) {
    if (K_.linearise(f_, x_) <= 0) return false;
    residual(to);
    // The prescribed increment enters through the first tangent: K du = r with du given where constrained.
    problem_.prescribe(from, dx_.u);
    problem_.prescribe(to, z_.u);
    MixedField given = K_.vector();
    for (const unsigned int i : system_.constrained)
      if (given.u.in_local_range(i)) given.u(i) = z_.u(i) - dx_.u(i);
    K_.apply(f_, given);
    K_.clear_constrained(f_.u);
    r_.add(-1, f_);
    const double tolerance = to < 1 ? std::max(system_.tolerance, 1e-4) : system_.tolerance;
    double eta = 1e-3, before = 1;
    for (int iteration = 0; iteration < 25; ++iteration) {
      if (!correct(eta, answer)) return false;
      if (iteration == 0) dx_.add(1, given);
      if (!advance(iteration == 0)) return false;
      const double now = residual(to);
      ++answer.newton_iterations;
      if (now <= tolerance && pressure_residual() <= tolerance) return true;
      // Not converging: a shorter load step is cheaper.
      if ((iteration >= 4 && now > std::max(0.1, 0.6 * before)) || (iteration >= 12 && now > 1e-3)) return false;
      before = now;
      eta = std::clamp(std::max(0.1 * now, 0.3 * tolerance / now), 1e-6, 1e-2);
    }
    return false;
  }

  // Solves K dx_ = r_ to the relative tolerance eta.  False if GMRES stalls, as it does when the system has lost its
  // stability.
  bool correct(double eta, FiniteAnswer& answer) {
    K_.prepare(x_);
    const BlockTriangular<Operator> precondition(K_, system_);
    int products = answer.iterations;
    const auto multiply = [&](MixedField& y, const MixedField& v) {
      ++products;
      progress::detail([&] {
        return fmt::format("{} unknowns, {:.3g} % of the load reached, load step {}, Newton step {}, iteration {}",
                           load_.size(), 100 * answer.load_reached, answer.load_steps + 1, answer.newton_iterations + 1,
                           products);
      });
      K_.vmult(y, v);
    };
    const auto solved = [&] {
      dx_.sadd(0, 0, dx_);
      const KrylovOutcome outcome = gmres(multiply, precondition, dot_, r_, eta, 120, dx_);
      answer.iterations += outcome.iterations;
      return outcome.reduction < 0.2;
    };
    return solved() || (K_.factorise(x_) && solved());
  }

  // x_ += dx_, halved until no cell is inverted; the first of a load step (`whole`) is not shortened: it has the
  // prescribed increment, and where it inverts cells the load step is too long.
  bool advance(bool whole) {
    const MixedField start = x_;
    for (double part = 1; part > 0.05; part /= 2) {
      x_.add(part, dx_);
      if (K_.linearise(f_, x_) > 0) return true;
      if (whole) return false;
      x_ = start;
    }
    return false;
  }

  // Largest dilatation residual of a pressure function, per volume.
  double pressure_residual() {
    if (system_.form != Form::mixed) return 0;
    K_.precondition_pressure(z_.p, r_.p);
    return z_.p.linfty_norm() / (2 * system_.mu);
  }

  // Size of the rounding errors in the forces at a strain of one.
  static double round_off(const ElasticSystem& system) {
    const auto& triangulation = system.dof_handler.get_triangulation();
    const double length =
        dealii::Utilities::MPI::min(dealii::GridTools::minimal_cell_diameter(triangulation, *system.body.mapping),
                                    triangulation.get_communicator());
    return 1e-14 * system.mu * length * length * std::sqrt(double(system.dof_handler.n_dofs()));
  }

  Operator& K_;
  const ElasticSystem& system_;
  const FiniteProblem& problem_;
  const DofVector& load_;
  ResidualProduct dot_;
  MixedField x_, r_, f_, dx_, z_;
  double round_off_;
};

}  // namespace springproof::fem::SPRINGPROOF_SOLVER_NAMESPACE
