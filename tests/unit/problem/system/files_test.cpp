// Whole files, written at once.
#include "problem/system/files.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <system_error>

#include "support/case_file.h"

namespace springproof::files_test {
namespace {

namespace fs = std::filesystem;

TEST(WriteFile, NamesTheFileAndTheReason) {
  const fs::path file = fs::path(testing::TempDir()) / "springproof-no-folder" / "a.json";
  try {
    write_file(file, "a");
    FAIL();
  } catch (const std::system_error& e) {
    EXPECT_EQ(e.code(), std::errc::no_such_file_or_directory);
    EXPECT_EQ(e.what(), "cannot write " + file.string() + ": No such file or directory");
  }
}

TEST(WriteFile, GoesThroughSymbolicLinks) {
  const fs::path folder = fs::path(testing::TempDir()) / "springproof-links";
  fs::remove_all(folder);
  fs::create_directories(folder / "deep");
  fs::create_symlink("deep/second", folder / "first");  // relative to the link's folder
  fs::create_symlink("../file", folder / "deep" / "second");
  for (const char* text : {"new", "again"}) {
    write_file(folder / "first", text);
    EXPECT_EQ(text_of_file(folder / "file"), text);
    EXPECT_TRUE(fs::is_symlink(folder / "first") && fs::is_symlink(folder / "deep" / "second"));
  }
  EXPECT_FALSE(fs::exists(folder / "first.part") || fs::exists(folder / "file.part"));
  fs::create_symlink("loop", folder / "loop");
  EXPECT_THROW(write_file(folder / "loop", "a"), std::system_error);
  EXPECT_TRUE(fs::is_symlink(folder / "loop"));
  fs::remove_all(folder);
}

}  // namespace
}  // namespace springproof::files_test
