#include "fem_reference/system/sample.h"

#include <deal.II/base/quadrature_lib.h>
#include <deal.II/fe/fe_dgq.h>
#include <deal.II/fe/fe_system.h>
#include <deal.II/fe/fe_values.h>

#include <algorithm>
#include <map>
#include <numeric>

#include "fem_reference/grid/processes.h"
#include "problem/system/input_error.h"

namespace springproof::fem {

NodalVectors displacement_at(const std::vector<Location>& places, const dealii::DoFHandler<3>& dof_handler,
                             const DofVector& displacement) {
  const auto& scalar = dof_handler.get_fe().base_element(0);
  NodalVectors u = NodalVectors::Zero(places.size(), 3);
  for (std::size_t k = 0; k < places.size(); ++k) {
    if (!places[k].answers) continue;
    const auto dofs = dofs_in(places[k].cell, dof_handler);
    for (unsigned int a = 0; a < scalar.n_dofs_per_cell(); ++a) {
      const double N = scalar.shape_value(a, places[k].unit);
      for (int c = 0; c < 3; ++c)
        u(k, c) += N * displacement[dofs[dof_handler.get_fe().component_to_system_index(c, a)]];
    }
  }
  sum_over_processes(u, dof_handler.get_communicator());
  return u;
}

namespace {

// The pressure at one point: from the pressure unknowns if there are any, else from the dilatation.
double pressure_at(const CellLaw& law, const CellPressures& pressures, const Location& place, double dilatation) {
  const double lambda = law.form == Form::mixed ? law.pointwise : law.lambda;
  const double of_dilatation = law.law ? pressure(*law.law, lambda, dilatation).value : lambda * dilatation;
  if (pressures.empty()) return of_dilatation;
  const auto& c = pressures[place.cell->active_cell_index()];
  return c[0] + c[1] * place.unit[0] + c[2] * place.unit[1] + c[3] * place.unit[2] + of_dilatation;
}

Eigen::Matrix3d linear_stress(const dealii::Tensor<2, 3>& h, double mu, double p) {
  Eigen::Matrix3d stress;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) stress(i, j) = mu * (h[i][j] + h[j][i]) + (i == j ? p : 0);
  return stress;
}

// F S F^T / det F
Eigen::Matrix3d cauchy_stress(Law law, const Eigen::Matrix3d& F, double mu, double p) {
  return F * tensor(stress(law, mu, p, F.transpose() * F)) * F.transpose() / F.determinant();
}

Eigen::Matrix3d deformation_gradient(const dealii::Tensor<2, 3>& h) {
  Eigen::Matrix3d F;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) F(i, j) = h[i][j] + (i == j);
  return F;
}

// Stresses at the superconvergent points of a cell (Barlow 1976), those of the Gauss rule with `degree` points per
// direction, and their extrapolation.
class CellStress {
 public:
  CellStress(const ElasticSystem& system, std::optional<Law> law, const ElasticAnswer& answer,
             const DofVector& displacement)
      : system_(system),
        law_(law),
        answer_(answer),
        displacement_(displacement),
        tetrahedra_(system.body.has_tetrahedra()),
        interpolation_(dealii::QGauss<1>(system.degree)),
        points_(tetrahedra_ ? tetrahedron_points(system.degree) : dealii::QGauss<3>(system.degree).get_points()),
        values_(*system.body.mapping, system.dof_handler.get_fe(), dealii::Quadrature<3>(points_),
                dealii::update_gradients),
        gradients_(points_.size()),
        stresses_(points_.size()) {}

  // What extrapolates the stresses at the points to `unit`.
  std::vector<double> weights(const dealii::Point<3>& unit) const {
    std::vector<double> w(points_.size(), 1.0);
    if (!tetrahedra_) {
      for (unsigned int i = 0; i < w.size(); ++i) w[i] = interpolation_.shape_value(i, unit);
    } else if (w.size() == 4) {
      const std::array<double, 4> barycentric = {1 - unit[0] - unit[1] - unit[2], unit[0], unit[1], unit[2]};
      for (int corner = 0; corner < 4; ++corner) w[corner] = (barycentric[corner] - far) / (near - far);
    }
    return w;
  }

  const std::vector<Eigen::Matrix3d>& at_points(const dealii::Triangulation<3>::active_cell_iterator& cell) {
    values_.reinit(dealii::DoFHandler<3>::active_cell_iterator(&system_.body.triangulation, cell->level(),
                                                               cell->index(), &system_.dof_handler));
    values_[dealii::FEValuesExtractors::Vector(0)].get_function_gradients(displacement_, gradients_);
    const CellLaw law = system_.law_of(cell->material_id(), law_);
    for (std::size_t k = 0; k < points_.size(); ++k) {
      const Location here{cell, points_[k]};
      if (law_) {
        const Eigen::Matrix3d F = deformation_gradient(gradients_[k]);
        const double p = pressure_at(law, answer_.pressure, here, dilatation(*law_, F));
        stresses_[k] = cauchy_stress(*law_, F, law.mu, p);
      } else {
        const double p = pressure_at(law, answer_.pressure, here, dealii::trace(gradients_[k]));
        stresses_[k] = linear_stress(gradients_[k], law.mu, p);
      }
    }
    return stresses_;
  }

 private:
  // Of four points, each nearer to one corner: their barycentric coordinates.
  inline static const double near = (5 + 3 * std::sqrt(5.0)) / 20, far = (5 - std::sqrt(5.0)) / 20;

  static std::vector<dealii::Point<3>> tetrahedron_points(int degree) {
    if (degree == 1) return {{0.25, 0.25, 0.25}};
    return {{far, far, far}, {near, far, far}, {far, near, far}, {far, far, near}};
  }

  const ElasticSystem& system_;
  std::optional<Law> law_;
  const ElasticAnswer& answer_;
  const DofVector& displacement_;
  bool tetrahedra_;
  dealii::FE_DGQArbitraryNodes<3> interpolation_;
  std::vector<dealii::Point<3>> points_;
  dealii::FEValues<3> values_;
  std::vector<dealii::Tensor<2, 3>> gradients_;
  std::vector<Eigen::Matrix3d> stresses_;
};

Eigen::Matrix3d weighted(const std::vector<double>& weights, const std::vector<Eigen::Matrix3d>& stresses) {
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  for (std::size_t k = 0; k < weights.size(); ++k) sum += weights[k] * stresses[k];
  return sum;
}

/// det(I + h) - 1 by its invariants, without cancellation.
double det_minus_1(const dealii::Tensor<2, 3>& h) {
  const double trace = dealii::trace(h);
  return trace + (trace * trace - dealii::trace(h * h)) / 2 + dealii::determinant(h);
}

Eigen::Matrix<double, 1, 6> components(const Eigen::Matrix3d& s) {
  Eigen::Matrix<double, 1, 6> out;
  out << s(0, 0), s(1, 1), s(2, 2), s(0, 1), s(1, 2), s(0, 2);
  return out;
}

}  // namespace

Stresses stress_at(const NodalVectors& points, const ElasticSystem& system, std::optional<Law> law,
                   const ElasticAnswer& answer, const DofVector& displacement) {
  Stresses stresses = Stresses::Zero(points.rows(), 6);
  const std::vector<Location> places = locate(system.body, points);
  const dealii::GridTools::Cache<3> cache(system.body.triangulation, *system.body.mapping);
  Eigen::VectorXd cells_at = Eigen::VectorXd::Zero(points.rows());
  CellStress stress(system, law, answer, displacement);
  for (std::size_t k = 0; k < places.size(); ++k) {
    if (!places[k].is_here()) continue;
    std::vector<Location> cells = cells_around(cache, places[k], points.row(k));
    const auto material = [](const Location& place) { return place.cell->material_id(); };
    const auto least = std::ranges::min(cells, {}, material).cell->material_id();  // several: of one process
    std::erase_if(cells, [&](const Location& place) { return material(place) != least; });
    cells_at[k] = double(cells.size());
    Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
    for (const Location& place : cells) sum += weighted(stress.weights(place.unit), stress.at_points(place.cell));
    stresses.row(k) = components(sum);
  }
  sum_over_processes(cells_at, system.dof_handler.get_communicator());
  sum_over_processes(stresses, system.dof_handler.get_communicator());
  stresses.array().colwise() /= cells_at.array();
  return stresses;
}

NodalSolution at_own_nodes(const ElasticSystem& system, std::optional<Law> law, const ElasticAnswer& answer,
                           const DofVector& displacement) {
  if (process_count() > 1) throw InputError("a file of the finite elements' own mesh is written by one process");
  const auto& fe = system.dof_handler.get_fe();
  const std::vector<dealii::Point<3>> units = fe.base_element(0).get_unit_support_points();
  CellStress stress(system, law, answer, displacement);
  std::vector<std::vector<double>> weights;
  for (const auto& unit : units) weights.push_back(stress.weights(unit));

  // Of a node, by its first degree of freedom and the material.
  std::map<std::pair<dealii::types::global_dof_index, dealii::types::material_id>, int> number;
  NodalSolution out;
  for (const auto& cell : system.dof_handler.active_cell_iterators()) {
    const auto dofs = dofs_in(cell, system.dof_handler);
    if (!system.laws.empty()) out.materials.push_back(cell->material_id());
    std::vector<int>& own = out.cells.emplace_back();
    for (unsigned int a = 0; a < units.size(); ++a)
      own.push_back(number
                        .try_emplace({dofs[fe.component_to_system_index(0, a)], cell->material_id()},
                                     static_cast<int>(number.size()))
                        .first->second);
  }
  const auto nodes = static_cast<Eigen::Index>(number.size());
  out.X.resize(nodes, 3);
  out.displacement.resize(nodes, 3);
  out.stress = Stresses::Zero(nodes, 6);
  Eigen::VectorXd cells_at = Eigen::VectorXd::Zero(nodes);
  for (const auto& cell : system.dof_handler.active_cell_iterators()) {
    const auto dofs = dofs_in(cell, system.dof_handler);
    const std::vector<Eigen::Matrix3d>& in_cell = stress.at_points(cell);
    for (unsigned int a = 0; a < units.size(); ++a) {
      const int n = out.cells[cell->active_cell_index()][a];
      out.stress.row(n) += components(weighted(weights[a], in_cell));
      cells_at[n] += 1;
      const dealii::Point<3> X = system.body.mapping->transform_unit_to_real_cell(cell, units[a]);
      for (int c = 0; c < 3; ++c) {
        out.X(n, c) = X[c];
        out.displacement(n, c) = displacement[dofs[fe.component_to_system_index(c, a)]];
      }
    }
  }
  out.stress.array().colwise() /= cells_at.array();
  return out;
}

namespace {

// The dilatation at the points of a cell, as its form takes it.
std::vector<double> dilatations(const CellLaw& law, const std::vector<dealii::Tensor<2, 3>>& gradients,
                                const std::vector<double>& weights) {
  std::vector<double> g;
  for (const auto& h : gradients)
    g.push_back(law.law ? dilatation(*law.law, deformation_gradient(h)) : dealii::trace(h));
  if (law.form == Form::mean_dilatation) {
    const double volume = std::accumulate(weights.begin(), weights.end(), 0.0);
    g.assign(g.size(), std::inner_product(g.begin(), g.end(), weights.begin(), 0.0) / volume);
  }
  return g;
}

// Stress and energy at a point of a cell.
struct PointState {
  Eigen::Matrix3d stress;  // Cauchy's
  double energy;           // per rest volume [Pa]
};

PointState state_at(const CellLaw& law, const dealii::Tensor<2, 3>& h, double p, double g) {
  if (!law.law) {
    const Eigen::Matrix3d stress = linear_stress(h, law.mu, p);
    double work = 0;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) work += stress(i, j) * h[i][j];
    return {stress, work / 2};
  }
  const Eigen::Matrix3d F = deformation_gradient(h);
  double energy = shear_energy(*law.law, law.mu, F);
  if (law.form != Form::mixed) {
    energy += dilatation_energy(*law.law, law.lambda, g);
  } else {
    const double others = law.lambda - law.pointwise, of_points = pressure(*law.law, law.pointwise, g).value;
    const double of_unknown = dilatation_at_pressure(*law.law, others, p - of_points).value;
    energy += dilatation_energy(*law.law, law.pointwise, g) + dilatation_energy(*law.law, others, of_unknown);
  }
  return {cauchy_stress(*law.law, F, law.mu, p), energy};
}

}  // namespace

std::vector<RegionMeans> measure_regions(const ElasticSystem& system, const ElasticAnswer& answer,
                                         const DofVector& displacement) {
  std::vector<RegionMeans> regions(system.laws.size() - 1);
  std::vector<double> volume(regions.size(), 0), deformed = volume;
  dealii::FEValues<3> values(*system.body.mapping, system.dof_handler.get_fe(),
                             cell_quadrature(system.body, system.degree + 1),
                             dealii::update_values | dealii::update_gradients | dealii::update_JxW_values);
  const dealii::FEValuesExtractors::Vector vector(0);
  std::vector<dealii::Tensor<2, 3>> gradients(values.n_quadrature_points);
  std::vector<dealii::Tensor<1, 3>> u(values.n_quadrature_points);
  for (const auto& cell : system.dof_handler.active_cell_iterators()) {
    if (cell->material_id() == 0) continue;
    const std::size_t r = cell->material_id() - 1;
    const CellLaw& law = system.laws[r + 1];
    values.reinit(cell);
    values[vector].get_function_gradients(displacement, gradients);
    values[vector].get_function_values(displacement, u);
    const std::vector<double> g = dilatations(law, gradients, values.get_JxW_values());
    for (const unsigned int q : values.quadrature_point_indices()) {
      const double w = values.JxW(q), change = det_minus_1(gradients[q]), now = law.law ? w * (1 + change) : w;
      const double p = pressure_at(law, answer.pressure, {cell, values.get_quadrature().point(q)}, g[q]);
      const PointState at = state_at(law, gradients[q], p, g[q]);
      volume[r] += w;
      deformed[r] += now;
      regions[r].volume_change += w * change;
      regions[r].stress += now * components(at.stress);
      regions[r].energy += w * at.energy;
      for (int i = 0; i < 3; ++i) regions[r].displacement[i] += w * u[q][i];
    }
  }
  for (std::size_t r = 0; r < regions.size(); ++r) {
    regions[r].volume_change /= volume[r];
    regions[r].displacement /= volume[r];
    regions[r].stress /= deformed[r];
  }
  return regions;
}

VolumeMeasure measure_volume(const Body3& body, const dealii::DoFHandler<3>& dof_handler,
                             const DofVector& displacement) {
  const auto& fe = dof_handler.get_fe();
  dealii::FEValues<3> values(*body.mapping, fe, cell_quadrature(body, fe.degree + 1),
                             dealii::update_gradients | dealii::update_JxW_values);
  const dealii::FEValuesExtractors::Vector vector(0);
  std::vector<dealii::Tensor<2, 3>> gradients(values.n_quadrature_points);
  VolumeMeasure measure;
  double volume = 0;
  for (const auto& cell : dof_handler.active_cell_iterators()) {
    if (!cell->is_locally_owned()) continue;
    values.reinit(cell);
    values[vector].get_function_gradients(displacement, gradients);
    for (const unsigned int q : values.quadrature_point_indices()) {
      const dealii::Tensor<2, 3> h = gradients[q];
      const double change = det_minus_1(h);
      volume += values.JxW(q);
      measure.change += values.JxW(q) * change;
      measure.change_first_order += values.JxW(q) * dealii::trace(h);
      measure.min_jacobian = std::min(measure.min_jacobian, 1 + change);
    }
  }
  const MPI_Comm comm = dof_handler.get_communicator();
  volume = dealii::Utilities::MPI::sum(volume, comm);
  measure.change = dealii::Utilities::MPI::sum(measure.change, comm);
  measure.change_first_order = dealii::Utilities::MPI::sum(measure.change_first_order, comm);
  measure.min_jacobian = dealii::Utilities::MPI::min(measure.min_jacobian, comm);
  measure.change /= volume;
  measure.change_first_order /= volume;
  return measure;
}

}  // namespace springproof::fem
