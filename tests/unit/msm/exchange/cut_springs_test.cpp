// Springs files of cut cells: written and read back with their supports, loads and time step.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "msm/dynamics/time_step.h"
#include "msm/embedding/supports.h"
#include "msm/exchange/anchored_springs.h"
#include "msm/models.h"
#include "msm/statics/equilibrium.h"
#include "problem/system/input_error.h"
#include "support/solids.h"
#include "support/zoo.h"

namespace springproof::cut_springs_test {
namespace {

const IsotropicMaterial material{1e4, 0.4, 1100};

/// A round bar of three cells, lying anyhow.
struct Bar {
  Mesh body;
  CutBody cut;

  Bar() : body(test::mapped(test::cylinder(2, 8, 8), test::random_placement(3, 1.0 / 3))) {
    cut = cut_body(test::grid_about(body, 1.0 / 3), body);
  }
};

const Bar& bar() {
  static const Bar b;
  return b;
}

SpringsFile file_of(const std::string& name) {
  SpringsFile file;
  file.density = material.density;
  file.material = material;
  file.model = build_cut(test::model(name), bar().cut, {}, Mesh{}, material).model;
  std::erase_if(file.model.laws, [](const ForceLaw& law) { return std::holds_alternative<Anchors>(law); });
  const Embedding embedding = embed(bar().cut, {}, file.model.network, Mesh{});
  file.loads = embedding.patches;
  file.volumes = embedding.volumes;
  for (const char* patch : {"z_min", "z_max"}) file.anchors[patch] = anchors_of_patch(bar().cut, patch, {material});
  return file;
}

TEST(CutSprings, AreReadAsTheyWereWrittenForEveryModelThatTakesThem) {
  for (const ModelRow& row : model_table()) {
    if (!has_cut_cells(row)) continue;
    SCOPED_TRACE(row.name);
    const SpringsFile written = file_of(row.name);
    const std::string text = springs_as_json(written);
    EXPECT_NE(text.find("\"version\": 7"), std::string::npos);
    const SpringsFile read = parse_springs(text, "own.json");
    const Network &a = written.model.network, &b = read.model.network;
    ASSERT_EQ(b.cells.filled.size(), a.cells.filled.size());
    EXPECT_FALSE(b.cells.grid);
    const NodalVectors x = a.X + test::noise(a.nodes(), 0.01);
    const NodalVectors ours = forces(written.model, x);
    EXPECT_LE((forces(read.model, x) - ours).cwiseAbs().maxCoeff(), 1e-12 * ours.cwiseAbs().maxCoeff());
    EXPECT_NEAR(energy(read.model, x), energy(written.model, x), 1e-12 * energy(written.model, x));
    const double step = safe_time_step(written.model, material.density);
    EXPECT_NEAR(safe_time_step(read.model, read.density), step, 1e-9 * step);
    EXPECT_EQ(read.patches, written.patches);
    EXPECT_LT((read.volumes - written.volumes).norm(), 1e-14 * written.volumes.norm());
    EXPECT_TRUE(read.loads.at("z_max").area == written.loads.at("z_max").area);
    EXPECT_TRUE(read.loads.at("z_max").normal == written.loads.at("z_max").normal);
    ASSERT_EQ(read.anchors.at("z_min").size(), written.anchors.at("z_min").size());
    for (std::size_t n = 0; n < read.anchors.at("z_min").size(); ++n) {
      const Anchor &mine = read.anchors.at("z_min")[n], &theirs = written.anchors.at("z_min")[n];
      EXPECT_EQ(mine.corners, theirs.corners);
      EXPECT_EQ(mine.weights, theirs.weights);
      EXPECT_EQ(mine.stiffness, theirs.stiffness);
    }
  }
}

TEST(CutSprings, BendLikeTheModelTheyCameFrom) {
  const Mesh cubes = voxelise(bar().cut.grid, bar().body).mesh;
  const std::vector<Load> loads = {PrescribedDisplacement{"z_min", {0.0, 0.0, 0.0}}, PatchForce{"z_max", Vec3(1, 2, 3)},
                                   Gravity{Vec3(3, -2, 1)}, Pressure{"z_max", 5}};
  const auto solved = [&](const MassSpringModel& model, const Embedding& embedding) {
    const BoundaryConditions bc =
        transfer(loads, cubes, embedding, model.network, material.density, Kinematics::linear);
    const Equilibrium e = solve_linear(model, bc);
    EXPECT_TRUE(e.ok) << e.message;
    return e;
  };
  const EmbeddedModel built = build_cut(test::model("hybmss_avg"), bar().cut, {"z_min"}, cubes, material);
  const auto [model, embedding] =
      anchored(parse_springs(springs_as_json(file_of("hybmss_avg")), "own"), {"z_min"}, cubes);
  const Equilibrium ours = solved(built.model, built.embedding), theirs = solved(model, embedding);
  EXPECT_LT((theirs.displacement - ours.displacement).norm(), 1e-9 * ours.displacement.norm());
  EXPECT_LT((theirs.support - ours.support).norm(), 1e-8 * ours.support.norm());
  const NodalVectors of_mesh = built.embedding.weights * ours.displacement;
  EXPECT_LT((embedding.weights * theirs.displacement - of_mesh).norm(), 1e-9 * of_mesh.norm());
}

TEST(CutSprings, AreRefusedWithTheirPlace) {
  const std::string good = springs_as_json(file_of("hybmss_avg"));
  const auto message = [&](const std::string& from, const std::string& to) {
    std::string text = good;
    const std::size_t at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    text.replace(at, from.size(), to);
    try {
      parse_springs(text, "own.json");
    } catch (const InputError& e) {
      return std::string(e.what());
    }
    return std::string("accepted");
  };
  const std::vector<std::array<std::string, 3>> cases = {
      {"\"fraction\": [", "\"fraction\": [2,", "/cells/fraction"},
      {"\"fraction\": [", "\"fractions\": [", "/cells/fractions: is an unknown key"},
      {"\"mixed\": [[", "\"mixed\": [[1,", "/cells/mixed/0"},
      {"\"variance\": [[", "\"variance\": [[-1,0,0],[", "/cells/variance"},
      {"\"weight_kg\": [", "\"weight_kg\": [1,", "/nodes/weight_kg: has"},
      {"\"area_m2\": [", "\"area_m2\": [1,", "/loads/surface/area_m2: has"},
      {"\"position_m\": [[", "\"position_m\": [[9,9,9],[", "/nodes/mass_kg"},
      {"\"averaged_springs\": {",
       "\"volume_correction\": {\"kappa_Pa\": 1, \"form\": \"paper\"}, \"averaged_springs\": {",
       "/laws/volume_correction: acts on whole cells"}};
  for (const auto& [from, to, expected] : cases)
    EXPECT_NE(message(from, to).find(expected), std::string::npos) << message(from, to);
  std::string moved = good;
  const std::size_t anchors = moved.find("\"anchors\": {"), position = moved.find("\"position_m\": [[", anchors) + 15;
  moved.replace(position, moved.find(',', position) - position, "[7.5");
  try {
    parse_springs(moved, "own.json");
    ADD_FAILURE() << "an anchor away from its nodes is accepted";
  } catch (const InputError& e) {
    EXPECT_NE(std::string(e.what()).find("/anchors/z_max/position_m: anchor 0 is"), std::string::npos) << e.what();
  }
}

TEST(CutSprings, OfEarlierVersionsHaveANumberPerAnchor) {
  auto text = nlohmann::json::parse(springs_as_json(file_of("hybmss_avg")));
  auto &stiffness = text["anchors"]["z_max"]["stiffness_N_m"], &version = text["version"];
  const auto refused = [&](const char* why) {
    try {
      parse_springs(text.dump(), "own.json");
      ADD_FAILURE() << why;
    } catch (const InputError& e) {
      EXPECT_NE(std::string(e.what()).find(why), std::string::npos) << e.what();
    }
  };
  stiffness[0][1] = 1e9;
  refused("/anchors/z_max/stiffness_N_m: anchor 0 pushes apart");
  version = 6;
  refused("/anchors/z_max/stiffness_N_m/0");
  for (auto& anchors : text["anchors"])
    for (auto& k : anchors["stiffness_N_m"]) k = 7.0;
  const std::vector<Anchor> read = parse_springs(text.dump(), "own.json").anchors.at("z_max");
  ASSERT_FALSE(read.empty());
  for (const Anchor& a : read) EXPECT_TRUE(a.stiffness == 7 * Eigen::Matrix3d::Identity());
  version = 7;
  refused("/anchors/z_max/stiffness_N_m");
}

}  // namespace
}  // namespace springproof::cut_springs_test
