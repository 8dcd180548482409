// Springs files of bodies of several materials: written and read back with their bonds.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "meshes/voxels/voxelise.h"
#include "msm/dynamics/time_step.h"
#include "msm/embedding/supports.h"
#include "msm/exchange/anchored_springs.h"
#include "msm/exchange/springs_file.h"
#include "msm/models.h"
#include "msm/statics/equilibrium.h"
#include "problem/system/input_error.h"
#include "support/says.h"
#include "support/two_materials.h"
#include "support/zoo.h"

namespace springproof::springs_of_materials_test {
namespace {

const IsotropicMaterial around{1e4, 0.3, 1100}, inside{1e6, 0.48, 1900};

SpringsFile written() {
  const Mesh body = test::ball_in_cube(2, {0.1, 0.05, 0});
  const CutBody cut = cut_body({Vec3::Constant(-2), 0.7, {6, 6, 6}}, body);
  SpringsFile file;
  file.density = around.density;
  file.material = around;
  file.regions = {{"ball", inside}};
  file.model = build_cut(test::model("hybmss_avg"), cut, {}, Mesh{}, around, {inside}).model;
  file.volumes = embed(cut, {}, file.model.network, Mesh{}).volumes;
  return file;
}

TEST(SpringsOfMaterials, AreReadAsTheyWereWritten) {
  const SpringsFile file = written();
  const SpringsFile read = parse_springs(springs_as_json(file), "own.json");
  const Network &a = file.model.network, &b = read.model.network;
  EXPECT_FALSE(a.bonds.empty());
  EXPECT_EQ(b.bonds.size(), a.bonds.size());
  EXPECT_EQ(b.cells.materials, a.cells.materials);
  EXPECT_LT((b.volume - a.volume).norm(), 1e-14 * a.volume.norm());
  EXPECT_LT((masses(b, read.density) - masses(a, file.density)).norm(), 1e-14 * masses(a, file.density).norm());
  ASSERT_EQ(read.regions.size(), 1u);
  EXPECT_EQ(read.regions[0].name, "ball");
  EXPECT_EQ(read.regions[0].material.density, inside.density);
  const NodalVectors x = a.X + test::noise(a.nodes(), 0.01);
  const NodalVectors ours = forces(file.model, x);
  EXPECT_LE((forces(read.model, x) - ours).cwiseAbs().maxCoeff(), 1e-12 * ours.cwiseAbs().maxCoeff());
  const double step = safe_time_step(file.model, file.density);
  EXPECT_NEAR(safe_time_step(read.model, read.density), step, 1e-9 * step);
}

TEST(SpringsOfMaterials, BendLikeTheModelTheyCameFrom) {
  const Mesh body = test::layered_block({2, 2, 3}, {2, 2, 6}, 2, 1.45);
  const CutBody cut = cut_body({Vec3(-0.13, -0.21, -0.17), 0.5, {5, 5, 7}}, body);
  const Mesh cubes = voxelise(cut.grid, body).mesh;
  SpringsFile file;
  file.density = around.density;
  file.material = around;
  file.regions = {{"upper", inside}};
  file.model = build_cut(test::model("hybmss_avg"), cut, {}, Mesh{}, around, {inside}).model;
  const Embedding loads_of = embed(cut, {}, file.model.network, Mesh{});
  file.loads = loads_of.patches;
  file.volumes = loads_of.volumes;
  file.anchors["z_min"] = anchors_of_patch(cut, "z_min", {around, inside});
  const std::vector<Load> loads = {PrescribedDisplacement{"z_min", {0.0, 0.0, 0.0}}, PatchForce{"z_max", Vec3(1, 2, 3)},
                                   Gravity{Vec3(3, -2, 1)}};
  const auto solved = [&](const MassSpringModel& model, const Embedding& embedding) {
    const Equilibrium e =
        solve_linear(model, transfer(loads, cubes, embedding, model.network, around.density, Kinematics::linear));
    EXPECT_TRUE(e.ok) << e.message;
    return e;
  };
  const EmbeddedModel built = build_cut(test::model("hybmss_avg"), cut, {"z_min"}, cubes, around, {inside});
  const auto [model, embedding] = anchored(parse_springs(springs_as_json(file), "own"), {"z_min"}, cubes);
  ASSERT_FALSE(model.network.bonds.empty());
  const Equilibrium ours = solved(built.model, built.embedding), theirs = solved(model, embedding);
  EXPECT_LT((theirs.displacement - ours.displacement).norm(), 1e-9 * ours.displacement.norm());
  EXPECT_LT((theirs.support - ours.support).norm(), 1e-8 * ours.support.norm());
  const NodalVectors of_mesh = built.embedding.weights * ours.displacement;
  EXPECT_LT((embedding.weights * theirs.displacement - of_mesh).norm(), 1e-9 * of_mesh.norm());
}

TEST(SpringsOfMaterials, AreRefusedWithTheirPlace) {
  const nlohmann::json good = nlohmann::json::parse(springs_as_json(written()));
  const auto message = [&](const nlohmann::json& change) {
    nlohmann::json document = good;
    for (const auto& [pointer, value] : change.items()) document[nlohmann::json::json_pointer(pointer)] = value;
    try {
      parse_springs(document.dump(), "own.json");
    } catch (const InputError& e) {
      return std::string(e.what());
    }
    return std::string("accepted");
  };
  EXPECT_EQ(message({{"/grip_m", 0.0}}), "accepted");
  const std::vector<std::pair<nlohmann::json, std::string>> cases = {
      {{{"/version", 4}}, "/cells/material: is of several materials (allowed: version 5)"},
      {{{"/cells/material/0", 2}}, "/cells/material/0: is 2"},
      {{{"/regions", nlohmann::json::array()}}, "/regions: has 0 regions"},
      {{{"/regions/0/density_kg_m3", 1000}}, "/nodes/mass_kg: node"},
      {{{"/regions/1", good["regions"][0]}}, "/laws/averaged_springs: has constants of 2 materials, of 3"},
      {{{"/laws/averaged_springs/regions/0/shear", 1}}, "/laws/averaged_springs/regions/0/shear: is an unknown key"},
      {{{"/laws/measured_cells", {{"form_N_m", 1}}}}, "/laws/measured_cells/form_N_m: is 1"},
      {{{"/laws/volume_correction", {{"kappa_Pa", 1}, {"form", "paper"}}}}, "acts on cells of one material"},
      {{{"/bonds/nodes/0/15", 100000}}, "/bonds/nodes/0/15: is 100000"},
      {{{"/bonds/weights/0/0", 5}}, "/bonds/weights: bond 0 has weights that do not sum to 1"},
      {{{"/bonds/nodes/0/0", good["bonds"]["nodes"][0][1]}}, "/bonds/weights: bond 0 is stretched at rest"},
      {{{"/bonds/stiffness_N_m/0/0", -1e9}}, "/bonds/stiffness_N_m: bond 0 pushes apart"},
      {{{"/bonds/stiffness_N_m/0/1", 1e9}}, "/bonds/stiffness_N_m: bond 0 pushes apart"},
  };
  for (const auto& [change, expected] : cases) EXPECT_WORDS(message(change), expected);
}

}  // namespace
}  // namespace springproof::springs_of_materials_test
