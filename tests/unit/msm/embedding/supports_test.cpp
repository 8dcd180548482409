// Supports of cut cells: three anchors for the part of a patch in each cell.
#include "msm/embedding/supports.h"

#include <gtest/gtest.h>

#include "msm/models.h"
#include "msm/statics/equilibrium.h"
#include "support/solids.h"
#include "support/zoo.h"

namespace springproof::supports_test {
namespace {

CutBody cut_of(const Mesh& body, double edge) { return cut_body(test::grid_about(body, edge), body); }

/// A sheet in the plane z = 0.5 within one layer of cubes of edge 1, of x from 0 to `length` and y from 0 to 2.
Mesh sheet(double length, double thickness) {
  return test::mapped(test::solid_of(block_mesh({length, 2, thickness}, {static_cast<int>(length), 2, 1})),
                      [&](const Vec3& x) -> Vec3 { return x + Vec3(0, 0, (1 - thickness) / 2); });
}

/// sum d.K d/2, d = sum w_a u(X_a), of a displacement field.
template <class Field>
double energy_of(const std::vector<Anchor>& anchors, const CutBody& body, const Field& field) {
  double sum = 0;
  for (const Anchor& a : anchors) {
    Vec3 u = Vec3::Zero();
    for (int n = 0; n < 8; ++n) u += a.weights[n] * field(Vec3(body.points.row(a.corners[n]).transpose()));
    sum += u.dot(a.stiffness * u) / 2;
  }
  return sum;
}

TEST(PatchAnchors, WeightsSumToOneAndMeetAtPointsOfThePatch) {
  const double edge = 1.0 / 3;
  const test::Placement place = test::random_placement(4, edge);
  const Mesh bar = test::mapped(test::cylinder(2, 8, 8), place);
  const CutBody body = cut_of(bar, edge);
  const std::vector<Anchor> anchors = anchors_of_patch(body, "z_min", {{7, 0.4, 1}});
  ASSERT_EQ(anchors.size(), anchors_of_part * body.patches.at("z_min").size());
  Eigen::Matrix3d stiffness = Eigen::Matrix3d::Zero();
  for (const Anchor& a : anchors) {
    double sum = 0;
    for (const double w : a.weights) sum += w;
    EXPECT_NEAR(sum, 1, 1e-12);
    const Vec3 off = anchored_point(a, body.points) - place.offset;
    EXPECT_NEAR(off.dot(place.turn.col(2)), 0, 1e-10);
    EXPECT_LT(off.norm(), 0.5 + edge);
    stiffness += a.stiffness;
  }
  double area = 0;
  for (const PatchInCell& p : body.patches.at("z_min")) area += p.total_area();
  const Vec3 expected(7.007, 7.007, 15.007);  // 7 (1 - nu) / ((1 + nu) (1 - 2 nu)) across, and a thousandth
  const Eigen::Matrix3d K = place.turn.transpose() * stiffness * place.turn;
  EXPECT_LE((K - anchor_stiffness * area / edge * Eigen::Matrix3d(expected.asDiagonal())).norm(), 1e-9 * K.norm());
}

// The face x = 0 of a sheet turns about its middle line: one layer of cells alone holds that, with the spread
// 1/sqrt(12) of its thickness; of a wide face each cell holds a ninth of its own share.
TEST(PatchAnchors, ShareTheTurnOfAPatchBetweenLayers) {
  const double E = 3;
  const auto turned = [](double middle) { return [=](const Vec3& x) -> Vec3 { return {x[2] - middle, 0, 0}; }; };
  for (const double thickness : {1.0, 0.5}) {
    const CutBody body = cut_of(sheet(3, thickness), 1);
    const double area = 2 * thickness, expected = anchor_stiffness / 2 * E * area * thickness * thickness / 12;
    EXPECT_NEAR(energy_of(anchors_of_patch(body, "x_min", {{E, 0, 1}}), body, turned(0.5)), expected, 1e-6 * expected);
  }
  const CutBody wide = cut_of(test::solid_of(block_mesh({2, 5, 5}, {2, 5, 5})), 1);
  std::vector<Anchor> middle;
  for (const Anchor& a : anchors_of_patch(wide, "x_min", {{E, 0, 1}})) {
    Vec3 centre = Vec3::Zero();
    for (const int n : a.corners) centre += wide.points.row(n).transpose() / 8;
    if ((centre - Vec3(0.5, 2.5, 2.5)).norm() < 1e-9) middle.push_back(a);
  }
  ASSERT_EQ(middle.size(), anchors_of_part);
  const double expected = anchor_stiffness / 2 * E / 12 / 81;
  EXPECT_NEAR(energy_of(middle, wide, turned(2.5)), expected, 1e-6 * expected);
}

/// Deflection of a sheet, 8 long, clamped at x = 0, under a force across its end, over that of a beam.
double deflection(double thickness, double nu) {
  const IsotropicMaterial material{1, nu, 1};
  const Mesh body = sheet(8, thickness);
  const CutBody cut = cut_of(body, 1);
  const Mesh cubes = voxelise(cut.grid, body).mesh;
  const EmbeddedModel built = build_cut(test::model("hybmss_avg"), cut, {"x_min"}, cubes, material);
  const BoundaryConditions bc =
      transfer({PrescribedDisplacement{"x_min", {0.0, 0.0, 0.0}}, PatchForce{"x_max", Vec3(0, 0, 1)}}, cubes,
               built.embedding, built.model.network, 1, Kinematics::linear);
  const Equilibrium e = solve_linear(built.model, bc);
  EXPECT_TRUE(e.ok) << e.message;
  const PatchShares& end = built.embedding.patches.at("x_max");
  const double w = e.displacement.col(2).dot(end.area) / end.area.sum();
  return w / (8 * 8 * 8 / (3 * 2 * std::pow(thickness, 3) / 12));
}

// Means alone leave the hinge: singular.  At nu > 0 the clamped width stiffens by a percent or two.
TEST(PatchAnchors, ClampASheetOfOneLayer) {
  for (const double thickness : {0.5, 0.9}) {
    EXPECT_NEAR(deflection(thickness, 0), 1, 0.03) << thickness;
    EXPECT_NEAR(deflection(thickness, 0.3), 1, 0.05) << thickness;
  }
}

}  // namespace
}  // namespace springproof::supports_test
