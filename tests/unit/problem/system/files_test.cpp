// Whole files, written at once, and whatever a user may name as one.
#include "problem/files/files.h"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <system_error>

#include "problem/processes/child.h"
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

/// Files of a folder.
std::size_t count_in(const fs::path& folder) {
  return static_cast<std::size_t>(std::distance(fs::recursive_directory_iterator(folder), {}));
}

class Files : public testing::Test {
 protected:
  Files() { fs::create_directory(folder_); }
  TemporaryFolder place_;
  const fs::path folder_ = place_.path / "here";
};

TEST_F(Files, ThatAreNamedAreWrittenThroughSymbolicLinks) {
  fs::create_directories(folder_ / "deep");
  fs::create_symlink("deep/second", folder_ / "first");  // relative to the link's folder
  fs::create_symlink("../file", folder_ / "deep" / "second");
  for (const char* text : {"new", "again"}) {
    write_named_file(folder_ / "first", text);
    EXPECT_EQ(text_of_file(folder_ / "file"), text);
    EXPECT_TRUE(fs::is_symlink(folder_ / "first") && fs::is_symlink(folder_ / "deep" / "second"));
  }
  EXPECT_EQ(count_in(folder_), 4u) << "something is left behind";
  fs::create_symlink("loop", folder_ / "loop");
  EXPECT_THROW(write_named_file(folder_ / "loop", "a"), std::system_error);
  EXPECT_TRUE(fs::is_symlink(folder_ / "loop"));
}

TEST_F(Files, OfOursReplaceLinksAndNeverWriteThroughThem) {
  write_file(folder_ / "of_others", "theirs");
  for (const char* name : {"results", "results.part"}) fs::create_symlink("of_others", folder_ / name);
  for (const char* text : {"new", "again"}) {
    write_file(folder_ / "results", text);
    EXPECT_EQ(text_of_file(folder_ / "results"), text);
  }
  EXPECT_EQ(text_of_file(folder_ / "of_others"), "theirs");
  EXPECT_TRUE(fs::is_symlink(folder_ / "results.part"));
  EXPECT_EQ(count_in(folder_), 3u) << "something is left behind";
}

TEST_F(Files, ThatAreNamedAndPipesOrDevicesStayWhatTheyAre) {
  const fs::path pipe = folder_ / "pipe";
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  const fs::path output = folder_ / "output";
  const pid_t reader = fork();
  if (reader == 0) {
    execl("/bin/sh", "sh", "-c", ("cat '" + pipe.string() + "' >'" + output.string() + "'").c_str(), nullptr);
    _exit(1);
  }
  write_named_file(pipe, "through");
  ASSERT_EQ(waitpid(reader, nullptr, 0), reader);
  EXPECT_EQ(text_of_file(output), "through");
  EXPECT_TRUE(fs::is_fifo(pipe));
  write_named_file("/dev/null", "nothing");
  EXPECT_TRUE(fs::is_character_file("/dev/null"));
  EXPECT_THROW(write_named_file("/dev/full", "something"), std::system_error);
}

std::string refusal(const fs::path& file, std::uintmax_t most_bytes = largest_file) try {
  read_named_file(file, "a case file", most_bytes);
  return "read";
} catch (const InputError& e) {
  const std::string message = e.what(), begin = file.string() + ": ", end = " (allowed: a case file)";
  EXPECT_TRUE(message.starts_with(begin) && message.ends_with(end)) << message;
  return message.substr(begin.size(), message.size() - begin.size() - end.size());
}

TEST_F(Files, ThatAreNoneAreRefusedByNameWithoutBeingRead) {
  const fs::path pipe = folder_ / "pipe", large = folder_ / "large", link = folder_ / "link", loop = folder_ / "loop",
                 text = folder_ / "text";
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);  // without a writer: whoever opens it waits
  std::ofstream(large) << "";
  fs::resize_file(large, largest_file + 1);  // sparse
  fs::create_symlink("/dev/zero", link);
  fs::create_symlink("loop", loop);
  write_file(text, "text");
  EXPECT_EQ(refusal(pipe), "is no regular file");
  EXPECT_EQ(refusal("/dev/zero"), "is no regular file");
  EXPECT_EQ(refusal(link), "is no regular file");
  EXPECT_EQ(refusal(folder_), "is a folder");
  EXPECT_EQ(refusal(large), "is larger than 2 GiB");
  EXPECT_EQ(refusal(folder_ / "none"), "no such file");
  EXPECT_EQ(refusal(text / "none"), "no such file");
  EXPECT_EQ(refusal(loop), "cannot be read: Too many levels of symbolic links");
  EXPECT_EQ(refusal("/proc/self/mem"), "cannot be read: Input/output error");
  EXPECT_EQ(refusal("/proc/self/maps", 1), "is larger than 0 MiB") << "a file without a size";
  EXPECT_EQ(refusal(text), "read");
  for (const fs::path& none : {pipe, fs::path("/dev/zero"), folder_, loop}) EXPECT_EQ(text_of_file(none), "");
}

}  // namespace
}  // namespace springproof::files_test
