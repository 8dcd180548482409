// Springs files of a material that relaxes: written, read back, and stepped by what is given to users for C.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "msm/dynamics/plain_motion.h"
#include "msm/dynamics/time_step.h"
#include "msm/exchange/springs_file.h"
#include "msm/models.h"
#include "msm/springs_of_model.h"
#include "problem/system/input_error.h"
#include "support/says.h"
#include "support/solids.h"
#include "support/zoo.h"

// C: a function may be named as a struct; not all are used here.
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wshadow"
#pragma GCC diagnostic ignored "-Wunused-function"
#include "../../../../examples/springproof_forces.h"

namespace springproof::springs_that_relax_test {
namespace {

using nlohmann::json;

const IsotropicMaterial rubber{1e4, 0.45, 1000};
const Relaxation two{{{0.25, 0.02}, {0.15, 0.3}}};

/// A bar of cubes, or a round one of cut cells.
SpringsFile written(MassSpringModel model) {
  SpringsFile file;
  file.density = rubber.density;
  file.material = rubber;
  file.model = std::move(model);
  std::erase_if(file.model.laws, [](const ForceLaw& law) { return std::holds_alternative<Anchors>(law); });
  file.relaxing = RelaxingCells::of(file.model, rubber, two);
  if (file.model.network.cells.cut()) file.volumes = file.model.network.volume;
  file.derived = derived_of(file);
  return file;
}
SpringsFile bar() {
  return written(build_embedded(test::model("hybmss_avg"), block_mesh({2, 1, 1}, {4, 2, 2}), rubber).model);
}
SpringsFile cut() {
  const Mesh body = test::mapped(test::cylinder(2, 8, 8), test::random_placement(3, 1.0 / 3));
  return written(
      build_cut(test::model("hybmss_avg"), cut_body(test::grid_about(body, 1.0 / 3), body), {}, Mesh{}, rubber).model);
}
SpringsFile measured() { return written(test::with_measured_cells(bar().model)); }

/// A weight of the nodes up and down, nothing held: the body bends and creeps.
BoundaryConditions pulled(const Network& network) {
  BoundaryConditions bc;
  bc.fixed.assign(network.X.size(), 0);
  bc.owner.assign(network.X.size(), -1);
  bc.prescribed = bc.external = NodalVectors::Zero(network.X.rows(), 3);
  for (Eigen::Index n = 0; n < network.X.rows(); ++n) bc.external(n, 2) = network.volume[n] * (n % 3 == 0 ? 160 : -72);
  return bc;
}

TEST(SpringsThatRelax, MoveAsTheModelThatWasWritten) {
  for (const SpringsFile& file : {bar(), cut(), measured()}) {
    const SpringsFile read = parse_springs(springs_as_json(file), "own.json");
    EXPECT_EQ(json::parse(springs_as_json(file))["version"], file.relaxing.of_measured() ? 7 : 6);
    ASSERT_EQ(read.relaxing.relaxation.branches.size(), 2u);
    MotionOptions options{.relaxation = file.relaxing}, of_read{.relaxation = read.relaxing};
    options.time_step = of_read.time_step = 0.9 * file.derived.at("safe_time_step_s");
    PlainMotion motion(file.model, file.density, options), again(read.model, read.density, of_read);
    for (PlainMotion* m : {&motion, &again}) {
      m->set_conditions(pulled(file.model.network));
      m->advance(200);
    }
    const double moved = (motion.positions() - file.model.network.X).norm();
    EXPECT_LT((again.positions() - motion.positions()).norm(), 1e-10 * moved) << traits(file.model.laws[0]).name;
  }
}

/// Positions after the steps of PlainMotion by examples/springproof_forces.h, without branches or with them.
NodalVectors stepped_in_c(const json& file, const BoundaryConditions& bc, double dt, int steps, bool relaxing) {
  const auto array = [](const json& list) {
    std::vector<double> out;
    for (const json& row : list)
      for (const json& x : row.is_array() ? row : json::array({row})) out.push_back(x);
    return out;
  };
  const auto law_of = [](const json& law, double lambda) {
    struct sp_averaged out = {SP_HENCKY,       law["shear_modulus_Pa"], lambda,       law["bending"],
                              law["coupling"], law["torsion"],          law["twist"], law["warping"]};
    return out;
  };
  const bool measured = file["laws"].contains("measured_cells");
  const std::vector<double> share = array(file["relaxation"]["share"]), time = array(file["relaxation"]["time_s"]),
                            form = measured ? array(file["laws"]["measured_cells"]["form_N_m"]) : share;
  const json of_springs = {{"shear_modulus_Pa", 0}, {"bending", 0}, {"coupling", 0},
                           {"torsion", 0},          {"twist", 0},   {"warping", 0}};
  const sp_branches branches{share.size(), share.data(), time.data(),
                             law_of(measured ? of_springs : file["relaxation"], 0), measured ? form.data() : nullptr};
  std::vector<int> nodes;
  for (const json& row : file["cells"]["nodes"]) nodes.insert(nodes.end(), row.begin(), row.end());
  const std::size_t cells = nodes.size() / 8;
  const std::vector<double> mass = array(file["nodes"]["mass_kg"]), edges(cells, file["cells"]["edge_m"]);
  const sp_parts full{nullptr, nullptr, nullptr, nullptr};
  std::vector<double> x = array(file["nodes"]["position_m"]), v(x.size()), states(cells * SP_STRAINS * 3);
  for (; steps > 0; --steps) {
    std::vector<double> f(bc.external.data(), bc.external.data() + bc.external.size());
    if (measured) {
      sp_measured(cells, nodes.data(), edges[0], full, form.data(), x.data(), f.data());
    } else {
      const json& law = file["laws"]["averaged_springs"];
      sp_averaged(cells, nodes.data(), edges[0], law_of(law, law["lame_lambda_Pa"]), x.data(), f.data());
    }
    if (relaxing) sp_relaxing(cells, nodes.data(), edges.data(), full, branches, x.data(), dt, states.data(), f.data());
    sp_step(mass.size(), mass.data(), f.data(), dt, 0, x.data(), v.data());
  }
  return Eigen::Map<const NodalVectors>(x.data(), static_cast<Eigen::Index>(mass.size()), 3);
}

TEST(SpringsThatRelax, CreepInCAsHere) {
  for (const SpringsFile& file : {bar(), measured()}) {
    const double dt = 0.9 * file.derived.at("safe_time_step_s");
    PlainMotion motion(file.model, file.density, {.time_step = dt, .relaxation = file.relaxing});
    const BoundaryConditions bc = pulled(file.model.network);
    motion.set_conditions(bc);
    motion.advance(200);
    const json document = json::parse(springs_as_json(file));
    const double moved = (motion.positions() - file.model.network.X).norm();
    EXPECT_LT((stepped_in_c(document, bc, dt, 200, true) - motion.positions()).norm(), 1e-10 * moved);
    EXPECT_GT((stepped_in_c(document, bc, dt, 200, false) - motion.positions()).norm(), 1e-3 * moved);
  }
}

TEST(SpringsThatRelax, TakeStepsOfTheSuddenModuli) {
  const IsotropicMaterial foam{1e4, 0, 1000};  // whose step is not that of its bulk modulus
  SpringsFile file;
  file.model = build_embedded(test::model("hybmss_avg"), block_mesh({2, 1, 1}, {4, 2, 2}), foam).model;
  file.relaxing = RelaxingCells::of(file.model, foam, two);
  file.derived = derived_of(file);
  const double elastic = safe_time_step(file.model, file.density);
  EXPECT_LT(file.derived.at("safe_time_step_s"), 0.99 * elastic);
}

TEST(SpringsThatRelax, AreRefusedWithTheirPlace) {
  const json good = json::parse(springs_as_json(bar()));
  const auto message = [&](const json& change) {
    json document = good;
    for (const auto& [pointer, value] : change.items()) document[json::json_pointer(pointer)] = value;
    try {
      parse_springs(document.dump(), "own.json");
    } catch (const InputError& e) {
      return std::string(e.what());
    }
    return std::string("accepted");
  };
  EXPECT_EQ(message({{"/grip_m", 0.0}}), "accepted");
  const std::vector<std::pair<json, std::string>> cases = {
      {{{"/version", 5}}, "/relaxation: is in a file of an earlier version (allowed: version 6)"},
      {{{"/version", 8}}, "/version: is 8"},
      {{{"/relaxation/share/0", -0.1}}, "/relaxation/share/0: is -0.1"},
      {{{"/relaxation/time_s/1", 0}}, "/relaxation/time_s/1: is 0"},
      {{{"/relaxation/time_s", {1}}}, "/relaxation/time_s: has 1"},
      {{{"/relaxation/share", json::array()}}, "/relaxation/share: is empty (allowed: one branch at least)"},
      {{{"/relaxation/bending", -1}}, "/relaxation/bending: is -1"},
      {{{"/relaxation/of", "all"}}, "/relaxation/of: is an unknown key"},
  };
  for (const auto& [change, expected] : cases) EXPECT_WORDS(message(change), expected);
}

}  // namespace
}  // namespace springproof::springs_that_relax_test
