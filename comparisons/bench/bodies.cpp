#include "comparisons/bench/bodies.h"

#include <cmath>
#include <numbers>

#include "comparisons/advise/speed.h"
#include "meshes/mesher/mesher.h"
#include "meshes/voxels/cut_cells.h"
#include "meshes/voxels/voxelise.h"
#include "msm/models.h"
#include "msm/parameters/calibrate.h"
#include "msm/topology/random/random_network.h"

namespace springproof::bench {

MassSpringModel lattice(const std::string& name, const std::array<int, 3>& cells, double poisson_ratio,
                        const decltype(ModelChoice::options)& options) {
  const Mesh mesh = block_mesh(edge * Vec3(cells[0], cells[1], cells[2]), cells);
  return build_model(resolve({name, options, name, {}}), mesh, {youngs_modulus, poisson_ratio, density});
}

MassSpringModel random_springs(int nodes) {
  const int n = int(std::lround(std::cbrt(nodes)));
  const Mesh mesh = block_mesh(Vec3::Constant(n * edge), {n, n, n});
  MassSpringModel model;
  model.network = random_network(region_of(mesh), {.spacing = edge, .max_length = {}});
  correct_surface(model.network);
  calibrate(0.4 * youngs_modulus, model.network);
  model.laws = {Springs{}};
  return model;
}

MassSpringModel cut_ball(double cells, double poisson_ratio) {
  const double diameter = edge * std::cbrt(6 * cells / std::numbers::pi);
  Body sphere;
  sphere.geo = "sphere.geo";
  const MeshRequest request{.file = find_geo(sphere, {}), .size = Vec3::Constant(diameter), .edge = diameter / 24};
  const Mesh ball = mesh_body(request).mesh;
  return build_cut(resolve({"hybmss_avg", {}, "hybmss_avg", {}}), cut_body(voxel_grid(ball, edge), ball), {}, Mesh{},
                   {youngs_modulus, poisson_ratio, density})
      .model;
}

NodalVectors moved(const Network& network) {
  NodalVectors x = network.X;
  for (Eigen::Index n = 0; n < x.rows(); ++n)
    for (int c = 0; c < 3; ++c)
      x(n, c) += 0.01 * edge * std::sin(3 * network.X(n, c) / edge + 2 * network.X(n, (c + 1) % 3) / edge + c);
  return x;
}

BoundaryConditions clamped_bottom(const Network& network, double depth) {
  return springproof::clamped_bottom(network, density, depth);
}

}  // namespace springproof::bench
