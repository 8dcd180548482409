#include <gtest/gtest.h>
#include <unistd.h>

#include <Eigen/Geometry>
#include <fstream>
#include <thread>

#include "meshes/mesher/mesher.h"
#include "meshes/volume.h"
#include "support/tolerances.h"

namespace springproof::gmsh_test {
namespace {

namespace fs = std::filesystem;

/// A folder of its own for each test, removed at the end.
class Gmsh : public testing::Test {
 protected:
  Gmsh() : folder_(fs::temp_directory_path() / ("springproof_gmsh_" + std::to_string(getpid()))) {
    fs::create_directories(folder_);
  }
  ~Gmsh() override { fs::remove_all(folder_); }

  fs::path write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name) << text;
    return folder_ / name;
  }

  static fs::path built_in(const std::string& name) { return find_geo({name, {}, {}, {}}, "case.toml"); }

  std::string message_of(const fs::path& geo) const {
    try {
      mesh_geo(geo, Vec3(1, 1, 1), {2, 2, 2});
    } catch (const InputError& error) {
      return error.what();
    }
    return "accepted";
  }

  fs::path folder_;
};

constexpr const char* parameters = "DefineConstant[size_x = 1, size_y = 1, size_z = 1, nx = 1, ny = 1, nz = 1];\n";

TEST_F(Gmsh, BlockIsBlockMesh) {
  const Vec3 size(2.4, 0.37, 1.1);
  const Cells cells = {5, 3, 4};
  const Mesh mesh = mesh_geo(built_in("block.geo"), size, cells), expected = block_mesh(size, cells);
  ASSERT_EQ(mesh.nodes.rows(), expected.nodes.rows());
  EXPECT_LE((mesh.nodes - expected.nodes).cwiseAbs().maxCoeff(),
            1e-15 * 2.4 * 4);  // a few units of round-off
  EXPECT_EQ(mesh.hexahedra, expected.hexahedra);
  ASSERT_TRUE(mesh.grid);
  EXPECT_EQ(mesh.grid->cells, cells);
  EXPECT_EQ(mesh.grid->cell_index, expected.grid->cell_index);
  ASSERT_EQ(mesh.patches.size(), 6u);
  for (int p = 0; p < 6; ++p) {
    EXPECT_EQ(mesh.patches[p].name, expected.patches[p].name);
    EXPECT_EQ(mesh.patches[p].facets, expected.patches[p].facets);
  }
}

TEST_F(Gmsh, BeamHasTheSamePatches) {
  const Mesh mesh = mesh_geo(built_in("beam.geo"), {2.4, 0.4, 0.4}, {24, 4, 4});
  EXPECT_EQ(mesh.hexahedra.size(), 24u * 16);
  EXPECT_EQ(mesh.hexahedra, block_mesh({2.4, 0.4, 0.4}, {24, 4, 4}).hexahedra);
  for (const char* name : {"x_min", "x_max", "y_min", "y_max", "z_min", "z_max"}) EXPECT_NO_THROW(patch(mesh, name));
  EXPECT_TRUE(mesh.grid);
}

TEST_F(Gmsh, OneCellAndVeryUnequalSides) {
  EXPECT_EQ(mesh_geo(built_in("block.geo"), {1, 1, 1}, {1, 1, 1}).hexahedra.size(), 1u);
  const Mesh needle = mesh_geo(built_in("block.geo"), {1000, 1e-3, 1}, {7, 1, 2});
  ASSERT_TRUE(needle.grid);
  EXPECT_NEAR(volume(needle, needle.nodes), 1, test::round_off);
}

TEST_F(Gmsh, FindsTheScriptBesideTheCaseFirst) {
  const fs::path own = write("block.geo", parameters);
  EXPECT_EQ(find_geo({"block.geo", {}, {}, {}}, folder_ / "case.toml"), own);
  EXPECT_NE(find_geo({"beam.geo", {}, {}, {}}, folder_ / "case.toml").parent_path(), folder_);
  try {
    find_geo({"blok.geo", {}, {}, {"case.toml", 3, 7}}, folder_ / "case.toml");
    FAIL() << "accepted";
  } catch (const InputError& error) {
    const std::string message = error.what();
    EXPECT_EQ(message.rfind("case.toml:3:7: body.geo: ", 0), 0u) << message;
    EXPECT_NE(message.find("beam.geo, block.geo"), std::string::npos) << message;
  }
  EXPECT_THROW(find_geo({"", {}, {}, {}}, folder_ / "case.toml"), InputError);
  EXPECT_THROW(find_geo({"..", {}, {}, {}}, folder_ / "case.toml"), InputError);
}

// A quarter of a tube: curved, so no grid; two patches.  The facets must point away from the body.
TEST_F(Gmsh, CurvedBody) {
  const fs::path geo = write("tube.geo", std::string(parameters) + R"(
    Point(1) = {1, 0, 0};
    a[] = Extrude {1, 0, 0} { Point{1}; Layers{nx}; };
    b[] = Extrude { {0, 0, 1}, {0, 0, 0}, Pi/2 } { Line{a[1]}; Layers{ny}; Recombine; };
    c[] = Extrude {0, 0, size_z} { Surface{b[1]}; Layers{nz}; Recombine; };
    Physical Surface("bottom") = {b[1]};
    Physical Surface("top") = {c[0]};
    Physical Volume("body") = {c[1]};)");
  const Mesh mesh = mesh_geo(geo, {1, 1, 2}, {3, 40, 2});
  EXPECT_FALSE(mesh.grid);
  EXPECT_EQ(mesh.hexahedra.size(), 240u);
  EXPECT_GT(cell_volumes(mesh, mesh.nodes).minCoeff(), 0);
  // Polygon of 40 chords: the area of the sector times sin(a)/a.
  const double angle = M_PI / 80, sector = 0.75 * M_PI;
  EXPECT_NEAR(volume(mesh, mesh.nodes), 2 * sector * std::sin(angle) / angle, 1e-10);
  for (const char* name : {"bottom", "top"}) {
    const Vec3 outward = (name == std::string("top") ? 1 : -1) * Vec3::UnitZ();
    for (const auto& f : patch(mesh, name).facets) {
      const Vec3 a = mesh.nodes.row(f[0]), b = mesh.nodes.row(f[1]), c = mesh.nodes.row(f[2]);
      EXPECT_NEAR((b - a).cross(c - b).normalized().dot(outward), 1, 1e-10);
    }
  }
}

TEST_F(Gmsh, ExtrudedDownwards) {
  const fs::path geo = write("down.geo", std::string(parameters) + R"(
    Point(1) = {0, 0, 0};
    a[] = Extrude {size_x, 0, 0} { Point{1}; Layers{nx}; };
    b[] = Extrude {0, size_y, 0} { Line{a[1]}; Layers{ny}; Recombine; };
    c[] = Extrude {0, 0, -size_z} { Surface{b[1]}; Layers{nz}; Recombine; };
    Physical Surface("z_max") = {b[1]};)");
  const Mesh mesh = mesh_geo(geo, {1, 2, 3}, {2, 3, 4});
  ASSERT_TRUE(mesh.grid);
  EXPECT_DOUBLE_EQ(mesh.grid->origin.z(), -3);
  EXPECT_NEAR(volume(mesh, mesh.nodes), 6, test::round_off);
  const Mesh expected = block_mesh({1, 2, 3}, {2, 3, 4});
  EXPECT_EQ(mesh.hexahedra, expected.hexahedra);
  EXPECT_EQ(patch(mesh, "z_max").facets, patch(expected, "z_max").facets);
}

/// A mesh of one cell with the given corner order and its top facet pointing inward.
std::string one_cell_msh(const std::string& corners) {
  return R"($MeshFormat
2.2 0 8
$EndMeshFormat
$PhysicalNames
2
2 1 "top"
3 2 "body"
$EndPhysicalNames
$Nodes
8
1 0 0 0
2 1 0 0
3 1.1 1 0
4 0 1 0
5 0 0 1
6 1 0 1
7 1 1 1
8 0 1 1
$EndNodes
$Elements
2
1 3 2 1 1 5 8 7 6
2 5 2 2 1 )" +
         corners + "\n$EndElements\n";
}

TEST_F(Gmsh, MirroredCellsAreTurnedRound) {
  write("cell.msh", one_cell_msh("5 6 7 8 1 2 3 4"));
  const Mesh mesh = mesh_geo(write("merge.geo", "Merge \"cell.msh\";\n"), {1, 1, 1}, {1, 1, 1});
  EXPECT_NEAR(volume(mesh, mesh.nodes), 1 + 0.1 / 4,
              test::round_off);  // the moved corner's share of a quarter
  const auto facet = patch(mesh, "top").facets.at(0);
  const Vec3 a = mesh.nodes.row(facet[0]), b = mesh.nodes.row(facet[1]), c = mesh.nodes.row(facet[2]);
  EXPECT_TRUE((b - a).cross(c - b).isApprox(Vec3(0, 0, 1), test::round_off));
}

TEST_F(Gmsh, TwistedCellsAreRefused) {
  write("cell.msh", one_cell_msh("1 3 2 4 5 6 7 8"));
  EXPECT_NE(message_of(write("merge.geo", "Merge \"cell.msh\";\n")).find("inverted"), std::string::npos);
}

TEST_F(Gmsh, SecondOrderScriptsStillGiveEightNodes) {
  const fs::path block = built_in("block.geo");
  const fs::path geo = write("second.geo", "Mesh.ElementOrder = 2;\nInclude \"" + block.string() + "\";\n");
  EXPECT_EQ(mesh_geo(geo, {1, 1, 1}, {2, 2, 2}).nodes.rows(), 27);
}

TEST_F(Gmsh, TwoBodiesAreRefused) {
  const fs::path two = write("two.geo", R"(
    SetFactory("OpenCASCADE");
    Box(1) = {0, 0, 0, 1, 1, 1};
    Box(2) = {3, 0, 0, 1, 1, 1};
    Transfinite Curve "*" = 3; Transfinite Surface "*"; Recombine Surface "*"; Transfinite Volume "*";
    Physical Volume("body") = {1, 2};
  )");
  EXPECT_NE(message_of(two).find("2 parts that share no node"), std::string::npos) << message_of(two);
  EXPECT_EQ(separate_parts(block_mesh(Vec3::Ones(), {2, 1, 1})), 1);
}

TEST_F(Gmsh, SecondOrderHexahedraFollowTheSurface) {
  const Mesh mesh = mesh_geo(built_in("thick_cylinder.geo"), Vec3(9, 9, 1), {4, 4, 1}, {.second_order = true});
  ASSERT_EQ(mesh.curved.rows(), 27 * Eigen::Index(mesh.hexahedra.size()));
  // Corners are among the 27 points, where the frame of the corners says.
  for (std::size_t h = 0; h < mesh.hexahedra.size(); ++h)
    for (int c = 0; c < 8; ++c) {
      const auto& at = hexahedron_corners[c];
      const Vec3 point = mesh.curved.row(27 * h + 2 * at[0] + 6 * at[1] + 18 * at[2]);
      EXPECT_LE((point - mesh.nodes.row(mesh.hexahedra[h][c]).transpose()).norm(), 1e-12);
    }
  // A straight edge's middle would lie inside the circle.
  const double outer = mesh.nodes.leftCols<2>().rowwise().norm().maxCoeff();
  EXPECT_NEAR(mesh.curved.leftCols<2>().rowwise().norm().maxCoeff(), outer, 1e-9 * outer);
}

TEST_F(Gmsh, ErrorsCarryTheFileAndGmshsMessage) {
  const std::string syntax = message_of(write("syntax.geo", "Point(1) = {0, 0,\n"));
  EXPECT_NE(syntax.find("syntax.geo"), std::string::npos) << syntax;
  EXPECT_NE(syntax.find("syntax error"), std::string::npos) << syntax;
  EXPECT_NE(message_of(write("unknown.geo", "Point(1) = {0, 0, q};\n")).find("Unknown variable 'q'"),
            std::string::npos);
  EXPECT_NE(message_of(write("own.geo", "Error(\"the wall is too thin\");\n")).find("the wall is too thin"),
            std::string::npos);
  EXPECT_NE(message_of(write("empty.geo", "")).find("no hexahedra"), std::string::npos);
  EXPECT_NE(message_of(folder_ / "nowhere.geo").find("no such file"), std::string::npos);
  EXPECT_NE(message_of(folder_).find("is a folder"), std::string::npos);
  std::string binary;
  for (int i = 0; i < 2000; ++i) binary += static_cast<char>(i * 37 % 256);
  EXPECT_NE(message_of(write("binary.geo", binary)), "accepted");
  EXPECT_NE(message_of(write("plain.geo", std::string(parameters) + R"(
    SetFactory("OpenCASCADE");
    Box(1) = {0, 0, 0, 1, 1, 1};)"))
                .find("where hexahedra are wanted"),
            std::string::npos);
  // A failure leaves nothing behind for the next caller.
  EXPECT_EQ(message_of(built_in("block.geo")), "accepted");
}

TEST_F(Gmsh, SurfacesInsideTheBodyAreNoPatches) {
  const fs::path geo = write("inside.geo", std::string(parameters) + R"(
    Point(1) = {0, 0, 0};
    a[] = Extrude {1, 0, 0} { Point{1}; Layers{nx}; };
    b[] = Extrude {0, 1, 0} { Line{a[1]}; Layers{ny}; Recombine; };
    c[] = Extrude {0, 0, 1} { Surface{b[1]}; Layers{nz}; Recombine; };
    d[] = Extrude {0, 0, 1} { Surface{c[0]}; Layers{nz}; Recombine; };
    Physical Surface("middle") = {c[0]};
    Physical Volume("body") = {c[1], d[1]};)");
  EXPECT_TRUE(mesh_geo(geo, {1, 1, 1}, {2, 2, 2}).patches.empty());
}

TEST_F(Gmsh, RefusesImpossibleSizes) {
  const fs::path geo = built_in("block.geo");
  EXPECT_THROW(mesh_geo(geo, {1, 0, 1}, {1, 1, 1}), InputError);
  EXPECT_THROW(mesh_geo(geo, {1, std::nan(""), 1}, {1, 1, 1}), InputError);
  EXPECT_THROW(mesh_geo(geo, {1, 1, 1}, {1, -1, 1}), InputError);
}

TEST_F(Gmsh, CallersFromSeveralThreadsWaitForEachOther) {
  const fs::path geo = built_in("block.geo");
  std::vector<std::thread> threads;
  std::array<std::size_t, 4> cells{};
  for (int i = 0; i < 4; ++i)
    threads.emplace_back([&, i] { cells[i] = mesh_geo(geo, {1, 1, 1}, {i + 1, 2, 3}).hexahedra.size(); });
  for (std::thread& thread : threads) thread.join();
  for (int i = 0; i < 4; ++i) EXPECT_EQ(cells[i], 6u * (i + 1));
}

}  // namespace
}  // namespace springproof::gmsh_test
