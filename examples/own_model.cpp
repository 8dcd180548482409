// A network of one's own, an octet truss (the nearest neighbours of a face-centred cubic lattice), hung up by its top:
// equilibrium under its weight, and the safe step for a motion.
#include <cstdio>

#include "msm/dynamics/time_step.h"
#include "msm/statics/equilibrium.h"

using namespace springproof;

int main() {
  const int nx = 3, ny = 3, nz = 9;               // cubes of the lattice
  const double a = 0.1, k = 2e5, density = 1000;  // edge of a cube [m], stiffness of a spring [N/m], [kg/m3]

  // Nodes: points of half integers whose sum is an integer.
  std::vector<Vec3> nodes;
  for (int x = 0; x <= 2 * nx; ++x)
    for (int y = 0; y <= 2 * ny; ++y)
      for (int z = 0; z <= 2 * nz; ++z)
        if ((x + y + z) % 2 == 0) nodes.push_back(0.5 * a * Vec3(x, y, z));

  MassSpringModel model;
  Network& network = model.network;
  network.X.resize(static_cast<Eigen::Index>(nodes.size()), 3);
  for (std::size_t n = 0; n < nodes.size(); ++n) network.X.row(static_cast<Eigen::Index>(n)) = nodes[n].transpose();
  network.volume = Eigen::VectorXd::Constant(network.X.rows(), nx * ny * nz * a * a * a / double(nodes.size()));
  const double length = a / std::sqrt(2.0);
  for (int i = 0; i < network.nodes(); ++i)
    for (int j = i + 1; j < network.nodes(); ++j)
      if ((nodes[i] - nodes[j]).norm() < 1.01 * length) network.springs.push_back({i, j, k, length});
  model.laws.push_back(Springs{});

  // Unknown 3 * node + axis: held at the top, pulled down by its weight elsewhere.
  BoundaryConditions conditions;
  conditions.fixed.assign(3 * nodes.size(), false);
  conditions.owner.assign(3 * nodes.size(), -1);
  conditions.prescribed = conditions.external = NodalVectors::Zero(network.X.rows(), 3);
  conditions.external.col(2) = -9.81 * masses(network, density);
  for (std::size_t n = 0; n < nodes.size(); ++n)
    for (int axis = 0; axis < 3; ++axis) {
      if (nodes[n].z() < (nz - 0.25) * a) continue;
      conditions.fixed[3 * n + axis] = true;
      conditions.owner[3 * n + axis] = 0;
    }

  const Equilibrium e = solve_linear(model, conditions);
  std::printf("%d nodes, %zu springs: sags by %.3f mm, the top carries %.2f N of %.2f N; safe step %.3g s (%s)\n",
              network.nodes(), network.springs.size(), -1000 * e.displacement.col(2).minCoeff(), e.support.col(2).sum(),
              9.81 * density * network.volume.sum(), safe_time_step(model, density), e.solver.c_str());
  return e.ok ? 0 : 1;
}
