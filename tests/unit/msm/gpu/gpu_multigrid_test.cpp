// A GPU's multigrid, here run by the processor or by the GPU that the library was built for, beside the processor's
// own.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "msm/gpu/gpu_multigrid.h"
#include "msm/multigrid/cell_stiffness.h"
#include "msm/multigrid/multigrid.h"
#include "msm/statics/equilibrium.h"
#include "support/zoo.h"

namespace springproof::gpu_multigrid_test {
namespace {

constexpr double density = 1000, edge = 0.25;

Mesh cubes(const std::array<int, 3>& cells) { return block_mesh(edge * Vec3(cells[0], cells[1], cells[2]), cells); }

struct Body {
  const char* name;
  Mesh mesh;
  bool thin = false;  ///< parts that coarser lattices merge, which the processor's cycle corrects and a GPU's does not
};

std::vector<Body> bodies() {
  std::vector<Body> all = {{"cube", cubes({12, 12, 12})}, {"odd", cubes({7, 11, 5})}, {"bar", cubes({40, 3, 4}), true}};
  all.push_back({"hollow ball",
                 test::voxels_of(cubes({15, 15, 15}),
                                 [](int i, int j, int k) {
                                   const double r = (i - 7.) * (i - 7) + (j - 7.) * (j - 7) + (k - 7.) * (k - 7);
                                   return r < 42 && r > 6;
                                 }),
                 true});
  return all;
}

/// Nodes of low x held, of high x held along y.
std::vector<char> fixed_in(const Network& network) {
  std::vector<char> fixed(3 * network.nodes(), 0);
  const double low = network.X.col(0).minCoeff(), high = network.X.col(0).maxCoeff();
  for (int n = 0; n < network.nodes(); ++n) {
    if (network.X(n, 0) < low + 0.1 * edge) fixed[3 * n] = fixed[3 * n + 1] = fixed[3 * n + 2] = 1;
    if (network.X(n, 0) > high - 0.1 * edge) fixed[3 * n + 1] = 1;
  }
  return fixed;
}

double difference(const Eigen::VectorXd& a, const Eigen::VectorXd& b) { return (a - b).norm() / b.norm(); }

TEST(GpuMultigrid, SolvesAsThatOfTheProcessor) {
  for (const Body& body : bodies())
    for (const char* name : {"hybmss", "hybmss_bt", "hybmss_avg"})
      for (const double nu : {0.0, 0.3}) {
        const MassSpringModel model = build_model(test::model(name), body.mesh, {1e5, nu, density});
        const std::vector<char> fixed = fixed_in(model.network);
        const CellMatrix cell = cell_stiffness(model).total;
        Multigrid processor(lattice_levels(model.network, fixed, 300), cell);
        GpuMultigrid gpu(lattice_levels(model.network, fixed, 300), cell);
        const NodalVectors load = test::noise(model.network.nodes(), 10, 3);
        const Eigen::VectorXd b = Eigen::Map<const Eigen::VectorXd>(load.data(), load.size());
        Eigen::VectorXd u, v, Ku, Kv;
        const KrylovResult ours = processor.solve(b, 1e-10, 200, u), theirs = gpu.solve(b, 1e-10, 200, v);
        const std::string what = fmt::format("{}, {}, nu {}", body.name, name, nu);
        EXPECT_TRUE(theirs.converged) << what;
        EXPECT_LE(difference(v, u), 1e-8) << what;
        if (body.thin)
          EXPECT_LE(theirs.iterations, 2 * ours.iterations) << what;
        else
          EXPECT_NEAR(theirs.iterations, ours.iterations, 1) << what;
        processor.multiply(b, Ku);
        gpu.multiply(b, Kv);
        EXPECT_LE(difference(Kv, Ku), 1e-13) << what;
      }
}

TEST(GpuMultigrid, GivesTheEquilibriumAndItsSupportForces) {
  const MassSpringModel model = build_model(test::model("hybmss_bt"), cubes({9, 8, 7}), {1e5, 0.2, density});
  BoundaryConditions bc;
  bc.fixed = fixed_in(model.network);
  bc.prescribed = bc.external = NodalVectors::Zero(model.network.nodes(), 3);
  for (int n = 0; n < model.network.nodes(); ++n)
    if (bc.fixed[3 * n + 1] && !bc.fixed[3 * n]) bc.prescribed(n, 1) = 0.1 * edge;
  const Equilibrium ours = solve_linear(model, bc, {LinearSolver::multigrid}),
                    theirs = solve_linear(model, bc, {LinearSolver::gpu_multigrid});
  ASSERT_TRUE(theirs.ok) << theirs.message;
  EXPECT_LE((theirs.displacement - ours.displacement).norm(), 1e-8 * ours.displacement.norm());
  EXPECT_LE((theirs.support - ours.support).norm(), 1e-8 * ours.support.norm());
}

TEST(GpuMultigrid, IsNotForBodiesThatNothingHolds) {
  const MassSpringModel model = build_model(test::model("hybmss"), cubes({8, 8, 8}), {1e5, 0.3, density});
  const std::vector<char> free(3 * model.network.nodes(), 0);
  EXPECT_THROW(GpuMultigrid(lattice_levels(model.network, free, 300), cell_stiffness(model).total), std::runtime_error);
}

}  // namespace
}  // namespace springproof::gpu_multigrid_test
