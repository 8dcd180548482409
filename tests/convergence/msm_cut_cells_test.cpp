// What cut cells are for: bodies that lie anyhow in the lattice.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <numbers>

#include "meshes/locate/locate.h"
#include "meshes/mesher/mesher.h"
#include "meshes/volume.h"
#include "msm/embedding/boundary.h"
#include "msm/models.h"
#include "msm/statics/equilibrium.h"
#include "support/solids.h"
#include "support/zoo.h"

namespace springproof::msm_cut_cells_test {
namespace {

using std::numbers::pi;

double rms(const std::vector<double>& values) {
  double sum = 0;
  for (double v : values) sum += v * v;
  return std::sqrt(sum / static_cast<double>(values.size()));
}

/// The cubes that stand for a cut body where a mesh is asked for.
Mesh cubes_of(const CutBody& cut, const Mesh& body) { return voxelise(cut.grid, body).mesh; }

/// Largest difference of the strain of a cell from that of uniform stress, relative.
double uniform_stress_error(const Mesh& body, double edge, double nu, double shift) {
  const IsotropicMaterial material{1, nu, 1};
  ModelParameters p = test::model("hybmss_bt");
  p.shift = shift;
  const CutBody cut = cut_body(test::grid_about(body, edge), body);
  const EmbeddedModel built = build_cut(p, cut, {}, Mesh{}, material);
  Eigen::Matrix3d stress;
  stress << 1, 0.3, -0.2, 0.3, -0.5, 0.4, -0.2, 0.4, 0.2;
  const Eigen::Matrix3d strain = (1 + nu) * stress - nu * stress.trace() * Eigen::Matrix3d::Identity();
  const Network& network = built.model.network;
  BoundaryConditions bc{std::vector<char>(network.X.size(), 0), std::vector<int>(network.X.size(), -1),
                        NodalVectors::Zero(network.nodes(), 3), built.embedding.patches.at("surface").normal * stress};
  hold_free_motions(network.X, bc);
  const Equilibrium e = solve_linear(built.model, bc);
  EXPECT_TRUE(e.ok) << e.message;
  double energy_off = 0, energy = 0;
  for (std::size_t c = 0; c < network.cells.size(); ++c) {
    const auto g = mean_gradients({edge, network.cells.filled[c]});
    Eigen::Matrix3d H = Eigen::Matrix3d::Zero();
    for (int n = 0; n < 8; ++n) H += e.displacement.row(network.cells.corners[c][n]).transpose() * g[n].transpose();
    energy_off += network.cells.filled[c].fraction * ((H + H.transpose()) / 2 - strain).squaredNorm();
    energy += network.cells.filled[c].fraction * strain.squaredNorm();
  }
  return std::sqrt(energy_off / energy);
}

TEST(CutCells, UniformStressIsExactInASphere) {
  for (double nu : {-0.5, 0.0, 0.25, 0.45, 0.499})
    for (unsigned seed : {1u, 2u, 3u}) {
      const double edge = 1.0 / 3;  // three cells across
      const Mesh body = test::mapped(test::ball_of_tetrahedra(8), test::random_placement(seed, edge));
      EXPECT_LE(uniform_stress_error(body, edge, nu, 0), 6e-3) << "nu = " << nu << ", place " << seed;
    }
}

/// Stiffness of a slice of a round bar, one cell thick, in bending about y or in torsion, over the exact one.
/// Displacements of its faces differ by those of the mode and are else the same.
double section_stiffness(double across, unsigned seed, double nu, bool torsion) {
  const double l = 1 / across;
  const IsotropicMaterial material{1, nu, 1};
  test::Placement place = test::random_placement(seed, l);
  const double turn = 6.28 * place.turn(0, 0);
  const Mesh body = test::mapped(test::cylinder(l, 32, 1), [&](const Vec3& x) -> Vec3 {
    return Eigen::AngleAxisd(turn, Vec3::UnitZ()) * x + Vec3(place.offset[0], place.offset[1], 0);
  });
  const CutBody cut = cut_body(test::grid_about(body, l), body);
  const EmbeddedModel built = build_cut(test::model("hybmss_bt"), cut, {}, Mesh{}, material);
  const Network& network = built.model.network;
  const int n = network.nodes();
  // The axis of the section, and the node below each of the upper face.
  Vec3 axis = Vec3::Zero();
  double volume = 0;
  for (std::size_t c = 0; c < cut.cells.size(); ++c) {
    axis += cut.cells[c].filled.fraction * (cut.centre(static_cast<int>(c)) + l * cut.cells[c].filled.mean);
    volume += cut.cells[c].filled.fraction;
  }
  axis /= volume;
  std::vector<int> below(n), number(n, -1);
  int free = 0;
  for (int i = 0; i < n; ++i) {
    below[i] = i;
    for (int j = 0; j < n; ++j)
      if (network.X(i, 2) > l / 2 && network.X(j, 2) < l / 2 &&
          (network.X.row(i) - network.X.row(j)).head<2>().norm() < l / 10)
        below[i] = j;
    if (below[i] == i) number[i] = free++;
  }
  Eigen::MatrixXd T = Eigen::MatrixXd::Zero(3 * n, 3 * free);
  Eigen::VectorXd mode = Eigen::VectorXd::Zero(3 * n);
  for (int i = 0; i < n; ++i) {
    T.block<3, 3>(3 * i, 3 * number[below[i]]).setIdentity();
    if (below[i] == i) continue;
    const double x = network.X(i, 0) - axis[0], y = network.X(i, 1) - axis[1];
    mode.segment<3>(3 * i) = torsion ? Vec3(-l * y, l * x, 0) : Vec3(-l * l / 2, 0, l * x);
  }
  const Tangent K = tangent(built.model, network.X);
  Eigen::MatrixXd dense(3 * n, 3 * n);
  Eigen::VectorXd column;
  for (int i = 0; i < 3 * n; ++i) {
    K.multiply(Eigen::VectorXd::Unit(3 * n, i), column);
    dense.col(i) = column;
  }
  const Eigen::VectorXd w =
      -(T.transpose() * dense * T).completeOrthogonalDecomposition().solve(T.transpose() * (dense * mode));
  const Eigen::VectorXd u = mode + T * w;
  const double stiffness = u.dot(dense * u) / l, area = pi / 4;
  const double exact = torsion ? shear_modulus(material) * area * area / (2 * pi) : area * area / (4 * pi);
  return stiffness / exact;
}

TEST(CutCells, RoundSectionsOfTwoCellsHaveTheirStiffness) {
  for (double nu : {0.0, 0.25, 0.45, 0.499})
    for (bool torsion : {false, true}) {
      std::vector<double> off;
      for (unsigned seed = 1; seed <= 8; ++seed) off.push_back(section_stiffness(2, seed, nu, torsion) - 1);
      EXPECT_LE(rms(off), 0.01) << "nu = " << nu << (torsion ? ", torsion" : ", bending");
    }
}

/// A round cantilever of unit diameter, four long, lying anyhow, of cut cells.
struct Cantilever {
  CutBody cut;
  Mesh cubes;
  Vec3 across_axis;

  Cantilever(const Mesh& straight, double across, unsigned seed) {
    const test::Placement place = test::random_placement(seed, 1 / across);
    const Mesh body = test::mapped(straight, place);
    cut = cut_body(test::grid_about(body, 1 / across), body);
    cubes = cubes_of(cut, body);
    across_axis = place.turn * Vec3::UnitX();
  }
};

/// Displacement of its tip under a unit force across its end.
double tip(const Cantilever& cantilever, double nu, double shift, Equilibrium& e) {
  const auto& [cut, cubes, across_axis] = cantilever;
  const IsotropicMaterial material{1, nu, 1};
  ModelParameters p = test::model("hybmss_bt");
  p.shift = shift;
  const EmbeddedModel built = build_cut(p, cut, {"z_min"}, cubes, material);
  const std::vector<Load> loads = {PrescribedDisplacement{"z_min", {0.0, 0.0, 0.0}}, PatchForce{"z_max", across_axis}};
  const BoundaryConditions bc = transfer(loads, cubes, built.embedding, built.model.network, 1, Kinematics::linear);
  e = solve_linear(built.model, bc);
  EXPECT_TRUE(e.ok) << e.message;
  const Eigen::VectorXd& share = built.embedding.patches.at("z_max").area;
  return (share.transpose() * e.displacement / share.sum()).dot(across_axis);
}

/// Own 27-node elements on a fitted mesh, three levels; the program's quadratic tetrahedra agree to .1 %.
double exact_tip(double nu) { return nu == 0 ? 446.31 : nu == 0.25 ? 444.55 : nu == 0.45 ? 435.6 : 431.9; }

TEST(CutCells, CantileversThatLieAnyhowBendAsTheyShould) {
  const Mesh straight = test::cylinder(4, 12, 24);
  struct Bound {
    double across, plain, shifted;
  };
  for (const Bound& bound : {Bound{2, 0.13, 0.08}, Bound{3, 0.07, 0.035}, Bound{4, 0.045, 0.021}}) {
    std::vector<Cantilever> cantilevers;
    for (unsigned seed = 1; seed <= 8; ++seed) cantilevers.emplace_back(straight, bound.across, seed);
    for (double nu : {0.0, 0.25, 0.45, 0.499}) {
      std::vector<double> plain, shifted;
      Equilibrium e;
      for (const Cantilever& cantilever : cantilevers) {
        plain.push_back(tip(cantilever, nu, 0, e) / exact_tip(nu) - 1);
        shifted.push_back(tip(cantilever, nu, 0.4, e) / exact_tip(nu) - 1);
      }
      EXPECT_LE(rms(plain), bound.plain) << bound.across << " cells across, nu = " << nu;
      EXPECT_LE(rms(shifted), bound.shifted) << bound.across << " cells across, nu = " << nu << ", shifted";
    }
  }
}

TEST(CutCells, SupportsAndLoadsBalanceToRoundOff) {
  const Mesh straight = test::cylinder(4, 8, 16);
  Equilibrium e;
  tip(Cantilever(straight, 3, 4), 0.45, 0, e);
  const Vec3 sum = e.support.colwise().sum().transpose();
  EXPECT_NEAR(sum.norm(), 1, 1e-8);
}

// The largest frequency by power iteration, with an eighth of a cell's mass in each corner, against that of one full
// cell: the step of whole cubes is safe.
TEST(CutCells, TheSafeStepIsThatOfFullCells) {
  for (double nu : {0.0, 0.25, 0.45, 0.499})
    for (unsigned seed : {1u, 2u, 3u}) {
      const double l = 1.0 / 3;
      const Mesh body = test::mapped(test::cylinder(3, 8, 12), test::random_placement(seed, l));
      const EmbeddedModel built =
          build_cut(test::model("hybmss_bt"), cut_body(test::grid_about(body, l), body), {}, Mesh{}, {1, nu, 1});
      const Network& network = built.model.network;
      const Tangent K = tangent(built.model, network.X);
      Eigen::VectorXd v = flat(test::noise(network.nodes(), 1)), Kv;
      double body_eigenvalue = 0;
      for (int i = 0; i < 200; ++i) {
        K.multiply(v.normalized().eval(), Kv);
        for (int n = 0; n < network.nodes(); ++n) Kv.segment<3>(3 * n) /= network.volume[n];
        body_eigenvalue = Kv.norm();
        v = Kv;
      }
      const Eigen::Matrix<double, 24, 24> cell = averaged_springs_of(built.model)->cell_matrix({l}) * 8 / (l * l * l);
      const double of_cell = cell.selfadjointView<Eigen::Lower>().eigenvalues().maxCoeff();
      EXPECT_LE(std::sqrt(body_eigenvalue / of_cell), 1 / 0.9) << "nu = " << nu << ", place " << seed;
    }
}

/// Standard deviation over the mean.
double spread(std::vector<double> values) {
  double mean = 0;
  for (double x : values) mean += x / static_cast<double>(values.size());
  for (double& x : values) x = x / mean - 1;
  return rms(values);
}

// Eight places of the lattice, at random; in whole cubes the head moves by several percent.
TEST(CutCells, ThePlaceInTheLatticeDoesNotMatterToARabbit) {
  MeshRequest request;
  request.file = SPRINGPROOF_SOURCE_DIR "/meshes/geo/rabbit.geo";
  request.size = {0.2, 0.12, 0.25};
  request.tetrahedra = 12000;
  const Mesh body = mesh_body(request).mesh;
  const double edge = std::cbrt(volume(body, body.nodes) / 1500);
  std::vector<double> head, head_of_cubes;
  for (unsigned seed = 1; seed <= 8; ++seed) {
    VoxelGrid grid = voxel_grid(body, edge);
    grid.origin -= test::random_placement(seed, edge).offset;
    for (int& n : grid.cells) ++n;
    const CutBody cut = cut_body(grid, body);
    const Mesh cubes = cubes_of(cut, body);
    const IsotropicMaterial material{1e4, 0.25, 1000};
    const std::vector<Load> loads = {PrescribedDisplacement{"feet", {0.0, 0.0, 0.0}},
                                     PatchForce{"head", Vec3(-0.1, 0, 0)}};
    const auto solved = [&](const EmbeddedModel& built) {
      const Equilibrium e = solve_linear(
          built.model, transfer(loads, cubes, built.embedding, built.model.network, 1000, Kinematics::linear));
      EXPECT_TRUE(e.ok) << e.message;
      return e;
    };
    const Equilibrium e = solved(build_cut(test::model("hybmss_bt"), cut, {"feet"}, cubes, material));
    const Location at = Locator(cubes)(Vec3(0.15, 0.06, 0.16));
    const Equilibrium of_cubes = solved(build_embedded(test::model("hybmss_bt"), cubes, material));
    double moved = 0;
    for (int n = 0; n < 8; ++n) moved += at.shape[n] * of_cubes.displacement(cubes.hexahedra[at.cell][n], 0);
    head_of_cubes.push_back(moved);
    EXPECT_LE(e.iterations, 2 * of_cubes.iterations);
    head.push_back(displacement_at(cut, e.displacement, NodalVectors(Eigen::RowVector3d(0.15, 0.06, 0.16)))(0, 0));
  }
  EXPECT_LE(spread(head), 0.01);
  EXPECT_GE(spread(head_of_cubes), 0.015);
}

// The bar of a turned cylinder, held at one end and pulled aside at the other.
TEST(CutCells, NeedAtMostTwiceTheIterationsOfWholeCubes) {
  const double l = 0.125;
  const Mesh body = test::mapped(test::cylinder(4, 8, 24), test::random_placement(4, l));
  const CutBody cut = cut_body(test::grid_about(body, l), body);
  const Mesh cubes = cubes_of(cut, body);
  const std::vector<Load> loads = {PrescribedDisplacement{"z_min", {0.0, 0.0, 0.0}},
                                   PatchForce{"z_max", Vec3(1e-3, 2e-3, 0)}};
  for (const double nu : {-0.5, 0.0, 0.25, 0.45, 0.49, 0.499}) {
    const auto iterations = [&](const EmbeddedModel& built) {
      const Equilibrium e = solve_linear(
          built.model, transfer(loads, cubes, built.embedding, built.model.network, 1, Kinematics::linear));
      EXPECT_TRUE(e.ok) << e.message;
      return e.iterations;
    };
    const int of_cut = iterations(build_cut(test::model("hybmss_bt"), cut, {"z_min"}, cubes, {1, nu, 1}));
    const int of_cubes = iterations(build_embedded(test::model("hybmss_bt"), cubes, {1, nu, 1}));
    RecordProperty("nu" + std::to_string(nu), std::to_string(of_cut) + " " + std::to_string(of_cubes));
    EXPECT_LE(of_cut, 2 * of_cubes) << nu;
    EXPECT_LE(of_cut, 40) << nu;
  }
}

/// The largest unbalanced force of a cut body in a homogeneous state F x, under the traction of its stress on the
/// surface at rest, over the largest force of the surface.
double finite_patch_error(const Mesh& body, double edge, double nu, StrainCurve curve, const Eigen::Matrix3d& F) {
  ModelParameters p = test::model("hybmss_avg");
  p.curve = curve;
  const EmbeddedModel built = build_cut(p, cut_body(test::grid_about(body, edge), body), {}, Mesh{}, {1, nu, 1});
  const MassSpringModel& model = built.model;
  const AveragedSprings& law = *averaged_springs_of(model);
  StrainEnergy W = springs_energy(curve, law.shear_modulus, F, Derivative::first);
  add_volume_term(curve, law.lame_lambda - law.shear_modulus, F, Derivative::first, W);
  const NodalVectors load = built.embedding.patches.at("surface").normal * W.stress.transpose();
  return (forces(model, model.network.X * F.transpose()) + load).rowwise().norm().maxCoeff() /
         load.rowwise().norm().maxCoeff();
}

// But for pieces of less than a thousandth of a cube, which are left out.
TEST(CutCells, HomogeneousLargeStrainIsExact) {
  Eigen::Matrix3d F;
  F << 1.2, 0.3, -0.1, 0.05, 0.9, 0.2, -0.2, 0.1, 1.1;
  const Mesh body = test::mapped(test::cylinder(3, 8, 12), test::random_placement(5, 1.0 / 3));
  for (double nu : {-0.5, 0.25, 0.499})
    for (int curve = 0; curve < 5; ++curve)
      EXPECT_LE(finite_patch_error(body, 1.0 / 3, nu, static_cast<StrainCurve>(curve), F), 1e-3) << nu << ' ' << curve;
}

// The lattice kernels' model and the averaged springs differ in the energy of xi_x xi_y xi_z and at corners, and the
// anchors give way a little.
TEST(CutCells, ABlockIsNearlyThatOfTheLattice) {
  const IsotropicMaterial material{1, 0.4, 1};
  const Mesh cubes = block_mesh({1, 1, 4}, {4, 4, 16}), body = test::solid_of(cubes);
  const CutBody cut = cut_body(voxel_grid(body, 0.25), body);
  const std::vector<Load> loads = {PrescribedDisplacement{"z_min", {0.0, 0.0, 0.0}},
                                   PatchForce{"z_max", Vec3(1, 0, 0)}};
  const auto tip_of = [&](const EmbeddedModel& built) {
    const BoundaryConditions bc = transfer(loads, cubes, built.embedding, built.model.network, 1, Kinematics::linear);
    const Equilibrium e = solve_linear(built.model, bc);
    EXPECT_TRUE(e.ok) << e.message;
    const NodalVectors u = built.embedding.weights * e.displacement;
    const Eigen::VectorXd share = nodal_areas(cubes, patch(cubes, "z_max"));
    return u.col(0).dot(share) / share.sum();
  };
  const double lattice = tip_of(build_embedded(test::model("hybmss_bt"), cubes, material));
  EXPECT_NEAR(tip_of(build_cut(test::model("hybmss_bt"), cut, {"z_min"}, cubes, material)), lattice, 0.02 * lattice);
}

}  // namespace
}  // namespace springproof::msm_cut_cells_test
