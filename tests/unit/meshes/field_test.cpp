#include "meshes/field.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdint>
#include <cstring>
#include <fstream>
#include <sstream>

#include "support/tolerances.h"
#include "support/vtu_reader.h"

namespace springproof::field_test {
namespace {

namespace fs = std::filesystem;

using test::read_array;

class Vtu : public testing::Test {
 protected:
  Vtu() : folder_(fs::temp_directory_path() / ("springproof_vtu_" + std::to_string(getpid()))) {
    fs::create_directories(folder_);
  }
  ~Vtu() override { fs::remove_all(folder_); }

  static std::string read(const fs::path& file) {
    std::ifstream in(file, std::ios::binary);
    std::stringstream text;
    text << in.rdbuf();
    return text.str();
  }

  /// A stretched block of 3 x 2 x 1 cells with a tetrahedron on top.
  static Field example() {
    Mesh mesh = block_mesh({3, 2, 1}, {3, 2, 1});
    const Eigen::Index top = mesh.nodes.rows();
    mesh.nodes.conservativeResize(top + 1, 3);
    mesh.nodes.row(top) << 0, 0, 2;
    mesh.tetrahedra = {{12, 13, 16, static_cast<int>(top)}};
    Field field;
    field.displacement = mesh.nodes * Vec3(0.1, -0.05, 0.2).asDiagonal();
    field.mesh = std::make_shared<const Mesh>(std::move(mesh));
    return field;
  }

  fs::path folder_;
};

TEST_F(Vtu, EveryArrayReadsBack) {
  const Field field = example();
  const NodalVectors difference = NodalVectors::Constant(field.mesh->nodes.rows(), 3, 1.0 / 3);
  write_vtu(folder_ / "a.vtu", field, {{"difference to FEM", difference}});
  const std::string document = read(folder_ / "a.vtu");

  EXPECT_NE(document.find("NumberOfPoints=\"25\" NumberOfCells=\"7\""), std::string::npos);
  EXPECT_NE(document.find("header_type=\"UInt64\""), std::string::npos);
  auto expect_vectors = [&](const std::string& name, const NodalVectors& expected) {
    const auto values = read_array<double>(document, name);
    ASSERT_EQ(values.size(), static_cast<std::size_t>(expected.size())) << name;
    EXPECT_EQ(std::memcmp(values.data(), expected.data(), values.size() * sizeof(double)), 0) << name;
  };
  expect_vectors("displacement", field.displacement);
  expect_vectors("difference to FEM", difference);
  expect_vectors("position", field.mesh->nodes);

  const auto connectivity = read_array<std::int32_t>(document, "connectivity");
  ASSERT_EQ(connectivity.size(), 6u * 8 + 4);
  EXPECT_TRUE(std::equal(connectivity.begin() + 40, connectivity.begin() + 48, field.mesh->hexahedra[5].begin()));
  EXPECT_EQ(connectivity.back(), 24);
  EXPECT_EQ(read_array<std::int32_t>(document, "offsets"), (std::vector<std::int32_t>{8, 16, 24, 32, 40, 48, 52}));
  EXPECT_EQ(read_array<std::uint8_t>(document, "types"), (std::vector<std::uint8_t>{12, 12, 12, 12, 12, 12, 10}));
  const auto changes = read_array<double>(document, "relative_volume_change");
  ASSERT_EQ(changes.size(), 7u);
  for (const double change : changes) EXPECT_NEAR(change, 1.1 * 0.95 * 1.2 - 1, test::round_off);
}

TEST_F(Vtu, SaysWhatItIsOf) {
  write_vtu(folder_ / "a.vtu", example(), {}, {{{"model", "hybmss"}}, {{"poisson_ratio", 0.25}}});
  const std::string document = read(folder_ / "a.vtu");
  EXPECT_NE(document.find("Name=\"model\" NumberOfTuples=\"1\" format=\"ascii\">104 121 98 109 115 115 0<"),
            std::string::npos);
  EXPECT_EQ(read_array<double>(document, "poisson_ratio"), std::vector<double>{0.25});
}

TEST_F(Vtu, SinglePrecisionIsRoundedAndSmaller) {
  const Field field = example();
  write_vtu(folder_ / "double.vtu", field);
  write_vtu(folder_ / "single.vtu", field, {}, {{}, {}, true});
  const std::string document = read(folder_ / "single.vtu");
  const auto values = read_array<float>(document, "displacement");
  ASSERT_EQ(values.size(), static_cast<std::size_t>(field.displacement.size()));
  for (std::size_t i = 0; i < values.size(); ++i)
    EXPECT_EQ(values[i], static_cast<float>(field.displacement.data()[i]));
  EXPECT_EQ(document.find("Float64"), std::string::npos);
  EXPECT_LT(document.size(), read(folder_ / "double.vtu").size());
}

TEST_F(Vtu, IsCompressed) {
  Field field;
  field.mesh = std::make_shared<const Mesh>(block_mesh({1, 1, 1}, {20, 20, 20}));
  field.displacement = 0.01 * field.mesh->nodes;
  write_vtu(folder_ / "a.vtu", field);
  const std::size_t plain = 9261 * 2 * 3 * sizeof(double) + 8000 * (9 * sizeof(std::int32_t) + sizeof(double) + 1);
  EXPECT_LT(read(folder_ / "a.vtu").size(), plain / 2);
}

TEST_F(Vtu, NamesAreEscaped) {
  const Field field = example();
  write_vtu(folder_ / "a.vtu", field, {{"a<b & \"c\"", field.displacement}});
  EXPECT_NE(read(folder_ / "a.vtu").find("Name=\"a&lt;b &amp; &quot;c&quot;\""), std::string::npos);
}

TEST_F(Vtu, ReplacesAnOlderFileAndLeavesNothingElse) {
  std::ofstream(folder_ / "a.vtu") << "old";
  write_vtu(folder_ / "a.vtu", example());
  EXPECT_EQ(read(folder_ / "a.vtu").rfind("<?xml", 0), 0u);
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_), {}), 1);
}

TEST_F(Vtu, WhatCannotBeWrittenThrowsAndLeavesNothing) {
  EXPECT_THROW(write_vtu(folder_ / "nowhere" / "a.vtu", example()), std::runtime_error);
  fs::create_directory(folder_ / "taken.vtu");
  std::ofstream(folder_ / "taken.vtu" / "file") << "x";
  EXPECT_THROW(write_vtu(folder_ / "taken.vtu", example()), std::runtime_error);
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_), {}), 1);
}

TEST_F(Vtu, IsNotWrittenThroughALinkThatIsPlantedBesideIt) {
  std::ofstream(folder_ / "other") << "kept";
  fs::create_symlink(folder_ / "other", folder_ / "a.vtu.part");
  write_vtu(folder_ / "a.vtu", example());
  EXPECT_EQ(read(folder_ / "a.vtu").rfind("<?xml", 0), 0u);
  EXPECT_EQ(read(folder_ / "other"), "kept");
}

TEST_F(Vtu, WrongShapesAreRefused) {
  Field field = example();
  EXPECT_THROW(write_vtu(folder_ / "a.vtu", field, {{"short", NodalVectors::Zero(3, 3)}}), std::invalid_argument);
  field.displacement.conservativeResize(3, 3);
  EXPECT_THROW(write_vtu(folder_ / "a.vtu", field), std::invalid_argument);
  EXPECT_FALSE(fs::exists(folder_ / "a.vtu"));
}

}  // namespace
}  // namespace springproof::field_test
