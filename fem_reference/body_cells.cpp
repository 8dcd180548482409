#include "fem_reference/body_cells.h"

#include <deal.II/dofs/dof_tools.h>
#include <deal.II/fe/fe_values.h>
#include <deal.II/lac/dynamic_sparsity_pattern.h>
#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "fem_reference/system/attached_mass.h"
#include "fem_reference/system/materials.h"
#include "problem/system/input_error.h"

namespace springproof::fem {

using Eigen::VectorXd;

namespace {

std::optional<Law> law_of(const GridProblem& problem) {
  const std::optional<Law> law = law_named(problem.law);
  if (!law && problem.law != "linear")
    throw InputError(fmt::format("unknown law \"{}\"; there are: linear, {}", problem.law, law_names()));
  return law;
}

}  // namespace

BodyCells::BodyCells(const GridProblem& problem, const Body3& body, const dealii::DoFHandler<3>& dof_handler,
                     const std::vector<Prescribed>& held)
    : laws_(laws_of(problem, law_of(problem), body.has_tetrahedra())),
      relaxation_(problem.motion ? problem.motion->relaxation : Relaxation{}),
      form_(describe({body.has_tetrahedra(), problem.degree}, form_of(laws_))),
      number_(dof_handler.n_dofs(), 0),
      component_(dof_handler.n_dofs()) {
  for (const Prescribed& p : held) number_[p.dof] = -1;
  for (PetscInt& n : number_)
    if (n == 0) n = free_++;

  const bool mixed = any_mixed(laws_);
  const auto scalar = scalar_element(body, problem.degree);
  const dealii::Quadrature<3> quadrature = cell_quadrature(body, problem.degree + 1);
  const Eigen::MatrixXd N = values_at(*scalar, quadrature);
  dealii::DoFHandler<3> of_pressure(body.of_pressures());
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
  const auto attached = attached_mass(problem.masses, body, *scalar);
  for (const auto& cell : dof_handler.active_cell_iterators()) {
    values.reinit(dealii::Triangulation<3>::cell_iterator(cell));
    Cell& c = cells_.emplace_back();
    c.material = cell->material_id();
    c.shape = {Eigen::MatrixXd(3 * points, nodes), VectorXd(points), pressures};
    for (int q = 0; q < points; ++q) {
      c.shape.weights[q] = values.JxW(q);
      for (int a = 0; a < nodes; ++a)
        for (int i = 0; i < 3; ++i) c.shape.gradients(3 * q + i, a) = values.shape_grad(a, q)[i];
    }
    c.mass = laws_[c.material].density * N.transpose() * c.shape.weights.asDiagonal() * N;
    if (const auto more = attached.find(cell->active_cell_index()); more != attached.end()) c.mass += more->second;
    c.overstrains.assign(points * relaxation_.branches.size(), Eigen::Matrix3d::Zero());
    cell->get_dof_indices(dofs);
    c.u.resize(dofs.size());
    for (unsigned int i = 0; i < dofs.size(); ++i) {
      const auto [component, node] = dof_handler.get_fe().system_to_component_index(i);
      c.u[3 * node + component] = Eigen::Index(dofs[i]);
      component_[dofs[i]] = int(component);
    }
    if (mixed) {
      dealii::DoFHandler<3>::active_cell_iterator(&body.of_pressures(), cell->level(), cell->index(), &of_pressure)
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

Vec3 BodyCells::angular_momentum(const VectorXd& position, const VectorXd& v) const {
  Vec3 sum = Vec3::Zero();
  for (const Cell& cell : cells_) {
    Eigen::MatrixXd x(cell.u.size() / 3, 3), speed = x;
    for (std::size_t i = 0; i < cell.u.size(); ++i) {
      x(i / 3, i % 3) = position[cell.u[i]];
      speed(i / 3, i % 3) = v[cell.u[i]];
    }
    const Eigen::MatrixXd momentum = cell.mass * speed;
    for (Eigen::Index a = 0; a < x.rows(); ++a)
      sum += Vec3(x.row(a).transpose()).cross(Vec3(momentum.row(a).transpose()));
  }
  return sum;
}

std::optional<double> BodyCells::energy(const Unknowns& x) const {
  const std::optional<Law>& law = laws_.front().law;
  if (!law || *law == Law::log_cauchy) return {};
  double sum = 0;
  for (const Cell& cell : cells_) sum += cell_energy(laws_[cell.material], cell.shape, read(cell, x));
  return sum;
}

double BodyCells::residual(const Unknowns& x, const Viscous& viscous, const Unknowns* before, Unknowns& r) const {
  r = zero();
  double smallest = std::numeric_limits<double>::infinity();
  const Unknowns rate = rate_of(x, viscous), from{viscous.before, x.p};
  const std::vector<RelaxingStep> branches = branches_over(viscous);
  for (const Cell& cell : cells_) {
    const CellVector at = read(cell, x);
    CellVector f = before ? step_residual(laws_[cell.material], cell.shape, read(cell, *before), at, smallest)
                          : cell_residual(laws_[cell.material], cell.shape, at, smallest, nullptr);
    if (!(smallest > 0)) break;
    if (viscous.acts())
      add_viscosity(laws_[cell.material], cell.shape, at.u, read(cell, rate).u, viscous.time, viscous.per_rate, f,
                    nullptr);
    if (!branches.empty())
      add_relaxation(laws_[cell.material], cell.shape, read(cell, from).u, at.u, branches, cell.overstrains, f,
                     nullptr);
    for (std::size_t i = 0; i < cell.u.size(); ++i) r.u[cell.u[i]] += f.u(i / 3, i % 3);
    for (std::size_t k = 0; k < cell.p.size(); ++k) r.p[cell.p[k]] += f.p[k];
  }
  return smallest;
}

std::vector<RelaxingStep> BodyCells::branches_over(const Viscous& step) const {
  std::vector<RelaxingStep> branches;
  if (step.per_rate > 0)
    for (const auto& [share, time] : relaxation_.branches)
      branches.push_back({share, BranchStep::of(2 / step.per_rate / time)});
  return branches;
}

void BodyCells::relax(const Unknowns& x, const Viscous& viscous) {
  const Unknowns from{viscous.before, x.p};
  const std::vector<RelaxingStep> branches = branches_over(viscous);
  if (branches.empty()) return;
  for (Cell& cell : cells_)
    advance(laws_[cell.material], cell.shape, read(cell, from).u, read(cell, x).u, branches, cell.overstrains);
}

void BodyCells::factor(const Unknowns& x, const Viscous& viscous, double inertia) {
  matrix_->clear();
  CellTangent tangent;
  const std::vector<RelaxingStep> branches = branches_over(viscous);
  for (const Cell& cell : cells_) {
    double smallest = 1;
    const CellVector at = read(cell, x);
    const CellLaw& law = laws_[cell.material];
    CellVector r = cell_residual(law, cell.shape, at, smallest, &tangent);
    if (viscous.acts()) add_viscosity(law, cell.shape, at.u, 0 * at.u, viscous.time, viscous.per_rate, r, &tangent);
    if (!branches.empty()) add_relaxation(law, cell.shape, at.u, at.u, branches, cell.overstrains, r, &tangent);
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

}  // namespace springproof::fem
