#include "meshes/surface/surface_files.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdint>
#include <ctime>
#include <fstream>

#include "problem/system/input_error.h"
#include "support/surfaces.h"

namespace springproof::stl_test {
namespace {

namespace fs = std::filesystem;
using namespace test;

class Stl : public testing::Test {
 protected:
  Stl() { fs::create_directories(folder_); }
  ~Stl() override { fs::remove_all(folder_); }

  fs::path write(const std::string& name, const std::string& bytes) const {
    std::ofstream(folder_ / name, std::ios::binary) << bytes;
    return folder_ / name;
  }
  static std::string bytes_of(const fs::path& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  static std::string message_of(const fs::path& file) {
    try {
      read_stl(file);
    } catch (const InputError& error) {
      return error.what();
    }
    return "accepted";
  }
  /// What reading a file of these bytes says, without the folder.
  std::string message(const std::string& bytes) const {
    const std::string all = message_of(write("a.stl", bytes));
    const std::string prefix = (folder_ / "a.stl").string();
    return all.starts_with(prefix) ? all.substr(prefix.size()) : all;
  }
  fs::path folder_ = fs::temp_directory_path() / fmt::format("springproof_stl_{}", getpid());
};

const std::string facet =
    "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n";

std::string binary(std::uint32_t count, std::size_t facets, float coordinate = 1) {
  std::string bytes(80, ' ');
  bytes.append(reinterpret_cast<const char*>(&count), 4);
  for (std::size_t f = 0; f < facets; ++f) {
    for (int i = 0; i < 12; ++i) {
      const float x = i == 7 && f + 1 == facets ? coordinate : static_cast<float>(i);
      bytes.append(reinterpret_cast<const char*>(&x), 4);
    }
    bytes.append(2, '\0');
  }
  return bytes;
}

TEST_F(Stl, BothKindsComeBackAsWritten) {
  const Surface s = noisy_sphere(1, 3, 0.05, 1);
  write_stl_ascii(folder_ / "ascii.stl", s);
  write_stl_binary(folder_ / "binary.stl", s);  // its header begins with "solid"
  for (const char* name : {"ascii.stl", "binary.stl"}) {
    const Surface read = read_stl(folder_ / name);
    ASSERT_EQ(read.triangles.size(), s.triangles.size());
    ASSERT_EQ(read.points.size(), 3 * s.triangles.size());
    for (std::size_t f = 0; f < s.triangles.size(); ++f)
      for (int i = 0; i < 3; ++i)
        EXPECT_LE((read.points[read.triangles[f][i]] - s.points[s.triangles[f][i]]).norm(), 2e-7) << name;  // floats
    EXPECT_NEAR(volume(read), volume(s), 1e-6 * volume(s)) << name;
  }
}

TEST_F(Stl, CoordinatesOfAnySizeAndSpelling) {
  const Surface s =
      read_stl(write("e.stl",
                     "solid\nfacet normal nan nan nan\nouter loop\nvertex 1e-6 -2.5E+03 +.5\nvertex 1. 1e-400 0\n"
                     "vertex -0 1e6 3\nendloop\nendfacet\nendsolid\n"));
  ASSERT_EQ(s.points.size(), 3u);
  EXPECT_EQ(s.points[0], Vec3(1e-6, -2500, 0.5));
  EXPECT_EQ(s.points[1], Vec3(1, 0, 0));
  EXPECT_EQ(s.points[2], Vec3(0, 1e6, 3));
}

TEST_F(Stl, LineEndsCaseNamesAndSeveralSolids) {
  const std::string solid = "solid endsolid facet vertex 1\n" + facet + facet + "endsolid of the first\n";
  std::string crlf, cr, upper = solid;
  for (const char c : solid) {
    crlf += c == '\n' ? std::string("\r\n") : std::string(1, c);
    cr += c == '\n' ? '\r' : c;
  }
  for (char& c : upper) c = static_cast<char>(std::toupper(c));
  for (const std::string& text : {solid, crlf, cr, upper, "\xef\xbb\xbf" + solid, "\n  \t" + solid, solid + "\n\n"})
    EXPECT_EQ(read_stl(write("a.stl", text)).triangles.size(), 2u) << text;
  EXPECT_EQ(read_stl(write("a.stl", solid + upper + crlf)).triangles.size(), 6u);
  EXPECT_EQ(message(crlf + "what now"), ":17:1: facet 3: 'what' where 'solid' should stand");
  EXPECT_EQ(message(cr + "what now"), ":17:1: facet 3: 'what' where 'solid' should stand");
}

TEST_F(Stl, RefusesWhatIsNoFile) {
  EXPECT_NE(message_of(folder_ / "nowhere.stl").find("nowhere.stl: no such file"), std::string::npos);
  EXPECT_NE(message_of(folder_).find("is a folder (allowed: an STL file"), std::string::npos);
  EXPECT_NE(message_of("/dev/null").find("is no regular file"), std::string::npos);
}

TEST_F(Stl, RefusesEmptyFiles) {
  EXPECT_EQ(message(""), ": is empty");
  EXPECT_EQ(message(" \n\r\n"), ": is empty");
  EXPECT_EQ(message("solid a\nendsolid a\n"), ": has no facets");
  EXPECT_EQ(message(binary(0, 0)), ": has no facets");
}

TEST_F(Stl, RefusesWhatIsCutOff) {
  EXPECT_EQ(message("solid a"), ":1:8: cut off after facet 0: no 'endsolid'");
  EXPECT_EQ(message("solid a\n" + facet), ":9:1: cut off after facet 1: no 'endsolid'");
  EXPECT_EQ(message("solid a\n" + facet + facet.substr(0, 50)), ":12:8: cut off within facet 2");
  // Wherever the cut is, short of the last word, it is seen as one.
  const std::string text = "solid a\n" + facet + facet + "endsolid";
  for (std::size_t size = 7; size < text.size(); ++size)
    EXPECT_NE(message(text.substr(0, size)).find("cut off"), std::string::npos) << message(text.substr(0, size)) << '\n'
                                                                                << text.substr(0, size);
}

TEST_F(Stl, RefusesAWrongCountWithBothNumbers) {
  EXPECT_NE(message(binary(12, 10)).find("says 12 facets, but the file's size is that of 10 facets:"),
            std::string::npos)
      << message(binary(12, 10));
  EXPECT_NE(message(binary(10, 12)).find("says 10 facets, but the file's size is that of 12 facets:"),
            std::string::npos);
  EXPECT_NE(
      message(binary(3, 3).substr(0, 200)).find("says 3 facets, but the file's size is that of 2 facets and 16 bytes"),
      std::string::npos);
  // 200 million facets, 10 GB, claimed: nothing is allocated for them.
  EXPECT_NE(message(binary(200'000'000, 2)).find("says 200000000 facets, but the file's size is that of 2 facets"),
            std::string::npos);
  EXPECT_NE(message(binary(0xffffffffu, 1)).find("says 4294967295 facets"), std::string::npos);
}

TEST_F(Stl, RefusesHugeFiles) {
  const fs::path file = write("huge.stl", binary(200'000'000, 0));
  fs::resize_file(file, 84 + std::uintmax_t{50} * 200'000'000);  // a hole: takes no room on the disk
  EXPECT_NE(message_of(file).find("is larger than 2 GiB (allowed: an STL file"), std::string::npos) << message_of(file);
}

TEST_F(Stl, RefusesWhatIsNoFiniteNumber) {
  EXPECT_NE(message(binary(3, 3, std::nanf("")))
                .find(": facet 3: a coordinate is not a finite number (corners (3, 4, 5), (6, nan, 8)"),
            std::string::npos)
      << message(binary(3, 3, std::nanf("")));
  EXPECT_NE(message(binary(1, 1, INFINITY)).find(": facet 1: a coordinate is not"), std::string::npos);
  for (const auto& [word, complaint] : {std::pair("nan", "coordinate 'nan' is not a finite number"),
                                        {"-inf", "coordinate '-inf' is not a finite"},
                                        {"1e999", "coordinate '1e999' is not a finite"},
                                        {"1,5", "'1,5' is not a number"},
                                        {"1.#QNAN", "'1.#QNAN' is not a number"},
                                        {"+-1", "'+-1' is not"},
                                        {"vertex", "'vertex' is not a number"}}) {
    std::string text = "solid\n" + facet + facet + "endsolid\n";
    text.replace(text.rfind("0 1 0"), 1, word);
    EXPECT_EQ(message(text).find(fmt::format(":13:8: facet 2: {}", complaint)), 0u) << message(text);
  }
}

TEST_F(Stl, RefusesOtherFiles) {
  EXPECT_EQ(message(std::string("\x89PNG\r\n\x1a\n\0\0\0\rIHDR", 16) + std::string(500, '\x7')),
            ": is no STL file but a PNG picture");
  EXPECT_EQ(message("Dear reader,\nthis is a letter.\n"),
            ": is no STL file: its first word is 'Dear' (ASCII STL begins with 'solid')");
  EXPECT_EQ(message("ISO-10303-21;\nHEADER;"), ": is no STL file but a STEP model");
  EXPECT_EQ(message("solid ground is what we need"), ":1:29: cut off after facet 0: no 'endsolid'");
  EXPECT_EQ(message("solid ground\nis what we need"), ":2:1: facet 1: 'is' where 'facet' or 'endsolid' should stand");
  EXPECT_EQ(message(std::string("\0\1\2", 3)), ": is no STL file: 3 bytes (binary STL has 84 and 50 per facet)");
  std::string noise;
  for (int i = 0; i < 5000; ++i) noise += static_cast<char>(i * 37 % 251);
  EXPECT_NE(message(noise).find("cut off or no STL file"), std::string::npos) << message(noise);
  EXPECT_NE(message("solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 1 1 0\nvertex 0 1 "
                    "0\nendloop\nendfacet\n")
                .find(":7:1: facet 1: 'vertex' where 'endloop' should stand"),
            std::string::npos)
      << "four corners";
}

/// At 1e6 m the coordinates of a ball of 2 m would be multiples of 0.06 m.
TEST_F(Stl, BinaryFilesWhoseNumbersDoNotResolveTheBodyAreRefused) {
  const Vec3 site(1e6, 2e5, 0);
  write_stl_binary(folder_ / "far.stl", moved(sphere(1, 2), 1, site));
  EXPECT_NE(message_of(folder_ / "far.stl")
                .find("far.stl: coordinates near 1000001 have steps of 0.062 in a binary STL file, and the body is 2 "
                      "long (allowed: 0.001 of that"),
            std::string::npos)
      << message_of(folder_ / "far.stl");
  write_stl_binary(folder_ / "long.stl", moved(sphere(1, 2), 1000, site));
  EXPECT_EQ(message_of(folder_ / "long.stl"), "accepted");
  write_stl_ascii(folder_ / "digits.stl", moved(sphere(1, 2), 1, site));
  EXPECT_EQ(message_of(folder_ / "digits.stl"), "accepted");
}

TEST_F(Stl, AMillionFacetsTakeSeconds) {
  const Surface s = torus(2, 0.5, 1000, 500);
  write_stl_binary(folder_ / "binary.stl", s);
  write_stl_ascii(folder_ / "ascii.stl", s);
  for (const char* name : {"binary.stl", "ascii.stl"}) {
    const std::clock_t start = std::clock();
    EXPECT_EQ(read_stl(folder_ / name).triangles.size(), 1'000'000u);
    const double seconds = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
    RecordProperty(name, fmt::format("{:.2f} s", seconds));
    EXPECT_LT(seconds, 20) << name;  // 0.1 s and 1 s; slower with sanitizers
  }
}

}  // namespace
}  // namespace springproof::stl_test
