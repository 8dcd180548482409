// Parts of a model, held to the forces of the whole; pressures, held to its tangent.
#include <gtest/gtest.h>

#include <algorithm>

#include "msm/distribution/model_part.h"
#include "msm/distribution/pressure_form.h"
#include "msm/parameters/calibrate.h"
#include "support/two_materials.h"
#include "support/zoo.h"

namespace springproof::model_part_test {
namespace {

const IsotropicMaterial material{1e4, 0.4, 1000};

Mesh steps() {
  return test::voxels_of(block_mesh(0.1 * Vec3(5, 4, 6), {5, 4, 6}), [](int i, int, int k) { return i + k < 8; });
}

MassSpringModel cut(const std::string& name) {
  MassSpringModel model{test::refined_network(), {AveragedSprings{4000, 16000}, Anchors{}}, false};
  if (name == "cut cells") {
    model.network = test::cut_network();
    model.laws[0] = AveragedSprings{4000, 16000, {1, 0.1, 0.2, 0.1, 0.3}, 0.5, 0.6};
  }
  return model;
}

/// In one of them springs bear the volume, in the others pressures may.
MassSpringModel of_three_materials(const std::string& name) {
  const std::vector<IsotropicMaterial> others = {{3e5, 0.49, 1000}, {1e3, 0.1, 1000}};
  if (!name.ends_with("bonds")) {
    Mesh mesh = steps();
    for (std::size_t c = 0; c < mesh.hexahedra.size(); ++c) mesh.materials.push_back(c % 3);
    return build_embedded(test::model("hybmss"), mesh, material, nullptr, others).model;
  }
  const Mesh body = test::with_materials(test::solid_of(block_mesh(Vec3(5, 4, 2), {5, 4, 2})), [](const Vec3& x) {
    return x[0] < 2 ? 0 : x[1] < 2 ? 1 : 2;
  });
  const CutBody cells = cut_body({Vec3(-0.3, -0.2, -0.4), 1, {6, 5, 3}}, body);
  return build_cut(test::model("hybmss_avg"), cells, {"x_min"}, Mesh{}, material, others).model;
}

MassSpringModel whole(const std::string& name) {
  if (name.starts_with("three materials")) return of_three_materials(name);
  if (name.ends_with("cells")) return cut(name);
  if (name == "angular") return {test::bent_triangles(), {Springs{}, AngularSprings{20}}, false};
  return build_model(test::model(name), steps(), material);
}

class Parts : public testing::TestWithParam<std::string> {};

INSTANTIATE_TEST_SUITE_P(Models, Parts,
                         testing::Values("hybmss", "hybmss_bt", "hybmss_avg", "emsm", "msm_18", "emsm_random",
                                         "emsm_patch", "msm_random", "emsm_centred", "cut cells", "refined cells",
                                         "angular", "three materials", "three materials and bonds"),
                         [](const auto& p) {
                           std::string name = p.param;
                           std::replace(name.begin(), name.end(), ' ', '_');
                           return name;
                         });

/// Nodes in three groups by their places, and some at random.
int group_of(const NodalVectors& X, int node) {
  if (node % 11 == 0) return node % 3;
  const double low = X.col(0).minCoeff(), span = X.col(0).maxCoeff() - low;
  return std::min(2, static_cast<int>(3 * (X(node, 0) - low) / span));
}

TEST_P(Parts, HaveTheRowsOfTheWholeOfTheirOwnNodes) {
  const MassSpringModel model = whole(GetParam());
  const Eigen::VectorXd u = flat(test::noise(model.network.nodes(), 1));
  Eigen::VectorXd Ku, of_part;
  tangent(model, model.network.X).multiply(u, Ku);
  int compared = 0;
  for (int group = 0; group < 3; ++group) {
    std::vector<char> own(model.network.nodes());
    for (int n = 0; n < model.network.nodes(); ++n) own[n] = group_of(model.network.X, n) == group;
    const ModelPart part = part_of(model, own);
    tangent(part.model, part.model.network.X).multiply(u, of_part);
    for (int n = 0; n < model.network.nodes(); ++n)
      if (own[n]) {
        EXPECT_LE((of_part.segment<3>(3 * n) - Ku.segment<3>(3 * n)).norm(), 1e-12 * Ku.norm());
        ++compared;
      }
  }
  EXPECT_EQ(compared, model.network.nodes());
}

TEST_P(Parts, AndPressuresGiveTheStiffnessOfTheWhole) {
  const MassSpringModel model = whole(GetParam());
  if (!(volume_stiffness_ratio(model) > 0)) GTEST_SKIP() << "no volume term";
  const PressureForm form = pressure_form(model);
  const Eigen::VectorXd u = flat(test::noise(model.network.nodes(), 1));
  Eigen::VectorXd Ku, mixed;
  tangent(model, model.network.X).multiply(u, Ku);
  tangent(form.springs, model.network.X).multiply(u, mixed);
  Eigen::VectorXd p = form.B * u;
  for (Eigen::Index i = 0; i < p.size(); ++i) p[i] = form.C[i] > 0 ? p[i] / form.C[i] : 0;
  mixed += form.B.transpose() * p;
  EXPECT_LE((mixed - Ku).norm(), 1e-12 * Ku.norm());
}

TEST(ModelPart, RefusesForcesWithoutAnEnergy) {
  ModelParameters p = test::model("emsm");
  p.dispersion = Dispersion::published;
  const MassSpringModel model = build_model(p, steps(), material);
  EXPECT_THROW(part_of(model, std::vector<char>(model.network.nodes(), 1)), std::invalid_argument);
}

TEST(ModelPart, KeepsOnlyWhatActsOnItsNodes) {
  const MassSpringModel model = whole("hybmss_bt");
  std::vector<char> own;
  for (Eigen::Index n = 0; n < model.network.X.rows(); ++n) own.push_back(model.network.X(n, 0) < 0.05);
  const ModelPart part = part_of(model, own);
  EXPECT_EQ(part.model.network.nodes(), model.network.nodes());
  for (const Spring& s : part.model.network.springs) EXPECT_TRUE(own[s.i] || own[s.j]) << s.i << ' ' << s.j;
  EXPECT_EQ(part.cells.size(), 24u);  // of 4 x 6 at x = 0
}

}  // namespace
}  // namespace springproof::model_part_test
