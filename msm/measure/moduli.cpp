#include "msm/measure/moduli.h"

#include <stdexcept>

#include "msm/models.h"
#include "msm/periodic/bulk_calibration.h"
#include "msm/periodic/homogenise.h"
#include "msm/statics/equilibrium.h"

namespace springproof {
namespace {

constexpr double test_strain = 1e-3;
const std::optional<double> free_component;

Equilibrium solved(const MassSpringModel& model, const BoundaryConditions& bc) {
  Equilibrium state = solve_linear(model, bc, {LinearSolver::automatic, 1e-12, 5000});
  if (!state.ok) throw std::runtime_error(state.message);
  return state;
}

/// u . K u of a displacement.
double twice_energy(const MassSpringModel& model, const NodalVectors& displacement) {
  const Eigen::Map<const Eigen::VectorXd> u(displacement.data(), displacement.size());
  Eigen::VectorXd Ku;
  tangent(model, model.network.X).multiply(u, Ku);
  return u.dot(Ku);
}

/// Affine shear gamma = 1 in the plane xy: energy G gamma^2 / 2 per volume.
double affine_shear(const MassSpringModel& model, double volume) {
  NodalVectors u = NodalVectors::Zero(model.network.nodes(), 3);
  u.col(0) = model.network.X.col(1);
  return twice_energy(model, u) / volume;
}

MeasuredModuli measure_block(const ModelParameters& parameters, const IsotropicMaterial& material, int cells) {
  const Mesh mesh = block_mesh(Vec3::Ones(), {cells, cells, cells});
  const auto [model, embedding] = build_embedded(parameters, mesh, material);
  // Symmetry planes on three faces, a plate moved along z on the fourth; the other two are free.
  const std::vector<Load> loads = {PrescribedDisplacement{"x_min", {0.0, free_component, free_component}},
                                   PrescribedDisplacement{"y_min", {free_component, 0.0, free_component}},
                                   PrescribedDisplacement{"z_min", {free_component, free_component, 0.0}},
                                   PrescribedDisplacement{"z_max", {free_component, free_component, test_strain}}};
  const Equilibrium state =
      solved(model, transfer(loads, mesh, embedding, model.network, material.density, Kinematics::linear));
  double force = 0, lateral = 0;
  for (int node : embedding.held.at("z_max")) force += state.support(node, 2);
  const std::vector<int> side = nodes_of(patch(mesh, "x_max"));
  for (int node : side) lateral += state.displacement(node, 0) / static_cast<double>(side.size());
  return {force / test_strain, -lateral / test_strain, affine_shear(model, 1)};
}

/// Rows of triangles between plates that slip, pulled along y.
MeasuredModuli measure_sheet(const ModelParameters& parameters, const IsotropicMaterial& material, int cells) {
  const MassSpringModel model = build_model(parameters, block_mesh({1, 1, 1.0 / cells}, {cells, cells, 1}), material);
  const NodalVectors& X = model.network.X;
  const double top = X.col(1).maxCoeff();
  BoundaryConditions bc{std::vector<char>(X.size(), 0), std::vector<int>(X.size(), -1), NodalVectors::Zero(X.rows(), 3),
                        NodalVectors::Zero(X.rows(), 3)};
  for (int n = 0; n < X.rows(); ++n) {
    bc.fixed[3 * n + 2] = 1;
    if (X(n, 1) > 1e-9 && X(n, 1) < top - 1e-9) continue;
    bc.fixed[3 * n + 1] = 1;
    bc.prescribed(n, 1) = test_strain * X(n, 1);
  }
  hold_free_motions(X, bc);
  const Equilibrium state = solved(model, bc);
  const Eigen::VectorXd x = X.col(0).array() - X.col(0).mean();
  const double in_plane = -x.dot(state.displacement.col(0)) / x.squaredNorm() / test_strain,
               nu = in_plane / (1 + in_plane);
  const double volume = model.network.volume.sum(),
               E = twice_energy(model, state.displacement) / (volume * test_strain * test_strain);
  return {E * (1 - nu * nu), nu, affine_shear(model, volume)};  // plane strain: E / (1 - nu^2), nu / (1 - nu)
}

MeasuredModuli measure_bulk(const ModelParameters& parameters, const IsotropicMaterial& material) {
  const int nodes = parameters.row.topology == Topology::random ? 1000 : 27;
  const Homogenised h = homogenise(periodic_model(parameters, material, 1, nodes), {1e-8, 20000});
  return {h.youngs_modulus, h.poisson_ratio, h.shear_modulus};
}

}  // namespace

MeasuredModuli measure_moduli(const ModelParameters& parameters, const IsotropicMaterial& material, int cells) {
  switch (parameters.row.topology) {
    case Topology::cells:
      return measure_block(parameters, material, cells);
    case Topology::hexagonal:
      return measure_sheet(parameters, material, cells);
    default:
      return measure_bulk(parameters, material);
  }
}

}  // namespace springproof
