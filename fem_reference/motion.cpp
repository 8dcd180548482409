#include "fem_reference/motion.h"

#include <deal.II/dofs/dof_tools.h>
#include <deal.II/fe/fe_values.h>
#include <deal.II/lac/dynamic_sparsity_pattern.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "fem_reference/boundary_conditions.h"
#include "fem_reference/cell_equations.h"
#include "fem_reference/multigrid.h"
#include "fem_reference/petsc.h"
#include "fem_reference/processes.h"
#include "fem_reference/sample.h"
#include "problem/system/input_error.h"
#include "problem/system/progress.h"

namespace springproof::fem {
namespace {

using Eigen::VectorXd;

constexpr double newton_tolerance = 1e-7;  // last correction over the largest displacement so far
constexpr int most_corrections = 80;
constexpr double slow = 0.6;  // ratio of two corrections above which new factors cost less than more corrections
constexpr double first_load_part = 0.25, smallest_load_part = 1. / 512;

/// Displacements of all degrees of freedom and pressures; or forces and residuals of the dilatation equation.
struct Unknowns {
  VectorXd u, p;
};

/// Viscosity in a step: the rate of displacements is per_rate * (x - before).
struct Viscous {
  double time = 0;      ///< of retardation [s]; 0: none
  double per_rate = 0;  ///< [1/s]
  VectorXd before;

  bool acts() const { return time * per_rate > 0; }
};

/// The cells of a body with their equations: consistent mass, internal force, and the factors of the tangent.
class BodyCells {
 public:
  BodyCells(const GridProblem& problem, const Body3& body, const dealii::DoFHandler<3>& dof_handler,
            const std::vector<Prescribed>& held);

  Unknowns zero() const { return {VectorXd::Zero(Eigen::Index(number_.size())), VectorXd::Zero(pressures_)}; }
  Eigen::Index unknowns() const { return free_ + pressures_; }
  bool is_free(Eigen::Index dof) const { return number_[dof] >= 0; }
  int component(Eigen::Index dof) const { return component_[dof]; }
  std::string form() const { return form_; }

  /// M a on all degrees of freedom.
  VectorXd times_mass(const VectorXd& a) const;
  /// Internal force and dilatation residual at x, on all degrees of freedom; the smallest det F, not positive if they
  /// are not valid.
  double residual(const Unknowns& x, const Viscous& viscous, Unknowns& r) const;
  /// Factors of inertia M + dr/dx, symmetrised.
  void factor(const Unknowns& x, const Viscous& viscous, double inertia);
  /// The correction by the factors; zero where held.
  Unknowns correction(const Unknowns& r) const;

 private:
  struct Cell {
    CellShape shape;
    Eigen::MatrixXd mass;                  ///< of one component [kg]
    std::vector<Eigen::Index> u;           ///< 3 a + i: component i of node a
    std::vector<Eigen::Index> p;           ///< pressures
    std::vector<PetscInt> rows_u, rows_p;  ///< in the matrix; -1: held
  };
  CellVector read(const Cell& cell, const Unknowns& x) const;
  static Unknowns rate_of(const Unknowns& x, const Viscous& viscous) {
    return {viscous.acts() ? VectorXd(viscous.per_rate * (x.u - viscous.before)) : x.u, x.p};
  }

  CellLaw law_;
  std::string form_;
  std::vector<Cell> cells_;
  std::vector<PetscInt> number_;  ///< of each degree of freedom among the free ones; -1: held
  std::vector<int> component_;    ///< of each degree of freedom
  PetscInt free_ = 0;
  Eigen::Index pressures_ = 0;
  std::unique_ptr<SparseMatrix> matrix_;
  std::unique_ptr<SymmetricFactors> factors_;
};

CellLaw law_of(const GridProblem& problem, const Body3& body) {
  const std::optional<Law> law = law_named(problem.law);
  if (!law && problem.law != "linear")
    throw InputError(fmt::format("unknown law \"{}\"; there are: linear, {}", problem.law, law_names()));
  return {law, form_for({body.has_tetrahedra(), problem.degree}, problem.material.poisson_ratio, !law),
          shear_modulus(problem.material), lame_lambda(problem.material)};
}

BodyCells::BodyCells(const GridProblem& problem, const Body3& body, const dealii::DoFHandler<3>& dof_handler,
                     const std::vector<Prescribed>& held)
    : law_(law_of(problem, body)),
      form_(describe({body.has_tetrahedra(), problem.degree}, law_.form)),
      number_(dof_handler.n_dofs(), 0),
      component_(dof_handler.n_dofs()) {
  for (const Prescribed& p : held) number_[p.dof] = -1;
  for (PetscInt& n : number_)
    if (n == 0) n = free_++;

  const bool mixed = law_.form == Form::mixed;
  const auto scalar = scalar_element(body, problem.degree);
  const dealii::Quadrature<3> quadrature = cell_quadrature(body, problem.degree + 1);
  const Eigen::MatrixXd N = values_at(*scalar, quadrature);
  dealii::DoFHandler<3> of_pressure(body.triangulation);
  Eigen::MatrixXd pressures(quadrature.size(), 0);
  if (mixed) {
    const auto fe = pressure_element(body, problem.degree);
    of_pressure.distribute_dofs(*fe);
    pressures = values_at(*fe, quadrature);
    pressures_ = Eigen::Index(of_pressure.n_dofs());
  }
  dealii::FEValues<3> values(*body.mapping, *scalar, quadrature, dealii::update_gradients | dealii::update_JxW_values);
  const int nodes = int(scalar->n_dofs_per_cell()), points = int(quadrature.size());
  std::vector<dealii::types::global_dof_index> dofs(3 * nodes), pressure_dofs(pressures.cols());
  dealii::DynamicSparsityPattern pattern(unknowns(), unknowns());
  for (const auto& cell : dof_handler.active_cell_iterators()) {
    values.reinit(dealii::Triangulation<3>::cell_iterator(cell));
    Cell& c = cells_.emplace_back();
    c.shape = {Eigen::MatrixXd(3 * points, nodes), VectorXd(points), pressures};
    for (int q = 0; q < points; ++q) {
      c.shape.weights[q] = values.JxW(q);
      for (int a = 0; a < nodes; ++a)
        for (int i = 0; i < 3; ++i) c.shape.gradients(3 * q + i, a) = values.shape_grad(a, q)[i];
    }
    c.mass = problem.material.density * N.transpose() * c.shape.weights.asDiagonal() * N;
    cell->get_dof_indices(dofs);
    c.u.resize(dofs.size());
    for (unsigned int i = 0; i < dofs.size(); ++i) {
      const auto [component, node] = dof_handler.get_fe().system_to_component_index(i);
      c.u[3 * node + component] = Eigen::Index(dofs[i]);
      component_[dofs[i]] = int(component);
    }
    if (mixed) {
      dealii::DoFHandler<3>::active_cell_iterator(&body.triangulation, cell->level(), cell->index(), &of_pressure)
          ->get_dof_indices(pressure_dofs);
      c.p.assign(pressure_dofs.begin(), pressure_dofs.end());
    }
    for (const Eigen::Index dof : c.u) c.rows_u.push_back(number_[dof]);
    for (const Eigen::Index dof : c.p) c.rows_p.push_back(free_ + PetscInt(dof));
    std::vector<dealii::types::global_dof_index> rows(c.rows_p.begin(), c.rows_p.end());
    for (const PetscInt row : c.rows_u)
      if (row >= 0) rows.push_back(row);
    std::sort(rows.begin(), rows.end());
    for (const auto row : rows) pattern.add_entries(row, rows.begin(), rows.end(), true);
  }
  const dealii::IndexSet all = dealii::complete_index_set(unknowns());
  matrix_ = std::make_unique<SparseMatrix>(all, all, pattern, PETSC_COMM_SELF);
}

CellVector BodyCells::read(const Cell& cell, const Unknowns& x) const {
  CellVector c{Eigen::MatrixXd(cell.u.size() / 3, 3), VectorXd(cell.p.size())};
  for (std::size_t i = 0; i < cell.u.size(); ++i) c.u(i / 3, i % 3) = x.u[cell.u[i]];
  for (std::size_t f = 0; f < cell.p.size(); ++f) c.p[f] = x.p[cell.p[f]];
  return c;
}

VectorXd BodyCells::times_mass(const VectorXd& a) const {
  VectorXd f = VectorXd::Zero(a.size());
  for (const Cell& cell : cells_) {
    Eigen::MatrixXd at_nodes(cell.u.size() / 3, 3);
    for (std::size_t i = 0; i < cell.u.size(); ++i) at_nodes(i / 3, i % 3) = a[cell.u[i]];
    const Eigen::MatrixXd inertia = cell.mass * at_nodes;
    for (std::size_t i = 0; i < cell.u.size(); ++i) f[cell.u[i]] += inertia(i / 3, i % 3);
  }
  return f;
}

double BodyCells::residual(const Unknowns& x, const Viscous& viscous, Unknowns& r) const {
  r = zero();
  double smallest = std::numeric_limits<double>::infinity();
  const Unknowns rate = rate_of(x, viscous);
  for (const Cell& cell : cells_) {
    const CellVector at = read(cell, x);
    CellVector f = cell_residual(law_, cell.shape, at, smallest, nullptr);
    if (!(smallest > 0)) break;
    if (viscous.acts())
      add_viscosity(law_, cell.shape, at.u, read(cell, rate).u, viscous.time, viscous.per_rate, f, nullptr);
    for (std::size_t i = 0; i < cell.u.size(); ++i) r.u[cell.u[i]] += f.u(i / 3, i % 3);
    for (std::size_t k = 0; k < cell.p.size(); ++k) r.p[cell.p[k]] += f.p[k];
  }
  return smallest;
}

void BodyCells::factor(const Unknowns& x, const Viscous& viscous, double inertia) {
  matrix_->clear();
  CellTangent tangent;
  for (const Cell& cell : cells_) {
    double smallest = 1;
    const CellVector at = read(cell, x);
    CellVector r = cell_residual(law_, cell.shape, at, smallest, &tangent);
    if (viscous.acts()) add_viscosity(law_, cell.shape, at.u, 0 * at.u, viscous.time, viscous.per_rate, r, &tangent);
    CellMatrix uu = (tangent.uu + tangent.uu.transpose()) / 2;
    for (Eigen::Index a = 0; a < cell.mass.rows(); ++a)
      for (Eigen::Index b = 0; b < cell.mass.cols(); ++b)
        for (int i = 0; i < 3; ++i) uu(3 * a + i, 3 * b + i) += inertia * cell.mass(a, b);
    matrix_->add(cell.rows_u, cell.rows_u, uu.data());
    if (cell.p.empty()) continue;
    const CellMatrix up = (tangent.up + tangent.pu.transpose()) / 2, pu = up.transpose();
    matrix_->add(cell.rows_u, cell.rows_p, up.data());
    matrix_->add(cell.rows_p, cell.rows_u, pu.data());
    matrix_->add(cell.rows_p, cell.rows_p, tangent.pp.data());
  }
  matrix_->finish();
  factors_.reset();
  factors_ = std::make_unique<SymmetricFactors>(matrix_->petsc());
}

Unknowns BodyCells::correction(const Unknowns& r) const {
  VectorXd b(unknowns());
  for (std::size_t dof = 0; dof < number_.size(); ++dof)
    if (number_[dof] >= 0) b[number_[dof]] = r.u[Eigen::Index(dof)];
  b.tail(pressures_) = r.p;
  const VectorXd x = factors_->solve(b);
  Unknowns d{VectorXd::Zero(r.u.size()), x.tail(pressures_)};
  for (std::size_t dof = 0; dof < number_.size(); ++dof)
    if (number_[dof] >= 0) d.u[Eigen::Index(dof)] = x[number_[dof]];
  return d;
}

/// The body in motion.
class MidpointRule {
 public:
  MidpointRule(const GridProblem& problem, const Body3& body, const dealii::DoFHandler<3>& dof_handler)
      : problem_(problem),
        motion_(*problem.motion),
        held_(prescribed(dof_handler, body, problem.loads)),
        cells_(problem, body, dof_handler, held_),
        x_(cells_.zero()),
        v_(x_.u),
        a_(x_.u),
        last_p_(x_.p) {
    const DofVector load = load_vector(dof_handler, body, problem.loads, problem.material, problem.body_force);
    load_.resize(x_.u.size());
    for (Eigen::Index i = 0; i < load_.size(); ++i) load_[i] = load[i];
    if (motion_.released) check_held(held_, dof_handler.get_communicator());
    set_velocity(body, dof_handler);
  }

  const Unknowns& state() const { return x_; }
  const BodyCells& cells() const { return cells_; }
  double kinetic_energy() const { return v_.dot(cells_.times_mass(v_)) / 2; }
  int corrections() const { return corrections_; }
  int factorisations() const { return factorisations_; }

  /// The state at time 0; false: there is no equilibrium under the loads.
  bool start() {
    if (!motion_.released) {
      prescribe(support_factor(0), x_.u);
      return true;
    }
    double reached = 0, step = law_named(problem_.law) ? first_load_part : 1;
    while (reached < 1) {
      const double next = std::min(1.0, reached + step);
      const Unknowns before = x_;
      prescribe(next, x_.u);
      if (solve(x_, next, {}, 0, VectorXd::Zero(x_.u.size()))) {
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
    if (!solve(middle, load_factor(from, to), {motion_.viscosity, 2 / dt, x_.u}, inertia, offset)) return false;
    last_p_ = x_.p;
    x_.p = middle.p;
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
  /// That of the whole body, about its centre of mass.
  void set_velocity(const Body3& body, const dealii::DoFHandler<3>& dof_handler) {
    std::map<dealii::types::global_dof_index, dealii::Point<3>> points;
    dealii::DoFTools::map_dofs_to_support_points(*body.mapping, dof_handler, points);
    const VectorXd mass = cells_.times_mass(VectorXd::Ones(v_.size()));
    Vec3 moment = Vec3::Zero(), total = Vec3::Zero();
    for (const auto& [dof, at] : points) {
      const int c = cells_.component(Eigen::Index(dof));
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
      u[h.dof] = *prescribed_displacement(problem_.loads[h.load], h.X, kinematics, factor)[h.component];
  }

  /// Solves M (inertia x + offset) + internal and viscous force = factor * load for the free entries of x.
  bool solve(Unknowns& x, double factor, const Viscous& viscous, double inertia, const VectorXd& offset) {
    double last = std::numeric_limits<double>::infinity();
    bool fresh = false;
    for (int k = 0; k < most_corrections; ++k) {
      Unknowns r;
      if (!(cells_.residual(x, viscous, r) > 0)) return false;
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
      if (size <= newton_tolerance * largest_) return true;
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
  const Motion& motion_;
  std::vector<Prescribed> held_;
  BodyCells cells_;
  VectorXd load_;
  Unknowns x_;
  VectorXd v_, a_, last_p_;
  double largest_ = 0;  ///< displacement so far [m]
  bool needs_factors_ = true;
  int corrections_ = 0, factorisations_ = 0;
};

}  // namespace

void solve_motion(const GridProblem& problem, const Body3& body, const dealii::DoFHandler<3>& dof_handler,
                  Solution& solution) {
  if (process_count() > 1) throw InputError("motion in time is computed by one process");
  start_mpi();
  const Motion& motion = *problem.motion;
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
  solution.form =
      fmt::format("{}, consistent mass, midpoint rule: {} steps of {:.3g} ms, {} corrections, {} times factored",
                  rule.cells().form(), problem.steps, 1000 * dt, rule.corrections(), rule.factorisations());
  if (ok) solution.displacement = solution.path.back();
}

}  // namespace springproof::fem
