#include "fem_reference/solvers/assembled_operator.h"

#include <limits>

#include "fem_reference/grid/processes.h"
#include "fem_reference/solvers/assembled_spaces.h"
#include "fem_reference/solvers/linear.h"
#include "fem_reference/solvers/newton.h"

namespace springproof::fem::assembled {

AssembledOperator::AssembledOperator(const ElasticSystem& system, std::optional<Law> law)
    : system_(system),
      law_(law),
      spaces_(std::make_unique<Spaces>(system, law, system.dof_handler, system.constrained)),
      most_factored_(system.most_factored) {
  if (system.degree == 2 && !system.plain_gamg) coarse_ = std::make_unique<CoarseSpaces>(system, *spaces_);
  assemble_stiffness(nullptr);
  state_ = vector();
  if (spaces_->mixed()) {
    assemble_mass();
  }
  if (law_ || spaces_->mixed()) {
    matrices_ = std::make_unique<Matrices>(*spaces_);
    MixedField f = vector();
    linearise(f, state_);
  }
}

AssembledOperator::~AssembledOperator() = default;

void AssembledOperator::assemble_stiffness(const DofVector* deformed_by) {
  multigrid_.reset();
  if (!smoothed_) smoothed_ = empty_matrix(spaces_->u, spaces_->u, spaces_->comm);
  spaces_->assemble_stiffness(deformed_by, *smoothed_);
  const dealii::Mapping<3>& mapping = *system_.body.mapping;
  if (!coarse_) {
    multigrid_ = std::make_unique<Multigrid>(*smoothed_, nullptr, mapping, spaces_->u, most_factored_);
    return;
  }
  DofVector at_corners;
  if (deformed_by) at_corners = coarse_->restricted(*spaces_, *deformed_by);
  coarse_->spaces.assemble_stiffness(deformed_by ? &at_corners : nullptr, *coarse_->matrix);
  const LinearLevel linear{*coarse_->matrix, *coarse_->interpolation};
  multigrid_ = std::make_unique<Multigrid>(*smoothed_, &linear, mapping, *coarse_->dof_handler, most_factored_);
}

namespace {

/// By how much the Schur complement of the pressures exceeds their mass matrix [1/Pa].
double compliance(const CellLaw& law) {
  if (law.form != Form::mixed) return 1 / law.mu;
  return 1 / (law.lambda - law.pointwise) + 1 / (2 * law.mu + law.pointwise);
}

}  // namespace

// That of the body's own material is left to precondition_pressure().
void AssembledOperator::assemble_mass() {
  mass_ = empty_matrix(spaces_->p, spaces_->p, spaces_->comm);
  inverse_mass_ = vector().p;
  const double own = compliance(system_.law_of(0, law_));
  spaces_->for_each_cell([&] {
    const CellShape& shape = spaces_->shape;
    CellMatrix M = shape.pressures.transpose() * shape.weights.asDiagonal() * shape.pressures;
    if (!system_.laws.empty()) M *= compliance(spaces_->law) / own;
    mass_->add(spaces_->p_indices, spaces_->p_indices, M.data());
    for (std::size_t f = 0; f < spaces_->p_indices.size(); ++f) inverse_mass_(spaces_->p_indices[f]) += M(f, f);
  });
  mass_->finish();
  inverse_mass_.compress(dealii::VectorOperation::add);
  for (double& m : inverse_mass_) m = 1 / m;
}

MixedField AssembledOperator::vector() const { return spaces_->vector(); }

double AssembledOperator::linearise(MixedField& f, const MixedField& x) {
  state_ = x;
  state_.u.update_ghost_values();
  if (spaces_->mixed()) state_.p.update_ghost_values();
  f.sadd(0, 0, f);
  for (SparseMatrix* m : matrices_->all()) m->clear();
  double smallest = std::numeric_limits<double>::infinity();
  CellTangent tangent;
  spaces_->for_each_cell([&] {
    const CellVector r = cell_residual(spaces_->law, spaces_->shape, spaces_->read(state_), smallest, &tangent);
    if (!(smallest > 0)) return;
    spaces_->add(r, f);
    if (law_) spaces_->add_free(tangent.uu, *matrices_->uu);
    if (!spaces_->mixed()) return;
    spaces_->add_coupling(tangent.pu, *matrices_->dilatation);
    spaces_->add_coupling(tangent.up.transpose(), *matrices_->force);
    matrices_->pp->add(spaces_->p_indices, spaces_->p_indices, tangent.pp.data());
  });
  f.u.compress(dealii::VectorOperation::add);
  if (spaces_->mixed()) f.p.compress(dealii::VectorOperation::add);
  for (SparseMatrix* m : matrices_->all()) m->finish();
  return dealii::Utilities::MPI::min(smallest, spaces_->comm);
}

// Cells on which x is zero are skipped: Newton applies this to boundary values, the linear solver to all unknowns.
void AssembledOperator::apply(MixedField& f, const MixedField& x) const {
  MixedField from = x;
  from.u.update_ghost_values();
  if (spaces_->mixed()) from.p.update_ghost_values();
  f.sadd(0, 0, f);
  double smallest = 1;
  CellTangent tangent;
  spaces_->for_each_cell([&] {
    const CellVector d = spaces_->read(from);
    if (d.u.isZero(0) && d.p.isZero(0)) return;
    if (!law_) return spaces_->add(cell_residual(spaces_->law, spaces_->shape, d, smallest, nullptr), f);
    cell_residual(spaces_->law, spaces_->shape, spaces_->read(state_), smallest, &tangent);
    const CellMatrix rows = d.u;
    const Eigen::Map<const Eigen::VectorXd> du(rows.data(), rows.size());
    CellMatrix fu = CellMatrix(d.u.rows(), 3);
    Eigen::Map<Eigen::VectorXd>(fu.data(), fu.size()) = tangent.uu * du;
    CellVector y{fu, d.p};
    if (spaces_->mixed()) {
      Eigen::Map<Eigen::VectorXd>(fu.data(), fu.size()) += tangent.up * d.p;
      y = {fu, tangent.pu * du + tangent.pp * d.p};
    }
    spaces_->add(y, f);
  });
  f.u.compress(dealii::VectorOperation::add);
  if (spaces_->mixed()) f.p.compress(dealii::VectorOperation::add);
}

void AssembledOperator::vmult(MixedField& y, const MixedField& x) const {
  // Constrained rows and columns of every matrix are zero except for the diagonal.
  (law_ ? matrices_->uu : smoothed_)->multiply(y.u, x.u);
  if (spaces_->mixed()) {
    matrices_->force->multiply_transposed_and_add(y.u, x.p);
    matrices_->pp->multiply(y.p, x.p);
    DofVector more = y.p;
    matrices_->dilatation->multiply(more, x.u);
    y.p += more;
  }
  clear_constrained(y.u);
}

void AssembledOperator::couple(DofVector& f, const DofVector& p) const {
  f = 0;
  matrices_->force->multiply_transposed_and_add(f, p);  // constrained columns are zero
}

void AssembledOperator::precondition_displacement(DofVector& z, const DofVector& r) const {
  multigrid_->vmult(z, r);
  ++cycles_;
  clear_constrained(z);
}

// Discontinuous pressures are nearly orthogonal: the diagonal does for them.
void AssembledOperator::precondition_pressure(DofVector& y, const DofVector& x) const {
  if (!spaces_->mixed()) return;
  if (system_.body.has_tetrahedra()) {
    divide_by_mass_matrix([&](DofVector& to, const DofVector& from) { mass_->multiply(to, from); }, inverse_mass_, x,
                          y);
  } else {
    y = x;
    y.scale(inverse_mass_);
  }
  y *= 1 / compliance(system_.law_of(0, law_));
}

void AssembledOperator::prepare(const MixedField& x) {
  const int cycles = std::exchange(cycles_, 0);
  if (cycles_when_new_ == 0) cycles_when_new_ = cycles;
  if (cycles <= 2 * cycles_when_new_ + 10) return;
  assemble_stiffness(&x.u);
  cycles_when_new_ = 0;
}

bool AssembledOperator::factorise(const MixedField& x) {
  if (!coarse_ || system_.dof_handler.n_dofs() > most_factored_for_thin_bodies) return false;
  coarse_.reset();
  most_factored_ = most_factored_for_thin_bodies;
  assemble_stiffness(law_ ? &x.u : nullptr);
  cycles_ = cycles_when_new_ = 0;
  return true;
}

void AssembledOperator::clear_constrained(DofVector& f) const {
  for (const unsigned int i : system_.constrained)
    if (f.in_local_range(i)) f(i) = 0;
}

CellPressures AssembledOperator::pressures(const MixedField& x) const {
  MixedField from = x;
  from.p.update_ghost_values();
  const dealii::FiniteElement<3>& fe = spaces_->p.get_fe();
  const std::vector<dealii::Point<3>> corners = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  CellPressures all(system_.body.triangulation.n_active_cells());
  for (const auto& cell : spaces_->p.active_cell_iterators()) {
    if (!cell->is_locally_owned()) continue;
    const auto dofs = dofs_in(cell, spaces_->p);
    std::array<double, 4>& c = all[cell->active_cell_index()];
    for (int k = 0; k < 4; ++k) {
      for (unsigned int f = 0; f < dofs.size(); ++f) c[k] += from.p(dofs[f]) * fe.shape_value(f, corners[k]);
      if (k > 0) c[k] -= c[0];
    }
  }
  return all;
}

namespace {

ElasticAnswer solve_elastic(const ElasticSystem& system, const DofVector& load, DofVector& displacement) {
  start_mpi();
  AssembledOperator K(system, std::nullopt);
  ElasticAnswer answer = solve_linear(K, system, load, displacement);
  answer.method = (system.form == Form::mixed ? "GMRES, " : "CG, ") + K.preconditioner();
  return answer;
}

FiniteAnswer solve_finite(const ElasticSystem& system, const FiniteProblem& problem, const DofVector& load,
                          DofVector& displacement) {
  start_mpi();
  AssembledOperator K(system, problem.law);
  FiniteAnswer answer = Newton<AssembledOperator>(K, system, problem, load).solve(displacement);
  answer.method = "Newton, GMRES, " + K.preconditioner();
  return answer;
}

}  // namespace

extern const Solvers solvers = {solve_elastic, solve_finite};

}  // namespace springproof::fem::assembled
