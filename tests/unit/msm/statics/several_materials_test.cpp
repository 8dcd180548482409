// Bodies of several materials: each is cut as a body of its own, and bonds tie them in the cubes that they share.
#include <gtest/gtest.h>

#include "msm/dynamics/natural_modes.h"
#include "msm/dynamics/time_step.h"
#include "msm/embedding/supports.h"
#include "msm/exchange/springs_document.h"
#include "msm/laws/capabilities.h"
#include "msm/models.h"
#include "msm/multigrid/cut/cut_levels.h"
#include "msm/statics/equilibrium.h"
#include "msm/statics/mixed_form.h"
#include "msm/statics/mixed_newton.h"
#include "support/tolerances.h"
#include "support/two_materials.h"
#include "support/zoo.h"

namespace springproof::several_materials_test {
namespace {

MassSpringModel model_of(const CutBody& cut, const std::vector<IsotropicMaterial>& materials,
                         const std::vector<std::string>& held = {}) {
  return build_cut(test::model("hybmss_avg"), cut, held, Mesh{}, materials[0], {materials.begin() + 1, materials.end()})
      .model;
}

BoundaryConditions no_conditions(const Network& network) {
  return {std::vector<char>(network.X.size(), 0), std::vector<int>(network.X.size(), -1),
          NodalVectors::Zero(network.nodes(), 3), NodalVectors::Zero(network.nodes(), 3)};
}

Equilibrium solved(const MassSpringModel& model, const BoundaryConditions& bc,
                   LinearSolver solver = LinearSolver::cholesky, double tolerance = 1e-8) {
  LinearOptions options;
  options.solver = solver;
  options.tolerance = solver == LinearSolver::cholesky ? 1e-12 : tolerance;
  Equilibrium e = solve_linear(model, bc, options);
  EXPECT_TRUE(e.ok) << e.message;
  return e;
}

constexpr double length = 4, pull = 0.01;

/// Force at the end x = 4 of a bar that is pulled by 0.01 and, if `confined`, cannot contract.
double force_of_bar(const MassSpringModel& model, bool confined) {
  const Network& network = model.network;
  BoundaryConditions bc = no_conditions(network);
  const auto fix = [&](int n, int axis, double u) {
    bc.fixed[3 * n + axis] = 1;
    bc.prescribed(n, axis) = u;
  };
  for (int n = 0; n < network.nodes(); ++n) {
    const Vec3 x = network.X.row(n).transpose();
    if (x[0] < 1e-9 || x[0] > length - 1e-9) fix(n, 0, x[0] < 1 ? 0 : pull);
    for (int axis = 1; axis < 3; ++axis)
      if (confined || x[axis] < 1e-9) fix(n, axis, 0);
  }
  const Equilibrium e = solved(model, bc);
  double force = 0;
  for (int n = 0; n < network.nodes(); ++n)
    if (network.X(n, 0) > length - 1e-9) force += e.support(n, 0);
  return force;
}

CutBody cut_layers(int axis, double at) {
  return cut_body({Vec3::Zero(), 1, {4, 2, 2}}, test::layered_block({length, 2, 2}, {4, 2, 2}, axis, at));
}

double confined_modulus(const IsotropicMaterial& m) { return lame_lambda(m) + 2 * shear_modulus(m); }

// An interface gives way like a thirtieth of a cell of the softer material.
TEST(SeveralMaterials, InSeriesGiveWayAsTheirBonds) {
  for (const double nu : {0.0, 0.3, 0.47})
    for (const double contrast : {1e-4, 1.0, 10.0, 1e4})
      for (const double at : {1.3, 2.5}) {
        const IsotropicMaterial a{1, nu, 1}, b{contrast, nu, 1};
        const auto modulus = [&](const IsotropicMaterial& m) {
          return nu > 0.45 ? confined_modulus(m) : m.youngs_modulus;
        };
        const double bonds = (1 / modulus(a) + 1 / modulus(b)) / 2 / anchor_stiffness;
        const double give = at / confined_modulus(a) + (length - at) / confined_modulus(b) + bonds;
        const double force = force_of_bar(model_of(cut_layers(0, at), {a, b}), true);
        EXPECT_NEAR(force, 4 * pull / give, 1e-6 * force) << nu << ' ' << contrast << ' ' << at;
      }
}

TEST(SeveralMaterials, InParallelAreExact) {
  for (const double contrast : {1e-3, 10.0, 1e3})
    for (const double at : {0.4, 1.3}) {
      const double force = force_of_bar(model_of(cut_layers(2, at), {{1, 0.3, 1}, {contrast, 0.3, 1}}), false);
      const double expected = 2 * (at + contrast * (2 - at)) * pull / length;
      EXPECT_NEAR(force, expected, test::patch_test * expected) << contrast << ' ' << at;
    }
}

TEST(SeveralMaterials, ThatMeetInAPlaneOfTheLatticeAreExactWithoutBonds) {
  const IsotropicMaterial a{1, 0.3, 1}, b{50, 0.45, 1};
  const MassSpringModel model = model_of(cut_layers(0, 1), {a, b});
  EXPECT_TRUE(model.network.bonds.empty());
  const double expected = 4 * pull / (1 / confined_modulus(a) + 3 / confined_modulus(b));
  EXPECT_NEAR(force_of_bar(model, true), expected, test::patch_test * expected);
}

// Near nu = 1/2 a lattice of cubes without it takes hundreds of iterations.
TEST(SeveralMaterials, InWholeCubesHaveTheMultigridOfCutCells) {
  Mesh cubes = block_mesh({1, 1, 1}, {10, 10, 10});
  for (std::size_t c = 0; c < cubes.hexahedra.size(); ++c)
    cubes.materials.push_back((cubes.nodes.row(cubes.hexahedra[c][0]).array() < 0.45).all());
  for (const double nu : {0.3, 0.499})
    for (const double contrast : {1e-3, 1e3}) {
      const MassSpringModel model =
          build_embedded(test::model("hybmss_avg"), cubes, {1, nu, 1}, nullptr, {{contrast, 0.3, 1}}).model;
      BoundaryConditions bc = no_conditions(model.network);
      for (int n = 0; n < model.network.nodes(); ++n)
        if (model.network.X(n, 2) < 1e-9)
          std::fill_n(bc.fixed.begin() + 3 * n, 3, 1);
        else if (model.network.X(n, 2) > 1 - 1e-9)
          bc.external.row(n) << 0.001, 0, 0.002;
      const Equilibrium found = solved(model, bc, LinearSolver::automatic), exact = solved(model, bc);
      EXPECT_LE(found.iterations, 25) << found.solver << ", nu = " << nu << ", contrast " << contrast;
      EXPECT_LE((found.displacement - exact.displacement).norm(), 1e-6 * exact.displacement.norm());
    }
}

// Means alone leave a hinge: singular.
TEST(SeveralMaterials, InABarOfOneCellBendTogether) {
  for (const double contrast : {1.0, 10.0}) {
    const double t = 0.9, at = 2.4, L = 8;
    const Mesh body = test::mapped(test::layered_block({L, t, t}, {8, 1, 1}, 0, at),
                                   [&](const Vec3& x) -> Vec3 { return x + Vec3(0, 0.05, 0.05); });
    const CutBody cut = cut_body({Vec3::Zero(), 1, {8, 1, 1}}, body);
    const Mesh cubes = voxelise(cut.grid, body).mesh;
    const EmbeddedModel built =
        build_cut(test::model("hybmss_avg"), cut, {"x_min"}, cubes, {1, 0, 1}, {{contrast, 0, 1}});
    const BoundaryConditions bc =
        transfer({PrescribedDisplacement{"x_min", {0.0, 0.0, 0.0}}, PatchForce{"x_max", Vec3(0, 0, 1)}}, cubes,
                 built.embedding, built.model.network, 1, Kinematics::linear);
    const Equilibrium e = solved(built.model, bc);
    const PatchShares& end = built.embedding.patches.at("x_max");
    const double I = std::pow(t, 4) / 12, rest = std::pow(L - at, 3) / 3;
    const double expected = ((std::pow(L, 3) / 3 - rest) + rest / contrast) / I;
    EXPECT_NEAR(e.displacement.col(2).dot(end.area) / end.area.sum(), expected, 0.05 * expected) << contrast;
  }
}

/// A ball of two cells' radius or more in the exact field around it, on the surface of a cube of two diameters.
struct Ball {
  test::BallInSpace exact;
  int across;  ///< cells
  Vec3 centre;
  MassSpringModel model = model_of(
      cut_body({Vec3::Constant(-2), 2.0 / across, {2 * across, 2 * across, 2 * across}}, test::ball_in_cube(8, centre)),
      {exact.around, exact.inside});

  Equilibrium solve(LinearSolver solver, double tolerance = 1e-8) const {
    const Network& network = model.network;
    BoundaryConditions bc = no_conditions(network);
    for (int n = 0; n < network.nodes(); ++n) {
      const Vec3 x = network.X.row(n).transpose();
      if (x.cwiseAbs().maxCoeff() < 2 - 1e-9) continue;
      bc.prescribed.row(n) = exact.displacement(x - centre).transpose();
      std::fill_n(bc.fixed.begin() + 3 * n, 3, 1);
    }
    return solved(model, bc, solver, tolerance);
  }

  /// Mean strain inside.
  Eigen::Matrix3d strain(const Equilibrium& e) const {
    const Network& network = model.network;
    Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
    double volume = 0;
    for (std::size_t c = 0; c < network.cells.size(); ++c) {
      if (network.cells.material(c) != 1) continue;
      const Eigen::Matrix3d H = mean_gradient(network, c, e.displacement);
      sum += filled_volume(network, c) / 2 * (H + H.transpose());
      volume += filled_volume(network, c);
    }
    return sum / volume;
  }

  /// Relative error of the mean stress inside.
  double stress_error(const Equilibrium& e) const {
    const Eigen::Matrix3d s = strain(e);
    const Eigen::Matrix3d stress =
        lame_lambda(exact.inside) * s.trace() * Eigen::Matrix3d::Identity() + 2 * shear_modulus(exact.inside) * s;
    return (stress - exact.stress()).norm() / exact.stress().norm();
  }
};

const Eigen::Matrix3d tension = Eigen::Vector3d(-0.3, -0.3, 1).asDiagonal(), pressure = -Eigen::Matrix3d::Identity();

TEST(SeveralMaterials, ABallHasTheStressOfEshelby) {
  for (const Eigen::Matrix3d& far : {tension, pressure}) {
    const Ball stiff{{{1, 0.3, 1}, {1e4, 0.3, 1}, far}, 4, {0.11, 0.05, -0.17}};
    EXPECT_LE(stiff.stress_error(stiff.solve(LinearSolver::cholesky)), 0.1);
    const Ball volume{{{1, 0.3, 1}, {1, 0.499, 1}, far}, 4, {0.11, 0.05, -0.17}};
    EXPECT_LE(volume.stress_error(volume.solve(LinearSolver::cholesky)), 0.02);
  }
}

TEST(SeveralMaterials, OfTheSameModuliAreNearlyOneMaterial) {
  for (const Eigen::Matrix3d& far : {tension, pressure}) {
    const Ball same{{{1, 0.3, 1}, {1, 0.3, 1}, far}, 8, {0.06, 0.02, -0.09}};
    EXPECT_LE((same.strain(same.solve(LinearSolver::multigrid)) - far).norm(), 0.02 * far.norm());
  }
}

/// Iterations of multigrid for the ball in a cube that stands on a face and is pulled askew at the opposite one.
int iterations(const Mesh& body, const std::vector<IsotropicMaterial>& materials,
               LinearSolver solver = LinearSolver::multigrid, int cells = 8) {
  const CutBody cut = cut_body({Vec3::Constant(-2), 4. / cells, {cells, cells, cells}}, body);
  const Mesh cubes = voxelise(cut.grid, body).mesh;
  const EmbeddedModel built = build_cut(test::model("hybmss_avg"), cut, {"z_min"}, cubes, materials[0],
                                        {materials.begin() + 1, materials.end()});
  const BoundaryConditions bc =
      transfer({PrescribedDisplacement{"z_min", {0.0, 0.0, 0.0}}, PatchForce{"z_max", Vec3(0.3, 0, 1)}}, cubes,
               built.embedding, built.model.network, 1, Kinematics::linear);
  return solved(built.model, bc, solver).iterations;
}

TEST(SeveralMaterials, TakeTheIterationsOfOne) {
  const Mesh body = test::ball_in_cube(8, {0.055, 0.025, -0.085});
  Mesh of_one = body;
  of_one.materials.clear();
  for (const int cells : {8, 12, 16}) {
    const int least = iterations(of_one, {{1, 0.3, 1}}, LinearSolver::multigrid, cells);
    for (const double contrast : {1e-4, 1e-2, 1.0, 1e2, 1e4})
      EXPECT_LE(iterations(body, {{1, 0.3, 1}, {contrast, 0.3, 1}}, LinearSolver::multigrid, cells), 1.5 * least)
          << contrast << ' ' << cells;
  }
}

// In displacements alone the first three take 20, 159 and 167.
TEST(SeveralMaterials, TakeTheIterationsOfOneInMixedForm) {
  const Mesh body = test::ball_in_cube(8, {0.055, 0.025, -0.085});
  Mesh of_one = body;
  of_one.materials.clear();
  const int least = iterations(of_one, {{1, 0.499, 1}}, LinearSolver::mixed_multigrid);
  const IsotropicMaterial soft{1, 0.3, 1}, liquid{1, 0.499, 1}, stiff{100, 0.3, 1}, hollow{1, 0.2, 1};
  for (const auto& [around, inside] :
       {std::pair{soft, liquid}, {liquid, soft}, {liquid, stiff}, {liquid, hollow}, {stiff, soft}})
    EXPECT_LE(iterations(body, {around, inside}, LinearSolver::mixed_multigrid), 1.6 * least)
        << around.poisson_ratio << ' ' << inside.youngs_modulus;
}

TEST(SeveralMaterials, AreTheSameInMixedForm) {
  const IsotropicMaterial soft{1, 0.3, 1}, liquid{1, 0.499, 1}, stiff{100, 0.499, 1}, hollow{1, 0.2, 1};
  for (const auto& [around, inside] : {std::pair{soft, liquid}, {liquid, soft}, {liquid, hollow}, {soft, stiff}}) {
    const Ball ball{{around, inside, tension}, 4, {0.11, 0.05, -0.17}};
    EXPECT_TRUE(mixed_form_pays(ball.model));
    const NodalVectors direct = ball.solve(LinearSolver::cholesky).displacement,
                       mixed = ball.solve(LinearSolver::mixed_multigrid, 1e-10).displacement;
    EXPECT_LE((mixed - direct).norm(), 1e-7 * direct.norm()) << around.poisson_ratio << ' ' << inside.youngs_modulus;
  }
  EXPECT_FALSE(mixed_form_pays(Ball{{soft, {1e4, 0.3, 1}, tension}, 2, Vec3::Zero()}.model));
}

// Of cells of two sizes, in a field at random.
TEST(SeveralMaterials, HaveTheirTangentInTheMatrixOfTheMultigrid) {
  VoxelGrid grid = with_halved_cubes({Vec3::Constant(-2), 1, {4, 4, 4}});
  halve_cell(grid, {2, 2, 4});
  const MassSpringModel model =
      model_of(cut_body(grid, test::ball_in_cube(8, {0.1, 0, 0})), {{1, 0.3, 1}, {100, 0.47, 1}});
  const Network& network = model.network;
  ASSERT_FALSE(network.bonds.empty());
  ASSERT_FALSE(network.cells.carried.empty());
  const AnchoredNodes nodes(network, std::vector<char>(network.X.size(), 0));
  const CutLevel level = cut_levels(network, nodes).front();
  const CutMatrix<double> cells(averaged_cells(*averaged_springs_of(model), level), 1, level, {});
  Eigen::VectorXd x = flat(test::noise(network.nodes(), 1, 1)), y, expected;
  for (const CarriedPoint& c : network.cells.carried) x.segment<3>(3 * c.point).setZero();
  nodes.multiply(cells, 1, x, y);
  tangent(model, network.X).multiply(x, expected);
  EXPECT_LE((y - expected).norm(), 1e-13 * expected.norm());
}

// Energy, forces and tangent of the bonds belong to each other, at large strain too.
TEST(SeveralMaterials, HaveTheForcesOfTheirEnergy) {
  const MassSpringModel model = model_of(cut_layers(0, 1.3), {{1, 0.3, 1}, {20, 0.47, 1}});
  const Network& network = model.network;
  ASSERT_FALSE(network.bonds.empty());
  const NodalVectors x = network.X + test::noise(network.nodes(), 0.1, 1), d = test::noise(network.nodes(), 1, 2);
  const double h = 1e-5;
  const double slope = (energy(model, x + h * d) - energy(model, x - h * d)) / (2 * h);
  const double expected = -forces(model, x).cwiseProduct(d).sum();
  EXPECT_NEAR(slope, expected, test::finite_difference * std::abs(expected));
  Eigen::VectorXd Kd;
  tangent(model, x).multiply(flat(d), Kd);
  const Eigen::VectorXd change = flat(forces(model, x - h * d) - forces(model, x + h * d)) / (2 * h);
  EXPECT_LE((Kd - change).norm(), test::finite_difference * Kd.norm());
}

TEST(SeveralMaterials, TurnAsABody) {
  const MassSpringModel model = model_of(cut_layers(0, 1.3), {{1, 0.3, 1}, {20, 0.499, 1}});
  const NodalVectors x = model.network.X + test::noise(model.network.nodes(), 0.1, 1);
  const Eigen::Matrix3d R = Eigen::AngleAxisd(1.2, Vec3(1, 2, -1).normalized()).toRotationMatrix();
  EXPECT_NEAR(energy(model, x * R.transpose()), energy(model, x), 1e-12 * energy(model, x));
  const NodalVectors f = forces(model, x);
  EXPECT_LE((forces(model, x * R.transpose()) - f * R.transpose()).norm(), 1e-12 * f.norm());
}

/// Force at the end of a bar that is pulled to `stretch` times its length, its sides free or, if `confined`, held.
double force_at_large_strain(const MassSpringModel& model, bool confined, double stretch) {
  const Network& network = model.network;
  const LoadPath pulled = [&](double factor) {
    BoundaryConditions bc = no_conditions(network);
    for (int n = 0; n < network.nodes(); ++n) {
      const Vec3 x = network.X.row(n).transpose();
      for (int axis = 0; axis < 3; ++axis) bc.fixed[3 * n + axis] = x[axis] < 1e-9 || (confined && axis > 0);
      if (x[0] < length - 1e-9) continue;
      bc.fixed[3 * n] = 1;
      bc.prescribed(n, 0) = (stretch - 1) * factor * length;
    }
    return bc;
  };
  const Equilibrium e = solve_finite(model, pulled);
  EXPECT_TRUE(e.ok) << e.message;
  double force = 0;
  for (int n = 0; n < network.nodes(); ++n)
    if (network.X(n, 0) > length - 1e-9) force += e.support(n, 0);
  return force;
}

TEST(SeveralMaterials, AreExactInParallelAtLargeStrain) {
  const IsotropicMaterial soft{1, 0.3, 1}, stiff{20, 0.3, 1};
  const double one = force_at_large_strain(model_of(cut_layers(2, 1.3), {soft, soft}), false, 1.2),
               both = force_at_large_strain(model_of(cut_layers(2, 1.3), {soft, stiff}), false, 1.2);
  EXPECT_NEAR(both, (1.3 + 20 * 0.7) / 2 * one, 1e-7 * both);
}

/// Stretch of a confined neo-Hookean solid under a first Piola-Kirchhoff stress.
double stretch_at(double stress, const IsotropicMaterial& m) {
  double low = 0.1, high = 2;
  for (int step = 0; step < 100; ++step) {
    const double l = (low + high) / 2;
    (shear_modulus(m) * (l - 1 / l) + lame_lambda(m) * std::log(l) / l < stress ? low : high) = l;
  }
  return low;
}

/// A bar of two layers between walls without friction: its stress where it is pulled to a stretch.
double stress_between_walls(const CutBody& cut, const IsotropicMaterial& a, const IsotropicMaterial& b,
                            double stretch) {
  MassSpringModel model = model_of(cut, {a, b});
  AveragedSprings& law = *law_of<AveragedSprings>(model);
  law.curve = law.regions[0].curve = StrainCurve::neo_hooke;
  return force_at_large_strain(model, true, stretch) / 4;
}

// An interface gives way as at small strain.
TEST(SeveralMaterials, InSeriesGiveWayAsTheirBondsAtLargeStrain) {
  for (const double contrast : {1e-2, 1.0, 1e4})
    for (const double stretch : {0.8, 1.2}) {
      const IsotropicMaterial a{1, 0, 1}, b{contrast, 0.4, 1};
      const double at = 1.3, stress = stress_between_walls(cut_layers(0, at), a, b, stretch),
                   bonds = stress / anchor_stiffness * (1 / a.youngs_modulus + 1 / b.youngs_modulus) / 2;
      EXPECT_NEAR(at * stretch_at(stress, a) + (length - at) * stretch_at(stress, b) + bonds, stretch * length, 1e-6)
          << contrast << ' ' << stretch;
    }
}

// Bonds that are stiffer across the interface give way less.
TEST(SeveralMaterials, NearlyIncompressibleOnesAreInSeriesAtLargeStrain) {
  for (const double stretch : {0.8, 1.2}) {
    const IsotropicMaterial a{1, 0.3, 1}, b{1, 0.499, 1};
    const double at = 2.5, stress = stress_between_walls(cut_layers(0, at), a, b, stretch);
    EXPECT_NEAR(at * stretch_at(stress, a) + (length - at) * stretch_at(stress, b), stretch * length, 0.005 * length);
  }
}

// With the pressures of one layer, where nu = 1/4 leaves none to the other.
TEST(SeveralMaterials, AreTheSameInMixedFormAtLargeStrain) {
  const CutBody cut =
      cut_body({Vec3::Zero(), 1.0 / 3, {12, 6, 6}}, test::layered_block({length, 2, 2}, {12, 6, 6}, 0, 1.3));
  const MassSpringModel model = model_of(cut, {{1, 0.2, 1}, {2, 0.499, 1}});
  const Network& network = model.network;
  BoundaryConditions bc = no_conditions(network);
  for (int n = 0; n < network.nodes(); ++n) {
    const bool end = network.X(n, 0) > length - 1e-9;
    std::fill_n(bc.fixed.begin() + 3 * n, 3, end || network.X(n, 0) < 1e-9);
    if (end) bc.prescribed.row(n) << 0.4, 0.3, 0;
  }
  NodalVectors x = network.X;
  ASSERT_TRUE(MixedNewton(model, bc.fixed).step(bc, 1e-9, 10, x));
  const Equilibrium direct = solve_finite(model, [&](double factor) {
    BoundaryConditions part = bc;
    part.prescribed *= factor;
    return part;
  });
  ASSERT_TRUE(direct.ok) << direct.message;
  EXPECT_LE((x - network.X - direct.displacement).norm(), 1e-6 * direct.displacement.norm());
}

// Whose forces the rounding of positions changes by more than the tolerance of Newton's method.
TEST(SeveralMaterials, ConvergeUnderSmallLoadsAtHighContrast) {
  const CutBody cut = cut_body({Vec3::Zero(), 1, {8, 2, 2}}, test::layered_block({8, 2, 2}, {8, 2, 2}, 0, 4));
  const MassSpringModel model = model_of(cut, {{1, 0, 1}, {1e4, 0, 1}});
  const Network& network = model.network;
  const LoadPath pulled = [&](double factor) {
    BoundaryConditions bc = no_conditions(network);
    for (int n = 0; n < network.nodes(); ++n) {
      for (int axis = 0; axis < 3; ++axis) bc.fixed[3 * n + axis] = network.X(n, 0) < 1e-9;
      if (network.X(n, 0) > 8 - 1e-9) bc.external(n, 0) = 1e-5 * factor;
    }
    return bc;
  };
  const Equilibrium e = solve_finite(model, pulled);
  ASSERT_TRUE(e.ok) << e.message;
  EXPECT_NEAR(e.displacement.col(0).maxCoeff(), 9e-5 / 4 * (4 + 4e-4), 1e-8);
}

TEST(SeveralMaterials, VibrateAsRodsOfTwoParts) {
  const double t = 0.25, at = 1.8;
  const CutBody cut = cut_body({Vec3::Zero(), t, {16, 1, 1}}, test::layered_block({length, t, t}, {16, 1, 1}, 0, at));
  for (const IsotropicMaterial& free : {IsotropicMaterial{1, 0.3, 1}, {1e4, 0.3, 3}, {1e-2, 0, 1}, {10, 0.499, 2}}) {
    const IsotropicMaterial held{1, 0.3, 1};
    const MassSpringModel model = model_of(cut, {held, free});
    std::vector<char> fixed(model.network.X.size());
    for (int n = 0; n < model.network.nodes(); ++n) {
      fixed[3 * n] = model.network.X(n, 0) < 1e-9;
      fixed[3 * n + 1] = fixed[3 * n + 2] = 1;
    }
    const NaturalModes modes = natural_modes(model, fixed, held.density, 0, 1);
    ASSERT_TRUE(modes.ok) << modes.message;
    const double expected = test::first_frequency({confined_modulus(held), held.density, at},
                                                  {confined_modulus(free), free.density, length - at});
    EXPECT_NEAR(modes.frequencies.front() / expected, 1, 0.005) << free.youngs_modulus;
  }
}

TEST(SeveralMaterials, AreRefusedByWhatKnowsOne) {
  const CutBody cut = cut_layers(0, 1.3);
  const IsotropicMaterial one{1, 0.3, 1000};
  const MassSpringModel model = model_of(cut, {one, {2, 0.3, 1000}});
  EXPECT_FALSE(can(model, Capability::mass_average));
  EXPECT_THROW(model_of(cut, {one}), InputError);
}

/// A block of cubes of edge 1/2, material 1 above `at` along an axis.
Mesh layered_cubes(int axis, double at) {
  Mesh cubes = block_mesh({length, 2, 2}, {8, 4, 4});
  for (const Hexahedron& cube : cubes.hexahedra)
    cubes.materials.push_back((cubes.nodes(cube[0], axis) + cubes.nodes(cube[6], axis)) / 2 > at);
  return cubes;
}

MassSpringModel whole_cubes(const std::string& model, const Mesh& cubes, const IsotropicMaterial& own,
                            const IsotropicMaterial& other) {
  return build_embedded(test::model(model), cubes, own, nullptr, {other}).model;
}

/// Poisson's ratios of a model in two materials: of springs alone 1/4.
std::array<double, 2> ratios_of(const std::string& model) {
  return own_poisson_ratio(test::model(model).row) ? std::array{0.25, 0.25} : std::array{0.3, 0.45};
}

const char* const of_whole_cubes[] = {"msm_18", "hybmss_cf", "hybmss", "hybmss_b", "hybmss_bt", "hybmss_avg"};

TEST(SeveralMaterials, InWholeCubesAreExactInSeries) {
  for (const std::string model : of_whole_cubes)
    for (const double contrast : {1e-4, 50.0}) {
      const auto [nu_a, nu_b] = ratios_of(model);
      const IsotropicMaterial a{1, nu_a, 1}, b{contrast, nu_b, 1};
      const double force = force_of_bar(whole_cubes(model, layered_cubes(0, 1.5), a, b), true),
                   expected = 4 * pull / (1.5 / confined_modulus(a) + 2.5 / confined_modulus(b));
      EXPECT_NEAR(force, expected, 1e-10 * expected) << model << ' ' << contrast;
    }
}

TEST(SeveralMaterials, InWholeCubesAreExactInParallel) {
  for (const std::string model : of_whole_cubes)
    for (const double contrast : {1e-3, 50.0}) {
      const double nu = ratios_of(model)[0],
                   force =
                       force_of_bar(whole_cubes(model, layered_cubes(2, 0.5), {1, nu, 1}, {contrast, nu, 1}), false),
                   expected = 2 * (0.5 + 1.5 * contrast) * pull / length;
      EXPECT_NEAR(force, expected, 1e-10 * expected) << model << ' ' << contrast;
    }
}

// Cubes of the majority's material, four across a ball: a third off in its stress, rms over places in the lattice.
TEST(SeveralMaterials, InWholeCubesAreOffByTheStepsOfTheInterface) {
  const VoxelGrid grid{Vec3::Constant(-2), 0.5, {8, 8, 8}};
  const std::vector<Vec3> centres = {{0.11, 0.05, -0.17}, {0.2, -0.1, 0.02}, {-0.05, 0.22, 0.13}, {0, 0, 0}};
  for (const auto& [far, expected] : {std::pair(tension, 0.32), std::pair(pressure, 0.19)}) {
    const test::BallInSpace exact{{1, 0.3, 1}, {10, 0.3, 1}, far};
    double squares = 0;
    for (const Vec3& centre : centres) {
      const Mesh cubes = voxelise(grid, test::ball_in_cube(8, centre)).mesh;
      const Ball ball{exact, 4, centre, whole_cubes("hybmss_avg", cubes, exact.around, exact.inside)};
      squares += std::pow(ball.stress_error(ball.solve(LinearSolver::cholesky)), 2) / 4;
    }
    EXPECT_NEAR(std::sqrt(squares), expected, 0.3 * expected) << far(2, 2);
  }
}

TEST(SeveralMaterials, InWholeCubesHaveTheForcesOfTheirEnergy) {
  for (const std::string model : {"hybmss", "hybmss_bt", "hybmss_avg"}) {
    const MassSpringModel of_two = whole_cubes(model, layered_cubes(0, 1.5), {1, 0.2, 1}, {20, 0.4, 1});
    const Network& network = of_two.network;
    const NodalVectors x = network.X + test::noise(network.nodes(), 0.05, 1), d = test::noise(network.nodes(), 1, 2);
    const double h = 1e-5, slope = (energy(of_two, x + h * d) - energy(of_two, x - h * d)) / (2 * h),
                 expected = -forces(of_two, x).cwiseProduct(d).sum();
    EXPECT_NEAR(slope, expected, test::finite_difference * std::abs(expected)) << model;
    Eigen::VectorXd Kd;
    tangent(of_two, x).multiply(flat(d), Kd);
    const Eigen::VectorXd change = flat(forces(of_two, x - h * d) - forces(of_two, x + h * d)) / (2 * h);
    EXPECT_LE((Kd - change).norm(), test::finite_difference * Kd.norm()) << model;
  }
}

// The stiff and light layer has the fastest modes.
TEST(SeveralMaterials, InWholeCubesHaveASafeStep) {
  for (const std::string model : {"hybmss_cf", "hybmss", "hybmss_bt", "hybmss_avg"}) {
    const double nu = ratios_of(model)[0];
    const MassSpringModel of_two = whole_cubes(model, layered_cubes(0, 1.5), {1, nu, 3}, {100, nu, 1});
    const Network& network = of_two.network;
    const Eigen::VectorXd mass = masses(network, 3);
    Eigen::VectorXd v = flat(test::noise(network.nodes(), 1, 1)), Kv;
    const Tangent K = tangent(of_two, network.X);
    double square = 0;  // of the largest frequency, by power iteration
    for (int i = 0; i < 400; ++i) {
      K.multiply(v, Kv);
      for (Eigen::Index n = 0; n < v.size(); ++n) Kv[n] /= mass[n / 3];
      square = Kv.norm() / v.norm();
      v = Kv / Kv.norm();
    }
    const double step = safe_time_step(of_two, 3), largest = 2 / std::sqrt(square);
    EXPECT_LE(step, 1.001 * largest) << model;
    EXPECT_GE(step, 0.3 * largest) << model;
  }
}

TEST(SeveralMaterials, InWholeCubesWeighByTheirDensities) {
  const Mesh cubes = layered_cubes(0, 1.5);
  const EmbeddedModel built = build_embedded(test::model("hybmss"), cubes, {1, 0.3, 1000}, nullptr, {{1, 0.3, 3000}});
  EXPECT_NEAR(masses(built.model.network, 1000).sum(), 4 * (1.5 * 1000 + 2.5 * 3000), 1e-8);
  const NodalVectors weight =
      transfer({Gravity{Vec3(0, 0, -10)}}, cubes, built.embedding, built.model.network, 1000, Kinematics::linear)
          .external;
  double lower = 0;
  for (int n = 0; n < built.model.network.nodes(); ++n)
    if (built.model.network.X(n, 0) < 1.5 - 1e-9) lower += weight(n, 2);
  EXPECT_NEAR(weight.col(2).sum(), -40 * (1.5 * 1000 + 2.5 * 3000), 1e-6);
  EXPECT_NEAR(lower, -40 * 1.25 * 1000, 1e-6);  // but half of the cubes at the interface
}

TEST(SeveralMaterials, InWholeCubesAreRefusedByWhatKnowsOne) {
  const Mesh cubes = layered_cubes(0, 1.5);
  const IsotropicMaterial one{1, 0.25, 1000}, other{2, 0.25, 1000};
  for (const std::string model : {"emsm", "msm_centred", "msm_random", "emsm_random"})
    EXPECT_THROW(whole_cubes(model, cubes, one, other), InputError) << model;
  EXPECT_THROW(build_embedded(test::model("hybmss"), cubes, one), InputError);
  Mesh of_three = cubes;
  of_three.materials.front() = 2;
  EXPECT_THROW(whole_cubes("hybmss", of_three, one, other), InputError);
  const MassSpringModel model = whole_cubes("hybmss", cubes, one, other);
  for (const Capability what :
       {Capability::lattice_kernels, Capability::gpu, Capability::equal_cells, Capability::viscosity})
    EXPECT_FALSE(can(model, what)) << name_of(what);
  SpringsFile file;
  file.model = model;
  EXPECT_THROW(document_of(file), std::invalid_argument);
}

TEST(SeveralMaterials, HaveTheirOwnDensities) {
  const CutBody cut = cut_layers(0, 1.3);
  const MassSpringModel model = model_of(cut, {{1, 0.3, 1000}, {1, 0.3, 3000}});
  EXPECT_NEAR(masses(model.network, 1000).sum(), 4 * (1.3 * 1000 + 2.7 * 3000), 1e-6);
  EXPECT_NEAR(mass_matrix(model.network, 1000, 0.5).sum(), 4 * (1.3 * 1000 + 2.7 * 3000), 1e-6);
}

}  // namespace
}  // namespace springproof::several_materials_test
