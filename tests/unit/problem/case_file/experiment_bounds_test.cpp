// Case files that would cost the stack, the memory or the trust of their reader.
#include <gtest/gtest.h>

#include "problem/case_file/experiment.h"
#include "problem/files/file_name.h"
#include "problem/system/shortened.h"
#include "support/case_file.h"

namespace springproof::experiment_bounds_test {
namespace {

using test::message_of;
using test::small_case;

std::string repeated(const std::string& text, int times) {
  std::string all;
  for (int i = 0; i < times; ++i) all += text;
  return all;
}

#define EXPECT_SAYS(message, words) EXPECT_NE((message).find(words), std::string::npos) << (message).substr(0, 1000)

TEST(Bounds, KeysOfFiftyThousandPartsAreRefused) {
  for (const std::string& line :
       {repeated("a.", 50000) + "a = 1\n", "[" + repeated("a.", 50000) + "a]\n",
        repeated("\"a\" . ", 50000) + "a = 1\n", "x = { " + repeated("a.", 50000) + "a = 1 }\n"}) {
    const std::string message = message_of(line + small_case);
    EXPECT_SAYS(message, "case.toml:1:1: more than 16 parts of a key");
  }
  EXPECT_SAYS(message_of("a = " + repeated("[", 50000)), "more than 16 tables and lists in each other");
  EXPECT_SAYS(message_of("\n\na = " + repeated("{a.a.a = ", 50000)), "case.toml:3:1: more than 16 tables and lists");
}

TEST(Bounds, DotsAndBracketsInStringsCommentsAndNumbersAreNoDepth) {
  const std::string dots = repeated(". ", 40) + repeated("[", 40);
  for (const std::string& top :
       {"cite = \"" + dots + " \\\" " + dots + "\"\n", "cite = '" + dots + "'\n",
        "cite = \"\"\"" + dots + "\n\" " + dots + "\"\"\"\n", "# " + dots + "\n", "cite = '''\n" + dots + "'''\n"})
    EXPECT_SAYS(message_of(top + small_case), "accepted");
  std::string text = small_case;
  text.replace(
      text.find("0.3"), 3, "[0.01" + [] {
        std::string l;
        for (int i = 1; i < 40; ++i) l += ", 0.01" + std::to_string(100 + i);
        return l;
      }() + "]");
  EXPECT_SAYS(message_of(text), "accepted");
}

TEST(Bounds, FilesOfMegabytesAreRefused) {
  EXPECT_SAYS(message_of(repeated("# comment\n", 500000) + small_case), "case.toml: has 5000");
}

TEST(Bounds, LongWordsAreShortenedInMessages) {
  const std::string name(5000, 'x');
  for (const std::string& message :
       {message_of(name + " = 1\n" + small_case), message_of("kinematics = \"" + name + "\"\n" + small_case),
        message_of("what = 1" + repeated("0", 400) + "\n" + small_case)}) {
    EXPECT_LT(message.size(), 600u);
    EXPECT_EQ(message.rfind("case.toml:1:", 0), 0u) << message.substr(0, 200);
  }
  EXPECT_EQ(shortened(repeated("\xc3\xa4", 60) + " end"), repeated("\xc3\xa4", 20) + "... (120 letters) end");
  EXPECT_EQ(shortened("two\nlines"), "two lines");
  EXPECT_EQ(shortened("\x1b[1;31mError\x1b[0m: \x1b[38;5;9mred\x1b[K"), "Error: red");
}

TEST(Bounds, NumbersBeyondReasonAreRefusedWithTheirPlace) {
  for (const auto& [number, shown] :
       {std::pair{"1e300", "1e+300"}, {"1e-300", "1e-300"}, {"5e-324", "5e-324"}, {"1e308", "1e+308"}}) {
    std::string text = small_case;
    text.replace(text.find("1e4"), 3, number);
    EXPECT_SAYS(message_of(text), std::string("case.toml:7:21: material.youngs_modulus_Pa: is ") + shown +
                                      " (allowed: a finite number > 0, 1e-30 to 1e+30 in size)");
  }
}

TEST(Bounds, BodiesOfNanometresAreRefused) {
  std::string text = small_case;
  text.replace(text.find("[1, 1.0, 2.5]"), 13, "[1e-9, 1e-9, 1e-9]");
  EXPECT_SAYS(message_of(text),
              "case.toml:3:11: body.size_m: is 1e-09 (allowed: a finite number > 0, from 1e-6 to 1e9 [m])");
}

std::string block_case(const std::string& loads, const std::string& reference) {
  return "[body]\ngeo = \"block.geo\"\nsize_m = [1, 1, 1]\ncells = [4, 4, 1]\n[material]\nyoungs_modulus_Pa = "
         "1e4\npoisson_ratio = 0.3\n" +
         loads + "[reference]\ncells = " + reference + "\n";
}

std::string held(const std::string& patch, const std::string& displacement) {
  return "[[load]]\non = \"" + patch + "\"\ndisplacement_m = " + displacement + "\n";
}

const std::string clamped = held("z_min", "[0, 0, 0]") + held("z_max", "[0, 0, 0.1]");
const std::string plane =
    held("z_min", "[\"free\", \"free\", 0]") + held("z_max", "[\"free\", \"free\", 0]") + held("x_min", "[0, 0, 0]");

TEST(ReferenceCells, ThatCannotBeRefinedAreRefused) {
  EXPECT_SAYS(
      message_of(block_case(clamped, "[1, 1, 1]")),
      "case.toml:15:9: reference.cells: is 1 along x, which cannot be refined (allowed: numbers divisible by 4");
  EXPECT_SAYS(message_of(block_case(clamped, "[8, 8, 1]")), "reference.cells: is 1 along z");
  EXPECT_SAYS(message_of(block_case(clamped, "[8, 6, 8]")),
              "reference.cells: is 6 along y (allowed: numbers divisible by 4");
  EXPECT_SAYS(message_of(block_case(clamped, "[8, 8, 8]")), "accepted");
}

TEST(ReferenceCells, PlaneStrainKeepsItsSingleLayer) {
  EXPECT_SAYS(message_of(block_case(plane, "[8, 8, 1]")), "accepted");
  EXPECT_SAYS(message_of(block_case(plane, "[8, 1, 1]")), "is 1 along y");
  EXPECT_SAYS(message_of(block_case(plane + "[[load]]\non = \"x_max\"\ntraction_Pa = [1, 1, 0]\n", "[8, 8, 1]")),
              "accepted");
  for (const std::string& more :
       {std::string("[[load]]\non = \"x_max\"\ntraction_Pa = [1, 0, 1]\n"),
        std::string("[[load]]\nforce_N = [1, 0, 0]\nat_m = [1, 1, 0]\n"), held("y_min", "[0, 0, 0.1]"),
        std::string("[[load]]\non = \"z_max\"\ntraction_Pa = [1, 0, 0]\n"),
        std::string("[[load]]\non = \"x_max\"\nrotation_deg = 1\naxis = [1, 0, 0]\nabout_m = [0, 0, 0]\n")})
    EXPECT_SAYS(message_of(block_case(plane + more, "[8, 8, 1]")), "is 1 along z, which cannot be refined");
}

TEST(ReferenceCells, ThatNoMachineHoldsAreRefusedWithTheirCost) {
  EXPECT_SAYS(message_of(block_case(clamped, "[1000, 1000, 1000]")),
              "reference.cells: [1000, 1000, 1000] would take 1.08e+04 GB of memory (allowed: what fits into the");
}

TEST(Loads, ThatContradictEachOtherAreRefused) {
  const auto says = [](const std::string& loads, const char* words) {
    EXPECT_SAYS(message_of(block_case(loads, "[8, 8, 8]")), words);
  };
  says(clamped + held("z_max", "[\"free\", \"free\", 0.2]"),
       "case.toml:14:1: load: the displacement of 'z_max' along z is prescribed by the load in line 11 too");
  says(clamped + "[[load]]\non = \"z_max\"\nrotation_deg = 5\naxis = [0, 0, 1]\nabout_m = [0, 0, 0]\n",
       "along x is prescribed by the load in line 11 too");
  says(clamped + "[[load]]\non = \"z_min\"\nforce_N = [0, 3, 0]\n",
       "'z_min' is held and pulled along y, here and by the load in line 8: the force would do nothing");
  says("[[load]]\non = \"z_min\"\ntraction_Pa = [0, 0, 3]\n" + clamped, "'z_min' is held and pulled along z");
  says(clamped + held("z_max", "[0, 0, 0.1]"), "accepted");
  says(held("z_min", "[0, 0, 0]") + held("z_max", "[\"free\", \"free\", 0.1]") +
           "[[load]]\non = \"z_max\"\nforce_N = [1, 0, 0]\n",
       "accepted");
}

std::string labelled(const std::string& a, const std::string& b) {
  return std::string(small_case) + "\n[compare]\nmodels = [{ model = \"hybmss\", label = " + a +
         " }, { model = \"msm_18\", label = " + b + " }]\n";
}

TEST(Labels, NeverShareAFile) {
  EXPECT_SAYS(message_of(labelled("\"a b\"", "\"a_b\"")),
              "compare.models: the label 'a_b' is taken as the name of a file, by 'a b'");
  EXPECT_SAYS(message_of(labelled("\"A\"", "\"a\"")), "the label 'a' is taken as the name of a file, by 'A'");
  EXPECT_SAYS(message_of(labelled("\"../a\"", "\"__a\"")), "accepted");
  EXPECT_SAYS(message_of(labelled("\"FEM\"", "\"a\"")), "the label 'FEM' is taken");
  EXPECT_SAYS(message_of(labelled("\"a\\nb\"", "\"a\"")), "cannot name a file");
  EXPECT_SAYS(message_of(labelled("\"" + std::string(5000, 'a') + "\"", "\"a\"")),
              "cannot name a file (allowed: up to 120 letters");
}

TEST(Labels, AsFileNamesStayInTheirFolder) {
  EXPECT_EQ(file_name("../../../x"), "_._.._.._x");
  EXPECT_EQ(file_name(".."), "_.");
  EXPECT_EQ(file_name("/etc/passwd"), "_etc_passwd");
  EXPECT_EQ(file_name("hybmss A=1"), "hybmss_A=1");
  EXPECT_EQ(file_name("\xce\xbd\x01"), "\xce\xbd_");
}

}  // namespace
}  // namespace springproof::experiment_bounds_test
