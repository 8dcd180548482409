// [[patch]]: what is read, what is refused.
#include "problem/patch_rule.h"

#include <gtest/gtest.h>

#include "problem/case_file/experiment.h"
#include "support/case_file.h"

namespace springproof::patch_rule_test {
namespace {

using test::message_of;

/// Rules are for bodies of voxels.
std::string voxel_case() {
  std::string text = test::small_case;
  const std::string cells = "cells = [2, 2, 5]";
  return text.replace(text.find(cells), cells.size(), "voxels = 100");
}

const std::string patch_case = voxel_case() + R"(
[[patch]]
name = "wrist"
box_m = [[0, 0, 0], [1, 2, 3]]
beyond = { point_m = [0, 0, 1], normal = [0, 3, 4] }
facing = { direction = [0, 0, -2], within_deg = 30 }
near = { point_m = [1, 2, 3], radius_m = 0.5 }

[[patch]]
name = "thumb"
near = { point_m = [4, 5, 6], radius_m = 1 }
)";

TEST(PatchRules, AreRead) {
  const Experiment e = parse_experiment(patch_case, "case.toml");
  ASSERT_EQ(e.patches.size(), 2u);
  const PatchRule& wrist = e.patches[0];
  EXPECT_EQ(wrist.name, "wrist");
  EXPECT_EQ(wrist.where.line, 14);
  ASSERT_TRUE(wrist.box && wrist.beyond && wrist.facing && wrist.near);
  EXPECT_EQ(wrist.box->low, Vec3(0, 0, 0));
  EXPECT_EQ(wrist.box->high, Vec3(1, 2, 3));
  EXPECT_EQ(wrist.beyond->point, Vec3(0, 0, 1));
  EXPECT_LE((wrist.beyond->normal - Vec3(0, 0.6, 0.8)).norm(), 1e-15);
  EXPECT_EQ(wrist.facing->direction, Vec3(0, 0, -1));
  EXPECT_EQ(wrist.facing->within_deg, 30);
  EXPECT_EQ(wrist.near->point, Vec3(1, 2, 3));
  EXPECT_EQ(wrist.near->radius, 0.5);
  EXPECT_TRUE(e.patches[1].near && !e.patches[1].box && !e.patches[1].beyond && !e.patches[1].facing);
}

TEST(PatchRules, KeepTheGridsOfHexahedraEven) {
  const std::string block = std::string(test::small_case) +
                            "[[patch]]\nname = \"low\"\nfacing = { direction = [0, 0, -1], within_deg = 10 }\n";
  EXPECT_EQ(parse_experiment(test::small_case, "case.toml").reference.grading, 1.5);
  EXPECT_EQ(parse_experiment(block, "case.toml").reference.grading, 1);
  EXPECT_NE(
      message_of(block + "[reference]\ngrading = 1.5\n").find("would move the border of a [[patch]] or [[region]]"),
      std::string::npos);
}

TEST(PatchRules, NoneIsTheUsualCase) { EXPECT_TRUE(parse_experiment(test::small_case, "case.toml").patches.empty()); }

struct Mistake {
  const char* old;
  const char* with;
  const char* says;
};

TEST(PatchRules, MistakesAreExplained) {
  const Mistake mistakes[] = {
      {"name = \"thumb\"", "name = \"wrist\"",
       "case.toml:22:8: patch.name: 'wrist' is the name of another patch (allowed: a name of its own)"},
      {"name = \"thumb\"\n", "", "case.toml:21:1: patch.name: is missing"},
      {"name = \"thumb\"", "name = 3", ":22:8: patch.name: is the integer 3 (allowed: a string)"},
      {"name = \"thumb\"", "name = \"\"", "patch.name: is empty"},
      {"near = { point_m = [4, 5, 6], radius_m = 1 }", "",
       ":21:1: patch: 'thumb' does not say where it lies (allowed: one or more of side, box_m"},
      {"box_m", "box",
       ":16:1: patch.box: unknown key (allowed: name, side, box_m, beyond, facing, near); did you mean 'box_m'?"},
      {"[[0, 0, 0], [1, 2, 3]]", "[[0, 0, 0]]", ":16:9: patch.box_m: is a list of 1"},
      {"[[0, 0, 0], [1, 2, 3]]", "[0, 0, 0, 1, 2, 3]", ":16:9: patch.box_m: is a list of 6"},
      {"[[0, 0, 0], [1, 2, 3]]", "[[0, 0, 0], [1, 0, 3]]",
       ":16:21: patch.box_m: has 0 for y, where the first corner has 0"},
      {"[[0, 0, 0], [1, 2, 3]]", "[[0, 0, 0], [1, inf, 3]]", "patch.box_m: is inf"},
      {"[[0, 0, 0], [1, 2, 3]]", "\"all\"", "patch.box_m: is the string 'all'"},
      {"normal = [0, 3, 4]", "normal = [0, 0, 0]", ":17:42: patch.beyond.normal: is the zero vector"},
      {", normal = [0, 3, 4]", "", ":17:10: patch.beyond.normal: is missing"},
      {"point_m = [0, 0, 1]", "point = [0, 0, 1]", "patch.beyond.point: unknown key"},
      {"direction = [0, 0, -2]", "direction = [0, 0]", "patch.facing.direction: is a list of 2"},
      {"name = \"wrist\"", "name = \"wrist\"\nside = \"bottom\"", "patch.side: stands beside beyond or facing"},
      {"near = { point_m = [4, 5, 6], radius_m = 1 }", "side = \"below\"",
       "patch.side: 'below' is not known (allowed: left, right, front, back, bottom, top)"},
      {"within_deg = 30", "within_deg = 0", ":18:49: patch.facing.within_deg: is 0 (allowed: an angle > 0 and <= 180)"},
      {"within_deg = 30", "within_deg = 181", "patch.facing.within_deg: is 181"},
      {"within_deg = 30", "within_deg = \"30\"", "patch.facing.within_deg: is the string '30'"},
      {"radius_m = 0.5", "radius_m = -1", "patch.near.radius_m: is -1 (allowed: a finite number > 0)"},
      {"radius_m = 0.5", "radius_m = nan", "patch.near.radius_m: is nan"},
      {", radius_m = 0.5", "", "patch.near.radius_m: is missing"},
      {"near = { point_m = [1, 2, 3], radius_m = 0.5 }", "near = 1", "patch.near: is the integer 1 (allowed: a table)"},
      {"[[patch]]\nname = \"thumb\"", "[[pach]]\nname = \"thumb\"", "did you mean 'patch'?"},
  };
  for (const Mistake& m : mistakes) {
    std::string text = patch_case;
    const std::size_t at = text.find(m.old);
    ASSERT_NE(at, std::string::npos) << m.old;
    const std::string message = message_of(text.replace(at, std::string(m.old).size(), m.with));
    EXPECT_NE(message.find(m.says), std::string::npos) << message << "\nlacks: " << m.says;
  }
  std::string table = patch_case;
  table.erase(table.rfind("\n[[patch]]"));
  table.replace(table.find("[[patch]]"), 9, "[patch]");
  EXPECT_NE(message_of(table).find("patch: is a table (allowed: tables headed [[patch]])"), std::string::npos)
      << message_of(table);
}

}  // namespace
}  // namespace springproof::patch_rule_test
