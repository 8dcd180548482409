// Newton's method with load steps.  Part of elastic_solver.cpp, as stiffness.h.
#pragma once

#include "fem_reference/elastic_system.h"
#include "fem_reference/finite_operator.h"
#include "fem_reference/krylov.h"
#include "fem_reference/v_cycle.h"

namespace springproof::fem::SPRINGPROOF_SOLVER_NAMESPACE {

template <int degree>
class Newton {
 public:
  Newton(const ElasticSystem& system, const FiniteProblem& problem, const DofVector& load)
      : system_(system),
        problem_(problem),
        load_(load),
        base_(system.dof_handler, dealii::numbers::invalid_unsigned_int, system.constrained,
              {system.mu, 0, false}),
        multigrid_(system, coarse_coefficients(system)),
        K_(base_, problem.law, system.form, system.lambda),
        x_(K_.vector()),
        r_(x_),
        f_(x_),
        dx_(x_),
        z_(x_) {}

  FiniteAnswer solve(DofVector& displacement) {
    FiniteAnswer answer;
    answer.load_reached = 0;
    double step = problem_.first_step;
    MixedVector accepted = x_;
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
    return answer;
  }

 private:
  static Coefficients<float> coarse_coefficients(const ElasticSystem& system) {
    if (system.form == Form::mixed) return {float(system.mu), 0, false};
    return {float(system.mu), float(system.lambda), system.form == Form::mean_dilatation};
  }

  // r_ = load - internal force where free, and minus the pressure's residual; f_ is that of x_.  Returns its
  // size relative to the forces at work.
  double residual(double factor) {
    r_ = f_;
    r_.sadd(-1, 0, r_);
    r_.u.add(factor, load_);
    double reaction = r_.u.l2_norm();
    base_.clear_constrained(r_.u);
    reaction = std::max(reaction, factor * load_.l2_norm());
    return reaction > 0 ? r_.u.l2_norm() / reaction : 0;
  }

  bool equilibrate(double from, double to, FiniteAnswer& answer) {
    if (K_.linearise(f_, x_) <= 0) return false;
    residual(to);
    // The prescribed increment goes in through the first tangent: K du = r with du given where constrained.
    problem_.prescribe(from, dx_.u);
    problem_.prescribe(to, z_.u);
    MixedVector given = K_.vector();
    for (const unsigned int i : system_.constrained)
      given.u.local_element(i) = z_.u.local_element(i) - dx_.u.local_element(i);
    K_.apply(f_, given);
    base_.clear_constrained(f_.u);
    r_.add(-1, f_);
    double eta = 1e-3;
    double last = std::numeric_limits<double>::infinity();
    for (int iteration = 0; iteration < 25; ++iteration) {
      correct(eta, answer);
      if (iteration == 0) dx_.add(1, given);
      if (!advance(iteration == 0)) return false;
      const double now = residual(to);
      ++answer.newton_iterations;
      if (now <= system_.tolerance && pressure_residual() <= system_.tolerance) return true;
      if (!(now < 1e3 * last)) return false;
      eta = std::clamp(0.1 * now, 1e-6, 1e-2);
      last = now;
    }
    return false;
  }

  void correct(double eta, FiniteAnswer& answer) {
    multigrid_.deform(x_.u);
    dx_.sadd(0, 0, dx_);
    const auto precondition = [&](MixedVector& z, const MixedVector& r) {
      multigrid_.vmult(z.u, r.u);
      K_.precondition_pressure(z.p, r.p);
    };
    const auto multiply = [&](MixedVector& y, const MixedVector& v) { K_.vmult(y, v); };
    answer.iterations += gmres(multiply, precondition, r_, eta, 200, dx_).iterations;
  }

  // x_ += dx_, or less of it, so that no cell turns inside out; the first step carries the prescribed
  // increment and cannot be shortened.
  bool advance(bool whole) {
    const MixedVector start = x_;
    for (double part = 1; part > 0.05; part /= 2) {
      x_.add(part, dx_);
      if (K_.linearise(f_, x_) > 0) return true;
      if (whole) return false;
      x_ = start;
    }
    return false;
  }

  // Largest lack of dilatation of a pressure function, per volume.
  double pressure_residual() {
    if (system_.form != Form::mixed) return 0;
    K_.precondition_pressure(z_.p, r_.p);
    return z_.p.linfty_norm() / (2 * system_.mu);
  }

  const ElasticSystem& system_;
  const FiniteProblem& problem_;
  const DofVector& load_;
  Stiffness<degree, double> base_;
  VCycle<degree> multigrid_;
  FiniteOperator<degree> K_;
  MixedVector x_, r_, f_, dx_, z_;
};

}  // namespace springproof::fem::SPRINGPROOF_SOLVER_NAMESPACE
