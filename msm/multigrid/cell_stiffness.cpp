#include "msm/multigrid/cell_stiffness.h"

#include <stdexcept>

namespace springproof {
namespace {

MassSpringModel one_cell(const MassSpringModel& model) {
  if (model.network.cells.empty()) throw std::invalid_argument("the network has no cells");
  MassSpringModel cell;
  for (const ForceLaw& law : model.laws)
    if (traits(law).reach != Reach::second_neighbours) cell.laws.push_back(law);
  cell.network.cells.edge = model.network.cells.edge;
  cell.network.cells.proportions = model.network.cells.proportions;
  cell.network.springs = model.network.cells.springs;
  cell.network.X.resize(8, 3);
  for (int n = 0; n < 8; ++n)
    for (int d = 0; d < 3; ++d)
      cell.network.X(n, d) = model.network.cells.edge * model.network.cells.proportions[d] * hexahedron_corners[n][d];
  cell.network.cells.corners = {{0, 1, 2, 3, 4, 5, 6, 7}};
  return cell;
}

CellMatrix dense(const Tangent& K) {
  CellMatrix A;
  Eigen::VectorXd column(24);
  for (int i = 0; i < 24; ++i) {
    K.multiply(Eigen::VectorXd::Unit(24, i), column);
    A.col(i) = column;
  }
  return A;
}

}  // namespace

CellStiffness in_units(CellStiffness cell, double G, double edge) {
  cell.total /= G * edge;
  cell.without_volume /= G * edge;
  cell.volume_gradient /= edge * edge;
  cell.kappa /= G;
  cell.volume /= edge * edge * edge;
  return cell;
}

CellStiffness cell_stiffness(const MassSpringModel& model) {
  const MassSpringModel cell = one_cell(model);
  CellStiffness s;
  s.total = dense(tangent(cell, cell.network.X));
  s.volume = cell.network.cells.volume();
  const MeanEdgeVolume v = mean_edge_volume(cell.network.cells.corners[0], cell.network.X);
  for (int n = 0; n < 8; ++n) s.volume_gradient.segment<3>(3 * n) = v.gradient.row(n).transpose();
  if (const auto* correction = law_of<VolumeCorrection>(model)) s.kappa += correction->kappa;
  if (const AveragedSprings* averaged = averaged_springs_of(model))
    s.kappa += averaged->lame_lambda - averaged->shear_modulus;
  s.without_volume = s.total - s.kappa / s.volume * s.volume_gradient * s.volume_gradient.transpose();
  return s;
}

StrainedCell strained_cell(const MassSpringModel& model, const Eigen::Matrix3d& F) {
  const MassSpringModel cell = one_cell(model);
  const NodalVectors x = cell.network.X * F.transpose();
  return {dense(tangent(cell, x)), -forces(cell, x).transpose() * cell.network.X / cell.network.cells.volume()};
}

}  // namespace springproof
