// Every way to get a case file wrong that we could think of: the message must say where, what, and what is
// allowed.
#include <gtest/gtest.h>

#include "problem/experiment.h"
#include "support/case_file.h"

namespace springproof {
namespace {

using test::full_case;
using test::small_case;

std::string message_of(const std::string& text) {
  try {
    parse_experiment(text, "case.toml");
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

/// One edit of a valid case and what must be in the message.
struct Mistake {
  const char* name;
  const char* file;
  const char* replace;  ///< "" appends
  const char* with;
  std::vector<const char*> says;
};

void PrintTo(const Mistake& mistake, std::ostream* out) {
  *out << mistake.name;
}

class Mistakes : public testing::TestWithParam<Mistake> {};

TEST_P(Mistakes, AreExplained) {
  const Mistake& mistake = GetParam();
  std::string text = mistake.file;
  ASSERT_NE(message_of(text).find("accepted"), std::string::npos) << "the unedited file must be valid";
  const std::string old = mistake.replace;
  const std::size_t at = text.find(old);
  ASSERT_NE(at, std::string::npos) << old;
  old.empty() ? text.append(mistake.with) : text.replace(at, old.size(), mistake.with);
  const std::string message = message_of(text);
  EXPECT_EQ(message.rfind("case.toml:", 0), 0u) << message;
  for (const char* part : mistake.says)
    EXPECT_NE(message.find(part), std::string::npos) << message << "\nlacks: " << part;
}

const Mistake mistakes[] = {
    // Keys.
    {"UnknownTopKey",
     small_case,
     "",
     "\n[refrence]\n",
     {":14:2: refrence: unknown key", "did you mean 'reference'?"}},
    {"UnknownKeyInBody",
     small_case,
     "size_m",
     "sizes_m",
     {":3:1: body.sizes_m", "allowed: geo, size_m, cells", "'size_m'?"}},
    {"UnknownKeyOfALoad",
     small_case,
     "displacement_m",
     "displacment_m",
     {":12:1: load.displacment_m", "'displacement_m'?"}},
    {"UnknownKeyFarFromAll",
     small_case,
     "geo",
     "qqqqqqqqqqqqqq",
     {":2:1: body.qqqqqqqqqqqqqq: unknown key (allowed"}},
    {"MissingBody",
     "[material]\nyoungs_modulus_Pa = 1\npoisson_ratio = 0\n[[load]]\ngravity_m_s2 = "
     "[0,0,1]\n[body]\ngeo=\"a\"\nsize_m=[1,1,1]\ncells=[1,1,1]\n",
     "[body]\ngeo=\"a\"\nsize_m=[1,1,1]\ncells=[1,1,1]\n",
     "",
     {"body: is missing (allowed: a table [body]"}},
    {"MissingKey", small_case, "cells = [2, 2, 5]", "", {":1:1: body.cells: is missing", "[nx, ny, nz]"}},
    {"KeyTwice", small_case, "size_m", "geo", {":3:", "not valid TOML"}},
    {"LoadIsATable",
     small_case,
     "[[load]]",
     "[load]",
     {":10:1: load: is a table (allowed: tables headed [[load]])"}},
    {"NoLoad", small_case, "[[load]]\non = \"z_min\"\ndisplacement_m = [0, 0, 0]", "", {"load: is missing"}},
    // Syntax.
    {"Syntax", small_case, "\"block.geo\"", "block.geo", {":2:7: not valid TOML"}},
    {"UnclosedString", small_case, "\"block.geo\"", "\"block.geo", {":2:17: not valid TOML"}},
    // Body.
    {"GeoIsEmpty", small_case, "\"block.geo\"", "\"\"", {":2:7: body.geo: is empty"}},
    {"GeoIsANumber",
     small_case,
     "\"block.geo\"",
     "7",
     {":2:7: body.geo: is the integer 7 (allowed: a string)"}},
    {"SizeIsShort",
     small_case,
     "[1, 1.0, 2.5]",
     "[1, 1.0]",
     {":3:10: body.size_m: is a list of 2", "[x, y, z]"}},
    {"SizeIsZero", small_case, "[1, 1.0, 2.5]", "[1, 0, 2.5]", {":3:14: body.size_m: is 0", "> 0"}},
    {"SizeIsNan", small_case, "[1, 1.0, 2.5]", "[1, nan, 2.5]", {":3:14: body.size_m: is nan"}},
    {"SizeIsInfinite", small_case, "[1, 1.0, 2.5]", "[1, 1, inf]", {"body.size_m: is inf"}},
    {"SizeIsText", small_case, "[1, 1.0, 2.5]", "[1, \"2\", 1]", {"body.size_m: is the string '2'"}},
    {"CellsAreFractions",
     small_case,
     "[2, 2, 5]",
     "[2, 2.0, 5]",
     {":4:13: body.cells: is the number 2", "integers from 1 to 1000"}},
    {"CellsAreZero", small_case, "[2, 2, 5]", "[2, 0, 5]", {":4:13: body.cells: is 0"}},
    {"CellsAreHuge", small_case, "[2, 2, 5]", "[2, 1001, 5]", {"body.cells: is 1001"}},
    {"CellsOverflow", small_case, "[2, 2, 5]", "[2, 4294967297, 5]", {"body.cells: is 4294967297"}},
    {"CellsAreEmpty", small_case, "[2, 2, 5]", "[]", {"body.cells: is an empty list"}},
    {"CellsAreMixed", small_case, "[2, 2, 5]", "[[2, 2, 5], 3]", {"body.cells: is the integer 3"}},
    {"CellsTwice",
     small_case,
     "[2, 2, 5]",
     "[[2, 2, 5], [2, 2, 5]]",
     {"body.cells: [2, 2, 5] is named twice"}},
    // Material.
    {"PoissonRatioOneHalf",
     small_case,
     "0.3",
     "0.5",
     {":8:17: material.poisson_ratio: is 0.5 (allowed: -1 < poisson_ratio < 0.5)"}},
    {"PoissonRatioTooLarge", small_case, "0.3", "0.6", {"is 0.6", "-1 < poisson_ratio < 0.5"}},
    {"PoissonRatioMinusOne", small_case, "0.3", "-1", {"is -1", "-1 < poisson_ratio < 0.5"}},
    {"PoissonRatioNan", small_case, "0.3", "nan", {"material.poisson_ratio: is nan"}},
    {"PoissonRatioInAList", small_case, "0.3", "[0.1, 0.5]", {":8:23: material.poisson_ratio: is 0.5"}},
    {"PoissonRatioTwice", small_case, "0.3", "[0.1, 0.1]", {"has the Poisson's ratio 0.1 twice"}},
    {"PoissonRatioEmpty", small_case, "0.3", "[]", {"material.poisson_ratio: is an empty list"}},
    {"ModulusIsText",
     small_case,
     "1e4",
     "\"stiff\"",
     {":7:21: material.youngs_modulus_Pa: is the string 'stiff'"}},
    {"ModulusIsNegative", small_case, "1e4", "-1e4", {"material.youngs_modulus_Pa: is -10000", "> 0"}},
    {"ModulusIsInfinite", small_case, "1e4", "inf", {"material.youngs_modulus_Pa: is inf"}},
    {"OneModulus",
     small_case,
     "youngs_modulus_Pa = 1e4",
     "",
     {":6:1: material: has 1 elastic moduli: poisson_ratio", "exactly two"}},
    {"ThreeModuli",
     small_case,
     "poisson_ratio",
     "bulk_modulus_Pa = 1e4\npoisson_ratio",
     {"has 3 elastic moduli", "bulk_modulus_Pa"}},
    {"ImpossiblePair",
     small_case,
     "poisson_ratio = 0.3",
     "shear_modulus_Pa = 3e3",
     {"no elastic solid has", "poisson_ratio = 0.66"}},
    {"ListsOfTwoLengths",
     small_case,
     "1e4\npoisson_ratio = 0.3",
     "[1, 2, 3]\npoisson_ratio = [0.1, 0.2]",
     {":8:17: material.poisson_ratio: is a list of 2"}},
    {"DensityIsZero", full_case, "1060", "0", {"material.density_kg_m3: is 0"}},
    {"Kinematics",
     full_case,
     "\"hencky\"",
     "\"henky\"",
     {":3:14: kinematics: 'henky' is not known (allowed: linear, hencky", "'hencky'?"}},
    // Loads.
    {"LoadSaysNothing",
     small_case,
     "displacement_m = [0, 0, 0]",
     "",
     {":10:1: load: says where but not what"}},
    {"LoadHasTwoKinds",
     small_case,
     "displacement_m = [0, 0, 0]",
     "displacement_m = [0, 0, 0]\ntraction_Pa = [0, 0, 1]",
     {":13:1: load.traction_Pa"}},
    {"LoadWithoutPatch", small_case, "on = \"z_min\"", "", {"load.on: is missing (allowed: a patch name"}},
    {"LoadOnANumber", small_case, "\"z_min\"", "5", {":11:6: load.on: is the integer 5"}},
    {"LoadOnNothing", small_case, "\"z_min\"", "[]", {"load.on: is an empty list"}},
    {"LoadOnThePatchTwice",
     small_case,
     "\"z_min\"",
     "[\"z_min\", \"z_min\"]",
     {":11:16: load.on: names 'z_min' twice"}},
    {"GravityOnAPatch",
     small_case,
     "displacement_m",
     "gravity_m_s2",
     {":11:1: load.on: unknown key (allowed: gravity_m_s2)"}},
    {"PointForceOnAPatch",
     small_case,
     "displacement_m = [0, 0, 0]",
     "force_N = [0, 0, 1]\nat_m = [0, 0, 0]",
     {"load.on: unknown key (allowed: force_N, at_m)"}},
    {"AllFree",
     small_case,
     "[0, 0, 0]",
     "[\"free\", \"free\", \"free\"]",
     {":12:18: load.displacement_m: prescribes nothing"}},
    {"NotQuiteFree",
     small_case,
     "[0, 0, 0]",
     "[\"fre\", 0, 0]",
     {":12:19: load.displacement_m: is the string 'fre'", "\"free\""}},
    {"DisplacementIsNan", small_case, "[0, 0, 0]", "[0, nan, 0]", {":12:22: load.displacement_m: is nan"}},
    {"FourComponents", small_case, "[0, 0, 0]", "[0, 0, 0, 0]", {"load.displacement_m: is a list of 4"}},
    {"GradientIsFlat",
     full_case,
     "[[0, 0, 0], [0, 0, 0], [0, 0, 1e-3]]",
     "[0, 0, 0]",
     {"load.displacement_gradient: is the integer 0"}},
    {"GradientIsShort",
     full_case,
     "[[0, 0, 0], [0, 0, 0], [0, 0, 1e-3]]",
     "[[0, 0, 0], [0, 0, 0]]",
     {"load.displacement_gradient: is a list of 2"}},
    {"AxisIsZero", full_case, "[0, 3, 4]", "[0, 0.0, 0]", {"load.axis: is the zero vector"}},
    {"AxisIsMissing", full_case, "axis = [0, 3, 4]", "", {"load.axis: is missing"}},
    {"RotationIsInfinite",
     full_case,
     "rotation_deg = 45",
     "rotation_deg = inf",
     {"load.rotation_deg: is inf"}},
    {"RotationIsText",
     full_case,
     "rotation_deg = 45",
     "rotation_deg = \"45\"",
     {"load.rotation_deg: is the string '45'"}},
    // Probes, section, reference.
    {"ProbesShareAName",
     full_case,
     "[reference]",
     "[[probe]]\nname = \"tip\"\nat_m = [0, 0, 0]\n[reference]",
     {"probe.name: 'tip' is the name of another probe"}},
    {"NormalIsZero", full_case, "[0, -2, 0]", "[0, 0, 0]", {"section.normal: is the zero vector"}},
    {"GradingIsSmall",
     full_case,
     "grading = 1",
     "grading = 0.9",
     {"reference.grading: is 0.9 (allowed: a number from 1 to 3)"}},
    {"GradingIsLarge", full_case, "grading = 1", "grading = 3.1", {"reference.grading: is 3.1"}},
    // Compare.
    {"UnknownMeasure",
     full_case,
     "\"reaction\"",
     "\"reactions\"",
     {"compare.measures: 'reactions' is not known", "did you mean 'reaction'?"}},
    {"MeasureTwice", full_case, "\"reaction\"", "\"volume_change\"", {"'volume_change' is named twice"}},
    {"SectionIsMissing",
     full_case,
     "[section]\npoint_m = [1.2, 0, 0]\nnormal = [0, -2, 0]\n",
     "",
     {"compare.measures: 'section_distance' needs a plane", "[section]"}},
    {"ProbeIsMissing",
     full_case,
     "[[probe]]\nname = \"tip\"\nat_m = [2.4, 0.2, 0.2]\n",
     "",
     {"compare.measures: 'probe' needs points", "[[probe]]"}},
    {"LabelTwice",
     full_case,
     "label = \"share\"",
     "label = \"hybmss\"",
     {"compare.models: the label 'hybmss' is taken"}},
    {"LabelOfTheReference", full_case, "label = \"share\"", "label = \"fem\"", {"the label 'fem' is taken"}},
    {"ModelWithoutName",
     full_case,
     "model = \"hybmss\", face_to_cube",
     "face_to_cube",
     {"compare.models.model: is missing"}},
    {"OptionIsAList",
     full_case,
     "face_to_cube = 1.0",
     "face_to_cube = [1.0]",
     {"compare.models.face_to_cube: is a list"}},
    {"OptionIsNan",
     full_case,
     "face_to_cube = 1.0",
     "face_to_cube = nan",
     {"compare.models.face_to_cube: is nan"}},
    {"NoModels", small_case, "", "\n[compare]\nmodels = []\n", {"compare.models: is an empty list"}},
    {"ModelsIsAString",
     small_case,
     "",
     "\n[compare]\nmodels = \"hybmss\"\n",
     {":15:10: compare.models: is the string 'hybmss'"}},
    // Expect and published.
    {"ExpectUnknownModel",
     full_case,
     "\"fem\"",
     "\"fem_q3\"",
     {"expect.model: 'fem_q3' is not known", "fem_q1"}},
    {"ExpectUnknownPoissonRatio",
     full_case,
     "poisson_ratio = 0.25",
     "poisson_ratio = 0.26",
     {"expect.poisson_ratio: 0.26 is not in the case (allowed: -0.5, 0.25, 0.499)"}},
    {"ExpectUnknownCells",
     full_case,
     "cells = [48, 8, 8]",
     "cells = [48, 8, 9]",
     {"expect.cells: [48, 8, 9] is not in the case (allowed: [24, 4, 4], [48, 8, 8])"}},
    {"ExpectUnknownMeasure",
     full_case,
     "\"force.x_max.magnitude\"",
     "\"force.x_mx.magnitude\"",
     {"expect.measure: 'force.x_mx.magnitude'", "'force.x_max.magnitude'?"}},
    {"ExpectUnknownProbe",
     full_case,
     "\"displacement.tip.z\"",
     "\"displacement.top.z\"",
     {"expect.measure", "'displacement.tip.z'?"}},
    {"ExpectUnmeasured",
     small_case,
     "",
     "\n[compare]\nmeasures = [\"reaction\"]\n[[expect]]\nmodel = \"hybmss\"\nmeasure = "
     "\"volume_change\"\nsource = \"analytic\"\nvalue = 0\nwithin = 1\n",
     {"expect.measure: 'volume_change' is not known (allowed: force.z_min.x"}},
    {"ExpectUnknownSource",
     full_case,
     "\"published\"\nvalue",
     "\"printed\"\nvalue",
     {"expect.source: 'printed'", "extrapolated FEM"}},
    {"ExpectWithoutValue", full_case, "value = -1.5\n", "", {"expect.value: is missing", "extrapolated FEM"}},
    {"ExpectWithoutTolerance", full_case, "within = 1e-6\n", "", {"expect: has no tolerance"}},
    {"ExpectWithTwoTolerances",
     full_case,
     "within = 1e-6\n",
     "within = 1\nwithin_relative = 1\n",
     {"expect: has two tolerances"}},
    {"ExpectNegativeTolerance",
     full_case,
     "within = 1e-6\n",
     "within = -1\n",
     {"expect.within: is -1", ">= 0"}},
    {"ExpectFractionOfZero",
     full_case,
     "-1.5\nwithin =",
     "0\nwithin_relative =",
     {"expect.within_relative: is a fraction of a value that is 0"}},
    {"ExpectNan", full_case, "value = -1.5", "value = nan", {"expect.value: is nan"}},
    {"PublishedUnknownPoissonRatio",
     full_case,
     "poisson_ratio = 0.499",
     "poisson_ratio = 0.49",
     {"published.poisson_ratio: 0.49 is not in the case"}},
    {"PublishedWithoutSource", full_case, "where = \"Fig. 4\"\n", "", {"published.where: is missing"}},
    {"PublishedValueIsText",
     full_case,
     "value = 0.1\n",
     "value = \"0.1\"\n",
     {"published.value: is the string '0.1'"}},
};

INSTANTIATE_TEST_SUITE_P(CaseFile, Mistakes, testing::ValuesIn(mistakes),
                         [](const auto& test) { return std::string(test.param.name); });

TEST(Mistake, TablesThatAreNone) {
  const std::string rest = std::string(small_case).substr(std::string(small_case).find("[material]"));
  EXPECT_EQ(message_of("body = 3\n" + rest), "case.toml:1:8: body: is the integer 3 (allowed: a table)");
  EXPECT_EQ(message_of("section = \"x\"\n" + std::string(small_case)),
            "case.toml:1:11: section: is the string 'x' (allowed: a table)");
}

TEST(Mistake, LoadIsAListOfNumbers) {
  std::string text = small_case;
  text = "load = [1, 2]\n" + text.erase(text.find("[[load]]"));
  EXPECT_NE(message_of(text).find("case.toml:1:9: load: is the integer 1 (allowed: tables headed [[load]])"),
            std::string::npos)
      << message_of(text);
}

}  // namespace
}  // namespace springproof
