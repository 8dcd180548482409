// One suite over the list of laws: what any force law must obey.
#include <gtest/gtest.h>

#include <set>

#include "meshes/volume.h"
#include "msm/cells/dispersion_weights.h"
#include "msm/exchange/springs_file.h"
#include "msm/laws/capabilities.h"
#include "msm/topology/cubic_lattice.h"
#include "support/tolerances.h"
#include "support/zoo.h"

namespace springproof::law_suite_test {
namespace {

struct Case {
  std::string name;
  MassSpringModel model;  ///< with the one law under test
  bool rotates;           ///< the law knows finite rotations
};

std::vector<Case> cases() {
  const Mesh mesh = test::notched_block();
  std::vector<Case> all;
  for (double nu : {-0.9, 0.0, 0.4, 0.499}) {
    const IsotropicMaterial material{1e4, nu, 1000};
    const std::string suffix = "_nu" + std::to_string(static_cast<int>(1000 * nu + 1000));
    for (double A : {0.0, 1.0, 2.0}) {
      ModelParameters p = test::model("hybmss");
      p.face_to_cube = A;
      const Network network = build_model(p, mesh, material).network;
      const std::string name = suffix + "_A" + std::to_string(static_cast<int>(A));
      all.push_back({"Springs" + name, {network, {Springs{}}}, true});
      all.push_back(
          {"Hourglass" + name, {network, {HourglassCorrection{shear_modulus(material), nu, A, true}}}, false});
      for (auto form : {VolumeEnergy::paper, VolumeEnergy::bounded})
        all.push_back({(form == VolumeEnergy::paper ? "VolumePaper" : "VolumeBounded") + name,
                       {network, {VolumeCorrection{kappa(material), form}}},
                       true});
      const double q = dispersed_fraction(lame_lambda(material), shear_modulus(material));
      all.push_back({"DispersionSymmetric" + name, {network, {MomentumDispersion{q}}}, true});
      all.push_back(
          {"DispersionFiniteStrain" + name, {network, {MomentumDispersion{q, Dispersion::finite_strain}}}, true});
      MomentumDispersion of_volumes{q, Dispersion::finite_strain};
      of_volumes.weight = volume_weights(network, volume_gradient(mesh), shear_modulus(material)).weight;
      of_volumes.group = volume_groups(network);
      all.push_back({"DispersionOfVolumes" + name, {network, {of_volumes}}, true});
      all.push_back({"DispersionShareWeighted" + name,
                     {network, {MomentumDispersion{q, Dispersion::share_weighted, spring_shares(network)}}},
                     true});
      all.push_back({"DispersionPublished" + name, {network, {MomentumDispersion{q, Dispersion::published}}}, true});
      all.push_back(
          {"DispersionTransposed" + name, {network, {MomentumDispersion{q, Dispersion::published_transposed}}}, true});
    }
  }
  const Network cut = test::cut_network(), refined = test::refined_network(),
                cells = cubic_lattice(mesh, CubicPattern{}),
                boxes = lattice_without_springs(test::notched_block(Vec3(0.5, 0.9, 0.35)));
  for (double nu : {-0.9, 0.0, 0.4, 0.499})
    for (double shift : {0.0, 0.5}) {
      const IsotropicMaterial material{1e4, nu, 1000};
      AveragedSprings law{shear_modulus(material), lame_lambda(material),
                          HourglassStiffness::of_pattern(2, nu, true, true, nu == 0), shift, nu / (1 - nu)};
      const std::string name = "Averaged_nu" + std::to_string(static_cast<int>(1000 * nu + 1000));
      if (shift > 0) {
        all.push_back({name + "_shifted", {cut, {law}}, false});
        continue;
      }
      for (int curve = 0; curve < 5; ++curve) {
        law.curve = static_cast<StrainCurve>(curve);
        all.push_back({name + "_curve" + std::to_string(curve), {cut, {law}}, true});
        if (curve == 0) all.push_back({name + "_refined", {refined, {law}}, true});
        all.push_back({name + "_full_curve" + std::to_string(curve), {cells, {law}}, true});
        all.push_back({name + "_boxes_curve" + std::to_string(curve), {boxes, {law}}, true});
      }
    }
  for (const auto& [name, network] : {std::pair("MeasuredCut", cut), std::pair("MeasuredFull", cells)}) {
    MeasuredCells measured;
    for (std::size_t c = 0; c < network.cells.size(); ++c) {
      const NodalVectors numbers = test::noise(108, 100, static_cast<unsigned>(c) + 1);
      const Eigen::Map<const DeformationForm> A(numbers.data());
      measured.add_form(A * A.transpose());
    }
    all.push_back({name, {network, {measured}}, true});
  }
  all.push_back({"Anchors", {cut, {Anchors{}}}, true});
  all.push_back({"AnchorsRefined", {refined, {Anchors{}}}, true});
  Network walls = refined;  // stiffer across, in a frame of their own
  for (Anchor& a : walls.anchors) a.stiffness += a.stiffness(0, 0) * Vec3(1, 2, 3) * Vec3(1, 2, 3).transpose();
  all.push_back({"AnchorsOfWalls", {walls, {Anchors{}}}, false});
  const Network sheet = test::bent_triangles();
  for (double beta : {-20.0, 100.0})
    all.push_back({"Angular" + std::string(beta < 0 ? "Negative" : "Positive"), {sheet, {AngularSprings{beta}}}, true});
  all.push_back({"SpringsOfASheet", {sheet, {Springs{}}}, true});
  return all;
}

TEST(LawSuiteCases, KeepTheirForcesInASpringsFile) {
  for (const Case& c : cases()) {
    if (c.model.network.cells.cut()) continue;  // files hold whole cubes
    SpringsFile file;
    file.model = c.model;
    file.model.laws.emplace_back(Springs{});
    if (std::holds_alternative<Springs>(c.model.laws[0])) file.model.laws.pop_back();
    const NodalVectors x = c.model.network.X + test::noise(c.model.network.nodes(), 0.01);
    const NodalVectors expected = forces(file.model, x);
    const SpringsFile read = parse_springs(springs_as_json(file), c.name);
    EXPECT_LE((forces(read.model, x) - expected).norm(), 1e-12 * expected.norm()) << c.name;
  }
}

TEST(LawSuiteCases, HaveEveryLawOfTheList) {
  std::set<std::size_t> tested;
  for (const Case& c : cases())
    for (const ForceLaw& law : c.model.laws) tested.insert(law.index());
  EXPECT_EQ(tested.size(), std::variant_size_v<ForceLaw>);
}

TEST(LawSuiteCases, SayWithTheirNameWhatTheyLack) {
  bool any = false;
  for (const Case& c : cases())
    for (const ForceLaw& law : c.model.laws)
      for (std::size_t what = 0; what < names_of(Capability{}).size(); ++what) {
        const std::string why = lacks(law, static_cast<Capability>(what));
        EXPECT_TRUE(why.empty() || why.starts_with(traits(law).name)) << why;
        any |= !why.empty();
      }
  EXPECT_TRUE(any);
}

TEST(LawSuiteCases, LackEnergyMomentumStepsWhereTheirForcesDoNotTurn) {
  for (const Case& c : cases()) {
    if (!can(c.model, Capability::large_displacements)) {
      EXPECT_FALSE(can(c.model, Capability::energy_momentum)) << c.name;
    }
    if (c.name != "AnchorsOfWalls") {  // their frame is that of a support that does not turn
      EXPECT_EQ(can(c.model, Capability::large_displacements), c.rotates) << c.name;
    }
  }
}

class LawSuite : public testing::TestWithParam<Case> {
 protected:
  const MassSpringModel& model() const { return GetParam().model; }
  const NodalVectors& X() const { return model().network.X; }
  double edge() const { return model().network.cells.edge; }
  NodalVectors disturbed() const { return X() + test::noise(X().rows(), 0.1 * edge()); }

  /// Largest force a displacement of the order of `disturbed` can cause.
  double force_scale() const { return forces(model(), disturbed()).cwiseAbs().maxCoeff(); }
};

TEST_P(LawSuite, HasNoForceAndNoEnergyAtRest) {
  EXPECT_LE(forces(model(), X()).cwiseAbs().maxCoeff(), test::round_off * force_scale());
  EXPECT_LE(std::abs(energy(model(), X())), test::round_off * std::abs(energy(model(), disturbed())));
}

TEST_P(LawSuite, ForcesAndTorquesSumToZero) {
  const NodalVectors x = disturbed(), f = forces(model(), x);
  Vec3 force = Vec3::Zero(), torque = Vec3::Zero();
  for (int n = 0; n < x.rows(); ++n) {
    force += f.row(n).transpose();
    if (GetParam().rotates) torque += Vec3(x.row(n)).cross(Vec3(f.row(n)));
  }
  EXPECT_LE(force.norm(), 1e-11 * force_scale());
  EXPECT_LE(torque.norm(), 1e-11 * force_scale() * 3 * edge());
}

TEST_P(LawSuite, RigidRotationLeavesNoForce) {
  if (!GetParam().rotates) {  // then an infinitesimal one must
    NodalVectors x = X();
    for (int n = 0; n < x.rows(); ++n) x.row(n) += 0.1 * Vec3(1, -2, 3).cross(Vec3(X().row(n))).transpose();
    EXPECT_LE(forces(model(), x).cwiseAbs().maxCoeff(), 1e-11 * force_scale());
    return;
  }
  const NodalVectors x = (X() * test::rotation().transpose()).rowwise() + Eigen::RowVector3d(1, 2, 3);
  EXPECT_LE(forces(model(), x).cwiseAbs().maxCoeff(), 1e-11 * force_scale());
}

TEST_P(LawSuite, ForceIsMinusTheGradientOfTheEnergy) {
  if (!can(model(), Capability::energy)) {
    EXPECT_EQ(energy(model(), disturbed()), 0);
    return;
  }
  const NodalVectors x = disturbed(), f = forces(model(), x);
  NodalVectors g(x.rows(), 3);
  const double h = 1e-5 * edge();
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    NodalVectors plus = x, minus = x;
    plus.data()[i] += h;
    minus.data()[i] -= h;
    g.data()[i] = (energy(model(), plus) - energy(model(), minus)) / (2 * h);
  }
  EXPECT_LE((f + g).norm(), test::finite_difference * f.norm());
}

TEST_P(LawSuite, TangentIsTheDerivativeOfTheForce) {
  const NodalVectors x = disturbed();
  const Tangent K = tangent(model(), x);
  const double h = 1e-5 * edge();
  double difference = 0, size = 0;
  Eigen::VectorXd column;
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    NodalVectors plus = x, minus = x;
    plus.data()[i] += h;
    minus.data()[i] -= h;
    const NodalVectors df = (forces(model(), plus) - forces(model(), minus)) / (2 * h);
    K.multiply(Eigen::VectorXd::Unit(x.size(), i), column);
    difference += (Eigen::Map<const Eigen::VectorXd>(df.data(), df.size()) + column).squaredNorm();
    size += column.squaredNorm();
  }
  EXPECT_LE(std::sqrt(difference), test::finite_difference * std::sqrt(size));
}

// Reciprocity: v K u = u K v where there is an energy, and only there (an unsymmetric tangent must say so).
TEST_P(LawSuite, TangentIsSymmetricIfThereIsAnEnergy) {
  const Tangent K = tangent(model(), disturbed());
  EXPECT_EQ(K.symmetric, can(model(), Capability::energy));
  const NodalVectors a = test::noise(X().rows(), 1, 7), b = test::noise(X().rows(), 1, 8);
  const Eigen::Map<const Eigen::VectorXd> u(a.data(), a.size()), v(b.data(), b.size());
  Eigen::VectorXd Ku, Kv;
  K.multiply(u, Ku);
  K.multiply(v, Kv);
  const double asymmetry = std::abs(v.dot(Ku) - u.dot(Kv)) / (Ku.norm() * v.norm());
  if (can(model(), Capability::energy))
    EXPECT_LE(asymmetry, 1e-14);
  else
    EXPECT_GE(asymmetry, 1e-6);
}

INSTANTIATE_TEST_SUITE_P(Laws, LawSuite, testing::ValuesIn(cases()), [](const auto& i) { return i.param.name; });

}  // namespace
}  // namespace springproof::law_suite_test
