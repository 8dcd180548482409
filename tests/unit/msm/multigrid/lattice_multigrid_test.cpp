// The matrix-free lattice operator and its multigrid, held to the plain loops over springs and cells.
#include <gtest/gtest.h>

#include <random>

#include "msm/multigrid/lattice_operator.h"
#include "msm/multigrid/mixed_multigrid.h"
#include "msm/statics/equilibrium.h"
#include "support/bodies.h"
#include "support/zoo.h"

namespace springproof::lattice_multigrid_test {
namespace {

Mesh cubes(int nx, int ny, int nz) { return block_mesh(0.1 * Vec3(nx, ny, nz), {nx, ny, nz}); }

/// Holes, an overhang, a bridge of one cell and a row longer than a kernel takes at once.
Mesh awkward_body() {
  return test::voxels_of(cubes(70, 6, 5), [](int i, int j, int k) {
    if (i > 40 && i < 44) return j == 2 && k == 2;
    if (k == 2 && j > 1 && j < 5 && i % 9 > 4) return false;
    return i < 60 || k < 2;
  });
}

struct Body {
  std::string name;
  Mesh mesh;
};

std::vector<Body> bodies() {
  return {{"one cell", cubes(1, 1, 1)},
          {"2 x 3 x 5", cubes(2, 3, 5)},
          {"16 x 8 x 4", cubes(16, 8, 4)},
          {"3 x 67 x 2", cubes(3, 67, 2)},
          {"awkward", awkward_body()}};
}

Eigen::VectorXd arbitrary(Eigen::Index n) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> uniform(-1, 1);
  Eigen::VectorXd v(n);
  for (double& value : v) value = uniform(random);
  return v;
}

template <class Real>
Eigen::VectorXd multiply(const LatticeLevels& lattice, const CellMatrix& cell, InstructionSet set,
                         const Eigen::VectorXd& u) {
  const LatticeLevel& level = lattice.levels[0];
  LatticeOperator<Real> K(level, reorder(cell, lattice.axes), 0, set);
  Eigen::VectorXd rows, y_rows = Eigen::VectorXd::Zero(3 * level.stride()), y;
  lattice.to_rows(Nodal::displacements, u, rows);
  const Eigen::Matrix<Real, Eigen::Dynamic, 1> x = rows.cast<Real>();
  K.pass(x.data(), nullptr, nullptr, [&](int a, long begin, long n, const Real* values) {
    for (long i = 0; i < n; ++i) y_rows[a * level.stride() + begin + i] = values[i];
  });
  lattice.from_rows(Nodal::forces, y_rows, y);
  return y;
}

TEST(LatticeOperator, IsTheTangentOfThePlainLoops) {
  for (const Body& body : bodies())
    for (const char* name : {"hybmss", "hybmss_bt", "hybmss_fd", "msm_18"}) {
      const MassSpringModel model = build_model(test::model(name), body.mesh, {1e4, 0.4, 1000});
      const std::vector<char> free(3 * model.network.nodes(), 0);
      const LatticeLevels lattice = lattice_levels(model.network, free);
      const CellMatrix cell = cell_stiffness(model).total;
      const Eigen::VectorXd u = arbitrary(3 * model.network.nodes());
      Eigen::VectorXd exact;
      tangent(model, model.network.X).multiply(u, exact);
      const double largest = exact.cwiseAbs().maxCoeff();
      for (InstructionSet set : usable_instruction_sets()) {
        EXPECT_LE((multiply<double>(lattice, cell, set, u) - exact).cwiseAbs().maxCoeff(), 1e-12 * largest)
            << body.name << ", " << name << ", " << name_of(set);
        EXPECT_LE((multiply<float>(lattice, cell, set, u) - exact).cwiseAbs().maxCoeff(), 1e-5 * largest)
            << body.name << ", " << name << ", " << name_of(set);
      }
    }
}

TEST(LatticeOperator, DivergenceAndGradientAreThoseOfTheCells) {
  const Mesh mesh = awkward_body();
  const MassSpringModel model = build_model(test::model("hybmss"), mesh, {1e4, 0.4, 1000});
  const LatticeLevels lattice = lattice_levels(model.network, std::vector<char>(3 * model.network.nodes(), 0));
  const LatticeLevel& level = lattice.levels[0];
  const CellStiffness cell = cell_stiffness(model);
  const double gradient = cell.volume_gradient.cwiseAbs().maxCoeff();
  const Eigen::VectorXd u = arbitrary(3 * model.network.nodes()), p = arbitrary(level.cells());
  Eigen::VectorXd u_rows, exact = Eigen::VectorXd::Zero(level.cells()), pull = Eigen::VectorXd::Zero(u.size());
  lattice.to_rows(Nodal::displacements, u, u_rows);
  for (long c = 0; c < level.cells(); ++c) {
    const MeanEdgeVolume v = mean_edge_volume(mesh.hexahedra[c], mesh.nodes);
    for (int n = 0; n < 8; ++n) {
      exact[lattice.cell_of_cell[c]] += v.gradient.row(n).dot(u.segment<3>(3 * mesh.hexahedra[c][n]));
      pull.segment<3>(3 * mesh.hexahedra[c][n]) += p[lattice.cell_of_cell[c]] * v.gradient.row(n).transpose();
    }
  }
  Eigen::VectorXd padded = Eigen::VectorXd::Zero(level.cells() + array_slack);
  padded.head(level.cells()) = p;
  for (InstructionSet set : usable_instruction_sets()) {
    LatticeOperator<double> B(level, CellMatrix::Zero(), gradient, set);
    Eigen::VectorXd divergence(level.cells() + array_slack), y_rows = Eigen::VectorXd::Zero(3 * level.stride()), y;
    B.divergence(u_rows.data(), divergence.data());
    EXPECT_LE((divergence.head(level.cells()) - exact).cwiseAbs().maxCoeff(), 1e-13 * exact.cwiseAbs().maxCoeff())
        << name_of(set);
    B.gradient_pass(padded.data(), [&](int k, long begin, long n) {
      for (int a = 0; a < 3; ++a)
        for (long i = 0; i < n; ++i) y_rows[a * level.stride() + begin + i] = B.plane(k, a)[i];
    });
    lattice.from_rows(Nodal::forces, y_rows, y);
    EXPECT_LE((y - pull).cwiseAbs().maxCoeff(), 1e-13 * pull.cwiseAbs().maxCoeff()) << name_of(set);
    // Both at once, in the pass of the stiffness (zero here).
    B.pass(u_rows.data(), padded.data(), divergence.data(), [&](int a, long begin, long n, const double* values) {
      for (long i = 0; i < n; ++i) y_rows[a * level.stride() + begin + i] = values[i];
    });
    lattice.from_rows(Nodal::forces, y_rows, y);
    EXPECT_LE((y - pull).cwiseAbs().maxCoeff(), 1e-13 * pull.cwiseAbs().maxCoeff()) << name_of(set);
    EXPECT_LE((divergence.head(level.cells()) - exact).cwiseAbs().maxCoeff(), 1e-13 * exact.cwiseAbs().maxCoeff())
        << name_of(set);
  }
}

TEST(LatticeOperator, RefusesACellWithoutMirrorPlanes) {
  const MassSpringModel model = build_model(test::model("hybmss"), cubes(2, 2, 2), {1e4, 0.4, 1000});
  CellMatrix cell = cell_stiffness(model).total;
  cell(0, 20) += 0.01 * cell(0, 0);
  cell(20, 0) += 0.01 * cell(0, 0);
  EXPECT_THROW(cell_blocks<double>(cell, 1), std::invalid_argument);
}

TEST(LatticeLevels, InterpolationIsExactForLinearFieldsAndTransposed) {
  const MassSpringModel model = build_model(test::model("hybmss"), awkward_body(), {1e4, 0.4, 1000});
  const LatticeLevels lattice = lattice_levels(model.network, std::vector<char>(3 * model.network.nodes(), 0));
  ASSERT_GT(lattice.levels.size(), 1u);
  const LatticeLevel &fine = lattice.levels[0], &coarse = lattice.levels[1];
  // The position of coarse points, by the corners of their cells' children.
  Eigen::VectorXd X_rows;
  lattice.to_rows(Nodal::displacements,
                  Eigen::Map<const Eigen::VectorXd>(model.network.X.data(), model.network.X.size()), X_rows);
  Eigen::VectorXf X_coarse = Eigen::VectorXf::Constant(3 * coarse.stride(), NAN);
  std::vector<Vec3> corner(coarse.cells(), Vec3::Constant(1e9));
  const double h = model.network.cells.edge;
  for (const CellRow& row : fine.rows)
    for (int i = 0; i < row.length; ++i) {
      Vec3& low = corner[coarse.parent[row.cell + i]];
      for (int a = 0; a < 3; ++a) {
        const double x = X_rows[a * fine.stride() + LatticeLevel::corner(row, i, 0)];
        low[a] = std::min(low[a], 2 * h * std::floor(x / (2 * h) + 1e-6));
      }
    }
  for (const CellRow& row : coarse.rows)
    for (int i = 0; i < row.length; ++i)
      for (int n = 0; n < 8; ++n)
        for (int a = 0; a < 3; ++a)
          X_coarse[a * coarse.stride() + LatticeLevel::corner(row, i, n)] =
              static_cast<float>(corner[row.cell + i][a] + 2 * h * hexahedron_corners[n][a]);
  for (InstructionSet set : usable_instruction_sets()) {
    const CellKernels<float>& kernels = kernels_of<float>(set).cells;
    Eigen::VectorXf field = Eigen::VectorXf::Zero(3 * coarse.stride()),
                    fine_field = Eigen::VectorXf::Zero(3 * fine.stride());
    for (int a = 0; a < 3; ++a)
      field.segment(a * coarse.stride(), coarse.points()) = X_coarse.segment(a * coarse.stride(), coarse.points());
    prolongate_field(coarse, kernels, field.data(), fine.stride(), fine_field.data());
    for (int a = 0; a < 3; ++a)
      for (long n = 0; n < fine.points(); ++n)
        ASSERT_NEAR(fine_field[a * fine.stride() + n], X_rows[a * fine.stride() + n], 1e-5)
            << a << ", " << n << ", " << name_of(set);
    Eigen::VectorXf r = Eigen::VectorXf::Zero(3 * fine.stride()),
                    restricted = Eigen::VectorXf::Zero(3 * coarse.stride());
    for (int a = 0; a < 3; ++a) r.segment(a * fine.stride(), fine.points()) = arbitrary(fine.points()).cast<float>();
    restrict_field(coarse, kernels, fine.stride(), r.data(), restricted.data());
    EXPECT_NEAR(restricted.cast<double>().dot(field.cast<double>()), r.cast<double>().dot(fine_field.cast<double>()),
                1e-5 * r.norm() * fine_field.norm());
  }
}

BoundaryConditions standing(const Network& network) {
  const int n = network.nodes();
  BoundaryConditions bc{std::vector<char>(3 * n, 0), std::vector<int>(3 * n, -1), NodalVectors::Zero(n, 3),
                        NodalVectors::Zero(n, 3)};
  const double floor = network.X.col(2).minCoeff();
  for (int i = 0; i < n; ++i) {
    bc.external.row(i) = 1000 * network.volume[i] * Eigen::RowVector3d(0.3, 0.2, -1);
    if (network.X(i, 2) > floor + 1e-9) continue;
    for (int d = 0; d < 3; ++d) bc.fixed[3 * i + d] = 1;
  }
  return bc;
}

Equilibrium solve(const MassSpringModel& model, double tolerance, LinearSolver solver = LinearSolver::automatic) {
  LinearOptions options;
  options.tolerance = tolerance;
  options.solver = solver;
  return solve_linear(model, standing(model.network), options);
}

TEST(LatticeMultigrid, GivesWhatCholeskyGives) {
  const Mesh sphere = test::voxels_of(
      cubes(12, 12, 12), [](int i, int j, int k) { return (Vec3(i, j, k) - Vec3::Constant(5.5)).norm() < 6; });
  for (const Mesh& mesh : {cubes(11, 7, 16), sphere, awkward_body()})
    for (double nu : {-0.5, 0.25, 0.45, 0.4999}) {
      const MassSpringModel model = build_model(test::model("hybmss"), mesh, {1e4, nu, 1000});
      const Equilibrium e = solve(model, 1e-10, nu > 0.4 ? LinearSolver::mixed_multigrid : LinearSolver::multigrid);
      const Equilibrium direct = solve(model, 1e-10, LinearSolver::cholesky);
      ASSERT_TRUE(e.ok && direct.ok) << e.message << direct.message;
      EXPECT_LE((e.displacement - direct.displacement).norm(), 1e-7 * direct.displacement.norm()) << nu;
      EXPECT_LE((e.support - direct.support).norm(), 1e-7 * direct.support.norm()) << nu;
    }
}

TEST(LatticeMultigrid, IterationsOnBlocksStayFew) {
  struct Bound {
    double nu;
    int iterations;
  };
  for (const Bound& bound :
       {Bound{0, 13}, Bound{0.25, 13}, Bound{0.4, 13}, Bound{0.45, 16}, Bound{0.499, 16}, Bound{0.4999, 25}})
    for (const Mesh& mesh : {cubes(12, 12, 12), cubes(33, 33, 33), cubes(8, 8, 48), cubes(30, 17, 9)}) {
      const Equilibrium e = solve(build_model(test::model("hybmss"), mesh, {1e4, bound.nu, 1000}), 1e-8);
      ASSERT_TRUE(e.ok) << e.message;
      if (e.solver == "Cholesky") continue;
      EXPECT_LE(e.iterations, bound.iterations) << mesh.hexahedra.size() << " cells, nu = " << bound.nu;
    }
}

/// A ball with two sheets of a cell or two standing on it: coarser cells bend less than these.
Mesh ball_with_ears(int n, int thickness) {
  return test::voxels_of(cubes(n, n, n), [=](int i, int j, int k) {
    const Vec3 x = Vec3(i + 0.5, j + 0.5, k + 0.5) / n;
    if ((x - Vec3(0.5, 0.5, 0.25)).norm() < 0.24) return true;
    const bool ear = (j >= 4 * n / 10 && j < 4 * n / 10 + thickness) || (j >= 6 * n / 10 && j < 6 * n / 10 + thickness);
    return ear && std::pow((x[0] - 0.5) / 0.1, 2) + std::pow((x[2] - 0.7) / 0.28, 2) < 1;
  });
}

TEST(LatticeMultigrid, IterationsOnThinPartsStayFew) {
  for (int n : {24, 48, 72})
    for (int thickness : {1, 2})
      for (double nu : {0.25, 0.499}) {
        const Equilibrium e =
            solve(build_model(test::model("hybmss"), ball_with_ears(n, thickness), {1e4, nu, 1000}), 1e-8);
        ASSERT_TRUE(e.ok) << e.message;
        EXPECT_LE(e.iterations, 40) << n << ", " << thickness << ", " << nu;
      }
}

TEST(LatticeMultigrid, PlatesAndRodsOfFewCells) {
  for (const Mesh& mesh : {cubes(40, 1, 40), cubes(30, 30, 3), cubes(120, 2, 3)})
    for (double nu : {0.25, 0.499}) {
      const MassSpringModel model = build_model(test::model("hybmss"), mesh, {1e4, nu, 1000});
      const Equilibrium e = solve(model, 1e-8, nu > 0.4 ? LinearSolver::mixed_multigrid : LinearSolver::multigrid);
      ASSERT_TRUE(e.ok) << e.message;
      EXPECT_LE(e.iterations, 40) << mesh.hexahedra.size() << ", " << nu;
    }
}

}  // namespace
}  // namespace springproof::lattice_multigrid_test
