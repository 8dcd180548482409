// Cells of several sizes as springs: exact for uniform strain, and as stable and as quickly solved as those of one
// size.
#include <gtest/gtest.h>

#include <fmt/format.h>

#include <Eigen/Dense>

#include "meshes/locate/outer_facets.h"
#include "meshes/volume.h"
#include "msm/embedding/boundary.h"
#include "msm/measure/promised_error.h"
#include "msm/models.h"
#include "msm/statics/equilibrium.h"
#include "support/refined_cells.h"
#include "support/solids.h"
#include "support/zoo.h"

namespace springproof::msm_refined_cells_test {
namespace {

// Under the traction of its stress on the surface a body of cut and full cells in uniform strain is in equilibrium.
TEST(RefinedCells, UniformStrainIsExactAtEveryNode) {
  const Mesh body = test::solid_of(block_mesh({1, 0.9, 0.8}, {2, 2, 2}));
  Eigen::Matrix3d H;
  H << 3, 1, -2, 0.5, -1, 4, 2, -3, 1;
  H *= 1e-6;
  for (unsigned seed = 1; seed <= 3; ++seed)
    for (double nu : {-0.5, 0.0, 0.25, 0.45, 0.499})
      for (const char* name : {"hybmss_bt", "hybmss_avg"}) {
        const CutBody cut = cut_body(test::halved_at_random(test::grid_about(body, 0.25), 2, 7, seed), body);
        const EmbeddedModel built = build_cut(test::model(name), cut, {}, Mesh{}, {1, nu, 1});
        const Network& network = built.model.network;
        const AveragedSprings& law = *averaged_springs_of(built.model);
        const Eigen::Matrix3d strain = (H + H.transpose()) / 2;
        const Eigen::Matrix3d stress =
            2 * law.shear_modulus * strain + law.lame_lambda * strain.trace() * Eigen::Matrix3d::Identity();
        NodalVectors load = built.embedding.patches.at("surface").normal * stress;
        hand_back(network.cells.carried, load);
        const NodalVectors u = network.X * H.transpose();
        Eigen::VectorXd Ku;
        tangent(built.model, network.X).multiply(Eigen::Map<const Eigen::VectorXd>(u.data(), u.size()), Ku);
        const Eigen::Map<const NodalVectors> internal(Ku.data(), u.rows(), 3);
        EXPECT_LE((internal - load).cwiseAbs().maxCoeff(), 1e-12 * load.cwiseAbs().maxCoeff()) << name << ' ' << nu;
      }
}

// Nothing holds the body; parts of less than a thousandth of a cell are left out.
TEST(RefinedCells, APressureChangesTheVolumeAsItShould) {
  const Mesh body = test::mapped(test::ball_of_tetrahedra(8), test::random_placement(2, 0.25));
  const CutBody cut = cut_body(test::halved_at_random(test::grid_about(body, 0.25), 2, 8), body);
  const double nu = 0.499, pressure = 1e-3;
  const EmbeddedModel built = build_cut(test::model("hybmss_avg"), cut, {}, body, {1, nu, 1});
  const Network& network = built.model.network;
  BoundaryConditions conditions =
      transfer({Pressure{"surface", pressure}}, body, built.embedding, network, 1, Kinematics::linear);
  hold_free_motions(network.X, conditions, network.cells.carried);
  const Equilibrium e = solve_linear(built.model, conditions);
  ASSERT_TRUE(e.ok) << e.message;
  const double exact = -3 * pressure * (1 - 2 * nu);
  EXPECT_NEAR(volume_change(network, e.displacement).first_order, exact, 1e-3 * std::abs(exact));
}

TEST(RefinedCells, RigidMotionsAloneCostNoEnergy) {
  const Mesh body = test::mapped(test::ball_of_tetrahedra(4), test::random_placement(2, 0.4));
  const CutBody cut = cut_body(test::halved_at_random(test::grid_about(body, 0.4), 1, 6), body);
  for (double nu : {-0.5, 0.25, 0.499}) {
    const MassSpringModel model = build_cut(test::model("hybmss_avg"), cut, {}, Mesh{}, {1, nu, 1}).model;
    const Tangent K = tangent(model, model.network.X);
    const int n = 3 * model.network.nodes();
    Eigen::MatrixXd dense(n, n);
    Eigen::VectorXd column;
    for (int i = 0; i < n; ++i) {
      K.multiply(Eigen::VectorXd::Unit(n, i), column);
      dense.col(i) = column;
    }
    EXPECT_LE((dense - dense.transpose()).cwiseAbs().maxCoeff(), 1e-14 * dense.cwiseAbs().maxCoeff());
    const Eigen::VectorXd values = dense.selfadjointView<Eigen::Lower>().eigenvalues();
    const auto none = 3 * static_cast<Eigen::Index>(model.network.cells.carried.size()) + 6;
    EXPECT_LE(values.head(none).cwiseAbs().maxCoeff(), 1e-13 * values[n - 1]);
    EXPECT_GE(values[none], 1e-11 * values[n - 1]) << nu;  // slivers are soft
  }
}

/// A turned bar held at one end and pulled aside at the other.
Equilibrium bent(const VoxelGrid& grid, const Mesh& body, const std::string& model, double nu, bool finite = false) {
  const CutBody cut = cut_body(grid, body);
  VoxelGrid cubes = grid;
  cubes.doubled.clear();
  const Mesh mesh = voxelise(cubes, body).mesh;
  const EmbeddedModel built = build_cut(test::model(model), cut, {"z_min"}, mesh, {1, nu, 1});
  const std::vector<Load> loads = {PrescribedDisplacement{"z_min", {0.0, 0.0, 0.0}},
                                   PatchForce{"z_max", Vec3(1e-3, 2e-3, 0)}};
  const auto path = [&](double factor) {
    return transfer(loads, mesh, built.embedding, built.model.network, 1,
                    finite ? Kinematics::finite : Kinematics::linear, factor);
  };
  Equilibrium e = finite ? solve_finite(built.model, path) : solve_linear(built.model, path(1));
  EXPECT_TRUE(e.ok) << e.message;
  Vec3 reaction = Vec3::Zero();
  for (Eigen::Index n = 0; n < e.support.rows(); ++n) reaction += e.support.row(n).transpose();
  EXPECT_LE((reaction + Vec3(1e-3, 2e-3, 0)).norm(), 1e-8 * 2e-3);
  return e;
}

TEST(RefinedCells, NeedAtMostTwiceTheIterations) {
  const double l = 0.125;
  const Mesh body = test::mapped(test::cylinder(4, 8, 24), test::random_placement(4, l));
  const VoxelGrid coarse = test::grid_about(body, l);
  for (double nu : {-0.5, 0.25, 0.499}) {
    const Equilibrium uniform = bent(coarse, body, "hybmss_avg", nu);
    const Equilibrium refined = bent(test::halved_at_random(coarse, 2, 30), body, "hybmss_avg", nu);
    RecordProperty("nu" + std::to_string(nu),
                   std::to_string(uniform.iterations) + " " + std::to_string(refined.iterations));
    EXPECT_GT(refined.unknowns, uniform.unknowns);
    EXPECT_LE(refined.iterations, 2 * uniform.iterations) << nu;
  }
}

/// A bar with a notch halfway, held at one end and pulled aside at the other: its compliance and what it promises.
struct Notched {
  std::size_t cells;
  double compliance, promised;
};
Notched notched(const VoxelGrid& grid, const Mesh& body, VoxelGrid* finer = nullptr) {
  const CutBody cut = cut_body(grid, body);
  const EmbeddedModel built = build_cut(test::model("hybmss_avg"), cut, {"x_min"}, body, {1, 0.3, 1});
  const BoundaryConditions conditions =
      transfer({PrescribedDisplacement{"x_min", {0.0, 0.0, 0.0}}, PatchForce{"x_max", Vec3(0, 0, 1)}}, body,
               built.embedding, built.model.network, 1, Kinematics::linear);
  const Equilibrium e = solve_linear(built.model, conditions);
  EXPECT_TRUE(e.ok) << e.message;
  const CellEnergies energies = cell_energies(built.model, e.displacement);
  if (finer) {
    EXPECT_TRUE(halve_worst_cells(cut, energies.larger(), *finer));
  }
  return {cut.cells.size(), e.displacement.cwiseProduct(conditions.external).sum(), energies.estimated_error()};
}

// The refined lattice has less than half of the error at no more cells, and says how large it is within a factor of
// two.
TEST(RefinedCells, PayAtANotchAndKnowTheirError) {
  const Mesh block = block_mesh({4, 1, 1}, {16, 4, 4});
  Mesh solid = test::voxels_of(block, [](int i, int, int k) { return i != 7 || k < 2; });
  for (const char* name : {"x_min", "x_max"}) {
    Patch& patch = solid.patches.emplace_back(Patch{name, {}});
    const double x = name == std::string("x_min") ? 0 : 4;
    for (const OuterFacet& f : outer_facets(solid)) {
      bool there = true;
      for (const int n : f.nodes) there &= std::abs(solid.nodes(n, 0) - x) < 1e-9;
      if (there) patch.facets.push_back(f.nodes);
    }
  }
  const Mesh body = test::solid_of(solid);
  const Notched coarse = notched(test::grid_about(body, 0.25), body),
                middle = notched(test::grid_about(body, 0.125), body),
                fine = notched(test::grid_about(body, 0.0625), body);
  const double step = fine.compliance - middle.compliance;  // of errors that fall by one factor, Aitken's limit
  const double limit = fine.compliance + step * step / (middle.compliance - coarse.compliance - step);
  const auto error = [&](const Notched& n) { return 1 - n.compliance / limit; };
  std::string found = fmt::format("{} {:.4f}, {} {:.4f}, {} {:.4f}; refined", coarse.cells, error(coarse), middle.cells,
                                  error(middle), fine.cells, error(fine));
  VoxelGrid grid = test::grid_about(body, 0.25), next = grid;
  Notched refined = coarse;
  for (; 2.5 * static_cast<double>(refined.cells) <= static_cast<double>(middle.cells); grid = next) {
    refined = notched(grid, body, &next);
    found += fmt::format(" {} {:.4f} (promised {:.4f})", refined.cells, error(refined), refined.promised);
    EXPECT_GE(refined.promised, error(refined));
    EXPECT_LE(refined.promised, 3 * error(refined));
  }
  EXPECT_LE(refined.cells, 1000u);
  EXPECT_LE(error(refined), error(middle));
  RecordProperty("cells_and_errors", found);
}

// A plate on a support, pulled evenly, at nu = 0: no error but that the anchors give way, which is known.
TEST(RefinedCells, PromiseWhatTheirSupportsGiveWay) {
  const Mesh body = test::solid_of(block_mesh({1, 1, 0.4}, {4, 4, 2}));
  std::vector<double> promised;
  VoxelGrid grid = test::grid_about(body, 0.22);
  for (int round = 0; round < 3; ++round) {
    const CutBody cut = cut_body(grid, body);
    const EmbeddedModel built = build_cut(test::model("hybmss_avg"), cut, {"z_min"}, body, {100, 0, 1});
    const BoundaryConditions conditions =
        transfer({PrescribedDisplacement{"z_min", {0.0, 0.0, 0.0}}, PatchForce{"z_max", Vec3(0, 0, 1)}}, body,
                 built.embedding, built.model.network, 1, Kinematics::linear);
    const Equilibrium e = solve_linear(built.model, conditions);
    ASSERT_TRUE(e.ok) << e.message;
    const CellEnergies energies = cell_energies(built.model, e.displacement);
    const double exact = 1 * 0.4 / 100, found = e.displacement.cwiseProduct(conditions.external).sum();
    EXPECT_NEAR(energies.estimated_error(), 1 - exact / found,
                round == 0 ? 1e-9 : 2e-4);  // later the stress is not even
    promised.push_back(energies.estimated_error());
    EXPECT_TRUE(halve_worst_cells(cut, energies.larger(), grid));
  }
  EXPECT_GT(promised[0], 0.01);
  EXPECT_LT(promised[2], 0.7 * promised[0]);
}

TEST(RefinedCells, LearnFromTheirEnergiesHowFarTheirEstimatesFallShort) {
  const auto found = [](double kappa) {  // of a body whose energy is 5
    std::vector<LatticeEstimate> lattices;
    for (const double error : {0.12, 0.1, 0.07, 0.04}) lattices.push_back({error, 5 * (1 - kappa * error)});
    return falls_short(lattices);
  };
  EXPECT_NEAR(found(1.7).value(), 1.7, 1e-12);
  EXPECT_NEAR(found(-1.7).value(), 1.7, 1e-12) << "supports are moved, or give way";
  EXPECT_EQ(found(0.3).value(), 1) << "an estimate that is too large may stay";
  EXPECT_FALSE(falls_short({{0.12, 4}}));
  EXPECT_FALSE(falls_short({{0.12, 4}, {0.115, 4.1}})) << "nearly the same estimate tells nothing";
  EXPECT_FALSE(falls_short({{0, 4}, {0, 4}})) << "no error";
  EXPECT_FALSE(falls_short({{0.12, 4}, {0.06, 1}, {0.05, 0.01}})) << "none is left";
}

TEST(RefinedCells, FollowALargeDisplacementWithAndWithoutPressures) {
  const Mesh body = test::mapped(test::cylinder(3, 6, 12), test::random_placement(4, 0.2));
  const VoxelGrid grid = test::halved_at_random(test::grid_about(body, 0.2), 2, 12);
  for (double nu : {0.25, 0.499}) {
    const Equilibrium e = bent(grid, body, "hybmss_avg", nu, true);
    const Equilibrium linear = bent(grid, body, "hybmss_avg", nu);
    EXPECT_NEAR(e.displacement.norm(), linear.displacement.norm(), 0.1 * linear.displacement.norm());
    EXPECT_NE(e.displacement.norm(), linear.displacement.norm());
  }
}

}  // namespace
}  // namespace springproof::msm_refined_cells_test
