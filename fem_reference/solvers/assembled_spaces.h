// What the assembled operator is made of: its degrees of freedom, those of linear elements below them, its matrices.
#pragma once

#include <deal.II/dofs/dof_tools.h>
#include <deal.II/fe/fe_values.h>
#include <deal.II/lac/dynamic_sparsity_pattern.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <set>
#include <vector>

#include "fem_reference/elements/cell_equations.h"
#include "fem_reference/solvers/assembled_operator.h"

namespace springproof::fem::assembled {

/// With the entries that the cells couple, all zero.
inline std::unique_ptr<SparseMatrix> empty_matrix(const dealii::DoFHandler<3>& rows,
                                                  const dealii::DoFHandler<3>& columns, MPI_Comm comm) {
  dealii::IndexSet relevant;
  dealii::DoFTools::extract_locally_relevant_dofs(rows, relevant);
  dealii::DynamicSparsityPattern pattern(rows.n_dofs(), columns.n_dofs(), relevant);
  for (const auto& cell : rows.active_cell_iterators()) {
    if (cell->is_artificial()) continue;
    auto c = dofs_in(cell, columns);
    std::sort(c.begin(), c.end());
    for (const auto row : dofs_in(cell, rows))
      if (rows.locally_owned_dofs().is_element(row)) pattern.add_entries(row, c.begin(), c.end(), true);
  }
  return std::make_unique<SparseMatrix>(rows.locally_owned_dofs(), columns.locally_owned_dofs(), pattern, comm);
}

/// Degrees of freedom, quadrature and constraints, which do not depend on the state.
struct AssembledOperator::Spaces {
  Spaces(const ElasticSystem& system, std::optional<Law> wanted_law, const dealii::DoFHandler<3>& displacement,
         const std::vector<unsigned int>& constrained)
      : system_(system),
        law(system.law_of(0, wanted_law)),
        comm(system.body.triangulation.get_communicator()),
        u(displacement),
        p(system.body.of_pressures()),
        scalar(scalar_element(system.body, int(u.get_fe().degree))),
        quadrature(cell_quadrature(system.body, u.get_fe().degree + 1)),
        values(*system.body.mapping, *scalar, quadrature, dealii::update_gradients | dealii::update_JxW_values),
        u_indices(u.get_fe().n_dofs_per_cell()),
        held(u.n_dofs()) {
    held.add_indices(constrained.begin(), constrained.end());
    held.compress();
    for (unsigned int i = 0; i < u_indices.size(); ++i) {
      const auto [component, node] = u.get_fe().system_to_component_index(i);
      place.push_back(3 * int(node) + int(component));
    }
    if (system.form != Form::mixed || &u != &system.dof_handler) return;
    const auto fe = pressure_element(system.body, system.degree);
    p.distribute_dofs(*fe);
    p_indices.resize(fe->n_dofs_per_cell());
    shape.pressures = values_at(*fe, quadrature);
  }

  bool mixed() const { return !p_indices.empty(); }

  // Calls visit() on every locally owned cell, with law, shape, u_indices and p_indices set.
  template <typename Visit>
  void for_each_cell(const Visit& visit) {
    for (const auto& cell : u.active_cell_iterators()) {
      if (!cell->is_locally_owned()) continue;
      const auto dofs = dofs_in(cell, u);
      for (std::size_t i = 0; i < dofs.size(); ++i) u_indices[place[i]] = PetscInt(dofs[i]);
      if (mixed()) std::ranges::copy(dofs_in(cell, p), p_indices.begin());
      const dealii::Triangulation<3>::cell_iterator here = cell;
      law = system_.law_of(cell->material_id(), law.law);
      values.reinit(here);
      set_shape(values, shape);
      visit();
    }
  }

  Eigen::MatrixXd displacement(const DofVector& x) const {
    Eigen::MatrixXd at_nodes(scalar->n_dofs_per_cell(), 3);
    for (std::size_t i = 0; i < u_indices.size(); ++i) at_nodes(i / 3, i % 3) = x(u_indices[i]);
    return at_nodes;
  }

  CellVector read(const MixedField& x) const {
    CellVector c{displacement(x.u), Eigen::VectorXd(p_indices.size())};
    for (std::size_t f = 0; f < p_indices.size(); ++f) c.p[f] = x.p(p_indices[f]);
    return c;
  }

  void add(const CellVector& c, MixedField& f) const {
    for (std::size_t i = 0; i < u_indices.size(); ++i) f.u(u_indices[i]) += c.u(i / 3, i % 3);
    for (std::size_t k = 0; k < p_indices.size(); ++k) f.p(p_indices[k]) += c.p[k];
  }

  MixedField vector() const { return {zero_vector(u), mixed() ? zero_vector(p) : DofVector()}; }

  // Stiffness of the undeformed body (nullptr), or of the deformed one.
  void assemble_stiffness(const DofVector* deformed_by, SparseMatrix& matrix) {
    matrix.clear();
    DofVector x;
    if (deformed_by) {
      x = zero_vector(u);
      x = *deformed_by;
      x.update_ghost_values();
    }
    for_each_cell([&] {
      Eigen::MatrixXd at_nodes;
      if (deformed_by) at_nodes = displacement(x);
      add_free(cell_stiffness(law, shape, deformed_by ? &at_nodes : nullptr), matrix);
    });
    matrix.finish();
  }

  // Adds a cell matrix with constrained rows and columns eliminated; their diagonal entries are kept.
  void add_free(CellMatrix K, SparseMatrix& matrix) const {
    for (std::size_t i = 0; i < u_indices.size(); ++i) {
      if (!held.is_element(u_indices[i])) continue;
      const double diagonal = K(i, i);
      K.row(i).setZero();
      K.col(i).setZero();
      K(i, i) = diagonal;
    }
    matrix.add(u_indices, u_indices, K.data());
  }
  // Adds a coupling block, one row per pressure.
  void add_coupling(CellMatrix B, SparseMatrix& matrix) const {
    for (std::size_t i = 0; i < u_indices.size(); ++i)
      if (held.is_element(u_indices[i])) B.col(i).setZero();
    matrix.add(p_indices, u_indices, B.data());
  }

  const ElasticSystem& system_;
  CellLaw law;  // of the cell being visited
  MPI_Comm comm;
  const dealii::DoFHandler<3>& u;
  dealii::DoFHandler<3> p;
  std::unique_ptr<dealii::FiniteElement<3>> scalar;
  dealii::Quadrature<3> quadrature;
  dealii::FEValues<3> values;
  std::vector<PetscInt> u_indices, p_indices;  // of the cell being visited; 3 a + i for component i of node a
  std::vector<int> place;                      // deal.II's local number -> 3 a + i
  dealii::IndexSet held;                       // degrees of freedom with prescribed value
  CellShape shape;
};

/// Linear elements on the same triangulation: the coarse level of p-multigrid.
struct AssembledOperator::CoarseSpaces {
  CoarseSpaces(const ElasticSystem& system, Spaces& fine)
      : dof_handler(distributed(system)), spaces(system, std::nullopt, *dof_handler, shared_constraints(fine)) {
    matrix = empty_matrix(*dof_handler, *dof_handler, fine.comm);
    interpolation = empty_matrix(fine.u, *dof_handler, fine.comm);
    for_each_pair(fine, [&](const auto& fine_dofs, const auto& coarse_dofs) {
      const auto &fe = fine.u.get_fe(), &linear = dof_handler->get_fe();
      const std::vector<PetscInt> columns(coarse_dofs.begin(), coarse_dofs.end());
      for (unsigned int i = 0; i < fine_dofs.size(); ++i) {
        if (!fine.u.locally_owned_dofs().is_element(fine_dofs[i])) continue;
        std::vector<double> row(columns.size(), 0.0);
        if (!fine.held.is_element(fine_dofs[i]))
          for (unsigned int j = 0; j < columns.size(); ++j)
            if (linear.system_to_component_index(j).first == fe.system_to_component_index(i).first &&
                !spaces.held.is_element(columns[j]))
              row[j] = linear.shape_value(j, fe.unit_support_point(i));
        interpolation->insert({PetscInt(fine_dofs[i])}, columns, row.data());
      }
    });
    interpolation->finish();
  }

  static std::unique_ptr<dealii::DoFHandler<3>> distributed(const ElasticSystem& system) {
    auto handler = std::make_unique<dealii::DoFHandler<3>>(system.body.triangulation);
    handler->distribute_dofs(*displacement_element(system.body, 1));
    return handler;
  }

  // Calls visit() on every locally owned cell, with the degrees of freedom of both elements.
  template <typename Visit>
  void for_each_pair(const Spaces& fine, const Visit& visit) const {
    for (const auto& cell : fine.u.active_cell_iterators())
      if (cell->is_locally_owned()) visit(dofs_in(cell, fine.u), dofs_in(cell, *dof_handler));
  }

  // The vertex degrees of freedom of a cell come first in both elements.
  std::vector<unsigned int> shared_constraints(const Spaces& fine) const {
    std::set<unsigned int> shared;
    for_each_pair(fine, [&](const auto& fine_dofs, const auto& coarse_dofs) {
      for (std::size_t i = 0; i < coarse_dofs.size(); ++i)
        if (fine.held.is_element(fine_dofs[i])) shared.insert(coarse_dofs[i]);
    });
    return {shared.begin(), shared.end()};
  }

  // Restriction by injection: the values at the vertices.
  DofVector restricted(const Spaces& fine, const DofVector& x) const {
    DofVector from = zero_vector(fine.u), to = zero_vector(spaces.u);
    from = x;
    from.update_ghost_values();
    for_each_pair(fine, [&](const auto& fine_dofs, const auto& coarse_dofs) {
      for (std::size_t i = 0; i < coarse_dofs.size(); ++i)
        if (spaces.u.locally_owned_dofs().is_element(coarse_dofs[i])) to(coarse_dofs[i]) = from(fine_dofs[i]);
    });
    return to;
  }

  std::unique_ptr<dealii::DoFHandler<3>> dof_handler;
  Spaces spaces;
  std::unique_ptr<SparseMatrix> matrix, interpolation;
};

/// Blocks of the tangent.  The couplings have one row per pressure: `dilatation` is K_pu, `force` is K_up transposed.
struct AssembledOperator::Matrices {
  explicit Matrices(const Spaces& s) {
    if (s.law.law) uu = empty_matrix(s.u, s.u, s.comm);  // otherwise smoothed_ is the tangent
    if (!s.mixed()) return;
    dilatation = empty_matrix(s.p, s.u, s.comm);
    force = empty_matrix(s.p, s.u, s.comm);
    pp = empty_matrix(s.p, s.p, s.comm);
  }
  std::vector<SparseMatrix*> all() const {
    std::vector<SparseMatrix*> there;
    for (const auto* m : {&uu, &dilatation, &force, &pp})
      if (*m) there.push_back(m->get());
    return there;
  }
  std::unique_ptr<SparseMatrix> uu, dilatation, force, pp;
};

}  // namespace springproof::fem::assembled
