// The three meshes of a reference on bodies of every kind: each really coarser than the next, and the same body.
#include <gtest/gtest.h>

#include <fstream>
#include <numbers>

#include "meshes/mesher/mesher.h"
#include "meshes/quality.h"
#include "meshes/volume.h"
#include "problem/processes/child.h"
#include "support/surfaces.h"

namespace springproof::reference_meshes_test {
namespace {

namespace fs = std::filesystem;
using namespace test;

struct ReferenceBody {
  std::string name;
  Surface surface;
  double edge;  ///< 0: of 6000 tetrahedra
};
void PrintTo(const ReferenceBody& b, std::ostream* out) { *out << b.name; }

double volume_of(const Mesh& mesh) { return volume(mesh, mesh.nodes); }

void expect_refined(const MeshedBody& body, double true_volume) {
  ASSERT_EQ(body.coarser.size(), 2u);
  const Mesh* const meshes[] = {&body.coarser[0], &body.coarser[1], &body.mesh};
  // One hundredth of the finest, and of the others half as much again as goes with the square of their edges.
  const double most_lost[] = {0.01 * 1.5 * 2.25 * 2.25, 0.01 * 1.5 * 1.5 * 1.5, 0.011};
  for (int i = 0; i < 3; ++i) {
    EXPECT_NEAR(volume_of(*meshes[i]), true_volume, most_lost[i] * true_volume);
    if (i == 0) continue;
    const double ratio = size_ratio(*meshes[i - 1], *meshes[i]);
    const bool few = meshes[i - 1]->tetrahedra.size() < 100;  // numbers that jump
    EXPECT_GE(ratio, few ? least_ratio : 1.3)
        << meshes[i - 1]->tetrahedra.size() << " and " << meshes[i]->tetrahedra.size() << " tetrahedra";
    EXPECT_LE(ratio, few ? 2.1 : 1.75) << meshes[i - 1]->tetrahedra.size() << " and " << meshes[i]->tetrahedra.size()
                                       << " tetrahedra";
  }
  EXPECT_EQ(std::count_if(body.notes.begin(), body.notes.end(),
                          [](const std::string& note) {
                            return note.starts_with("coarser by") &&
                                   note.find("tetrahedra, mean edge") != std::string::npos;
                          }),
            2);
}

class ReferenceMeshes : public testing::TestWithParam<ReferenceBody> {
 protected:
  TemporaryFolder folder_;
};

TEST_P(ReferenceMeshes, AreRefined) {
  const fs::path file = folder_.path / "body.stl";
  write_stl_binary(file, GetParam().surface);
  expect_refined(mesh_body({.file = file, .edge = GetParam().edge, .tetrahedra = 6000, .coarser = {2.25, 1.5}}),
                 volume(GetParam().surface));
}

const ReferenceBody bodies[] = {
    {"globe_edges_0_18", globe(1, 24, 48), 0.18},
    {"globe_edges_0_25", globe(1, 24, 48), 0.25},
    {"globe", globe(1, 24, 48), 0},
    {"globe_of_few_facets", globe(1, 8, 12), 0},
    {"dense_scan", scan(5, 0.004, 3), 0.3},
    {"denser_scan", scan(6, 0.005, 3), 0},
    {"noisy_sphere", noisy_sphere(1, 5, 0.01, 7), 0},
    {"ring", torus(2, 0.4, 120, 20), 0},
    {"cube_of_12_facets", box({1, 1, 1}, 1), 0.2},
    {"slender_beam", box({1, 0.05, 0.05}, 1), 0},
    {"plate", box({1, 1, 0.02}, 1), 0},
    {"edges_longer_than_the_body", box({1, 1, 1}, 1), 3},
};
INSTANTIATE_TEST_SUITE_P(Bodies, ReferenceMeshes, testing::ValuesIn(bodies),
                         [](const auto& i) { return i.param.name; });

class ReferenceMeshesOfFiles : public testing::Test {
 protected:
  fs::path write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_.path / name) << text;
    return folder_.path / name;
  }
  TemporaryFolder folder_;
};

TEST_F(ReferenceMeshesOfFiles, ADenseSurfaceIsThinnedOutOnceForAllMeshes) {
  const auto thinnings = [&](const Surface& surface) {
    const fs::path file = folder_.path / "body.stl";
    write_stl_binary(file, surface);
    const MeshedBody body = mesh_body({.file = file, .tetrahedra = 3000, .coarser = {2.25, 1.5}});
    for (const Mesh* mesh : {&body.mesh, &body.coarser[0], &body.coarser[1]}) EXPECT_GT(quality_of(*mesh).worst, 0.02);
    return std::count_if(body.notes.begin(), body.notes.end(),
                         [](const std::string& note) { return note.find("thinned out to") != std::string::npos; });
  };
  EXPECT_EQ(thinnings(noisy_sphere(1, 6, 0.005, 3)), 1);
  EXPECT_EQ(thinnings(globe(1, 24, 48)), 0);
}

TEST_F(ReferenceMeshesOfFiles, ScriptsOfEveryKindAreRefined) {
  const auto meshed = [](const std::string& name, const Vec3& size, double edge) {
    return mesh_body({.file = find_geo({name, {}, {}, {}}, "case.toml"),
                      .size = size,
                      .edge = edge,
                      .tetrahedra = 6000,
                      .coarser = {2.25, 1.5}});
  };
  expect_refined(meshed("block.geo", {1, 2, 3}, 0), 6);
  expect_refined(meshed("block.geo", {1, 1, 1}, 0.7), 1);
  const double fifth = 0.02;
  expect_refined(meshed("l_bracket.geo", {0.1, 0.05, 0.1}, 0),
                 0.05 * fifth * (0.1 + 0.08 + fifth * (1 - std::numbers::pi / 4)));
}

TEST_F(ReferenceMeshesOfFiles, SolidsAndMeshFilesAreRefined) {
  const std::string script = R"(SetFactory("OpenCASCADE");
Box(1) = {0, 0, 0, 1, 1, 2};
Cylinder(2) = {0.5, 0.5, 2, 0, 0, 1, 0.4};
BooleanUnion(3) = { Volume{1}; Delete; }{ Volume{2}; Delete; };
Mesh.MeshSizeMax = 0.25;
Mesh 3;
)";
  const fs::path step = folder_.path / "form.step", msh = folder_.path / "form.msh";
  mesh_body({.file = write("form.geo", script + "Save \"" + step.string() + "\";\nSave \"" + msh.string() + "\";\n"),
             .edge = 1});
  const double inside = 2 + std::numbers::pi * 0.16;
  expect_refined(mesh_body({.file = step, .scale = 1000, .tetrahedra = 6000, .coarser = {2.25, 1.5}}), inside);
  expect_refined(mesh_body({.file = msh, .tetrahedra = 6000, .coarser = {2.25, 1.5}}),
                 volume_of(mesh_body({.file = msh}).mesh));
}

TEST_F(ReferenceMeshesOfFiles, AScriptWithLayersOfItsOwnIsRefused) {
  const fs::path geo = write("fixed.geo", R"(Point(1) = {0, 0, 0};
a[] = Extrude {1, 0, 0} { Point{1}; Layers{3}; };
b[] = Extrude {0, 1, 0} { Line{a[1]}; Layers{3}; };
c[] = Extrude {0, 0, 1} { Surface{b[1]}; Layers{3}; };
Physical Volume("body") = {c[1]};
)");
  EXPECT_NO_THROW(mesh_body({.file = geo, .edge = 0.3}));
  try {
    mesh_body({.file = geo, .edge = 0.3, .coarser = {2.25, 1.5}});
    FAIL() << "accepted";
  } catch (const InputError& e) {
    const std::string said = e.what();
    EXPECT_EQ(said.find(geo.string() + ": no mesh is coarser than that of 162 tetrahedra"), 0u) << said;
    EXPECT_NE(said.find("elements = []"), std::string::npos) << said;
  }
}

}  // namespace
}  // namespace springproof::reference_meshes_test
