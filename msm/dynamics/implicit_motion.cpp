#include "msm/dynamics/implicit_motion.h"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "msm/algebra/dense.h"
#include "msm/algebra/fixed.h"
#include "msm/dynamics/time_step.h"
#include "msm/laws/capabilities.h"

namespace springproof {
namespace {

// Largest unbalanced force of a step relative to its inertial and internal forces; round-off where that is more.
constexpr double newton_tolerance = 1e-11;
constexpr int most_newton_steps = 30;  // of a step
constexpr int slow = 8;                // iterations after which the factors are renewed
constexpr int most_halvings = 6;
constexpr int most_contacts = 40;  // sets of nodes on a plane that are tried for a step
constexpr int anderson_depth = 15, most_simple_iterations = 30;
constexpr double difference = 1e-7;  // of directional derivatives, relative to the size of a cell

/// Anderson's acceleration of x += d, d = B r: the next change of x is the combination of the latest states whose d is
/// least, moved by that d.
class Anderson {
 public:
  Eigen::VectorXd change(const Eigen::VectorXd& d) {
    if (d_.size() > 0) {
      const Eigen::Index kept = std::min<Eigen::Index>(dd_.cols(), anderson_depth - 1);
      Eigen::MatrixXd of_d(d.size(), kept + 1), of_x(d.size(), kept + 1);
      of_d << dd_.rightCols(kept), d - d_;
      of_x << dx_.rightCols(kept), change_;
      dd_.swap(of_d);
      dx_.swap(of_x);
    }
    d_ = change_ = d;
    if (dd_.cols() > 0) change_ -= (dx_ + dd_) * least_squares(dd_, d).X;
    return change_;
  }

 private:
  Eigen::VectorXd d_, change_;
  Eigen::MatrixXd dd_, dx_;  ///< differences of d and x between states
};

/// The rotation that best takes X to x, by mass.
Eigen::Matrix3d rotation_between(const NodalVectors& X, const NodalVectors& x, const Eigen::VectorXd& mass) {
  const Eigen::RowVector3d X0 = mass.transpose() * X / mass.sum(), x0 = mass.transpose() * x / mass.sum();
  const Eigen::Matrix3d moment = (x.rowwise() - x0).transpose() * mass.asDiagonal() * (X.rowwise() - X0);
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(moment, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Matrix3d U = svd.matrixU();
  if (U.determinant() * svd.matrixV().determinant() < 0) U.col(2) *= -1;
  return U * svd.matrixV().transpose();
}

}  // namespace

ImplicitMotion::ImplicitMotion(const MassSpringModel& model, double density, const MotionOptions& options)
    : MotionOfNodes(model, options),
      options_(options),
      density_(density),
      safe_step_(safe_time_step(model, density)),
      mass_(masses(model.network, density)),
      spacing_(std::cbrt(model.network.volume.mean())) {
  if (options.integrator == Integrator::energy_momentum) secant_ = std::make_unique<EnergyMomentum>(model);
  if (options.contact) plane_.emplace(options.contact->plane(), x_.rows(), spacing_);
}

void ImplicitMotion::set_conditions(const BoundaryConditions& conditions) {
  if (conditions.fixed != conditions_.fixed) prepared_for_ = 0;
  if (conditions_.fixed.empty()) external_before_ = conditions.external;
  conditions_ = conditions;
}

NodalVectors ImplicitMotion::relaxing_forces() const {
  if (!overstrains_.acts()) return {};
  NodalVectors f = NodalVectors::Zero(x_.rows(), 3);
  overstrains_.add_forces(x_, 0, f);
  return f;
}

std::optional<BranchEnergies> ImplicitMotion::branch_energies() const {
  if (!options_.branch_energies || !overstrains_.acts()) return {};
  return BranchEnergies{overstrains_.energy(), overstrains_.dissipated()};
}

ImplicitMotion::Formula ImplicitMotion::formula() const {
  const double dt = dt_, dashpots = options_.viscosity.time() / dt;
  double of_mean = 0, at_end = 0;  // branches
  for (const auto& [share, time] : options_.relaxation.relaxation.branches) {
    of_mean += share * BranchStep::of(dt / time).psi;
    at_end += share * BranchStep::of(dt / time).phi;
  }
  if (options_.integrator == Integrator::energy_momentum)
    return {2 / (dt * dt), 1 / dt, 0.5 + of_mean + dashpots, x_ + dt * v_};
  return {1 / (dt * dt), 1 / dt, 1 + at_end + dashpots, x_ + dt * v_};
}

/// Internal, of branches, viscous and external.  Over an energy-momentum step dashpots are those of its middle, where
/// they have no torque, and take the energy f . (x1 - x0) <= 0.
NodalVectors ImplicitMotion::force(const Formula& step, NodalVectors x1) const {
  carry(model_.network.cells.carried, x1);
  NodalVectors f = secant_ ? NodalVectors(secant_->forces(x_, x1) + (external_before_ + conditions_.external) / 2)
                           : NodalVectors(springproof::forces(model_, x1) + conditions_.external);
  if (secant_)
    overstrains_.add_mean_forces(x_, x1, dt_, f);
  else
    overstrains_.add_forces(x1, dt_, f);
  if (options_.viscosity.acts())
    options_.viscosity.add_forces(model_.network, secant_ ? NodalVectors((x_ + x1) / 2) : x1, step.rate * (x1 - x_), f);
  return f;
}

/// Makes B for the free unknowns and the mass term of the step, if there is none.
void ImplicitMotion::prepare(const Formula& step) {
  const double a = step.a + options_.damping * step.rate;
  if (a == prepared_for_) return;
  prepared_for_ = a;
  renewed_ = false;
  factors_ = std::make_unique<DirectSolver>();
  cycle_.reset();
  const Network& network = model_.network;
  const long unknowns = std::count(conditions_.fixed.begin(), conditions_.fixed.end(), 0);
  if (unknowns > cholesky_limit && can(model_, Capability::equal_cells))
    cycle_ = std::make_unique<Multigrid>(lattice_levels(network, conditions_.fixed),
                                         step.of_stiffness * cell_stiffness(model_).total, true,
                                         a * density_ * network.cells.volume() / 8);
}

void ImplicitMotion::renew(const Formula& step, const NodalVectors& x1) {
  renewed_ = true;
  if (!factored()) {
    if (!held()) turn_ = rotation_between(model_.network.X, (x_ + x1) / 2, mass_);
    return;
  }
  ++factorisations_;
  if (K_.local.nodes() == 0) K_.local = BlockMatrix(model_.network);
  update_tangent(model_, x1, K_);
  scale_ = step.of_stiffness;
  const double a = prepared_for_ / scale_;
  for (int n = 0; n < model_.network.nodes(); ++n) K_.local.add(n, n, a * mass_[n] * Eigen::Matrix3d::Identity());
  if (plane_) plane_->stiffen(K_.local);
  factors_->factor(K_, fixed_or_carried(model_.network, conditions_.fixed));
}

Eigen::VectorXd ImplicitMotion::correction(const Eigen::VectorXd& r) const {
  Eigen::VectorXd d;
  const auto allowed = [&](const Eigen::VectorXd& change) { return plane_ ? free_part(by_point(change)) : change; };
  if (factored()) {
    factors_->solve(r, d);
    return allowed(d / scale_);
  }
  using Columns = Eigen::Matrix<double, 3, Eigen::Dynamic>;
  const Eigen::Index n = r.size() / 3;
  const Columns turned = turn_.transpose() * Eigen::Map<const Columns>(r.data(), 3, n);
  cycle_->apply(Eigen::Map<const Eigen::VectorXd>(turned.data(), r.size()), d);
  const Columns back = turn_ * Eigen::Map<const Columns>(d.data(), 3, n);
  return allowed(Eigen::Map<const Eigen::VectorXd>(back.data(), r.size()));
}

NodalVectors ImplicitMotion::with_supports(NodalVectors x) const {
  for (Eigen::Index i = 0; i < x.size(); ++i)
    if (conditions_.fixed[i]) x.data()[i] = model_.network.X.data()[i] + conditions_.prescribed.data()[i];
  if (plane_) plane_->put(x);
  carry(model_.network.cells.carried, x);
  return x;
}

Eigen::VectorXd ImplicitMotion::free_part(NodalVectors v) const {
  clear_fixed(conditions_.fixed, v);
  if (plane_) plane_->project(v);
  return Eigen::Map<const Eigen::VectorXd>(v.data(), v.size());
}

/// x + dt v; a body that is not held is turned, by the angle 2 atan(w dt / 2) of midpoint kinematics.
NodalVectors ImplicitMotion::predicted() const {
  const double dt = dt_;
  if (held()) return with_supports(x_ + dt * v_);
  const Eigen::RowVector3d middle = mass_.transpose() * x_ / mass_.sum(),
                           velocity = mass_.transpose() * v_ / mass_.sum();
  const NodalVectors arm = x_.rowwise() - middle;
  Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();
  Vec3 spin = Vec3::Zero();
  for (Eigen::Index n = 0; n < arm.rows(); ++n) {
    const Vec3 a = arm.row(n).transpose();
    inertia += mass_[n] * (a.squaredNorm() * Eigen::Matrix3d::Identity() - a * a.transpose());
    spin += mass_[n] * a.cross(Vec3(v_.row(n).transpose()));
  }
  const Vec3 rate = inertia.ldlt().solve(spin);
  if (!(rate.norm() > 0) || !rate.allFinite()) return x_ + dt * v_;
  const Eigen::Matrix3d turn =
      Eigen::AngleAxisd(2 * std::atan(rate.norm() * dt / 2), rate.normalized()).toRotationMatrix();
  NodalVectors x1(x_.rows(), 3);
  for (Eigen::Index n = 0; n < arm.rows(); ++n) {
    const Vec3 a = arm.row(n).transpose(), other = (v_.row(n) - velocity).transpose() - rate.cross(a);
    x1.row(n) = middle + dt * velocity + (turn * (a + dt * other)).transpose();
  }
  return x1;
}

/// f and the unbalanced force at x1.
ImplicitMotion::Balance ImplicitMotion::balance(const Formula& now, const NodalVectors& x1) {
  ++evaluations_;
  Balance b{force(now, x1), {}, {}};
  b.whole = b.force - mass_.asDiagonal() * (now.a * (x1 - now.inertial) + options_.damping * now.rate * (x1 - x_));
  b.unbalanced = free_part(b.whole);
  return b;
}

/// Simple iteration, x1 += B r, accelerated; x1 becomes the best state found.
void ImplicitMotion::iterate(const Formula& now, double enough, NodalVectors& x1, Balance& b) {
  Anderson anderson;
  NodalVectors x = x1;
  Balance at = b;
  for (int k = 0; k < most_simple_iterations && b.unbalanced.norm() > enough; ++k) {
    if (!renewed_ || (k > 0 && k % slow == 0 && factored())) {
      renew(now, k == 0 ? x_ : x);
      anderson = {};
    }
    x += Eigen::Map<const NodalVectors>(anderson.change(correction(at.unbalanced)).data(), x.rows(), 3);
    at = balance(now, x);
    if (at.unbalanced.norm() < b.unbalanced.norm()) {
      x1 = x;
      b = at;
    } else if (!(at.unbalanced.norm() < 10 * b.unbalanced.norm()))
      return;
  }
}

/// One step of Newton's method with a search along it.
void ImplicitMotion::newton_step(const Formula& now, double relative, NodalVectors& x1, Balance& b) {
  const double of_mass = now.a + options_.damping * now.rate;
  const Operator jacobian = [&](const Eigen::VectorXd& d, Eigen::VectorXd& y) {
    const auto change = by_point(d);
    const double t = difference * spacing_ / std::max(change.cwiseAbs().maxCoeff(), 1e-300);
    ++evaluations_;
    y = free_part(of_mass * (mass_.asDiagonal() * change) - (force(now, x1 + t * change) - b.force) / t);
  };
  const Operator condition = [&](const Eigen::VectorXd& r, Eigen::VectorXd& z) { z = correction(r); };
  Eigen::VectorXd d = Eigen::VectorXd::Zero(b.unbalanced.size());
  const KrylovResult solved = gmres(jacobian, condition, b.unbalanced, std::clamp(relative, 1e-4, 1e-2), 60, 60, d);
  const NodalVectors from = x1;
  const double before = b.unbalanced.norm();
  for (double t = 1;; t /= 2) {
    x1 = from + t * by_point(d);
    b = balance(now, x1);
    if (b.unbalanced.norm() < before || t < 0.05) break;
  }
  if (factored() && solved.iterations > slow) renew(now, x1);
}

bool ImplicitMotion::held() const {
  return std::find(conditions_.fixed.begin(), conditions_.fixed.end(), 1) != conditions_.fixed.end();
}

/// One step of dt, or, where it has no solution, two of half the size, which conserve as much.
bool ImplicitMotion::step(double dt, int halvings) {
  dt_ = dt;
  if (solve_step()) return true;
  if (halvings == 0) return false;
  failure_.clear();
  ++halved_;
  const BoundaryConditions at_end = conditions_;
  conditions_.external = (external_before_ + at_end.external) / 2;
  conditions_.prescribed = (x_ - model_.network.X + at_end.prescribed) / 2;
  const bool first = step(dt / 2, halvings - 1);
  conditions_ = at_end;
  return first && step(dt / 2, halvings - 1);
}

/// Solves a step from x1 with the nodes on the plane as they are.
bool ImplicitMotion::solve(const Formula& now, NodalVectors& x1, Balance& b) {
  const double stiffest = 4 / (safe_step_ * safe_step_);
  const double round_off = 4 * std::numeric_limits<double>::epsilon() * mass_.norm() *
                           (now.a + options_.damping * now.rate + now.of_stiffness * stiffest) *
                           x_.cwiseAbs().maxCoeff();
  const double inertia = (mass_.asDiagonal() * v_).norm() / dt_;
  x1 = with_supports(x1);
  b = balance(now, x1);
  if (!b.unbalanced.allFinite()) {  // a cell turned inside out
    x1 = with_supports(x_);
    b = balance(now, x1);
  }
  const auto scale = [&] { return std::max(inertia, b.force.norm()); };
  const auto enough = [&] { return std::max(newton_tolerance * scale(), round_off); };
  iterate(now, enough(), x1, b);
  for (int k = 0; !(b.unbalanced.norm() <= enough()); ++k) {
    const double relative = b.unbalanced.norm() / scale();
    if (k == most_newton_steps || !std::isfinite(relative)) {
      failure_ = fmt::format(
          "a step of {:.3g} s has no solution within {} Newton steps (unbalanced force {:.1e} of "
          "the others): a smaller time_step_s helps",
          dt_, k, relative);
      return false;
    }
    newton_step(now, relative, x1, b);
  }
  if (!std::isfinite(energy(model_, x1))) {
    failure_ = "a cell is turned inside out: a smaller time_step_s or load helps";
    return false;
  }
  return true;
}

/// Nodes on the plane stop; counts what the plane gave.  A reaction r changes the momentum by r rate / a.
void ImplicitMotion::land(const Formula& now, const NodalVectors& x1, const Balance& b, NodalVectors& v1) {
  ContactImpulse given;
  const Vec3& normal = plane_->normal();
  for (const int n : plane_->held()) {
    const Vec3 end = x1.row(n).transpose(), middle = (x_.row(n) + x1.row(n)).transpose() / 2;
    const double reaction = -normal.dot(Vec3(b.whole.row(n).transpose()));
    const double speed = normal.dot(Vec3(v1.row(n).transpose()));
    given.add(now.rate / now.a * reaction * (secant_ ? 2 : 1) * normal, secant_ ? middle : end);
    given.add(-mass_[n] * speed * normal, end);
    v1.row(n) -= speed * normal.transpose();
  }
  if (!plane_->held().empty()) options_.contact->count(given);
}

bool ImplicitMotion::solve_step() {
  const Formula now = formula();
  prepare(now);
  NodalVectors x1 = predicted();
  Balance b;
  for (int sets = 1;; ++sets) {
    if (!solve(now, x1, b)) return false;
    if (!plane_ || !plane_->revise(x_, x1, b.whole, b.force.norm(), conditions_.fixed)) break;
    renewed_ = false;
    if (sets == most_contacts) {
      failure_ = fmt::format("a step of {:.3g} s finds no nodes to end on the plane: a smaller time_step_s helps", dt_);
      return false;
    }
  }
  carry(model_.network.cells.carried, x1);
  double unbalanced = 0, support = 0;
  for (Eigen::Index i = 0; i < x1.size(); ++i)
    (conditions_.fixed[i] ? support : unbalanced) += b.force.data()[i] * b.force.data()[i];
  norms_ = {std::sqrt(unbalanced), std::sqrt(support)};
  NodalVectors v1 = now.rate * (x1 - x_);
  if (secant_)
    for (Eigen::Index i = 0; i < v1.size(); ++i)
      if (!conditions_.fixed[i]) v1.data()[i] = 2 * v1.data()[i] - v_.data()[i];
  if (plane_) land(now, x1, b, v1);
  overstrains_.advance(x1, dt_);
  x_ = x1;
  v_ = v1;
  external_before_ = conditions_.external;
  return true;
}

ForceNorms ImplicitMotion::advance(long steps) {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  for (; steps > 0; --steps) {
    if (!factored()) renewed_ = false;  // the turn follows the body
    ++advanced_;
    if (!step(options_.time_step.value(), most_halvings)) return {nan, nan};
  }
  return norms_;
}

std::string ImplicitMotion::description() const {
  return fmt::format("{:.1f} evaluations of the forces a step, {}{}",
                     static_cast<double>(evaluations_) / std::max(1L, advanced_),
                     factored() ? fmt::format("{} factorisations", factorisations_) : "multigrid of the rest state",
                     halved_ > 0 ? fmt::format(", {} steps halved", halved_) : "");
}

}  // namespace springproof
