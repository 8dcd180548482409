// Averaged springs in boxes that are no cubes: exact where cubes are, and solved by the same means.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "meshes/volume.h"
#include "msm/dynamics/dynamics.h"
#include "msm/dynamics/natural_modes.h"
#include "msm/dynamics/plain_motion.h"
#include "msm/dynamics/time_step.h"
#include "msm/embedding/boundary.h"
#include "msm/models.h"
#include "msm/statics/equilibrium.h"
#include "support/tolerances.h"
#include "support/zoo.h"

namespace springproof::box_cells_test {
namespace {

constexpr std::array<int, 3> cells = {3, 4, 2};
constexpr double inside = 1e-11;  // round-off at nu = 0.499, where bulk forces cancel

std::vector<Vec3> proportions() {
  return {{1, 1, 1}, {1, 0.5, 0.25}, {0.25, 0.25, 1}, {2, 1, 1}, {4, 1, 2}, {1, 4, 4}};
}

Mesh block(const Vec3& edges) { return block_mesh(edges.cwiseProduct(Vec3(cells[0], cells[1], cells[2])), cells); }

EmbeddedModel build(const Mesh& mesh, double nu) {
  return build_embedded(test::model("hybmss_avg"), mesh, {1e4, nu, 1000});
}

template <class Field>
NodalVectors field_at(const NodalVectors& X, const Field& field) {
  NodalVectors u(X.rows(), 3);
  for (Eigen::Index n = 0; n < X.rows(); ++n) u.row(n) = field(Vec3(X.row(n).transpose())).transpose();
  return u;
}

/// Energy of a displacement linearised at rest [J], and the largest force on a node inside over that on any.
struct Response {
  double energy = 0, inside = 0;
};
Response response(const MassSpringModel& model, const NodalVectors& u) {
  const Network& network = model.network;
  Eigen::VectorXd Ku;
  tangent(model, network.X).multiply(Eigen::Map<const Eigen::VectorXd>(u.data(), u.size()), Ku);
  Response r{0.5 * Ku.dot(Eigen::Map<const Eigen::VectorXd>(u.data(), u.size()))};
  const NodalVectors f = Eigen::Map<const NodalVectors>(Ku.data(), u.rows(), 3);
  const double eighth = network.cells.volume() / 8;
  for (int n = 0; n < network.nodes(); ++n)
    if (network.volume[n] > 7.5 * eighth)
      r.inside = std::max(r.inside, f.row(n).norm() / f.rowwise().norm().maxCoeff());
  return r;
}

TEST(BoxCells, AreBuiltOfTheModelsThatHaveThem) {
  const Mesh mesh = block({1, 0.5, 0.25});
  for (const ModelRow& row : model_table()) {
    if (row.topology != Topology::cells && row.topology != Topology::centres) continue;
    try {
      const Network network = build_model(test::model(row.name), mesh, {1e4, 0.25, 1000}).network;
      EXPECT_TRUE(can(row, Capability::cells_of_any_shape)) << row.name;
      EXPECT_TRUE(network.cells.kind() == CellKind::boxes);
      EXPECT_NEAR(network.cells.proportions.prod(), 1, 1e-14);
      EXPECT_LT((network.cells.edge * network.cells.proportions - Vec3(1, 0.5, 0.25)).norm(), 1e-14);
    } catch (const InputError& e) {
      EXPECT_FALSE(can(row, Capability::cells_of_any_shape)) << row.name;
      EXPECT_NE(std::string(e.what()).find("hybmss_avg"), std::string::npos) << e.what();
    }
  }
  EXPECT_TRUE((build(block({0.5, 0.5, 0.5}), 0.25).model.network.cells.proportions.array() == 1).all());
}

TEST(BoxCells, UniformStrainIsExact) {
  Eigen::Matrix3d H;
  H << 3, 1, -2, 0.5, -1, 4, 2, -3, 1;
  H *= 1e-3;
  const Eigen::Matrix3d strain = (H + H.transpose()) / 2;
  for (const Vec3& edges : proportions())
    for (double nu : {-0.5, 0.0, 0.25, 0.45, 0.499}) {
      const Mesh mesh = block(edges);
      const IsotropicMaterial material{1e4, nu, 1000};
      const Response r =
          response(build(mesh, nu).model, field_at(mesh.nodes, [&](const Vec3& x) -> Vec3 { return H * x; }));
      const double density = shear_modulus(material) * strain.squaredNorm() +
                             lame_lambda(material) / 2 * strain.trace() * strain.trace(),
                   exact = density * volume(mesh, mesh.nodes);
      EXPECT_NEAR(r.energy, exact, 1e-11 * exact) << edges.transpose() << ", nu = " << nu;
      EXPECT_LE(r.inside, inside);
    }
}

// Pure bending of a bar, with the contraction of its free sides, about each axis and in each plane.
TEST(BoxCells, BendAsABarDoes) {
  for (const Vec3& edges : proportions())
    for (double nu : {-0.5, 0.0, 0.25, 0.45, 0.499})
      for (int x = 0; x < 3; ++x)
        for (int y = 0; y < 3; ++y) {
          if (x == y) continue;
          const int z = 3 - x - y;
          const Mesh mesh = block(edges);
          const Vec3 size = mesh.nodes.colwise().maxCoeff().transpose();
          const double curvature = 1e-3;
          const Response r = response(build(mesh, nu).model, field_at(mesh.nodes, [&](const Vec3& at) -> Vec3 {
                                        const Vec3 p = at - size / 2;
                                        Vec3 u;
                                        u[x] = curvature * p[x] * p[y];
                                        u[y] = -curvature / 2 * (p[x] * p[x] + nu * (p[y] * p[y] - p[z] * p[z]));
                                        u[z] = -nu * curvature * p[y] * p[z];
                                        return u;
                                      }));
          const double I = size[z] * std::pow(size[y], 3) / 12, exact = 1e4 * I * curvature * curvature / 2 * size[x];
          EXPECT_NEAR(r.energy, exact, 1e-10 * exact) << edges.transpose() << ", nu = " << nu << ", axes " << x << y;
          EXPECT_LE(r.inside, inside);
        }
}

// Of one cell without warping: G I_p t^2 / 2 per length.
TEST(BoxCells, TwistAsTheTrilinearFieldDoes) {
  for (const Vec3& edges : proportions())
    for (int x = 0; x < 3; ++x) {
      const int y = (x + 1) % 3, z = (x + 2) % 3;
      const Mesh mesh = block_mesh(edges, {1, 1, 1});
      const double nu = 0.3, t = 1e-3;
      const Response r = response(build(mesh, nu).model, field_at(mesh.nodes, [&](const Vec3& at) -> Vec3 {
                                    const Vec3 p = at - edges / 2;
                                    Vec3 u = Vec3::Zero();
                                    u[y] = -t * p[x] * p[z];
                                    u[z] = t * p[x] * p[y];
                                    return u;
                                  }));
      const double I = edges[y] * edges[z] * (edges[y] * edges[y] + edges[z] * edges[z]) / 12,
                   exact = 1e4 / (2 * (1 + nu)) * I * t * t / 2 * edges[x];
      EXPECT_NEAR(r.energy, exact, 1e-12 * exact) << edges.transpose() << ", axis " << x;
    }
}

/// A bar clamped at x = 0 and pushed sideways at its end, of boxes of these edges.
struct Cantilever {
  Mesh mesh;
  EmbeddedModel built;
  BoundaryConditions conditions;

  Cantilever(const Vec3& size, const std::array<int, 3>& count, double nu)
      : mesh(block_mesh(size, count)), built(build(mesh, nu)) {
    conditions = transfer({PrescribedDisplacement{"x_min", {0.0, 0.0, 0.0}}, PatchForce{"x_max", {0, 1, 3}}}, mesh,
                          1000, Kinematics::linear);
  }
  Equilibrium solve(LinearSolver solver) const {
    return solve_linear(built.model, conditions, {.solver = solver, .tolerance = 1e-9});
  }
};

TEST(BoxCells, MultigridSolvesWhatCholeskyDoes) {
  for (const LinearSolver solver : {LinearSolver::multigrid, LinearSolver::mixed_multigrid})
    for (const Vec3& size : {Vec3(4, 1, 1), Vec3(4, 0.5, 1), Vec3(8, 0.5, 1), Vec3(2, 1, 2)}) {
      const Cantilever bar(size, {16, 4, 8}, solver == LinearSolver::mixed_multigrid ? 0.499 : 0.3);
      const Equilibrium exact = bar.solve(LinearSolver::cholesky), other = bar.solve(solver);
      ASSERT_TRUE(exact.ok && other.ok) << exact.message << other.message;
      EXPECT_LE((other.displacement - exact.displacement).norm(), 1e-6 * exact.displacement.norm());
      EXPECT_LE((other.support - exact.support).norm(), 1e-6 * exact.support.norm());
      const Vec3& p = bar.built.model.network.cells.proportions;
      EXPECT_LE(other.iterations, p.maxCoeff() / p.minCoeff() < 3 ? 30 : 90) << size.transpose() << other.solver;
    }
}

// Explicit steps by the kernels of lists of cells.
TEST(BoxCells, MoveAsThePlainLoopsDo) {
  for (const double viscous : {0.0, 1e-4}) {
    const MassSpringModel model = build(block({0.5, 0.25, 1}), 0.4).model;
    const MotionOptions options = {.time_step = 0.5 * safe_time_step(model, 1000),
                                   .viscosity = Viscosity::of(model, {1e4, 0.4, 1000}, viscous)};
    PlainMotion plain(model, 1000, options);
    const std::unique_ptr<Motion> motion = make_motion(model, 1000, options);
    EXPECT_NE(motion->description().find("cell kernel"), std::string::npos) << motion->description();
    const NodalVectors x = model.network.X * test::rotation().transpose() + test::noise(model.network.nodes(), 0.02),
                       v = test::noise(model.network.nodes(), 0.5, 2);
    BoundaryConditions none;
    none.fixed.assign(3 * model.network.nodes(), 0);
    none.prescribed = none.external = NodalVectors::Zero(model.network.nodes(), 3);
    for (Motion* m : {static_cast<Motion*>(&plain), motion.get()}) {
      m->set_conditions(none);
      m->set_state(x, v);
      m->advance(100);
    }
    const double moved = (plain.positions() - x).norm();
    EXPECT_GT(moved, 0.1);
    EXPECT_LE((motion->positions() - plain.positions()).norm(), 1e-10 * moved);
  }
}

// Of a bar between lubricated walls: those of a chain, whatever its section (natural_modes_test.cpp).
TEST(BoxCells, HaveTheStandingWavesOfABar) {
  const int n = 8;
  const double length = 2, h = length / n, c = std::sqrt(1e4 / 1000), pi = std::numbers::pi;
  for (const double width : {0.5 * h, h, 4 * h}) {
    const MassSpringModel model = build(block_mesh({length, width, 2 * width}, {n, 2, 1}), 0).model;
    std::vector<char> fixed(3 * model.network.nodes(), 0);
    for (int i = 0; i < model.network.nodes(); ++i) {
      fixed[3 * i] = model.network.X(i, 0) < 1e-9;
      fixed[3 * i + 1] = fixed[3 * i + 2] = 1;
    }
    for (const double theta : {0.0, 1.0}) {
      const double s = std::pow(std::sin(pi / (4 * n)), 2);
      const double chain = 2 * c / h * std::sqrt(s / (1 - theta * s * 2 / 3)) / (2 * pi);
      const NaturalModes modes = natural_modes(model, fixed, 1000, theta, 1);
      ASSERT_TRUE(modes.ok) << modes.message;
      EXPECT_NEAR(modes.frequencies[0], chain, 1e-8 * chain) << width << ", " << theta;
    }
  }
}

}  // namespace
}  // namespace springproof::box_cells_test
