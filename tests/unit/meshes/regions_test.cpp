// Regions of other materials: which cells are theirs, whatever says where they lie.
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <map>
#include <numbers>

#include "meshes/locate/outer_facets.h"
#include "meshes/mesh_json.h"
#include "meshes/mesher/mesher.h"
#include "meshes/mesher/refined_meshes.h"
#include "meshes/patches/select_patches.h"
#include "meshes/quality.h"
#include "meshes/regions/mark_regions.h"
#include "meshes/volume.h"
#include "problem/processes/child.h"
#include "support/says.h"
#include "support/surfaces.h"

namespace springproof::regions_test {
namespace {

namespace fs = std::filesystem;

MaterialRegion region(const RegionPlace& place) { return {"part", {1, 0.3, 1000}, {"case.toml", 7, 1}, place}; }

const PatchRule::Box box{{0.21, 0.33, 0.1}, {0.71, 0.8, 0.64}};
const PatchRule::Near ball{{0.5, 0.45, 0.5}, 0.3};

Mesh cube(bool tetrahedra = true) {
  return mesh_geo(find_geo({"block.geo", {}, {}, {}}, "case.toml"), {1, 1, 1}, {5, 5, 5}, {.tetrahedra = tetrahedra});
}

double volume_of(const Mesh& mesh, int material) {
  const Eigen::VectorXd cells = cell_volumes(mesh, mesh.nodes);
  double sum = 0;
  for (std::size_t c = 0; c < mesh.materials.size(); ++c)
    if (mesh.materials[c] == material) sum += cells[static_cast<Eigen::Index>(c)];
  return sum;
}

/// Facets that only one cell has: those of the surface, if the cells match.
std::size_t facets_of_one_cell(const Mesh& mesh) {
  std::map<std::array<int, 3>, int> cells;
  for (const Tetrahedron& t : mesh.tetrahedra)
    for (int without = 0; without < 4; ++without) {
      std::array<int, 3> facet{};
      for (int i = 0, n = 0; i < 4; ++i)
        if (i != without) facet[n++] = t[i];
      std::sort(facet.begin(), facet.end());
      ++cells[facet];
    }
  return std::count_if(cells.begin(), cells.end(), [](const auto& f) { return f.second == 1; });
}

std::string refusal_of(const std::vector<MaterialRegion>& regions, Mesh mesh) try {
  mark_regions(regions, 1, mesh);
  return "accepted";
} catch (const InputError& e) {
  return e.what();
}

TEST(Regions, CutABoxExactly) {
  Mesh mesh = cube();
  const auto notes = mark_regions({region(box)}, 1, mesh);
  EXPECT_NEAR(volume_of(mesh, 1), (box.high - box.low).prod(), 1e-12);
  EXPECT_NEAR(volume_of(mesh, 0) + volume_of(mesh, 1), 1, 1e-12);
  EXPECT_EQ(facets_of_one_cell(mesh), outer_facets(mesh).size());
  EXPECT_NEAR(nodal_areas(mesh, patch(mesh, "x_max")).sum(), 1, 1e-12);
  EXPECT_GT(quality_of(mesh).worst, 0.01);
  EXPECT_WORDS(notes.at(0), "region 'part' is 12.69 % of the body");
}

TEST(Regions, ThatAreThinTakeNoMoreTetrahedraThanABody) {
  for (const double beyond : {0.0, 9.0}) {  // of the sides of the body
    Mesh mesh = cube();
    mark_regions({region(PatchRule::Box{{-beyond, -beyond, 0.44}, {1 + beyond, 1 + beyond, 0.44 + 1. / 60}})}, 1, mesh);
    EXPECT_NEAR(volume_of(mesh, 1), 1. / 60, 1e-12);
    const auto inside = std::ranges::count(mesh.materials, 1);
    EXPECT_GT(inside, 5000);
    EXPECT_LT(inside, 50000);
    EXPECT_LT(mesh.tetrahedra.size(), 200000u);
    EXPECT_EQ(facets_of_one_cell(mesh), outer_facets(mesh).size());
  }
}

TEST(Regions, CutABallByFacetsOfItsVolume) {
  const double exact = 4 * std::numbers::pi / 3 * std::pow(ball.radius, 3);
  for (const double coarseness : {2.25, 1.5, 1.0, 0.5}) {
    Mesh mesh = coarseness < 1 ? halved(cube()) : cube();
    mark_regions({region(ball)}, coarseness, mesh);
    EXPECT_NEAR(volume_of(mesh, 1), exact, 1e-9 * exact) << coarseness;
    EXPECT_EQ(facets_of_one_cell(mesh), outer_facets(mesh).size());
    EXPECT_GT(quality_of(mesh).worst, 0.01);
  }
}

TEST(Regions, CutHalfABallByFacetsOfItsVolume) {
  Mesh mesh = cube();
  mark_regions({region(PatchRule::Near{{0.5, 0.45, 0}, 0.3})}, 1, mesh);
  const double exact = 2 * std::numbers::pi / 3 * std::pow(0.3, 3);
  EXPECT_NEAR(volume_of(mesh, 1), exact, 0.015 * exact);
  EXPECT_NEAR(nodal_areas(mesh, patch(mesh, "z_min")).sum(), 1, 1e-12);
}

TEST(Regions, CutAHalfSpaceAndLaterOnesLieOver) {
  Mesh mesh = cube();
  const PatchRule::Beyond upper{{0, 0, 0.37}, {0, 0, 1}};
  const auto notes = mark_regions({region(upper), region(box)}, 1, mesh);
  const double common = 0.5 * 0.47 * 0.27;
  EXPECT_NEAR(volume_of(mesh, 1), 0.63 - common, 1e-12);
  EXPECT_NEAR(volume_of(mesh, 2), (box.high - box.low).prod(), 1e-12);
  EXPECT_WORDS(notes.at(0), "% of it lies in later regions");
}

TEST(Regions, SayWhatOfThemLiesInALaterPhysicalVolume) {
  Mesh mesh = cube();
  for (const Tetrahedron& t : mesh.tetrahedra) {
    double z = 0;
    for (const int n : t) z += mesh.nodes(n, 2) / 4;
    mesh.materials.push_back(z > 0.4 ? 2 : 0);
  }
  const auto notes = mark_regions({region(box), region("upper")}, 1, mesh);
  EXPECT_WORDS(notes.at(0), "% of it lies in later regions");
  EXPECT_EQ(notes.at(0).find("outside"), std::string::npos) << notes.at(0);
}

TEST(Regions, StayWhenPatchesAreCutThroughThem) {
  Mesh mesh = cube();
  const PatchRule::Beyond right{{0.37, 0, 0}, {1, 0, 0}};
  mark_regions({region(right)}, 1, mesh);
  PatchRule rule;
  rule.name = "spot";
  rule.near = PatchRule::Near{{0.4, 0.5, 1}, 0.2};
  select_patches({rule}, mesh, 1);
  EXPECT_NEAR(volume_of(mesh, 1), 0.63, 1e-12);
}

TEST(Regions, OfHexahedraAreWholeOnes) {
  Mesh mesh = cube(false);
  mark_regions({region(PatchRule::Box{{0, 0, 0.6}, {1, 1, 1}})}, 1, mesh);
  EXPECT_NEAR(volume_of(mesh, 1), 0.4, 1e-12);
  EXPECT_TRUE(end_at_faces_of(mesh, {region(PatchRule::Box{{0, 0, 0.6}, {1, 1, 1}})}));
  EXPECT_FALSE(end_at_faces_of(mesh, {region(box)}));
  EXPECT_FALSE(end_at_faces_of(block_mesh({1, 1, 1}, {1, 1, 1}), {region(PatchRule::Box{{0, 0, 0.6}, {1, 1, 1}})}));
  EXPECT_FALSE(end_at_faces_of(mesh, {region(ball)}));
  EXPECT_WORDS(refusal_of({region(box)}, cube(false)), "case.toml:7:1: region: the border of 'part' runs through");
}

TEST(Regions, WithoutCellsAreRefused) {
  EXPECT_WORDS(refusal_of({region(PatchRule::Near{{3, 3, 3}, 0.2})}, cube()),
               "case.toml:7:1: region: 'part' holds no part of the body");
  EXPECT_WORDS(refusal_of({region(ball), region(PatchRule::Box{{-1, -1, -1}, {2, 2, 2}})}, cube()),
               "as later regions lie over all of it");
}

TEST(Regions, ThatAreTheBodyOrLieOutsideOfItAreSaid) {
  Mesh mesh = cube();
  EXPECT_WORDS(mark_regions({region(PatchRule::Box{{-1, -1, -1}, {2, 2, 2}})}, 1, mesh).at(0),
               "[material] is not used");
  mesh = cube();
  EXPECT_WORDS(mark_regions({region(PatchRule::Box{{0.5, 0, 0}, {1.5, 1, 1}})}, 1, mesh).at(0),
               "50 % of its shape lies outside of the body");
}

TEST(HalvedTetrahedra, KeepVolumesPatchesAndMaterials) {
  Mesh mesh = cube();
  mark_regions({region(box)}, 1, mesh);
  const Mesh fine = halved(mesh);
  EXPECT_EQ(fine.tetrahedra.size(), 8 * mesh.tetrahedra.size());
  EXPECT_GT(cell_volumes(fine, fine.nodes).minCoeff(), 0);
  EXPECT_NEAR(volume_of(fine, 1), volume_of(mesh, 1), 1e-12);
  EXPECT_EQ(facets_of_one_cell(fine), 4 * facets_of_one_cell(mesh));
  EXPECT_NEAR(nodal_areas(fine, patch(fine, "z_min")).sum(), 1, 1e-12);
}

TEST(Regions, TravelWithTheMesh) {
  Mesh mesh = cube();
  mark_regions({region(box)}, 1, mesh);
  EXPECT_EQ(mesh_from_json(to_json(mesh)).materials, mesh.materials);
}

class RegionFiles : public testing::Test {
 protected:
  fs::path write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_.path / name) << text;
    return folder_.path / name;
  }

  static std::string message_of(const MeshRequest& request) try {
    mesh_body(request);
    return "accepted";
  } catch (const InputError& e) {
    return e.what();
  }

  const std::string halves_ =
      "SetFactory(\"OpenCASCADE\");\nBox(1) = {0, 0, 0, 1, 1, 1};\nBox(2) = {1, 0, 0, 2, 1, 1};\n"
      "BooleanFragments{ Volume{1}; Delete; }{ Volume{2}; Delete; }\n"
      "Physical Volume(\"small\") = Volume In BoundingBox{-0.1, -0.1, -0.1, 1.1, 1.1, 1.1};\n"
      "Physical Volume(7) = Volume In BoundingBox{0.9, -0.1, -0.1, 3.1, 1.1, 1.1};\n";

  const TemporaryFolder folder_;
};

TEST_F(RegionFiles, OfAScriptAreItsPhysicalVolumes) {
  const fs::path file = write("halves.geo", halves_);
  const MeshedBody body = mesh_body({.file = file, .size = {3, 1, 1}, .edge = 0.5, .volumes = {"small"}});
  EXPECT_NEAR(volume_of(body.mesh, 1), 1, 1e-12);
  EXPECT_NEAR(volume_of(body.mesh, 0), 2, 1e-12);
  const MeshedBody by_number = mesh_body({.file = file, .size = {3, 1, 1}, .edge = 0.5, .volumes = {"", "7"}});
  EXPECT_NEAR(volume_of(by_number.mesh, 2), 2, 1e-12);
  EXPECT_WORDS(message_of({.file = file, .size = {3, 1, 1}, .edge = 0.5}), "a [[region]] with volume = ");
  EXPECT_WORDS(message_of({.file = file, .size = {3, 1, 1}, .edge = 0.5, .volumes = {"large"}}),
               "has no physical volume 'large', which a [[region]] names (allowed: ");
}

TEST_F(RegionFiles, ThatOverlapAreRefused) {
  const fs::path file = write("overlap.geo", halves_ + "Physical Volume(\"all\") = {Volume{:}};\n");
  EXPECT_WORDS(message_of({.file = file, .size = {3, 1, 1}, .edge = 0.5, .volumes = {"small", "all"}}),
               "have a part in common");
  EXPECT_NEAR(volume_of(mesh_body({.file = file, .size = {3, 1, 1}, .edge = 0.5, .volumes = {"small"}}).mesh, 1), 1,
              1e-12);
}

TEST_F(RegionFiles, OfStepAreItsSolidsByNumber) {
  const fs::path step = folder_.path / "two.step";
  const fs::path geo = write("make.geo",
                             "SetFactory(\"OpenCASCADE\");\nBox(1) = {0, 0, 0, 1, 1, 1};\nBox(2) = {1, 0, 0, 2, "
                             "1, 1};\nSave \"" +
                                 step.string() + "\";\n");
  try {
    mesh_body({.file = geo, .edge = 1});
  } catch (const InputError&) {  // two parts
  }
  const MeshedBody body = mesh_body({.file = step, .edge = 0.3, .scale = 1000, .volumes = {"2"}});
  EXPECT_NEAR(volume_of(body.mesh, 1), 2, 1e-9);
  EXPECT_NEAR(volume_of(body.mesh, 0), 1, 1e-9);
  EXPECT_EQ(facets_of_one_cell(body.mesh), outer_facets(body.mesh).size());
  EXPECT_WORDS(message_of({.file = step, .edge = 0.3, .scale = 1000, .volumes = {"3"}}), "has no physical volume '3'");
}

/// A surface in a file of the folder.
class RegionSurfaces : public RegionFiles {
 protected:
  MaterialRegion enclosed(const std::string& name, const Surface& surface, double scale = 1) const {
    const fs::path file = folder_.path / name;
    test::write_stl_binary(file, surface);
    return region(EnclosedPlace{file, scale});
  }
};

TEST_F(RegionSurfaces, NestedInTheBodyConvergeToTheirVolume) {
  const Surface round = test::moved(test::sphere(0.3, 4), 1, {0.5, 0.45, 0.5});
  const double exact = volume(round);
  Mesh coarse = cube(), fine = halved(cube());
  mark_regions({enclosed("ball.stl", round)}, 1, coarse);
  const auto notes = mark_regions({enclosed("ball.stl", round)}, 0.5, fine);
  EXPECT_LT(std::abs(exact - volume_of(fine, 1)), 0.4 * std::abs(exact - volume_of(coarse, 1)));
  EXPECT_LT(std::abs(exact - volume_of(fine, 1)), 0.03 * exact);
  EXPECT_EQ(facets_of_one_cell(fine), outer_facets(fine).size());
  EXPECT_GT(quality_of(fine).worst, 0.01);
  EXPECT_EQ(notes.at(0).find("outside"), std::string::npos) << notes.at(0);
}

TEST_F(RegionSurfaces, WithSharpEdgesKeepThem) {
  const Vec3 size(0.52, 0.48, 0.54);
  const Surface brick = test::moved(test::box(size, 2), 1, {0.21, 0.33, 0.12});
  Mesh mesh = halved(cube());
  mark_regions({enclosed("brick.stl", brick)}, 0.5, mesh);
  EXPECT_NEAR(volume_of(mesh, 1), size.prod(), 0.01 * size.prod());
  EXPECT_EQ(facets_of_one_cell(mesh), outer_facets(mesh).size());
}

TEST_F(RegionSurfaces, ThatPokeOutOfTheBodyAreClippedAndThoseThatOverlapPaintedOver) {
  Mesh mesh = cube();
  const Surface half = test::moved(test::box({1, 1, 1}, 3), 1, {0.6, 0, 0}),
                lower = test::moved(test::box({1, 1, 0.5}, 3), 1, {0, 0, -0.1});
  const auto notes = mark_regions({enclosed("half.stl", half), enclosed("lower.stl", lower)}, 1, mesh);
  EXPECT_NEAR(volume_of(mesh, 1), 0.4 * 0.6, 5e-3);
  EXPECT_NEAR(volume_of(mesh, 2), 0.4, 5e-3);
  EXPECT_WORDS(notes.at(0), "60 % of its shape lies outside of the body");
  EXPECT_WORDS(notes.at(0), "40 % of it lies in later regions");
  EXPECT_EQ(facets_of_one_cell(mesh), outer_facets(mesh).size());
}

TEST_F(RegionSurfaces, ThatAreThinAndPokeOutTakeTheTetrahedraOfWhatIsInside) {
  Mesh mesh = cube();
  mark_regions({enclosed("sheet.stl", test::moved(test::box({19, 19, 1. / 60}, 1), 1, {-9, -9, 0.44}))}, 1, mesh);
  EXPECT_NEAR(volume_of(mesh, 1), 1. / 60, 1e-3 / 60);
  EXPECT_GT(std::ranges::count(mesh.materials, 1), 5000);
}

TEST_F(RegionSurfaces, ThatTouchOrNestLeaveNoGap) {
  Mesh mesh = cube();
  const Surface left = test::moved(test::box({0.25, 0.5, 0.5}, 2), 1, {0.25, 0.25, 0.25}),
                right = test::moved(test::box({0.25, 0.5, 0.5}, 3), 1, {0.5, 0.25, 0.25});
  mark_regions({enclosed("left.stl", left), enclosed("right.stl", right)}, 1, mesh);
  EXPECT_NEAR(volume_of(mesh, 1), 0.0625, 1e-3 * 0.0625);
  EXPECT_NEAR(volume_of(mesh, 2), 0.0625, 1e-3 * 0.0625);
  EXPECT_EQ(facets_of_one_cell(mesh), outer_facets(mesh).size());
  std::array<double, 3> across = {0, 0, 0};  // cells whose middle lies within a tenth of the common face
  for (std::size_t c = 0; c < mesh.tetrahedra.size(); ++c) {
    Vec3 middle = Vec3::Zero();
    for (const int n : mesh.tetrahedra[c]) middle += mesh.nodes.row(n).transpose() / 4;
    if ((middle - Vec3(0.5, 0.5, 0.5)).cwiseQuotient(Vec3(0.1, 0.2, 0.2)).cwiseAbs().maxCoeff() < 1)
      ++across.at(mesh.materials[c]);
  }
  EXPECT_EQ(across[0], 0);
  EXPECT_GT(std::min(across[1], across[2]), 0);
  Mesh nested = cube();
  mark_regions({enclosed("outer.stl", test::moved(test::sphere(0.3, 3), 1, {0.5, 0.5, 0.5})),
                enclosed("inner.stl", test::moved(test::sphere(0.15, 3), 1, {0.53, 0.5, 0.48}))},
               1, nested);
  const double inner = volume(test::sphere(0.15, 3)), outer = volume(test::sphere(0.3, 3));
  EXPECT_NEAR(volume_of(nested, 2), inner, 0.06 * inner);
  EXPECT_NEAR(volume_of(nested, 1), outer - inner, 0.06 * outer);
  EXPECT_EQ(facets_of_one_cell(nested), outer_facets(nested).size());
}

TEST_F(RegionSurfaces, OfAllTheBodyAreIt) {
  Mesh mesh = cube();
  EXPECT_WORDS(mark_regions({enclosed("all.stl", test::box({1, 1, 1}, 4))}, 1, mesh).at(0), "[material] is not used");
  EXPECT_NEAR(volume_of(mesh, 1), 1, 1e-12);
}

TEST_F(RegionSurfaces, ThatCannotBeTakenAreRefusedAtTheirLine) {
  EXPECT_WORDS(refusal_of({enclosed("far.stl", test::moved(test::sphere(0.3, 2), 1, {5, 5, 5}))}, cube()),
               "case.toml:7:1: region: 'part' holds no part of the body: its surface reaches from (4.7, 4.7, 4.7) to "
               "(5.3, 5.3, 5.3) m, with scale = 1");
  Surface open = test::sphere(0.3, 2);
  open.triangles.pop_back();
  EXPECT_WORDS(refusal_of({enclosed("open.stl", open)}, cube()), "case.toml:7:1: region 'part': ");
  EXPECT_WORDS(refusal_of({enclosed("open.stl", open)}, cube()), "open.stl: ");
  write("none.stl", "nothing");
  EXPECT_WORDS(refusal_of({region(EnclosedPlace{folder_.path / "none.stl"})}, cube()), "none.stl");
}

/// A brick of two cells along x, each a physical volume.
constexpr const char* two_bricks =
    "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n2\n3 1 \"soft\"\n3 2 \"stiff\"\n$EndPhysicalNames\n"
    "$Nodes\n12\n1 0 0 0\n2 1 0 0\n3 2 0 0\n4 0 1 0\n5 1 1 0\n6 2 1 0\n7 0 0 1\n8 1 0 1\n9 2 0 1\n10 0 1 1\n11 1 1 1\n"
    "12 2 1 1\n$EndNodes\n$Elements\n2\n1 5 2 1 1 1 2 5 4 7 8 11 10\n2 5 2 2 2 2 3 6 5 8 9 12 11\n$EndElements\n";

TEST_F(RegionFiles, OfAMeshAreThoseOfItsCells) {
  const fs::path file = write("bricks.msh", two_bricks);
  EXPECT_EQ(mesh_body({.file = file, .volumes = {"stiff"}}).mesh.materials, (std::vector<std::uint8_t>{0, 1}));
  const MeshedBody cut = mesh_body({.file = file, .edge = 0.4, .volumes = {"stiff"}, .coarser = {2.25, 1.5}});
  ASSERT_EQ(cut.coarser.size(), 2u);
  EXPECT_EQ(cut.mesh.tetrahedra.size(), 64 * cut.coarser[0].tetrahedra.size());
  EXPECT_NEAR(volume_of(cut.mesh, 1), 1, 1e-12);
  EXPECT_NEAR(volume_of(cut.coarser[0], 1), 1, 1e-12);
}

TEST_F(RegionFiles, OfAMeshOfManyCellsAreCutIntoOneFilledAnew) {
  const fs::path file = folder_.path / "many.msh";
  const fs::path geo =
      write("many.geo", halves_ + "Mesh.CharacteristicLengthMax = 0.13;\nMesh 3;\nSave \"" + file.string() + "\";\n");
  mesh_body({.file = geo, .size = {3, 1, 1}, .edge = 0.5, .volumes = {"small", "7"}});
  const MeshedBody body = mesh_body({.file = file, .edge = 0.2, .volumes = {"small"}, .coarser = {2.25, 1.5}});
  ASSERT_EQ(body.coarser.size(), 2u);
  for (const auto& [mesh, times] :
       {std::pair(&body.mesh, 1.0), std::pair(&body.coarser[1], 1.5), std::pair(&body.coarser[0], 2.25)}) {
    const double chords = 1e-3 * times * times;
    EXPECT_NEAR(volume_of(*mesh, 1), 1, chords);
    EXPECT_NEAR(volume_of(*mesh, 0), 2, chords);
    EXPECT_EQ(facets_of_one_cell(*mesh), outer_facets(*mesh).size());
  }
  EXPECT_LT(body.mesh.tetrahedra.size(), 20000u);
}

}  // namespace
}  // namespace springproof::regions_test
