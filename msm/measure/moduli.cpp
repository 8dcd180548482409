#include "msm/measure/moduli.h"

#include <stdexcept>

#include "msm/solve/equilibrium.h"

namespace springproof {

MeasuredModuli measure_moduli(const ModelParameters& parameters, const IsotropicMaterial& material, int cells) {
  const Mesh mesh = block_mesh(Vec3::Ones(), {cells, cells, cells});
  const auto [model, embedding] = build_embedded(parameters, mesh, material);
  const double strain = 1e-3;
  const std::optional<double> free;
  // Symmetry planes on three faces, a plate moved along z on the fourth; the other two are free.
  const std::vector<Load> loads = {PrescribedDisplacement{"x_min", {0.0, free, free}},
                                   PrescribedDisplacement{"y_min", {free, 0.0, free}},
                                   PrescribedDisplacement{"z_min", {free, free, 0.0}},
                                   PrescribedDisplacement{"z_max", {free, free, strain}}};
  const BoundaryConditions bc = transfer(loads, mesh, embedding, model.network, material.density, Kinematics::linear);
  const Equilibrium state = solve_linear(model, bc, {LinearSolver::automatic, 1e-12, 5000});
  if (!state.ok) throw std::runtime_error(state.message);
  double force = 0, lateral = 0;
  for (int node : embedding.held.at("z_max")) force += state.support(node, 2);
  const NodalVectors displacement = embedding.weights * state.displacement;
  const std::vector<int> side = nodes_of(patch(mesh, "x_max"));
  for (int node : side) lateral += displacement(node, 0) / static_cast<double>(side.size());

  // Affine shear gamma in the plane xy: energy G gamma^2 / 2 per volume (K u . u / 2, linear).
  const NodalVectors& X = model.network.X;
  Eigen::VectorXd u = Eigen::VectorXd::Zero(X.size()), Ku;
  for (int n = 0; n < X.rows(); ++n) u[3 * n] = X(n, 1);
  tangent(model, model.network.X).multiply(u, Ku);
  return {force / strain, -lateral / strain, u.dot(Ku)};
}

}  // namespace springproof
