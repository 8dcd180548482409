#include "fem_reference/motion.h"

#include <deal.II/dofs/dof_tools.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "fem_reference/body_cells.h"
#include "fem_reference/grid/processes.h"
#include "fem_reference/system/boundary_conditions.h"
#include "fem_reference/system/sample.h"
#include "problem/system/input_error.h"
#include "problem/system/progress.h"

namespace springproof::fem {
namespace {

using Eigen::VectorXd;

constexpr double newton_tolerance = 1e-7;  // last correction over the largest displacement so far
constexpr double exact_tolerance = 1e-10;  // of energy-momentum steps
constexpr int most_corrections = 80;
constexpr double slow = 0.6;     // ratio of two corrections above which new factors cost less than more corrections
constexpr double sudden = 1e-9;  // [s], as supports that move at the start do
constexpr double first_load_part = 0.25, smallest_load_part = 1. / 512;

/// The body in motion.
class MidpointRule {
 public:
  MidpointRule(const GridProblem& problem, const Body3& body, const dealii::DoFHandler<3>& dof_handler)
      : problem_(problem),
        body_(body),
        dof_handler_(dof_handler),
        motion_(*problem.motion),
        held_(prescribed(dof_handler, body, problem.loads)),
        cells_(problem, body, dof_handler, held_),
        x_(cells_.zero()),
        v_(x_.u),
        a_(x_.u),
        last_p_(x_.p) {
    set_load(0);
    if (motion_.released) check_held(held_, dof_handler.get_communicator());
    set_velocity(body, dof_handler);
  }

  const Unknowns& state() const { return x_; }
  const BodyCells& cells() const { return cells_; }
  double kinetic_energy() const { return v_.dot(cells_.times_mass(v_)) / 2; }
  Vec3 angular_momentum() const { return cells_.angular_momentum(rest_ + x_.u, v_); }
  int corrections() const { return corrections_; }
  int factorisations() const { return factorisations_; }

  /// The state at time 0; false: there is no equilibrium under the loads.
  bool start() {
    if (!motion_.released) {
      prescribe(support_factor(0), x_.u);
      cells_.relax({x_.u / 2, x_.p}, {0, 2 / sudden, VectorXd::Zero(x_.u.size())});
      return true;
    }
    double reached = 0, step = law_named(problem_.law) ? first_load_part : 1;
    while (reached < 1) {
      const double next = std::min(1.0, reached + step);
      const Unknowns before = x_;
      prescribe(next, x_.u);
      if (solve(x_, next, {}, nullptr, 0, VectorXd::Zero(x_.u.size()))) {
        reached = next;
        step *= 1.5;
      } else {
        x_ = before;
        step /= 2;
        if (step < smallest_load_part) return false;
      }
      needs_factors_ = true;
    }
    last_p_ = x_.p;
    return true;
  }

  /// From time `from` to `from` + dt; false: the step has no solution.
  bool advance(double from, double dt) {
    const double to = from + dt, inertia = 4 / (dt * dt) + 2 * motion_.damping / dt;
    VectorXd before = x_.u, after = x_.u, next = x_.u;
    prescribe(support_factor(from), before);
    prescribe(support_factor(to), after);
    prescribe(support_factor(to + dt), next);
    // Of the unknown middle: acceleration = inertia (middle - x) + offset where free, given where held.
    Unknowns middle{x_.u + dt / 2 * v_ + dt * dt / 8 * a_, 2 * x_.p - last_p_};  // a guess
    VectorXd offset = -2 / dt * v_ - inertia * x_.u, v_after(x_.u.size());
    for (const Prescribed& h : held_) {
      const auto i = Eigen::Index(h.dof);
      middle.u[i] = (before[i] + after[i]) / 2;
      v_after[i] = (next[i] - before[i]) / (2 * dt);
      const double acceleration = (v_after[i] - v_[i]) / dt + motion_.damping * (after[i] - before[i]) / dt;
      offset[i] = acceleration - inertia * middle.u[i];
    }
    const Unknowns* const start = motion_.energy_momentum ? &x_ : nullptr;
    const Viscous viscous{motion_.viscosity, 2 / dt, x_.u};
    if (problem_.body_force) set_load((from + to) / 2);
    if (!solve(middle, load_factor(from, to), viscous, start, inertia, offset)) return false;
    cells_.relax(middle, viscous);
    const VectorXd p = start ? VectorXd(2 * middle.p - x_.p) : middle.p;  // at the end of the step, or in its middle
    last_p_ = x_.p;
    x_.p = p;
    const VectorXd v_middle = 2 / dt * (middle.u - x_.u);
    a_ = 2 / dt * (v_middle - v_);
    x_.u = 2 * middle.u - x_.u;
    v_ = 2 * v_middle - v_;
    for (const Prescribed& h : held_) {
      const auto i = Eigen::Index(h.dof);
      x_.u[i] = after[i];
      v_[i] = v_after[i];
      a_[i] = 0;
    }
    return true;
  }

 private:
  void set_load(double time) {
    const DofVector load = load_vector(dof_handler_, body_, problem_, time);
    load_.resize(x_.u.size());
    for (Eigen::Index i = 0; i < load_.size(); ++i) load_[i] = load[i];
  }

  /// That of the whole body, about its centre of mass.
  void set_velocity(const Body3& body, const dealii::DoFHandler<3>& dof_handler) {
    std::map<dealii::types::global_dof_index, dealii::Point<3>> points;
    dealii::DoFTools::map_dofs_to_support_points(*body.mapping, dof_handler, points);
    const VectorXd mass = cells_.times_mass(VectorXd::Ones(v_.size()));
    Vec3 moment = Vec3::Zero(), total = Vec3::Zero();
    rest_.resize(v_.size());
    for (const auto& [dof, at] : points) {
      const int c = cells_.component(Eigen::Index(dof));
      rest_[Eigen::Index(dof)] = at[c];
      moment[c] += mass[Eigen::Index(dof)] * at[c];
      total[c] += mass[Eigen::Index(dof)];
    }
    const Vec3 centre = moment.cwiseQuotient(total);
    for (const auto& [dof, at] : points) {
      const auto i = Eigen::Index(dof);
      const Vec3 v = motion_.velocity + motion_.spin.cross(Vec3(at[0], at[1], at[2]) - centre);
      if (cells_.is_free(i)) v_[i] = v[cells_.component(i)];
    }
  }

  /// The mean over a step: the impulse of the loads is right however short they are.
  double load_factor(double from, double to) const {
    const double mean = (motion_.course.integral(to) - motion_.course.integral(from)) / (to - from);
    return motion_.released ? 1 - mean : mean;
  }
  double support_factor(double time) const { return motion_.released ? 1 : motion_.course.factor(time); }

  void prescribe(double factor, VectorXd& u) const {
    const Kinematics kinematics = law_named(problem_.law) ? Kinematics::finite : Kinematics::linear;
    for (const Prescribed& h : held_)
      u[h.dof] = *prescribed_displacement(problem_.loads[h.load()], h.X, kinematics, factor)[h.component];
  }

  /// Solves M (inertia x + offset) + internal and viscous force = factor * load for the free entries of x.
  bool solve(Unknowns& x, double factor, const Viscous& viscous, const Unknowns* before, double inertia,
             const VectorXd& offset) {
    double last = std::numeric_limits<double>::infinity();
    const double tolerance = before ? exact_tolerance : newton_tolerance,
                 rounding = std::numeric_limits<double>::epsilon() * rest_.lpNorm<Eigen::Infinity>();
    bool fresh = false;
    for (int k = 0; k < most_corrections; ++k) {
      Unknowns r;
      if (!(cells_.residual(x, viscous, before, r) > 0)) return false;
      if (needs_factors_) {
        cells_.factor(x, viscous, inertia);
        ++factorisations_;
        needs_factors_ = false;
        fresh = true;
      }
      r.u += cells_.times_mass(inertia * x.u + offset) - factor * load_;
      const Unknowns d = cells_.correction(r);
      const double size = d.u.lpNorm<Eigen::Infinity>();
      if (!std::isfinite(size)) return false;
      x.u -= d.u;
      x.p -= d.p;
      ++corrections_;
      largest_ = std::max(largest_, x.u.lpNorm<Eigen::Infinity>());
      if (size <= std::max(tolerance * largest_, rounding)) return true;
      if (size > slow * last) {
        if (fresh && size > last) return false;
        needs_factors_ = true;
        fresh = false;
      }
      last = size;
    }
    return false;
  }

  const GridProblem& problem_;
  const Body3& body_;
  const dealii::DoFHandler<3>& dof_handler_;
  const MotionRequest& motion_;
  std::vector<Prescribed> held_;
  BodyCells cells_;
  VectorXd load_;
  Unknowns x_;
  VectorXd v_, a_, last_p_, rest_;
  double largest_ = 0;  ///< displacement so far [m]
  bool needs_factors_ = true;
  int corrections_ = 0, factorisations_ = 0;
};

}  // namespace

void solve_motion(const GridProblem& problem, const Body3& body, const dealii::DoFHandler<3>& dof_handler,
                  Solution& solution) {
  if (process_count() > 1) throw InputError("motion in time is computed by one process");
  start_mpi();
  const MotionRequest& motion = *problem.motion;
  const double dt = motion.duration / problem.steps;
  const std::vector<Location> places = locate(body, problem.points);
  MidpointRule rule(problem, body, dof_handler);
  DofVector u = zero_vector(dof_handler);
  const auto record = [&](int step) {
    for (Eigen::Index i = 0; i < rule.state().u.size(); ++i) u[i] = rule.state().u[i];
    u.update_ghost_values();
    solution.time.push_back(step * dt);
    solution.path.push_back(displacement_at(places, dof_handler, u));
    solution.kinetic_energy.push_back(rule.kinetic_energy());
    solution.angular_momentum.push_back(rule.angular_momentum());
    if (const auto energy = rule.cells().energy(rule.state())) solution.elastic_energy.push_back(*energy);
    u.zero_out_ghost_values();
  };
  bool ok = rule.start();
  if (!ok) solution.message = "no equilibrium found from which the body could be released";
  if (ok) record(0);
  for (int step = 0; ok && step < problem.steps; ++step) {
    progress::detail(
        [&] { return fmt::format("{} unknowns, step {} of {}", rule.cells().unknowns(), step + 1, problem.steps); });
    ok = rule.advance(step * dt, dt);
    if (ok)
      record(step + 1);
    else
      solution.message = fmt::format(
          "the step at {:.4g} s of {:.4g} s has no solution (more samples make smaller steps, ramp_s lets loads and "
          "supports grow)",
          step * dt, motion.duration);
  }
  solution.ok = ok;
  solution.unknowns = rule.cells().unknowns();
  solution.iterations = rule.corrections();
  solution.form = fmt::format("{}, consistent mass, {}: {} steps of {:.3g} ms, {} corrections, {} times factored",
                              rule.cells().form(), motion.energy_momentum ? "energy-momentum steps" : "midpoint rule",
                              problem.steps, 1000 * dt, rule.corrections(), rule.factorisations());
  if (ok) solution.displacement = solution.path.back();
}

}  // namespace springproof::fem
