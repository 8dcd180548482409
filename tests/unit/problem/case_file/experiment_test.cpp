#include "problem/case_file/experiment.h"

#include <gtest/gtest.h>

#include <set>

#include <numbers>

#include "problem/case_file/measures.h"
#include "support/case_file.h"
#include "support/tolerances.h"

namespace springproof::experiment_test {
namespace {

using test::full_case;
using test::small_case;

Experiment parse(const std::string& text) { return parse_experiment(text, "golec_2019/beam.toml"); }

TEST(Experiment, SmallestCaseHasTheDefaults) {
  const Experiment e = parse(small_case);
  EXPECT_EQ(e.name, "beam");
  EXPECT_EQ(e.folder, "golec_2019");
  EXPECT_EQ(e.file, "golec_2019/beam.toml");
  EXPECT_EQ(e.text, small_case);
  EXPECT_EQ(e.kinematics, "linear");
  EXPECT_EQ(e.model_kinematics(), Kinematics::linear);
  EXPECT_EQ(e.body.geo, "block.geo");
  EXPECT_EQ(e.body.size, Vec3(1, 1, 2.5));
  EXPECT_EQ(e.body.cells, (std::vector<Cells>{{2, 2, 5}}));
  ASSERT_EQ(e.materials.size(), 1u);
  EXPECT_EQ(e.materials[0].youngs_modulus, 1e4);
  EXPECT_EQ(e.materials[0].poisson_ratio, 0.3);
  EXPECT_EQ(e.materials[0].density, 1000);
  ASSERT_EQ(e.models.size(), 1u);
  EXPECT_EQ(e.models[0].name, "hybmss");
  EXPECT_EQ(e.models[0].label, "hybmss");
  EXPECT_EQ(e.measures, (std::vector<std::string>{"displacement_error", "volume_change", "reaction"}));
  EXPECT_EQ(e.elements, (std::vector<std::string>{"q1"}));
  EXPECT_FALSE(e.cost);
  EXPECT_EQ(e.max_unknowns, 0);
  EXPECT_EQ(e.reference.cells, (Cells{0, 0, 0}));
  EXPECT_EQ(e.reference.elements, (std::vector<std::string>{"q2"}));
  EXPECT_EQ(e.reference.grading, 1.5);
  EXPECT_FALSE(e.reference.smooth);
  EXPECT_EQ(e.exact, "");
  EXPECT_FALSE(e.section);
  EXPECT_TRUE(e.probes.empty() && e.expectations.empty() && e.published.empty());
}

TEST(Experiment, ElementsBesideTheModelsOfLargeLatticesAreAskedFor) {
  const auto elements_at = [](const std::string& cells, const std::string& more = "") {
    std::string text = small_case;
    const auto at = text.find("cells = [2, 2, 5]");
    return parse(text.replace(at, 17, "cells = " + cells) + more).elements;
  };
  EXPECT_EQ(elements_at("[20, 20, 50]"), (std::vector<std::string>{"q1"}));
  EXPECT_TRUE(elements_at("[[2, 2, 5], [24, 24, 60]]").empty());
  EXPECT_EQ(elements_at("[24, 24, 60]", "[compare]\nelements = [\"q1\"]\n"), (std::vector<std::string>{"q1"}));
}

TEST(Experiment, AMovedSupportBringsTheReactionError) {
  const auto measures_with = [](const std::string& load, const std::string& more = "") {
    std::string text = small_case;
    return parse(text + "[[load]]\non = \"z_max\"\n" + load + "\n" + more).measures;
  };
  const std::vector<std::string> held = {"displacement_error", "volume_change", "reaction"};
  std::vector<std::string> moved = held;
  moved.emplace_back("reaction_error");
  EXPECT_EQ(measures_with("displacement_m = [0, \"free\", 0.1]"), moved);
  EXPECT_EQ(measures_with("rotation_deg = 5\naxis = [0, 0, 1]\nabout_m = [0, 0, 0]"), moved);
  EXPECT_EQ(measures_with("displacement_gradient = [[0, 0, 0], [0, 0, 1], [0, 0, 0]]"), moved);
  EXPECT_EQ(measures_with("rotation_deg = 0\naxis = [0, 0, 1]\nabout_m = [0, 0, 0]"), held);
  EXPECT_EQ(measures_with("force_N = [0, 0, 1]"), held);
  EXPECT_EQ(measures_with("displacement_m = [0, 0, 0.1]", "[compare]\nmeasures = [\"volume_change\"]"),
            (std::vector<std::string>{"volume_change", "reaction_error"}));
  EXPECT_EQ(measures_with("displacement_m = [0, 0, 0.1]", "[compare]\nmodels = []\n[reference]\nelements = [\"q2\"]"),
            held);
}

TEST(Experiment, EveryPartOfAFullCase) {
  const Experiment e = parse(full_case);
  EXPECT_EQ(e.cite, "Golec et al. (2019), \"Table 3\"");
  EXPECT_EQ(e.kinematics, "hencky");
  EXPECT_EQ(e.model_kinematics(), Kinematics::finite);
  EXPECT_EQ(e.body.cells, (std::vector<Cells>{{24, 4, 4}, {48, 8, 8}}));
  EXPECT_EQ(e.body.where.line, 6);
  ASSERT_EQ(e.materials.size(), 3u);
  const double nu[] = {-0.5, 0.25, 0.499};
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(e.materials[i].poisson_ratio, nu[i]);
    EXPECT_NEAR(shear_modulus(e.materials[i]), 4e3, 4e3 * test::round_off) << "the other modulus is held fixed";
    EXPECT_EQ(e.materials[i].density, 1060);
  }

  ASSERT_EQ(e.loads.size(), 10u);
  ASSERT_EQ(e.load_locations.size(), 10u);
  for (int i = 0; i < 2; ++i) {
    const auto& clamp = std::get<PrescribedDisplacement>(e.loads[i]);
    EXPECT_EQ(clamp.on, i == 0 ? "x_min" : "y_min");
    EXPECT_EQ(clamp.displacement[0], 0.0);
    EXPECT_FALSE(clamp.displacement[1]);
    EXPECT_EQ(clamp.displacement[2], 0.5);
  }
  EXPECT_EQ(e.load_locations[0].line, e.load_locations[1].line);
  EXPECT_LT(e.load_locations[1].line, e.load_locations[2].line);
  const auto& affine = std::get<PrescribedAffine>(e.loads[2]);
  EXPECT_EQ(affine.gradient(0, 1), 0.2);
  EXPECT_EQ(affine.gradient(1, 0), 0.4);
  EXPECT_EQ(affine.offset, Vec3::Zero());
  EXPECT_EQ(std::get<PrescribedAffine>(e.loads[3]).offset, Vec3(1, 2, 3));
  const auto& rotation = std::get<PrescribedRotation>(e.loads[4]);
  EXPECT_DOUBLE_EQ(rotation.angle, std::numbers::pi / 4);
  EXPECT_TRUE(rotation.axis.isApprox(Vec3(0, 0.6, 0.8), test::round_off));
  EXPECT_EQ(rotation.point, Vec3(1, 0.2, 0.2));
  EXPECT_EQ(std::get<Traction>(e.loads[5]).traction, Vec3(10, 0, -1e-3));
  EXPECT_EQ(std::get<PatchForce>(e.loads[6]).force, Vec3(0, 0, -5));
  EXPECT_EQ(std::get<Pressure>(e.loads[7]).on, "y_max");
  EXPECT_EQ(std::get<Pressure>(e.loads[7]).pressure, 2.5);
  EXPECT_EQ(std::get<Gravity>(e.loads[8]).acceleration, Vec3(0, 0, -9.81));
  EXPECT_EQ(std::get<PointForce>(e.loads[9]).at, Vec3(2.4, 0.2, 0.4));
  EXPECT_EQ(std::get<PointForce>(e.loads[9]).force, Vec3(0, 1, 0));

  ASSERT_EQ(e.models.size(), 4u);
  EXPECT_EQ(e.models[0].label, "hybmss");
  EXPECT_EQ(e.models[1].name, "hybmss");
  EXPECT_EQ(e.models[1].label, "hybmss A=1 paper_e_form");
  EXPECT_EQ(std::get<double>(e.models[1].options.at("face_to_cube")), 1.0);
  EXPECT_EQ(std::get<bool>(e.models[1].options.at("paper_e_form")), true);
  EXPECT_EQ(e.models[2].label, "share");
  EXPECT_EQ(std::get<std::string>(e.models[2].options.at("weights")), "share");
  EXPECT_EQ(e.models[3].label, "emsm damped=false q=0.25");

  ASSERT_EQ(e.probes.size(), 1u);
  EXPECT_EQ(e.probes[0].name, "tip");
  EXPECT_EQ(e.section->normal, Vec3(0, -1, 0));
  EXPECT_EQ(e.reference.cells, (Cells{96, 16, 16}));
  EXPECT_EQ(e.reference.grading, 1.0);
  EXPECT_TRUE(e.reference.smooth);
  EXPECT_EQ(e.reference.elements, (std::vector<std::string>{"p2", "q1", "q2"}));

  ASSERT_EQ(e.expectations.size(), 4u);
  EXPECT_EQ(e.expectations[3].model, "fem_p2");
  EXPECT_EQ(e.expectations[0].measure, "force.x_max.magnitude");
  EXPECT_EQ(e.expectations[0].source, Source::published);
  EXPECT_EQ(e.expectations[0].value, 0.0254);
  EXPECT_EQ(e.expectations[0].within, 0.0005);
  EXPECT_FALSE(e.expectations[0].relative);
  EXPECT_EQ(e.expectations[0].poisson_ratio, 0.25);
  EXPECT_EQ(e.expectations[0].cells, (Cells{48, 8, 8}));
  EXPECT_EQ(e.expectations[1].source, Source::extrapolated_fem);
  EXPECT_FALSE(e.expectations[1].value);
  EXPECT_TRUE(e.expectations[1].relative);
  EXPECT_FALSE(e.expectations[1].poisson_ratio);
  EXPECT_EQ(e.expectations[2].model, "fem");
  EXPECT_EQ(e.expectations[2].measure, "displacement.tip.z");
  ASSERT_EQ(e.published.size(), 1u);
  EXPECT_EQ(e.published[0].model, "corotational FEM");
  EXPECT_EQ(e.published[0].remark, "read from the figure");
}

TEST(Experiment, AVerificationCaseHasNoModelsButAnExactField) {
  const Experiment e = parse(test::verification_case);
  EXPECT_TRUE(e.models.empty());
  EXPECT_EQ(e.exact, "trigonometric");
  ASSERT_EQ(e.loads.size(), 7u);
  EXPECT_EQ(std::get<PrescribedField>(e.loads[5]).on, "z_max");
  EXPECT_EQ(std::get<PrescribedField>(e.loads[5]).field, "trigonometric");
  EXPECT_EQ(std::get<FieldBodyForce>(e.loads[6]).field, "trigonometric");
  ASSERT_EQ(e.expectations.size(), 1u);
  EXPECT_EQ(e.expectations[0].at_least, 1.9);
  EXPECT_FALSE(e.expectations[0].value);
}

TEST(Experiment, IntegersThatNoDoubleHoldsAreRounded) {
  std::string text = small_case;
  const std::string old = "youngs_modulus_Pa = 1e4";
  text.replace(text.find(old), old.size(), "youngs_modulus_Pa = 9223372036854775807");
  EXPECT_EQ(parse(text).materials[0].youngs_modulus, 0x1p63);
}

TEST(Experiment, AnyTwoModuliAndListsInPairs) {
  auto with = [](const std::string& material) {
    std::string text = small_case;
    const std::string old = "youngs_modulus_Pa = 1e4\npoisson_ratio = 0.3\n";
    return parse(text.replace(text.find(old), old.size(), material)).materials;
  };
  EXPECT_DOUBLE_EQ(with("bulk_modulus_Pa = 2e4\nshear_modulus_Pa = 1e4\n")[0].poisson_ratio, 2. / 7);
  const auto pairs = with("youngs_modulus_Pa = [1e4, 2e4]\npoisson_ratio = [0.1, 0.2]\n");
  ASSERT_EQ(pairs.size(), 2u);
  EXPECT_EQ(pairs[1].youngs_modulus, 2e4);
  EXPECT_EQ(pairs[1].poisson_ratio, 0.2);
}

TEST(Experiment, AComputedPoissonRatioIsFoundByItsPrintedValue) {
  std::string text = small_case;
  const std::string old = "youngs_modulus_Pa = 1e4\npoisson_ratio = 0.3\n";
  text.replace(text.find(old), old.size(), "youngs_modulus_Pa = 2.6\nshear_modulus_Pa = 1.0\n");
  text +=
      "[[published]]\nmodel = \"x\"\npoisson_ratio = 0.3\nmeasure = \"volume_change\"\nvalue = 1\nwhere = "
      "\"T\"\n";
  const Experiment e = parse(text);
  EXPECT_EQ(e.published[0].poisson_ratio, e.materials[0].poisson_ratio);
}

TEST(MeasureTable, EveryRowFindsItsMeasureAndUnit) {
  const std::pair<const char*, const char*> rows[] = {{"displacement_error", "1"},
                                                      {"section_axis_distance", "m"},
                                                      {"force.z_max.x", "N"},
                                                      {"torque.z_max.magnitude", "N m"},
                                                      {"displacement.tip.z", "m"},
                                                      {"mean_displacement.skin.x", "m"},
                                                      {"stress.tip.xx", "Pa"},
                                                      {"moduli.poisson_ratio", "1"},
                                                      {"moduli.youngs_modulus", "Pa"},
                                                      {"moduli.youngs_modulus_local", "Pa"},
                                                      {"moduli.affine_youngs_modulus", "Pa"},
                                                      {"network.nodes", "1"},
                                                      {"network.mean_length", "m"},
                                                      {"line.stress.all", "1"}};
  for (const auto& [row, unit] : rows) {
    EXPECT_TRUE(measure_of(row)) << row;
    EXPECT_EQ(unit_of(row), unit) << row;
  }
  EXPECT_FALSE(measure_of("forces"));
  EXPECT_TRUE(wanted("torque.feet.x", {"probe", "reaction"}));
  EXPECT_FALSE(wanted("displacement_error_max", {"displacement_error"}));
  EXPECT_TRUE(is_distance("reaction_error") && is_deviation("line.strain.xx") && !is_deviation("line.strain.order"));
}

TEST(MeasureTable, NamesDifferAndEachIsExplained) {
  std::set<std::string> names;
  for (const Measure& m : measure_table()) {
    EXPECT_TRUE(names.insert(m.name).second) << m.name;
    EXPECT_FALSE(m.what.empty() || m.units.empty()) << m.name;
  }
}

TEST(Measures, RowsOfEachMeasure) {
  const Experiment e = parse(full_case);
  EXPECT_EQ(rows_of_measure("volume_change", e), (std::vector<std::string>{"volume_change"}));
  EXPECT_EQ(rows_of_measure("probe", e),
            (std::vector<std::string>{"displacement.tip.x", "displacement.tip.y", "displacement.tip.z",
                                      "displacement.tip.magnitude"}));
  EXPECT_EQ(rows_of_measure("stress", e),
            (std::vector<std::string>{"stress.tip.xx", "stress.tip.yy", "stress.tip.zz", "stress.tip.xy",
                                      "stress.tip.yz", "stress.tip.xz"}));
  EXPECT_EQ(supported_patches(e), (std::vector<std::string>{"x_min", "y_min", "z_min", "z_max", "x_max"}));
  const auto rows = rows_of_measure("reaction", e);
  EXPECT_EQ(rows.size(), 5u * 8);
  EXPECT_EQ(rows.front(), "force.x_min.x");
  EXPECT_EQ(rows.back(), "torque.x_max.magnitude");
}

TEST(CheckPatches, NamesTheLoadThatIsWrong) {
  const Experiment e = parse(full_case);
  EXPECT_NO_THROW(check_patches(e, {"x_min", "x_max", "y_min", "y_max", "z_min", "z_max"}));
  try {
    check_patches(e, {"x_min", "x_max", "y_min", "y_max", "z_minimum", "z_max"});
    FAIL() << "accepted";
  } catch (const InputError& error) {
    const std::string message = error.what();
    const std::string start = "golec_2019/beam.toml:" + std::to_string(e.load_locations[2].line) + ":";
    EXPECT_EQ(message.rfind(start, 0), 0u) << message;
    EXPECT_NE(message.find("no patch 'z_min' (allowed: x_min, x_max, y_min, y_max, z_minimum, z_max)"),
              std::string::npos)
        << message;
  }
}

}  // namespace
}  // namespace springproof::experiment_test
