// Files that are no case at all: missing, empty, cut off, damaged.  The answer is a case or an InputError,
// never anything else.
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <random>

#include "problem/case_file/experiment.h"
#include "support/case_file.h"

namespace springproof::experiment_damage_test {
namespace {

using test::message_of;

using test::full_case;
using test::small_case;

TEST(CaseFile, EmptyIsOneClearMessage) {
  for (const char* text : {"", "\n\n", "# only a comment\n", "\xef\xbb\xbf"})
    EXPECT_EQ(message_of(text), "case.toml: the case file is empty (needed: [body], [material], [[load]])");
}

TEST(CaseFile, MissingFileDirectoryAndDevice) {
  auto message = [](const std::filesystem::path& file) {
    try {
      read_experiment(file);
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string("accepted");
  };
  EXPECT_EQ(message("nowhere/case.toml"), "nowhere/case.toml: no such file (allowed: a case file, NAME.toml)");
  EXPECT_NE(message(std::filesystem::temp_directory_path()).find("is a folder (allowed: a case file"),
            std::string::npos);
  EXPECT_NE(message("/dev/null").find("no regular file"), std::string::npos);
  EXPECT_NE(message(std::string("\0x", 2)), "accepted");
  EXPECT_NE(message(std::string(100000, 'x')), "accepted");
}

TEST(CaseFile, ReadsFromDisk) {
  const auto folder = std::filesystem::temp_directory_path() / ("springproof_case_" + std::to_string(getpid()));
  std::filesystem::create_directory(folder);
  std::ofstream(folder / "stretch.toml") << small_case;
  const Experiment e = read_experiment(folder / "stretch.toml");
  std::filesystem::remove_all(folder);
  EXPECT_EQ(e.name, "stretch");
  EXPECT_EQ(e.folder, folder.filename());
  EXPECT_EQ(e.text, small_case);
}

/// Either a valid experiment or an InputError that names the file; anything else fails the test or ends it.
void expect_answer(const std::string& text) {
  const std::string message = message_of(text);
  if (message == "accepted") return;
  ASSERT_EQ(message.rfind("case.toml:", 0), 0u) << message << "\nof:\n" << text;
}

TEST(CaseFile, CutOffAtEveryByte) {
  const std::string text = full_case;
  int accepted = 0;
  for (std::size_t length = 0; length < text.size(); ++length) {
    expect_answer(text.substr(0, length));
    accepted += message_of(text.substr(0, length)) == "accepted";
  }
  EXPECT_GT(accepted, 0);
  EXPECT_LT(accepted, static_cast<int>(text.size()) / 2);
}

TEST(CaseFile, RandomDamage) {
  std::mt19937 generator(1);
  const std::string text = full_case;
  const std::string bytes = std::string("\0\xff\x80\"'[]{}=,.#\n\t-+_e0", 21);
  for (int i = 0; i < 3000; ++i) {
    std::string damaged = text;
    for (int edits = 0; edits < 1 + i % 3; ++edits) {
      const std::size_t at = generator() % damaged.size();
      switch (generator() % 3) {
        case 0:
          damaged[at] = bytes[generator() % bytes.size()];
          break;
        case 1:
          damaged.erase(at, 1 + generator() % 20);
          break;
        default:
          damaged.insert(at, damaged.substr(generator() % damaged.size(), generator() % 30));
      }
    }
    expect_answer(damaged);
  }
}

TEST(CaseFile, BinaryGarbage) {
  std::mt19937 generator(2);
  for (int i = 0; i < 500; ++i) {
    std::string garbage(1 + generator() % 300, '\0');
    for (char& c : garbage) c = static_cast<char>(generator());
    expect_answer(garbage);
  }
  EXPECT_NE(message_of(std::string(100000, '[')).find("more than 16 tables and lists"), std::string::npos);
  EXPECT_NE(message_of("a = " + std::string(100000, '[')).find("more than 16 tables and lists"), std::string::npos);
}

}  // namespace
}  // namespace springproof::experiment_damage_test
