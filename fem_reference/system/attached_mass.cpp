#include "fem_reference/system/attached_mass.h"

#include <deal.II/fe/fe_values.h>
#include <fmt/format.h>

#include "fem_reference/grid/locate.h"
#include "problem/system/input_error.h"

namespace springproof::fem {
namespace {

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

}  // namespace

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

}  // namespace springproof::fem
