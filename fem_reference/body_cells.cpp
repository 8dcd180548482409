#include "fem_reference/body_cells.h"

#include <deal.II/dofs/dof_tools.h>
#include <deal.II/fe/fe_values.h>
#include <deal.II/lac/dynamic_sparsity_pattern.h>
#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "fem_reference/grid/locate.h"
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

using ByCell = std::map<unsigned int, Eigen::MatrixXd>;

void add(unsigned int cell, double mass, const Eigen::VectorXd& N, ByCell& all) {
  Eigen::MatrixXd& M = all.try_emplace(cell, Eigen::MatrixXd::Zero(N.size(), N.size())).first->second;
  M += mass * N * N.transpose();
}

void add_points(const AttachedMass& mass, const Body3& body, const dealii::FiniteElement<3>& scalar, ByCell& all) {
  const std::vector<Vec3> at = points_of(mass);
  NodalVectors points(Eigen::Index(at.size()), 3);
  for (std::size_t p = 0; p < at.size(); ++p) points.row(Eigen::Index(p)) = at[p].transpose();
  for (const Location& place : locate(body, points)) {
    Eigen::VectorXd N(scalar.n_dofs_per_cell());
    for (unsigned int a = 0; a < scalar.n_dofs_per_cell(); ++a) N[a] = scalar.shape_value(a, place.unit);
    add(place.cell->active_cell_index(), mass.mass / double(at.size()), N, all);
  }
}

void add_patch(const AttachedMass& mass, const Body3& body, const dealii::FiniteElement<3>& scalar, ByCell& all) {
  const auto patch = body.patches.find(mass.on);
  if (patch == body.patches.end() || patch->second.empty())
    throw InputError(fmt::format("the body has no patch \"{}\"", mass.on));
  dealii::FEFaceValues<3> values(*body.mapping, scalar, face_quadrature(body, scalar.degree + 1),
                                 dealii::update_values | dealii::update_JxW_values);
  ByCell of_area;
  double area = 0;
  for (const auto& cell : body.triangulation.active_cell_iterators())
    for (const unsigned int f : cell->face_indices()) {
      if (!cell->face(f)->at_boundary() || !patch->second.count(cell->face(f)->boundary_id())) continue;
      values.reinit(dealii::Triangulation<3>::cell_iterator(cell), f);
      for (const unsigned int q : values.quadrature_point_indices()) {
        Eigen::VectorXd N(scalar.n_dofs_per_cell());
        for (unsigned int a = 0; a < scalar.n_dofs_per_cell(); ++a) N[a] = values.shape_value(a, q);
        add(cell->active_cell_index(), values.JxW(q), N, of_area);
        area += values.JxW(q);
      }
    }
  for (const auto& [cell, M] : of_area) {
    Eigen::MatrixXd& sum = all.try_emplace(cell, Eigen::MatrixXd::Zero(M.rows(), M.cols())).first->second;
    sum += mass.mass / area * M;
  }
}

/// Per cell that has any, by its active index: integral of N_a N_b over what is hung on the body or glued to it, of one
/// component [kg].
/// @throws InputError naming the mass, if it is outside of the body or on a patch that there is not.
ByCell attached_mass(const std::vector<AttachedMass>& masses, const Body3& body,
                     const dealii::FiniteElement<3>& scalar) {
  ByCell all;
  for (const AttachedMass& mass : masses) try {
      mass.on.empty() ? add_points(mass, body, scalar, all) : add_patch(mass, body, scalar, all);
    } catch (const InputError& e) {
      throw InputError(fmt::format("mass '{}': {}", mass.name, e.what()));
    }
  return all;
}

}  // namespace

BodyEquations::BodyEquations(const GridProblem& problem, const Body3& body, const dealii::DoFHandler<3>& dof_handler,
                             const std::vector<Prescribed>& held, const std::vector<CellLaw>& laws, unsigned int points)
    : number(dof_handler.n_dofs(), 0), problem_(problem), body_(body), u_(dof_handler), laws_(laws), points_(points) {
  for (const Prescribed& p : held) number[p.dof] = -1;
  for (PetscInt& n : number)
    if (n == 0) n = displacements++;
  if (!any_mixed(laws)) return;
  p_.emplace(body.of_pressures());
  p_->distribute_dofs(*pressure_element(body, problem.degree));
  pressures = PetscInt(p_->n_dofs());
}

void BodyEquations::for_each_cell(const std::function<void(BodyCell&&)>& visit) const {
  const auto scalar = scalar_element(body_, problem_.degree);
  const dealii::Quadrature<3> quadrature = cell_quadrature(body_, points_);
  const Eigen::MatrixXd N = values_at(*scalar, quadrature),
                        of_pressures = p_ ? values_at(p_->get_fe(), quadrature) : Eigen::MatrixXd(quadrature.size(), 0);
  dealii::FEValues<3> values(*body_.mapping, *scalar, quadrature, dealii::update_gradients | dealii::update_JxW_values);
  const auto attached = attached_mass(problem_.masses, body_, *scalar);
  for (const auto& cell : u_.active_cell_iterators()) {
    values.reinit(dealii::Triangulation<3>::cell_iterator(cell));
    BodyCell c;
    c.material = cell->material_id();
    set_shape(values, c.shape);
    c.shape.pressures = of_pressures;
    c.mass = laws_[c.material].density * N.transpose() * c.shape.weights.asDiagonal() * N;
    if (const auto more = attached.find(cell->active_cell_index()); more != attached.end()) c.mass += more->second;
    const auto dofs = dofs_in(cell, u_);
    c.u.resize(dofs.size());
    for (unsigned int i = 0; i < dofs.size(); ++i) {
      const auto [component, node] = u_.get_fe().system_to_component_index(i);
      c.u[3 * node + component] = Eigen::Index(dofs[i]);
    }
    if (p_)
      for (const auto dof : dofs_in(cell, *p_)) c.p.push_back(Eigen::Index(dof));
    for (const Eigen::Index dof : c.u) c.rows_u.push_back(number[dof]);
    for (const Eigen::Index dof : c.p) c.rows_p.push_back(displacements + PetscInt(dof));
    visit(std::move(c));
  }
}

std::unique_ptr<SparseMatrix> BodyEquations::matrix() const {
  dealii::DynamicSparsityPattern pattern(unknowns(), unknowns());
  for (const auto& cell : u_.active_cell_iterators()) {
    std::vector<dealii::types::global_dof_index> rows;
    for (const auto dof : dofs_in(cell, u_))
      if (number[dof] >= 0) rows.push_back(number[dof]);
    if (p_)
      for (const auto dof : dofs_in(cell, *p_)) rows.push_back(displacements + dof);
    std::sort(rows.begin(), rows.end());
    for (const auto row : rows) pattern.add_entries(row, rows.begin(), rows.end(), true);
  }
  const dealii::IndexSet all = dealii::complete_index_set(unknowns());
  return std::make_unique<SparseMatrix>(all, all, pattern, PETSC_COMM_SELF);
}

BodyCells::BodyCells(const GridProblem& problem, const Body3& body, const dealii::DoFHandler<3>& dof_handler,
                     const std::vector<Prescribed>& held)
    : laws_(laws_of(problem, law_of(problem), body.has_tetrahedra())),
      relaxation_(problem.motion ? problem.motion->relaxation : Relaxation{}),
      form_(describe({body.has_tetrahedra(), problem.degree}, form_of(laws_))),
      equations_(problem, body, dof_handler, held, laws_, problem.degree + 1),
      component_(dof_handler.n_dofs()),
      matrix_(equations_.matrix()) {
  equations_.for_each_cell([&](BodyCell&& cell) {
    cell.overstrains.assign(cell.shape.points() * relaxation_.branches.size(), Eigen::Matrix3d::Zero());
    for (std::size_t i = 0; i < cell.u.size(); ++i) component_[cell.u[i]] = int(i % 3);
    cells_.push_back(std::move(cell));
  });
}

CellVector BodyCells::read(const BodyCell& cell, const Unknowns& x) const {
  CellVector c{Eigen::MatrixXd(cell.u.size() / 3, 3), VectorXd(cell.p.size())};
  for (std::size_t i = 0; i < cell.u.size(); ++i) c.u(i / 3, i % 3) = x.u[cell.u[i]];
  for (std::size_t f = 0; f < cell.p.size(); ++f) c.p[f] = x.p[cell.p[f]];
  return c;
}

VectorXd BodyCells::times_mass(const VectorXd& a) const {
  VectorXd f = VectorXd::Zero(a.size());
  for (const BodyCell& cell : cells_) {
    Eigen::MatrixXd at_nodes(cell.u.size() / 3, 3);
    for (std::size_t i = 0; i < cell.u.size(); ++i) at_nodes(i / 3, i % 3) = a[cell.u[i]];
    const Eigen::MatrixXd inertia = cell.mass * at_nodes;
    for (std::size_t i = 0; i < cell.u.size(); ++i) f[cell.u[i]] += inertia(i / 3, i % 3);
  }
  return f;
}

Vec3 BodyCells::angular_momentum(const VectorXd& position, const VectorXd& v) const {
  Vec3 sum = Vec3::Zero();
  for (const BodyCell& cell : cells_) {
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
  for (const BodyCell& cell : cells_) sum += cell_energy(laws_[cell.material], cell.shape, read(cell, x));
  return sum;
}

double BodyCells::residual(const Unknowns& x, const Viscous& viscous, const Unknowns* before, Unknowns& r) const {
  r = zero();
  double smallest = std::numeric_limits<double>::infinity();
  const Unknowns rate = rate_of(x, viscous), from{viscous.before, x.p};
  const std::vector<RelaxingStep> branches = branches_over(viscous);
  for (const BodyCell& cell : cells_) {
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
  for (BodyCell& cell : cells_)
    advance(laws_[cell.material], cell.shape, read(cell, from).u, read(cell, x).u, branches, cell.overstrains);
}

void BodyCells::factor(const Unknowns& x, const Viscous& viscous, double inertia) {
  matrix_->clear();
  CellTangent tangent;
  const std::vector<RelaxingStep> branches = branches_over(viscous);
  for (const BodyCell& cell : cells_) {
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
  const std::vector<PetscInt>& number = equations_.number;
  for (std::size_t dof = 0; dof < number.size(); ++dof)
    if (number[dof] >= 0) b[number[dof]] = r.u[Eigen::Index(dof)];
  b.tail(r.p.size()) = r.p;
  const VectorXd x = factors_->solve(b);
  Unknowns d{VectorXd::Zero(r.u.size()), x.tail(r.p.size())};
  for (std::size_t dof = 0; dof < number.size(); ++dof)
    if (number[dof] >= 0) d.u[Eigen::Index(dof)] = x[number[dof]];
  return d;
}

}  // namespace springproof::fem
