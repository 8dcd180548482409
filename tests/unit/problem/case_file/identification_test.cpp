// [[identify]].
#include "problem/case_file/identification.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "problem/case_file/varied.h"
#include "support/case_file.h"

namespace springproof::identification_test {
namespace {

using test::message_of;

const std::string bar = test::heavy_bar + std::string(R"([[probe]]
name = "tip"
at_m = [0.1, 0.015, 0.015]

[compare]
measures = ["probe"]

[[input]]
name = "length"
of = "body.size_m[0]"
u = 5e-4

[[input]]
name = "density"
of = "material.density_kg_m3"
u = 20

[[input]]
name = "law"
with = { kinematics = "hencky" }

[[measured]]
source = "our laboratory"
licence = "CC BY 4.0"
values = [
  { name = "sag", quantity = "displacement.tip.z", value = -0.0108, u = 3e-4 },
  { name = "drift", quantity = "displacement.tip.x", value = -0.001, u = 3e-4 },
]
)");

std::string with(const std::string& table) { return std::string(bar) + "[[identify]]\nname = \"modulus\"\n" + table; }

constexpr const char* modulus = "parameters = [{ of = \"material.youngs_modulus_Pa\" }]\nfit = [\"sag\"]\n";

Identification read(const std::string& table) {
  return identifications(parse_experiment(with(table), "bar.toml")).at(0);
}

TEST(IdentifyTable, StartsAtTheCaseBetweenWideBounds) {
  const Identification i = read(modulus);
  EXPECT_EQ(i.name, "modulus");
  EXPECT_EQ(i.fitted, std::vector<std::size_t>{0});
  EXPECT_EQ(i.model, "hybmss");
  const SoughtParameter& E = i.parameters.at(0);
  EXPECT_EQ(E.name, "youngs_modulus_Pa");
  EXPECT_DOUBLE_EQ(E.start, 2.5e5);
  EXPECT_DOUBLE_EQ(E.lower, 250);
  EXPECT_DOUBLE_EQ(E.upper, 2.5e8);
  EXPECT_TRUE(E.logarithmic);
  EXPECT_TRUE(identifications(parse_experiment(bar, "bar.toml")).empty());
}

TEST(IdentifyTable, SeeksPoissonsRatioItselfAndInputsThatItDoesNotSeekStayUncertain) {
  const Identification i = read(
      "parameters = [{ of = \"material.poisson_ratio\", start = 0.3, bounds = [0.1, 0.45] }, { of = "
      "\"material.density_kg_m3\" }]\nfit = [\"sag\", \"drift\"]\nmodel = \"fem_p1\"\ncells = [[4, 1, 1]]\n");
  EXPECT_FALSE(i.parameters.at(0).logarithmic);
  EXPECT_DOUBLE_EQ(i.parameters[0].start, 0.3);
  ASSERT_EQ(i.inputs.size(), 2u);  // the length, and the density, which is sought; not the law
  EXPECT_TRUE(i.inputs[0].sought.empty());
  EXPECT_EQ(i.inputs[1].sought, std::vector<std::size_t>{1});
  for (const OtherInput& input : read(modulus).inputs) EXPECT_TRUE(input.sought.empty());
  EXPECT_EQ(i.model, "fem_p1");
  EXPECT_EQ(i.cells, std::vector<Cells>{Cells({4, 1, 1})});
}

TEST(IdentifyTable, TakesTheValuesThatAnInputWasFittedTo) {
  std::string text = with("parameters = [{ of = \"material.youngs_modulus_Pa\" }]\n");
  EXPECT_NE(message_of(text).find("identify: has nothing to fit"), std::string::npos) << message_of(text);
  text.replace(text.find("u = 3e-4"), 8, "u = 3e-4, use = \"fit\"");
  text.replace(text.find("u = 20"), 6, "u = 20\nfitted = true");
  EXPECT_EQ(identifications(parse_experiment(text, "bar.toml")).at(0).fitted, std::vector<std::size_t>{0});
}

TEST(IdentifyTable, OtherNumbersAreThoseOfTheCaseReadAnew) {
  const Experiment e = parse_experiment(with(modulus), "bar.toml");
  const Experiment other =
      varied(e, {.numbers = {{{"material.youngs_modulus_Pa"}, 1e5}, {{"body.size_m[1]", "body.size_m[2]"}, 0.02}}});
  EXPECT_DOUBLE_EQ(other.materials.at(0).youngs_modulus, 1e5);
  EXPECT_EQ(other.body.size, Vec3(0.1, 0.02, 0.02));
  EXPECT_DOUBLE_EQ(number_of(e, "body.size_m[0]").value(), 0.1);
  EXPECT_FALSE(number_of(e, "body.size_m[3]"));
  EXPECT_FALSE(number_of(e, "body.geo"));
}

TEST(IdentifyTable, IsRefusedAtThePlaceOfTheMistake) {
  const std::string E = "{ of = \"material.youngs_modulus_Pa\" }", nu = "{ of = \"material.poisson_ratio\" }";
  for (const auto& [table, message] : std::initializer_list<std::pair<std::string, std::string>>{
           {"parameters = [" + E + ", " + nu + "]\nfit = [\"sag\"]\n",
            "identify.parameters: 2 parameters for 1 fitted values (allowed: as many values as parameters at least: "
            "more "
            "in fit, or fewer parameters)"},
           {"parameters = [{ of = \"material.loss\" }]\nfit = [\"sag\"]\n",
            "identify.parameters.of: 'material.loss' is no number of the case"},
           {"parameters = [{ of = \"material.youngs_modulus_Pa\", bounds = [1e6, 1e4] }]\nfit = [\"sag\"]\n",
            "identify.parameters.bounds: 1e+06 is not below 10000 (allowed: the lower first)"},
           {"parameters = [{ of = \"material.youngs_modulus_Pa\", start = 1e7, bounds = [1e4, 1e6] }]\nfit = "
            "[\"sag\"]\n",
            "identify.parameters.start: starts at 1e+07, outside its bounds (allowed: a number from 10000 to 1e+06"},
           {"parameters = [{ of = \"body.size_m[2]\" }]\nfit = [\"sag\"]\n",
            "identify.parameters.of: of 'body.size_m[2]' no usual bounds are known (allowed: bounds = [lower, upper]"},
           {"parameters = [" + E + "]\nfit = [\"sagg\"]\n", "identify.fit: 'sagg' is not known (allowed: sag, drift)"},
           {"parameters = [" + E + "]\nfit = [\"sag\", \"sag\"]\n", "identify.fit: 'sag' is named twice"},
           {"parameters = [" + E + "]\nfit = [\"sag\"]\nmodel = \"fem_q3\"\n", "identify.model: 'fem_q3' is not known"},
           {std::string(modulus) + "[[identify]]\nname = \"modulus\"\n" + modulus,
            "'modulus' is the name of another"}}) {
    const std::string said = message_of(with(table));
    EXPECT_NE(said.find(message), std::string::npos) << said << "\n" << message;
    EXPECT_TRUE(said.starts_with("case.toml:")) << said;
  }
}

}  // namespace
}  // namespace springproof::identification_test
