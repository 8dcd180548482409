// The mixed form of momentum dispersion on lattices, held to its tangent and to the direct solver.
#include <gtest/gtest.h>

#include "msm/laws/capabilities.h"
#include "msm/multigrid/dispersion_multigrid.h"
#include "msm/parameters/calibrate.h"
#include "msm/statics/equilibrium.h"
#include "support/zoo.h"

namespace springproof::dispersion_multigrid_test {
namespace {

Mesh cubes(int nx, int ny, int nz) { return block_mesh(0.1 * Vec3(nx, ny, nz), {nx, ny, nz}); }

/// An overhang, a hole through it and a row of cells that touch by an edge on one side.
Mesh cut_body() {
  return test::voxels_of(cubes(12, 7, 8), [](int i, int j, int k) {
    if (k < 4 && i >= 8) return false;
    if (j == 3 && i > 4 && i < 7) return false;
    return k != 5 || i % 4 != 1 || j > 4;
  });
}

MassSpringModel emsm(const Mesh& mesh, double nu, std::optional<bool> exact = {}) {
  ModelParameters p = test::model("emsm");
  p.exact_volumes = exact;
  return build_model(p, mesh, {1e4, nu, 1000});
}

/// Bottom held, the top shifted and turned where `moved`, an oblique body force.
BoundaryConditions standing(const Network& network, bool moved) {
  const int n = network.nodes();
  BoundaryConditions bc{std::vector<char>(3 * n, 0), std::vector<int>(3 * n, -1), NodalVectors::Zero(n, 3),
                        NodalVectors::Zero(n, 3)};
  const double floor = network.X.col(2).minCoeff(), roof = network.X.col(2).maxCoeff();
  for (int i = 0; i < n; ++i) {
    bc.external.row(i) = 100 * network.volume[i] * Eigen::RowVector3d(0.3, 0.2, -1);
    const bool top = moved && network.X(i, 2) > roof - 1e-9;
    if (network.X(i, 2) > floor + 1e-9 && !top) continue;
    for (int d = 0; d < 3; ++d) bc.fixed[3 * i + d] = 1;
    if (top) bc.prescribed.row(i) << 0.01 - 0.02 * network.X(i, 1), 0.02 * network.X(i, 0), -0.01;
  }
  return bc;
}

Eigen::VectorXd arbitrary(int nodes, unsigned seed) {
  const NodalVectors v = test::noise(nodes, 1, seed);
  return Eigen::Map<const Eigen::VectorXd>(v.data(), v.size());
}

TEST(NodalVolumes, AreTheInflowsOfTheTangentAndItsTranspose) {
  for (const Mesh& mesh : {cubes(3, 2, 2), cubes(70, 3, 4), cut_body(), cubes(2, 2, 1)})
    for (bool exact : {true, false}) {
      const MassSpringModel model = emsm(mesh, 0.45, exact);
      const Network& network = model.network;
      const double G = affine_shear_modulus(network), l = network.cells.edge;
      const LatticeLevels lattice = lattice_levels(network, std::vector<char>(3 * network.nodes(), 0));
      const long stride = lattice.levels[0].stride();
      const NodalVolumes volumes(model, lattice, G);
      const Tangent K = tangent(model, network.X);
      const Eigen::VectorXd u = arbitrary(network.nodes(), 1), p = arbitrary(network.nodes(), 2).head(network.nodes());
      const Eigen::VectorXd J = K.inflow * u / (10 * G * l * l), pull = K.inflow.transpose() * p / (10 * G * l * l);
      Eigen::VectorXd u_rows, p_rows = Eigen::VectorXd::Zero(stride);
      lattice.to_rows(Nodal::displacements, u, u_rows);
      for (int n = 0; n < network.nodes(); ++n) p_rows[lattice.point_of_node[n]] = p[n];
      for (InstructionSet set : usable_instruction_sets()) {
        const NodalVolumeOperator<double> B(volumes, stride, set);
        Eigen::VectorXd found(stride), y = Eigen::VectorXd::Zero(3 * stride), nodal;
        B.change(u_rows.data(), found.data());
        for (int n = 0; n < network.nodes(); ++n)
          ASSERT_NEAR(found[lattice.point_of_node[n]], J[n], 1e-12) << name_of(set);
        B.add_forces(p_rows.data(), y.data());
        lattice.from_rows(Nodal::forces, y, nodal);
        EXPECT_LE((nodal - pull).cwiseAbs().maxCoeff(), 1e-12) << name_of(set);
      }
    }
}

TEST(NodalVolumes, DiagonalOfTheSchurComplement) {
  const MassSpringModel model = emsm(cut_body(), 0.45);
  const Network& network = model.network;
  const double G = affine_shear_modulus(network), l = network.cells.edge;
  const LatticeLevels lattice = lattice_levels(network, std::vector<char>(3 * network.nodes(), 0));
  const Eigen::VectorXd D = arbitrary(network.nodes(), 3).array() + 2;
  Eigen::VectorXd D_rows;
  lattice.to_rows(Nodal::displacements, D, D_rows);
  const Eigen::VectorXd found = NodalVolumes(model, lattice, G).schur_diagonal(lattice.levels[0], D_rows.cast<float>());
  const NodalForms B = tangent(model, network.X).inflow / (10 * G * l * l);
  for (int n = 0; n < network.nodes(); ++n) {
    double exact = 0;
    for (NodalForms::InnerIterator e(B, n); e; ++e) exact += e.value() * e.value() * D[e.col()];
    EXPECT_NEAR(found[lattice.point_of_node[n]], exact, 1e-6);
  }
}

TEST(DispersionMultigrid, GivesWhatCholeskyGives) {
  for (const Mesh& mesh : {cubes(5, 6, 7), cubes(3, 3, 16), cut_body()})
    for (bool exact : {true, false})
      for (double nu : {0.3, 0.45, 0.4999}) {
        const MassSpringModel model = emsm(mesh, nu, exact);
        const BoundaryConditions bc =
            standing(model.network, nu < 0.46);  // a clamped top near 1/2 would press on a volume that cannot give
        const Equilibrium e = solve_linear(model, bc, {LinearSolver::mixed_multigrid, 1e-12, 100});
        const Equilibrium direct = solve_linear(model, bc, {LinearSolver::cholesky, 1e-12, 100});
        ASSERT_TRUE(e.ok && direct.ok) << e.message << direct.message;
        EXPECT_LE((e.displacement - direct.displacement).norm(), 1e-8 * direct.displacement.norm()) << nu << exact;
        EXPECT_LE((e.support - direct.support).norm(), 1e-8 * direct.support.norm()) << nu << exact;
      }
}

TEST(DispersionMultigrid, IterationsStayFew) {
  struct Bound {
    double nu;
    int iterations;
  };
  for (const Bound& bound : {Bound{0.45, 16}, Bound{0.499, 16}, Bound{0.4999, 25}})
    for (const Mesh& mesh : {cubes(10, 10, 10), cubes(20, 20, 20), cubes(8, 8, 48), cut_body()}) {
      const MassSpringModel model = emsm(mesh, bound.nu);
      const Equilibrium e = solve_linear(model, standing(model.network, false), {.tolerance = 1e-8});
      ASSERT_TRUE(e.ok) << e.message;
      EXPECT_EQ(e.solver, "GMRES + mixed multigrid");
      EXPECT_LE(e.iterations, bound.iterations) << mesh.hexahedra.size() << " cells, nu = " << bound.nu;
      EXPECT_LE(e.residual, 1e-7);
    }
}

TEST(DispersionMultigrid, IsForTheEnergyFormAboveAQuarter) {
  const MassSpringModel model = emsm(cubes(4, 4, 4), 0.2);
  const std::vector<char> free(3 * model.network.nodes(), 0);
  EXPECT_FALSE(can(model, Capability::nodal_pressures));
  EXPECT_THROW(DispersionMultigrid(model, free, 1), std::invalid_argument);
  ModelParameters published = test::model("emsm");
  published.dispersion = Dispersion::published;
  EXPECT_FALSE(can(build_model(published, cubes(4, 4, 4), {1e4, 0.45, 1000}), Capability::nodal_pressures));
}

}  // namespace
}  // namespace springproof::dispersion_multigrid_test
