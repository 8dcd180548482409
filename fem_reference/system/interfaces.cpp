#include "fem_reference/system/interfaces.h"

#include <map>
#include <set>
#include <utility>

namespace springproof::fem {
namespace {

// Degrees of freedom that cells of several materials have.
struct CommonDof {
  int component;
  std::set<int> materials;
};

std::map<dealii::types::global_dof_index, CommonDof> common_dofs(const dealii::DoFHandler<3>& dof_handler) {
  const auto& fe = dof_handler.get_fe();
  std::vector<int> first(dof_handler.n_dofs(), -1);
  std::map<dealii::types::global_dof_index, CommonDof> common;
  for (const auto& cell : dof_handler.active_cell_iterators()) {
    const int own = cell->material_id();
    const auto dofs = dofs_in(cell, dof_handler);
    for (unsigned int i = 0; i < dofs.size(); ++i) {
      int& known = first[dofs[i]];
      if (known < 0) known = own;
      if (known == own) continue;
      CommonDof& here =
          common.try_emplace(dofs[i], CommonDof{int(fe.system_to_component_index(i).first), {}}).first->second;
      here.materials.insert({known, own});
    }
  }
  return common;
}

// Adds the internal forces of the cells of each material to its vector.
void add_internal_forces(const ElasticSystem& system, const ElasticAnswer& answer, const DofVector& displacement,
                         std::vector<DofVector>& forces) {
  const auto& fe = system.dof_handler.get_fe();
  const auto scalar = scalar_element(system.body, system.degree);
  const dealii::Quadrature<3> rule = cell_quadrature(system.body, system.degree + 1);
  dealii::FEValues<3> values(*system.body.mapping, *scalar, rule, dealii::update_gradients | dealii::update_JxW_values);
  Eigen::MatrixXd linear(rule.size(), 4);  // CellPressures at the points
  for (unsigned int q = 0; q < rule.size(); ++q)
    linear.row(q) << 1, rule.point(q)[0], rule.point(q)[1], rule.point(q)[2];
  double smallest = 1;
  CellShape shape;
  for (const auto& cell : system.dof_handler.active_cell_iterators()) {
    const CellLaw& law = system.laws[cell->material_id()];
    const dealii::Triangulation<3>::cell_iterator here = cell;
    values.reinit(here);
    set_shape(values, shape);
    const auto dofs = dofs_in(cell, system.dof_handler);
    CellVector x{Eigen::MatrixXd(shape.nodes(), 3), {}};
    shape.pressures.resize(shape.points(), 0);
    if (law.form == Form::mixed) {
      shape.pressures = linear;
      x.p = Eigen::Map<const Eigen::Vector4d>(answer.pressure[cell->active_cell_index()].data());
    }
    for (unsigned int i = 0; i < dofs.size(); ++i) {
      const auto [component, node] = fe.system_to_component_index(i);
      x.u(node, component) = displacement[dofs[i]];
    }
    const CellVector f = cell_residual(law, shape, x, smallest, nullptr);
    for (unsigned int i = 0; i < dofs.size(); ++i) {
      const auto [component, node] = fe.system_to_component_index(i);
      forces[cell->material_id()][dofs[i]] += f.u(node, component);
    }
  }
}

}  // namespace

std::vector<InterfaceForce> measure_interfaces(const ElasticSystem& system, const ElasticAnswer& answer,
                                               const DofVector& displacement, const std::vector<DofVector>& loads) {
  std::vector<DofVector> on = loads;  // a material, by the others
  for (DofVector& force : on) force *= -answer.load_reached;
  add_internal_forces(system, answer, displacement, on);
  std::map<std::pair<int, int>, Vec3> forces;
  for (const auto& [dof, at] : common_dofs(system.dof_handler))
    for (const int own : at.materials)
      for (const int other : at.materials)
        if (own > other)
          forces.try_emplace({own, other}, Vec3::Zero()).first->second[at.component] +=
              (on[own][dof] - on[other][dof]) / double(at.materials.size());
  std::vector<InterfaceForce> interfaces;
  for (const auto& [materials, force] : forces) interfaces.push_back({materials.first, materials.second, force});
  return interfaces;
}

}  // namespace springproof::fem
