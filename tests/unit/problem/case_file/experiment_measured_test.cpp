// [[measured]], [[load_case]] and [[input]].
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "problem/case_file/varied.h"
#include "support/case_file.h"

namespace springproof::experiment_measured_test {
namespace {

using test::message_of;

const std::string bar = test::heavy_bar + std::string(R"([[mass]]
name = "weight"
at_m = [0.1, 0.015, 0.03]
mass_kg = 0.052

[[probe]]
name = "tip"
at_m = [0.1, 0.015, 0.015]

[compare]
measures = ["probe", "stress", "mean_displacement", "displacement_error"]

[[load_case]]
name = "52 g"

[[load_case]]
name = "own weight"
with = { mass = [] }

[[load_case]]
name = "102 g"
with = { "mass[0].mass_kg" = 0.102 }

[[input]]
name = "length"
of = ["body.size_m[0]", "mass[0].at_m[0]"]
u = 5e-4

[[input]]
name = "modulus"
of = "material.youngs_modulus_Pa"
u = 7e3
fitted = true

[[input]]
name = "law"
with = { kinematics = "hencky" }

[[measured]]
source = "our laboratory"
licence = "CC BY 4.0"
values = [
  { name = "sag", quantity = "displacement.tip.z", minus = "own weight", value = -0.0108, u = 3e-4, use = "fit" },
  { name = "more", quantity = "mean_displacement.x_max.z", arm_m = [0, 0, 0.007], load_case = "102 g", value = -0.02, u = 5e-4 },
]

[[expect]]
model = "hybmss"
measure = "measured.more"
source = "measured"
value = 0
within = 2
)");

/// The bar with one text in place of another.
std::string edited(const std::string& from, const std::string& to) {
  std::string text = bar;
  const auto at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

TEST(MeasuredTable, IsReadWithItsLoadCasesAndInputs) {
  const Experiment e = parse_experiment(bar, "bar.toml");
  ASSERT_EQ(e.measured.size(), 2u);
  EXPECT_TRUE(e.measured[0].fitted);
  EXPECT_EQ(e.measured[0].of, 0u);
  EXPECT_EQ(e.measured[0].minus, 1u);
  EXPECT_EQ(e.measured[1].of, 2u);
  EXPECT_EQ(e.measured[1].arm, Vec3(0, 0, 0.007));
  EXPECT_EQ(e.measured[1].licence, "CC BY 4.0");
  EXPECT_EQ(e.expectations.at(0).measure, "measured.more");
}

TEST(MeasuredTable, ValuesAreInTheUnitsOfTheCase) {
  std::string text = std::string("units = \"mm\"\n") + bar;
  for (const auto& [m, mm] : std::initializer_list<std::pair<const char*, const char*>>{
           {"size_m = [0.1, 0.03, 0.03]", "size_mm = [100, 30, 30]"},
           {"youngs_modulus_Pa = 2.5e5", "youngs_modulus_MPa = 0.25"},
           {"material.youngs_modulus_Pa\"\nu = 7e3", "material.youngs_modulus_MPa\"\nu = 7e-3"},
           {"density_kg_m3 = 1070", "density_t_mm3 = 1.07e-9"},
           {"displacement_m = ", "displacement_mm = "},
           {"gravity_m_s2 = [0, 0, -9.81]", "gravity_mm_s2 = [0, 0, -9810]"},
           {"at_m = [0.1, 0.015, 0.03]", "at_mm = [100, 15, 30]"},
           {"mass_kg = 0.052", "mass_t = 5.2e-5"},
           {"at_m = [0.1, 0.015, 0.015]", "at_mm = [100, 15, 15]"},
           {"mass[0].mass_kg\" = 0.102", "mass[0].mass_t\" = 1.02e-4"},
           {"[\"body.size_m[0]\", \"mass[0].at_m[0]\"]\nu = 5e-4",
            "[\"body.size_mm[0]\", \"mass[0].at_mm[0]\"]\nu = 0.5"},
           {"value = -0.0108, u = 3e-4", "value = -10.8, u = 0.3"},
           {"arm_m = [0, 0, 0.007]", "arm_mm = [0, 0, 7]"},
           {"value = -0.02, u = 5e-4", "value = -20, u = 0.5"}}) {
    ASSERT_NE(text.find(m), std::string::npos) << m;
    text.replace(text.find(m), std::string(m).size(), mm);
  }
  const Experiment e = parse_experiment(text, "bar.toml");
  EXPECT_DOUBLE_EQ(e.measured[0].value, -0.0108);
  EXPECT_DOUBLE_EQ(e.measured[0].u, 3e-4);
  EXPECT_DOUBLE_EQ(e.measured[1].arm.z(), 0.007);
  EXPECT_NEAR(varied(e, {0, 0}).body.size.x(), 0.1005, 1e-15);
}

TEST(VariedCase, HasTheLoadCaseAndTheChangedInput) {
  const Experiment e = parse_experiment(bar, "bar.toml");
  EXPECT_TRUE(varied(e, {1, {}}).masses.empty());
  EXPECT_DOUBLE_EQ(varied(e, {2, {}}).masses.at(0).mass, 0.102);
  const Experiment longer = varied(e, {2, 0});
  EXPECT_DOUBLE_EQ(longer.body.size.x(), 0.1005);
  EXPECT_DOUBLE_EQ(longer.masses.at(0).at.at(0).x(), 0.1005);
  EXPECT_DOUBLE_EQ(longer.masses.at(0).mass, 0.102);
  EXPECT_DOUBLE_EQ(varied(e, {1, 0}).body.size.x(), 0.1005);
  EXPECT_EQ(varied(e, {0, 2}).kinematics, "hencky");
  EXPECT_EQ(longer.measures, e.measures);
  EXPECT_TRUE(longer.measured.empty() && longer.expectations.empty());
}

TEST(VariedCase, OfALoadCaseIsLeftAsItIsByAnAlternativeToWhatItDoesNotHave) {
  for (const char* key :
       {"mass = [{ name = \"other\", at_m = [0.1, 0.015, 0], mass_kg = 0.05 }]", "\"mass[0].mass_kg\" = 0.05"}) {
    const Experiment e = parse_experiment(
        edited("with = { kinematics = \"hencky\" }", ("with = { " + std::string(key) + " }").c_str()), "bar.toml");
    EXPECT_TRUE(varied(e, {1, 2}).masses.empty()) << key;
    EXPECT_DOUBLE_EQ(varied(e, {0, 2}).masses.at(0).mass, 0.05) << key;
  }
}

struct Mistake {
  const char *name, *from, *to, *message;
};
void PrintTo(const Mistake& m, std::ostream* out) { *out << m.name; }

class MeasuredTableMistake : public testing::TestWithParam<Mistake> {};

TEST_P(MeasuredTableMistake, IsRefusedWithLineKeyAndRemedy) {
  const Mistake& m = GetParam();
  const std::string message = message_of(edited(m.from, m.to));
  EXPECT_NE(message.find(m.message), std::string::npos) << message;
  EXPECT_NE(message.find("(allowed: "), std::string::npos) << message;
  EXPECT_EQ(message.find('\n'), std::string::npos) << message;
}

INSTANTIATE_TEST_SUITE_P(
    All, MeasuredTableMistake,
    testing::Values(
        Mistake{"no_u", ", u = 5e-4 }", " }", "62:3: measured.values.u: is missing (allowed: a finite number > 0"},
        Mistake{"u_of_0", "u = 5e-4 }", "u = 0 }", "measured.values.u: is 0 (allowed: a finite number > 0"},
        Mistake{"negative_u", "u = 5e-4 }", "u = -5e-4 }", "measured.values.u: is -0.0005"},
        Mistake{"millimetres_for_metres", "value = -0.02,", "value = -20,",
                "measured.values.value: is -20 m, more than twice the size of the body (allowed: a number in m"},
        Mistake{"unmeasured_quantity", "\"displacement.tip.z\"", "\"displacement.end.z\"",
                "'displacement.end.z' is not known"},
        Mistake{"a_difference", "\"displacement.tip.z\"", "\"displacement_error\"",
                "is a difference between computations"},
        Mistake{"same_name", "name = \"more\"", "name = \"sag\"", "measured.values.name: 'sag' is the name of another"},
        Mistake{"no_licence", "licence = \"CC BY 4.0\"\n", "", "measured.licence: is missing"},
        Mistake{"no_such_load_case", "minus = \"own weight\"", "minus = \"own wait\"", "did you mean 'own weight'"},
        Mistake{"minus_itself", "minus = \"own weight\"", "minus = \"52 g\"", "is the same load case"},
        Mistake{"arm_of_a_probe", "minus = \"own weight\"", "arm_m = [0, 0, 1]",
                "measured.values.arm_m: turns with a patch"},
        Mistake{"fit_to_nothing", ", use = \"fit\"", "", "1 inputs are fitted to 0 values"},
        Mistake{"nothing_fitted", "fitted = true\n", "", "0 inputs are fitted to 1 values"},
        Mistake{"first_load_case_changed", "name = \"52 g\"\n", "name = \"52 g\"\nwith = { mass = [] }\n",
                "changes the first load case"},
        Mistake{"second_unchanged", "with = { mass = [] }\n", "", "is the case as written once more"},
        Mistake{"no_such_key",
                "\"mass[0].mass_kg\" = ", "\"mass[1].mass_kg\" = ", "'mass[1].mass_kg' names nothing in the case"},
        Mistake{"no_dot_after_an_item",
                "\"mass[0].mass_kg\" = ", "\"mass[0]mass_kg\" = ", "'mass[0]mass_kg' names nothing in the case"},
        Mistake{"open_item", "\"mass[0].mass_kg\" = 0.102", "\"mass[0\" = []", "'mass[0' names nothing in the case"},
        Mistake{"item_beyond_all_numbers",
                "\"mass[0].mass_kg\" = ", "\"mass[99999999999999999999].mass_kg\" = ", "names nothing in the case"},
        Mistake{"key_with_dots_unquoted", "with = { \"mass[0].mass_kg\" = 0.102 }",
                "with = { material.density_kg_m3 = 1000 }",
                "load_case.with: 'material' would be replaced by a table (allowed: a key of it, in quotes"},
        Mistake{"item_of_a_replaced_list", "with = { \"mass[0].mass_kg\" = 0.102 }",
                "with = { mass = [{ name = \"other\", at_m = [0, 0.015, 0.03], mass_kg = 0.05 }] }",
                "input.of: 'mass[0].at_m[0]' is of a list that a load case replaces"},
        Mistake{"fit_to_0", "value = -0.0108,", "value = 0,", "measured.values.value: is 0, to which nothing can be"},
        Mistake{"stress", "\"displacement.tip.z\"", "\"stress.tip.xx\"",
                "'stress.tip.xx' is not known of the equilibria of models"},
        Mistake{"nothing_to_leave_out", "with = { mass = [] }", "with = { mas = [] }",
                "'mas' names nothing in the case"},
        Mistake{"no_such_number", "\"body.size_m[0]\"", "\"body.size_m[3]\"",
                "'body.size_m[3]' is no number of the case"},
        Mistake{"input_without_u", "u = 5e-4\n", "", "input: is neither uncertain nor an alternative"},
        Mistake{"input_u_of_0", "u = 5e-4\n", "u = 0\n", "input.u: is 0"},
        Mistake{"input_beyond_the_case", "of = \"material.youngs_modulus_Pa\"\nu = 7e3",
                "of = \"material.poisson_ratio\"\nu = 0.02", "with this change the case is refused"},
        Mistake{"several_materials", "poisson_ratio = 0.49", "poisson_ratio = [0.4, 0.49]",
                "the case has several materials"}),
    [](const auto& test) { return test.param.name; });

TEST(MeasuredTable, LoadCasesAloneAreRefused) {
  std::string text = bar;
  text.erase(text.find("[[measured]]"));
  EXPECT_NE(message_of(text).find("load_case: is for measured values (allowed: beside [[measured]]"), std::string::npos)
      << message_of(text);
}

}  // namespace
}  // namespace springproof::experiment_measured_test
