// Which files a body is made from.
#include "meshes/mesher/mesh_cache.h"

#include <gtest/gtest.h>

#include <fstream>

#include "problem/processes/child.h"

namespace springproof::script_files_test {
namespace {

namespace fs = std::filesystem;

class ScriptFiles : public testing::Test {
 protected:
  void write(const std::string& name, const std::string& text = "x") {
    fs::create_directories((folder_.path / name).parent_path());
    std::ofstream(folder_.path / name) << text;
  }
  std::set<std::string> behind(const std::string& name) {
    std::set<std::string> names;
    for (const fs::path& file : files_behind(folder_.path / name))
      names.insert(fs::relative(file, fs::canonical(folder_.path)));
    return names;
  }

  TemporaryFolder folder_;
};

TEST_F(ScriptFiles, IncludesAreFollowedAndAppliedFromWhereTheyStand) {
  write("body.geo", "Include \"parts/sizes.geo\"; // don't\nMerge 'skin.stl';\nPhysical Surface(\"nothing\") = {1};\n");
  write("parts/sizes.geo", "a = 1;\nInclude \"deep.inc\";\n");
  write("parts/deep.inc", "Include \"../body.geo\";\n");  // round again
  write("skin.stl");
  write("deep.inc");
  write("bystander.geo");
  EXPECT_EQ(behind("body.geo"), (std::set<std::string>{"body.geo", "parts/sizes.geo", "parts/deep.inc", "skin.stl"}));
}

TEST_F(ScriptFiles, NamesMadeByAScriptAndOptionsAreSeen) {
  write(
      "body.geo",
      "For i In {1 : 2}\n Merge Sprintf(\"part%g.stl\", i);\nEndFor\nMerge StrCat(CurrentDirectory, \"last.step\");\n");
  for (const char* name : {"part1.stl", "part2.stl", "last.step", "body.geo.opt", "other.stl"}) write(name);
  EXPECT_EQ(behind("body.geo"),
            (std::set<std::string>{"body.geo", "body.geo.opt", "part1.stl", "part2.stl", "last.step"}));
}

TEST_F(ScriptFiles, OtherBodiesStandAlone) {
  write("skin.stl", "solid x\n");
  EXPECT_EQ(behind("skin.stl"), (std::set<std::string>{"skin.stl"}));
  EXPECT_TRUE(behind("missing.stl").empty());
}

}  // namespace
}  // namespace springproof::script_files_test
