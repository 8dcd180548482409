// A silicone bar, clamped at one end and bent by a force on the other: springs without the comparator.
#include <cstdio>

#include "msm/models.h"
#include "msm/statics/equilibrium.h"

using namespace springproof;

int main() {
  const IsotropicMaterial silicone{1e6, 0.49, 1100};                      // E [Pa], nu, rho [kg/m^3]
  const Mesh mesh = block_mesh({0.06, 0.01, 0.01}, {24, 4, 4});           // size [m], cells
  const ModelParameters parameters = resolve({"hybmss_bt", {}, "", {}});  // a row of the table of models
  const MassSpringModel model = build_model(parameters, mesh, silicone);

  const std::vector<Load> loads = {PrescribedDisplacement{"x_min", {0.0, 0.0, 0.0}},
                                   PatchForce{"x_max", {0, 0, -0.005}}};  // [N]
  const BoundaryConditions conditions = transfer(loads, mesh, silicone.density, Kinematics::linear);
  require_supported(conditions, mesh.nodes);
  const Equilibrium state = solve_linear(model, conditions);
  if (!state.ok) return std::fprintf(stderr, "%s\n", state.message.c_str()), 1;

  const Field field = to_field(state, std::make_shared<Mesh>(mesh), nodes_of_mesh(mesh), model.network, loads,
                               conditions, Kinematics::linear);
  double tip = 0;  // mean over the nodes of the end
  const std::vector<int> end = nodes_of(patch(mesh, "x_max"));
  for (int node : end) tip += field.displacement(node, 2) / static_cast<double>(end.size());
  std::printf("tip %.4f mm, support %.4f N, %d nodes, %zu springs, %s\n", 1e3 * tip, field.reactions[0].force[2],
              model.network.nodes(), model.network.springs.size(), state.solver.c_str());
}
