// Bodies for engines: tetrahedra of the cubes, files, and what an engine cannot have.
#include "comparisons/engines/engine_files.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <map>
#include <nlohmann/json.hpp>
#include <regex>
#include <set>

#include "comparisons/engines/engine_constants.h"
#include "meshes/locate/outer_facets.h"
#include "meshes/volume.h"
#include "msm/dynamics/time_step.h"
#include "msm/models.h"

namespace springproof::engine_files_test {
namespace {

SpringsFile springs_of_block(const std::string& model, double nu, const std::array<int, 3>& cells = {4, 2, 3}) {
  const IsotropicMaterial material{1e6, nu, 1100};
  const Mesh mesh = block_mesh(0.5 * Vec3(cells[0], cells[1], cells[2]), cells);
  EmbeddedModel built = build_embedded(resolve({model, {}, model, {}}), mesh, material);
  SpringsFile file;
  file.material = material;
  file.density = material.density;
  file.patches = built.embedding.held;
  file.origin = {"springproof 0", model, {}, "block.geo", "abc"};
  file.derived = {{"safe_time_step_s", safe_time_step(built.model, material.density)}, {"mass_kg", 0}};
  file.model = std::move(built.model);
  return file;
}

TEST(FiveTetrahedra, FillTheCellsAndConform) {
  Mesh mesh = block_mesh({2, 1, 1.5}, {4, 2, 3});
  std::erase_if(mesh.hexahedra, [](const Hexahedron& cell) { return cell[0] == 0; });  // not every cell of the block
  Mesh cut;
  cut.nodes = mesh.nodes;
  cut.tetrahedra = five_tetrahedra(mesh.nodes, mesh.hexahedra, 0.5);
  ASSERT_EQ(cut.tetrahedra.size(), 5 * mesh.hexahedra.size());
  const Eigen::VectorXd volumes = cell_volumes(cut, cut.nodes);
  EXPECT_GT(volumes.minCoeff(), 0.125 / 6 - 1e-12);
  EXPECT_NEAR(volumes.sum(), 23 * 0.125, 1e-12);
  for (std::size_t c = 0; c < mesh.hexahedra.size(); ++c) EXPECT_NEAR(volumes.segment(5 * c, 5).sum(), 0.125, 1e-12);
  // Faces inside are shared by two: of the surface there are two for each square, and nothing else.
  EXPECT_EQ(outer_facets(cut).size(), 2 * outer_facets(mesh).size());
}

TEST(FiveTetrahedra, PreferNoDirection) {
  const Mesh mesh = block_mesh({1, 1, 1}, {2, 2, 2});
  std::map<std::array<long, 3>, int> diagonals;  // by direction
  std::set<std::pair<int, int>> seen;
  for (const Tetrahedron& t : five_tetrahedra(mesh.nodes, mesh.hexahedra, 0.5))
    for (int a = 0; a < 4; ++a)
      for (int b = 0; b < a; ++b) {
        if (!seen.insert(std::minmax(t[a], t[b])).second) continue;
        Vec3 d = 2 * (mesh.nodes.row(t[a]) - mesh.nodes.row(t[b])).transpose();
        if (d.squaredNorm() < 1.5) continue;
        if (d[0] < 0 || (d[0] == 0 && d[1] < 0)) d = -d;
        ++diagonals[{std::lround(d[0]), std::lround(d[1]), std::lround(d[2])}];
      }
  ASSERT_EQ(diagonals.size(), 6u);  // of faces alone
  for (const auto& [direction, count] : diagonals) EXPECT_EQ(count, diagonals.begin()->second);
}

TEST(EngineFiles, JoltGetsTheSpringsAsCompliances) {
  const SpringsFile springs = springs_of_block("msm_18", 0.25);
  const nlohmann::json file = nlohmann::json::parse(jolt_json(springs, {"x_min"}));
  EXPECT_EQ(file["format"], "springproof jolt");
  EXPECT_EQ(file["version"], 1);
  EXPECT_EQ(file["poisson_ratio_of_model"], 0.25);
  EXPECT_EQ(file["material"]["youngs_modulus_Pa"], 1e6);
  double mass = 0;
  for (const double m : file["nodes"]["mass_kg"]) mass += m;
  EXPECT_NEAR(mass, 1100 * 3, 1e-9);
  const auto& network = springs.model.network;
  ASSERT_EQ(file["edges"]["nodes"].size(), network.springs.size());
  for (std::size_t s = 0; s < network.springs.size(); ++s) {
    const double k = file["edges"]["stiffness_N_m"][s], c = file["edges"]["compliance_m_N"][s];
    EXPECT_NEAR(k * c, 1, 1e-14);
    EXPECT_EQ(k, network.springs[s].stiffness);
  }
  EXPECT_EQ(file["pins"].size(), 1u);
  EXPECT_EQ(file["pins"]["x_min"].size(), 12u);
  EXPECT_EQ(file["patches"].size(), 6u);
  EXPECT_EQ(file["surface"]["facets"].size(), 2u * (2 * (4 * 2 + 2 * 3 + 3 * 4)));
  EXPECT_EQ(file["cells"]["edge_m"], 0.5);
  const double least = file["substeps"]["least_s"], most = file["substeps"]["most_s"];
  EXPECT_LT(least, most);
  EXPECT_LT(most, double(file["safe_time_step_s"]));
}

TEST(EngineFiles, SurfacePointsOutwards) {
  const SpringsFile springs = springs_of_block("msm_18", 0.25);
  const nlohmann::json file = nlohmann::json::parse(bullet_json(springs, {}));
  const NodalVectors& X = springs.model.network.X;
  double six_volumes = 0;
  for (const auto& f : file["surface"]["facets"]) {
    Eigen::Matrix3d corners;
    for (int a = 0; a < 3; ++a) corners.col(a) = X.row(f[a].get<int>()).transpose();
    six_volumes += corners.determinant();
  }
  EXPECT_NEAR(six_volumes / 6, 3, 1e-12);
}

TEST(EngineFiles, BulletGetsTetrahedraAndConvertedConstants) {
  const SpringsFile springs = springs_of_block("msm_18", 0.45);
  const nlohmann::json file = nlohmann::json::parse(bullet_json(springs, {"x_min", "x_max"}));
  EXPECT_EQ(file["format"], "springproof bullet");
  EXPECT_EQ(file["poisson_ratio_of_model"], 0.45);
  EXPECT_EQ(file["tetrahedra"]["nodes"].size(), 5u * 24);
  EXPECT_EQ(file["edges"]["nodes"].size(), 0u);
  EXPECT_EQ(file["engine"]["neo_hooke"]["mu_Pa"], bullet_neo_hooke(*springs.material).mu);
  EXPECT_EQ(file["engine"]["linear"]["poisson_ratio"], 0.45);
  EXPECT_EQ(file["engine"]["default_damping"]["neo_hooke"], 0.05);
  EXPECT_EQ(file["pins"].size(), 2u);
}

TEST(EngineFiles, MujocoGetsAFlexWithTheMassOfEachNode) {
  const SpringsFile springs = springs_of_block("msm_18", 0.3);
  const std::string text = mujoco_mjcf(springs, {"x_min"});
  double mass = 0;
  int free = 0;
  const std::regex inertial("<inertial pos=\"0 0 0\" mass=\"([^\"]*)\"");
  for (std::sregex_iterator at(text.begin(), text.end(), inertial), end; at != end; ++at, ++free)
    mass += std::stod((*at)[1]);
  const Eigen::VectorXd all = masses(springs.model.network, springs.density);
  double held = 0;
  for (const int n : springs.patches.at("x_min")) held += all[n];
  EXPECT_EQ(free, 60 - 12);
  EXPECT_NEAR(mass + held, 1100 * 3, 1e-9);
  for (const char* part : {"integrator=\"discrete\"", "<elasticity young=\"1000000\" poisson=\"0.3\" damping=\"0\"/>",
                           "<flex name=\"solid\" dim=\"3\"", "<body name=\"solid\">"})
    EXPECT_NE(text.find(part), std::string::npos) << part;
}

template <class Write>
std::string refusal(const Write& write, const SpringsFile& springs) {
  try {
    write(springs, {});
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(EngineFiles, WhatAnEngineCannotHaveIsRefused) {
  EXPECT_NE(refusal(jolt_json, springs_of_block("hybmss", 0.4)).find("--model: hybmss has more than springs"),
            std::string::npos);
  EXPECT_NE(refusal(jolt_json, springs_of_block("msm_18", 0.4)).find("--poisson-ratio: is 0.4, and springs alone"),
            std::string::npos);
  for (const auto& write : {jolt_json, bullet_json, mujoco_mjcf})
    EXPECT_NE(refusal(write, springs_of_block("msm_centred", 0.25)).find("not the corners of whole cubes"),
              std::string::npos);
  for (const char* able : {"msm_18", "msm_14", "hybmss_cf"})
    EXPECT_EQ(refusal(jolt_json, springs_of_block(able, 0.25)), "accepted") << able;
}

}  // namespace
}  // namespace springproof::engine_files_test
