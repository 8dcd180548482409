// Any file a user brings through springproof-mesh.  Files are written by gmsh itself where it can write them.
#include "meshes/mesher/mesher.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <numbers>

#include "meshes/locate/outer_facets.h"
#include "meshes/mesher/mesher_exchange.h"
#include "meshes/volume.h"
#include "problem/processes/child.h"
#include "support/surfaces.h"
#include "support/tolerances.h"

namespace springproof::mesher_test {
namespace {

namespace fs = std::filesystem;

class Mesher : public testing::Test {
 protected:
  void TearDown() override {
    unsetenv("SPRINGPROOF_MESH_PROGRAM");
    unsetenv("SPRINGPROOF_MESH_SECONDS");
  }

  fs::path write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_.path / name) << text;
    return folder_.path / name;
  }

  /// The file that gmsh saves of a script.
  fs::path saved(const std::string& name, const std::string& script) const {
    const fs::path file = folder_.path / name;
    const fs::path geo = write("make.geo", script + "\nSave \"" + file.string() + "\";\n");
    try {
      mesh_body({.file = geo, .edge = 1});
    } catch (const InputError&) {  // not meshed itself
    }
    EXPECT_TRUE(fs::is_regular_file(file)) << file;
    return file;
  }

  void use_program(const std::string& script) const {
    const fs::path file = write("program", "#!/bin/sh\n" + script + "\n");
    chmod(file.c_str(), 0700);
    setenv("SPRINGPROOF_MESH_PROGRAM", file.c_str(), 1);
  }

  static std::string message_of(const MeshRequest& request) {
    try {
      mesh_body(request);
    } catch (const InputError& e) {
      return e.what();
    }
    return "accepted";
  }

  TemporaryFolder folder_;
};

#define EXPECT_SAYS(message, words) EXPECT_NE((message).find(words), std::string::npos) << (message)

double volume_of(const Mesh& mesh) { return volume(mesh, mesh.nodes); }

Vec3 extent(const Mesh& mesh) { return mesh.nodes.colwise().maxCoeff() - mesh.nodes.colwise().minCoeff(); }

std::size_t facets_in_patches(const Mesh& mesh) {
  std::size_t count = 0;
  for (const Patch& p : mesh.patches) count += p.facets.size();
  return count;
}

constexpr const char* box_solid = "SetFactory(\"OpenCASCADE\");\nBox(1) = {0, 0, 0, 1, 2, 3};\n";
constexpr const char* hexahedra =
    "SetFactory(\"OpenCASCADE\");\nBox(1) = {0, 0, 0, 1, 2, 3};\n"
    "Transfinite Curve \"*\" = 3; Transfinite Surface \"*\"; Recombine Surface \"*\"; Transfinite Volume \"*\";\n";

TEST_F(Mesher, ScriptWithAnEdge) {
  const fs::path geo = find_geo({"sphere.geo", {}, {}, {}}, "case.toml");
  const MeshedBody body = mesh_body({.file = geo, .size = {2, 2, 2}, .edge = 0.2});
  EXPECT_NEAR(volume_of(body.mesh), 4 * std::numbers::pi / 3, 0.03 * 4.19);
  EXPECT_EQ(body.mesh.patches.size(), 1u);
  EXPECT_EQ(facets_in_patches(body.mesh), outer_facets(body.mesh).size());
  ASSERT_EQ(body.notes.size(), 1u);
  EXPECT_SAYS(body.notes[0], "tetrahedra, mean edge 0.");
}

TEST_F(Mesher, StructuredScriptsFollowTheEdgeToo) {
  const fs::path geo = find_geo({"block.geo", {}, {}, {}}, "case.toml");
  const Mesh mesh = mesh_body({.file = geo, .size = {1, 2, 3}, .edge = 0.5}).mesh;
  EXPECT_GE(mesh.tetrahedra.size(), 2u * 4 * 6 * 5);
  EXPECT_NEAR(volume_of(mesh), 6, test::round_off * 6);
}

TEST_F(Mesher, ScaleMultipliesTheCoordinatesAndNotTheEdge) {
  const fs::path geo = write("box.geo", box_solid);
  const Mesh metres = mesh_body({.file = geo, .edge = 0.5}).mesh;
  const Mesh millimetres = mesh_body({.file = geo, .edge = 0.5e-3, .scale = 1e-3}).mesh;
  EXPECT_EQ(metres.tetrahedra, millimetres.tetrahedra);
  EXPECT_LE((metres.nodes * 1e-3 - millimetres.nodes).cwiseAbs().maxCoeff(), 1e-12);
}

TEST_F(Mesher, MeshFilesOfBothVersionsAndBothKinds) {
  for (const std::string version : {"2.2", "4.1"})
    for (const bool tetrahedra : {true, false}) {
      SCOPED_TRACE(version + (tetrahedra ? " tetrahedra" : " hexahedra"));
      const fs::path file = saved("box.msh", std::string(tetrahedra ? box_solid : hexahedra) +
                                                 "Physical Surface(\"x_min\") = {1};\nPhysical Surface(17) = {2};\n"
                                                 "Physical Volume(\"body\") = {1};\nMesh.MshFileVersion = " +
                                                 version + ";\nMesh.MeshSizeMax = 1;\nMesh 3;");
      const Mesh mesh = mesh_body({.file = file}).mesh;
      EXPECT_EQ(mesh.tetrahedra.empty(), !tetrahedra);
      EXPECT_EQ(mesh.hexahedra.size(), tetrahedra ? 0u : 8u);
      EXPECT_NEAR(volume_of(mesh), 6, 1e-9);
      ASSERT_EQ(mesh.patches.size(), 2u);
      EXPECT_EQ(patch(mesh, "x_min").name, "x_min");
      EXPECT_NEAR(nodal_areas(mesh, patch(mesh, "17")).sum(), 6, 1e-9) << "x_max, by its number";
      EXPECT_EQ(mesh.grid.has_value(), !tetrahedra);
    }
}

TEST_F(Mesher, SecondOrderCellsAreTakenByTheirCorners) {
  const fs::path file =
      saved("box.msh", std::string(box_solid) + "Mesh.ElementOrder = 2; Mesh.MeshSizeMax = 1; Mesh 3;");
  const MeshedBody body = mesh_body({.file = file});
  EXPECT_NEAR(volume_of(body.mesh), 6, 1e-9);
  ASSERT_EQ(body.notes.size(), 1u);
  EXPECT_SAYS(body.notes[0], "'Tetrahedron 10'");
}

TEST_F(Mesher, MixedCellsAreRefusedWithTheirCounts) {
  const fs::path file =
      write("mixed.msh",
            "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n9\n1 0 0 0\n2 1 0 0\n3 1 1 0\n4 0 1 0\n5 0 0 1\n"
            "6 1 0 1\n7 1 1 1\n8 0 1 1\n9 2 0 0\n$EndNodes\n$Elements\n2\n1 5 2 1 1 1 2 3 4 5 6 7 8\n"
            "2 4 2 1 1 2 9 3 6\n$EndElements\n");
  const std::string message = message_of({.file = file});
  EXPECT_SAYS(message, "mixed or unknown cells");
  EXPECT_SAYS(message, "1 'Tetrahedron 4'");
  EXPECT_SAYS(message, "1 'Hexahedron 8'");
}

/// A bar of two bricks, 2 x 1 x 1, and a layer of four prisms on them, as an extrusion gives it; `more` elements.
std::string bricks_and_prisms(const std::string& more, int elements) {
  std::string nodes;
  int number = 0;
  for (const double z : {0.0, 1.0, 1.5})
    for (const double y : {0.0, 1.0})
      for (const double x : {0.0, 1.0, 2.0}) nodes += fmt::format("{} {} {} {}\n", ++number, x, y, z);
  return "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n3\n2 7 \"left\"\n2 8 \"between\"\n3 1 \"all\"\n"
         "$EndPhysicalNames\n$Nodes\n18\n" +
         nodes + fmt::format("$EndNodes\n$Elements\n{}\n", 6 + elements) +
         "1 5 2 1 1 1 2 5 4 7 8 11 10\n2 5 2 1 1 2 3 6 5 8 9 12 11\n"
         "3 6 2 1 1 7 8 10 13 14 16\n4 6 2 1 1 8 11 10 14 17 16\n"
         "5 6 2 1 1 8 9 11 14 15 17\n6 6 2 1 1 9 12 11 15 18 17\n" +
         more + "$EndElements\n";
}

TEST_F(Mesher, MixedCellsAreFilledAnew) {
  const fs::path file = write("bricks.msh", bricks_and_prisms("7 3 2 7 7 1 4 10 7\n8 3 2 7 7 7 10 16 13\n", 2));
  const MeshedBody body = mesh_body({.file = file, .edge = 0.4});
  EXPECT_NEAR(volume_of(body.mesh), 3, 1e-9);
  EXPECT_NEAR(nodal_areas(body.mesh, patch(body.mesh, "left")).sum(), 1.5, 1e-9);
  EXPECT_SAYS(message_of({.file = file}), "others with voxels or voxel_edge_m");
}

TEST_F(Mesher, ASurfaceInsideOfTheBodyIsNoPatch) {
  const fs::path file = write("bricks.msh", bricks_and_prisms("7 3 2 7 7 1 4 10 7\n8 3 2 8 8 2 5 11 8\n", 2));
  const MeshedBody body = mesh_body({.file = file, .edge = 0.4});
  ASSERT_EQ(body.mesh.patches.size(), 1u);
  EXPECT_EQ(body.mesh.patches[0].name, "left");
  EXPECT_SAYS(body.notes[0], "the physical surface 'between' lies inside of the body");
}

/// Two tetrahedra of volume 1/6 beside each other on the plane x = 0, with nodes of their own there; `second` is the
/// physical volume of the other one, 0: none.
std::string two_tetrahedra(double gap, int second) {
  return "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n2\n3 1 \"soft\"\n3 2 \"stiff\"\n$EndPhysicalNames\n"
         "$Nodes\n8\n1 0 0 0\n2 0 1 0\n3 0 0 1\n4 1 0 0\n" +
         fmt::format("5 {0} 0 0\n6 {0} 1 0\n7 {0} 0 1\n8 -1 0 0\n", -gap) +
         fmt::format("$EndNodes\n$Elements\n2\n1 4 2 1 1 1 4 2 3\n2 4 2 {} 2 5 6 8 7\n$EndElements\n", second);
}

TEST_F(Mesher, CoincidentNodesOfPartsAreJoined) {
  const MeshedBody body = mesh_body({.file = write("two.msh", two_tetrahedra(1e-7, 1))});
  EXPECT_EQ(body.mesh.nodes.rows(), 5);
  EXPECT_SAYS(body.notes[0], "3 nodes were at the places of others");
  const std::string apart = message_of({.file = write("apart.msh", two_tetrahedra(1e-3, 1))});
  EXPECT_SAYS(apart, "2 parts that share no node (allowed: one body; join them in the program that wrote the file");
}

TEST_F(Mesher, PartsOfTheBodyAreNoMaterials) {
  EXPECT_SAYS(message_of({.file = write("two.msh", two_tetrahedra(0, 2))}),
              "the physical volumes 'soft', 'stiff' are parts of the body, which may be of several materials");
  const MeshedBody body = mesh_body({.file = write("one.msh", two_tetrahedra(0, 0))});
  EXPECT_EQ(body.mesh.tetrahedra.size(), 1u);
  EXPECT_SAYS(body.notes[0], "1 of the file's 2 cells are in no physical volume");
}

TEST_F(Mesher, CellsThatMeetInAnEdgeAreNoBody) {
  const fs::path file = write("hinge.msh",
                              "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n6\n1 0 0 0\n2 0 0 1\n3 1 0 0\n4 0 1 0\n"
                              "5 -1 0 0\n6 0 -1 0\n$EndNodes\n$Elements\n2\n1 4 2 1 1 1 3 4 2\n2 4 2 1 1 1 5 6 2\n"
                              "$EndElements\n");
  EXPECT_SAYS(message_of({.file = file}), "2 parts that meet in edges or points only, as at (0, 0, ");
}

TEST_F(Mesher, AShellInTheBodyIsACavity) {
  const fs::path file = saved("hollow.stl",
                              "SetFactory(\"OpenCASCADE\");\nSphere(1) = {0, 0, 0, 1};\nSphere(2) = {0, 0, 0.2, 0.5};\n"
                              "BooleanDifference(3) = { Volume{1}; Delete; }{ Volume{2}; Delete; };\n"
                              "Mesh.MeshSizeMax = 0.15; Mesh 2;");
  const MeshedBody body = mesh_body({.file = file, .edge = 0.15});
  EXPECT_NEAR(volume_of(body.mesh), 7.0 / 8 * 4 / 3 * std::numbers::pi, 0.05);
}

/// The corners of a cube, and its sides as quadrilaterals.
constexpr const char* cube_points = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n";

TEST_F(Mesher, GroupsOfAnObjFileArePatches) {
  const fs::path file = write("cube.obj", std::string("# a cube\n") + cube_points +
                                              "g bottom\nf 1/1 4/2 3 2\ng top\nf 5 6 7 8\ng sides\nf 1 2 6 5\n"
                                              "f 2//1 3//1 7//1 6//1\nf -5 -1 -2 -6\nf 4 1 5 8\n");
  const Mesh mesh = mesh_body({.file = file, .edge = 0.4}).mesh;
  EXPECT_NEAR(volume_of(mesh), 1, 1e-9);
  for (const char* end : {"bottom", "top"}) EXPECT_NEAR(nodal_areas(mesh, patch(mesh, end)).sum(), 1, 1e-9) << end;
  EXPECT_NEAR(nodal_areas(mesh, patch(mesh, "sides")).sum(), 4, 1e-9);
  EXPECT_SAYS(message_of({.file = write("bad.obj", "v 0 0 0\nv 1 0\n"), .edge = 1}), "bad.obj:2:1: vertex 2: ''");
  EXPECT_SAYS(message_of({.file = write("far.obj", std::string(cube_points) + "f 1 2 9\n"), .edge = 1}),
              "far.obj:9:1: facet: '9' names none of the 8 vertices");
}

TEST_F(Mesher, SolidsOfAnStlFileArePatches) {
  const auto facet = [](const char* a, const char* b, const char* c) {
    return fmt::format("facet normal 0 0 0\nouter loop\nvertex {}\nvertex {}\nvertex {}\nendloop\nendfacet\n", a, b, c);
  };
  const fs::path file =
      write("parts.stl", "solid lower face\n" + facet("0 0 0", "0 1 0", "1 0 0") + "endsolid\nsolid others\n" +
                             facet("0 0 0", "1 0 0", "0 0 1") + facet("0 0 0", "0 0 1", "0 1 0") +
                             facet("1 0 0", "0 1 0", "0 0 1") + "endsolid others\n");
  const Mesh mesh = mesh_body({.file = file, .edge = 0.3}).mesh;
  EXPECT_NEAR(nodal_areas(mesh, patch(mesh, "lower face")).sum(), 0.5, 1e-9);
  EXPECT_NEAR(nodal_areas(mesh, patch(mesh, "surface")).sum(), 1.5 + std::sqrt(3) / 2, 1e-9);
}

TEST_F(Mesher, PlyIsReadAsStlIs) {
  const fs::path file =
      write("cube.ply",
            "ply\nformat ascii 1.0\nelement vertex 8\nproperty float x\nproperty float y\n"
            "property float z\nelement face 6\nproperty list uchar int vertex_indices\nend_header\n"
            "0 0 0\n1 0 0\n1 1 0\n0 1 0\n0 0 1\n1 0 1\n1 1 1\n0 1 1\n4 0 3 2 1\n4 4 5 6 7\n4 0 1 5 4\n"
            "4 1 2 6 5\n4 2 3 7 6\n4 3 0 4 7\n");
  EXPECT_NEAR(volume_of(mesh_body({.file = file, .edge = 0.4}).mesh), 1, 1e-9);
  EXPECT_SAYS(message_of({.file = write("bad.ply", "ply\nformat ascii 1.0\n"), .edge = 1}), "bad.ply: ");
}

TEST_F(Mesher, ASurfaceMeshIsFilled) {
  const fs::path file = saved("skin.msh", std::string(box_solid) + "Mesh.MeshSizeMax = 0.5; Mesh 2;");
  const MeshedBody body = mesh_body({.file = file, .edge = 0.5});
  EXPECT_NEAR(volume_of(body.mesh), 6, 1e-9);
  EXPECT_EQ(patch(body.mesh, "surface").facets.size(), outer_facets(body.mesh).size());
  EXPECT_SAYS(message_of({.file = file}), "edge: the file holds a surface and no cells");
}

TEST_F(Mesher, StlIsFilledAtAnyEdge) {
  const fs::path file =
      saved("sphere.stl", "SetFactory(\"OpenCASCADE\");\nSphere(1) = {0, 0, 0, 1};\nMesh.MeshSizeMax = 0.1; Mesh 2;");
  for (const double edge : {0.1, 0.3}) {
    const MeshedBody body = mesh_body({.file = file, .edge = edge});
    EXPECT_NEAR(volume_of(body.mesh), 4 * std::numbers::pi / 3, (edge > 0.2 ? 0.02 : 0.006) * 4.19) << edge;
    EXPECT_EQ(patch(body.mesh, "surface").facets.size(), outer_facets(body.mesh).size());
    EXPECT_GT(cell_volumes(body.mesh, body.mesh.nodes).minCoeff(), 0);
    const double regular = std::pow(edge, 3) / (6 * std::sqrt(2));
    const double mean = volume_of(body.mesh) / double(body.mesh.tetrahedra.size());
    EXPECT_GT(mean, 0.35 * regular) << edge;  // the file's facets of 0.1 kept would give 0.2
    EXPECT_LT(mean, 2.5 * regular) << edge;
  }
}

TEST_F(Mesher, StepComesOutInMetresAndNamesItsFaces) {
  // gmsh writes millimetres without saying so: a box of 1 x 2 x 3 is one of millimetres.
  const fs::path file = saved("box.step", box_solid);
  const Mesh mesh = mesh_body({.file = file, .edge = 0.5e-3}).mesh;
  EXPECT_LE((extent(mesh) - Vec3(1e-3, 2e-3, 3e-3)).norm(), 1e-9);
  EXPECT_EQ(mesh.patches.size(), 6u);
  EXPECT_NO_THROW(patch(mesh, "surface_6"));
  EXPECT_EQ(facets_in_patches(mesh), outer_facets(mesh).size());
  const Mesh scaled = mesh_body({.file = file, .edge = 0.5, .scale = 1000}).mesh;
  EXPECT_NEAR(volume_of(scaled), 6, 1e-6);
}

TEST_F(Mesher, FacetsOfASurfaceFileComeBackInMetres) {
  const fs::path file = folder_.path / "ball.stl";
  const Surface ball = test::sphere(2, 2);
  test::write_stl_binary(file, ball);
  const MeshedBody body = mesh_body({.file = file, .edge = 1e-3, .scale = 1e-3});
  EXPECT_EQ(body.facets.triangles.size(), ball.triangles.size());
  EXPECT_NEAR(volume(body.facets), 1e-9 * volume(ball), 1e-15);
  EXPECT_EQ(body.smooth_volume, 0);
  EXPECT_TRUE(mesh_body({.file = saved("box.brep", box_solid), .edge = 0.5}).facets.triangles.empty());
}

TEST_F(Mesher, SmoothBodiesHaveTheirVolumeBesideThatOfTheirChords) {
  const std::string ball = "SetFactory(\"OpenCASCADE\");\nSphere(1) = {0, 0, 0, 1};\n";
  for (const fs::path& file : {write("ball.geo", ball), saved("ball.brep", ball)}) {
    const MeshedBody body = mesh_body({.file = file, .edge = 1e-3, .scale = 2e-3});
    EXPECT_NEAR(body.smooth_volume, 8e-9 * 4 * std::numbers::pi / 3, 1e-14) << file;
    EXPECT_GT(std::abs(volume_of(body.mesh) / body.smooth_volume - 1), 1e-5) << file;
  }
}

TEST_F(Mesher, BrepHasNoUnit) {
  const Mesh mesh = mesh_body({.file = saved("box.brep", box_solid), .edge = 0.5}).mesh;
  EXPECT_NEAR(volume_of(mesh), 6, 1e-9);
  EXPECT_EQ(mesh.patches.size(), 6u);
}

TEST_F(Mesher, SeveralSolidsAreRefused) {
  const fs::path file = saved("two.brep", std::string(box_solid) + "Box(2) = {5, 0, 0, 1, 1, 1};");
  EXPECT_SAYS(message_of({.file = file, .edge = 0.5}), "2 parts that share no node");
}

TEST_F(Mesher, BadFilesOfEachKindAreRefusedByName) {
  for (const std::string name : {"bad.geo", "bad.stl", "bad.msh", "bad.step", "bad.stp", "bad.brep"}) {
    SCOPED_TRACE(name);
    for (const std::string& text :
         {std::string(), std::string("not a body\n"), std::string("\x89PNG\r\n\x1a\n\0\0\0\rIHDR", 16)}) {
      const std::string message = message_of({.file = write(name, text), .edge = 0.1});
      EXPECT_NE(message, "accepted");
      EXPECT_EQ(message.rfind((folder_.path / name).string(), 0), 0u) << message;
      EXPECT_SAYS(message_of({.file = folder_.path / ("none" + name), .edge = 0.1}), "no such file");
    }
  }
  EXPECT_SAYS(message_of({.file = write("cut.msh", "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Nodes\n1 9"), .edge = 0.1}),
              "cut.msh");
}

TEST_F(Mesher, OnlyScriptsRunCommands) {
  const fs::path trace = folder_.path / "trace";
  const std::string command = "SystemCall \"touch '" + trace.string() + "'\";\n";
  for (const std::string name : {"mesh.msh", "mesh.MSH", "part.step", "part.stp", "part.brep", "skin.stl"}) {
    SCOPED_TRACE(name);
    std::vector<std::string> texts = {command, "solid x\nendsolid x\n" + command};
    if (name == "mesh.msh")
      for (const char* begin : {"\n", "// $MeshFormat\n", " $MeshFormat\n", "$PostFormat\n", "View \"x\" {};\n"})
        texts.push_back(begin + command);
    for (const std::string& text : texts) {
      const std::string message = message_of({.file = write(name, text), .edge = 0.1});
      EXPECT_EQ(message.rfind((folder_.path / name).string(), 0), 0u) << message;
      EXPECT_FALSE(fs::exists(trace)) << text;
    }
  }
}

TEST_F(Mesher, OptionsBesideAMeshAreNotRun) {
  const fs::path file = saved("box.msh", std::string(hexahedra) + "Mesh 3;"), trace = folder_.path / "trace";
  write("box.msh.opt", "SystemCall \"touch '" + trace.string() + "'\";\n");
  EXPECT_EQ(mesh_body({.file = file}).mesh.hexahedra.size(), 8u);
  EXPECT_FALSE(fs::exists(trace));
}

TEST_F(Mesher, BodiesHaveOneRangeOfSizes) {
  const fs::path box = write("box.geo", box_solid);
  for (const double scale : {1e200, 1e31, 1e-31})
    EXPECT_SAYS(message_of({.file = box, .edge = scale, .scale = scale}), "is no factor (allowed: 1e-30 to 1e+30)");
  for (const double scale : {1e12, 1e-12})
    EXPECT_SAYS(message_of({.file = box, .edge = scale, .scale = scale}),
                "(allowed: a longest side of 1e-06 to 1e+09 m");
  EXPECT_EQ(message_of({.file = box, .edge = 1e8, .scale = 1e8}), "accepted");
  const fs::path block = find_geo({.geo = "block.geo"}, {});
  EXPECT_SAYS(message_of({.file = block, .size = {1e10, 1, 1}, .cells = {1, 1, 1}}), "the body spans 1e+10 x 1 x 1 m");
  const fs::path far = write("far.geo", "SetFactory(\"OpenCASCADE\");\nBox(1) = {1e10, 0, 0, 1e9, 1e9, 1e9};\n");
  EXPECT_SAYS(message_of({.file = far, .edge = 1e9}), "up to 1.1e+10 m from the origin");
}

TEST_F(Mesher, RefusesWhatItCannotRead) {
  const std::string message = message_of({.file = write("body.3mf", "PK"), .edge = 0.1});
  EXPECT_SAYS(
      message,
      "cannot read a body from a '.3mf' file (allowed: .geo, .stl, .obj, .ply, .msh, .step, .stp, .brep; programs "
      "such as MeshLab, Blender or FreeCAD convert others to one of these)");
  const fs::path geo = write("box.geo", box_solid), stl = write("body.stl", "");
  EXPECT_SAYS(message_of({.file = geo, .edge = -1}), "edge: -1 m is no length");
  EXPECT_SAYS(message_of({.file = geo, .edge = std::nan("")}), "is no length");
  EXPECT_SAYS(message_of({.file = geo, .edge = 1, .scale = 0}), "scale: 0 is no factor");
  EXPECT_SAYS(message_of({.file = stl}), "edge: the length of the tetrahedra's edges is needed");
  EXPECT_SAYS(message_of({.file = geo, .size = {1, 1, 1}, .edge = 1e-4}), "tetrahedra (allowed: 2e+07)");
}

TEST_F(Mesher, AScriptThatDoesNotEndIsEnded) {
  const fs::path geo = write("loop.geo", "For i In {0 : 1e12}\n  a = Sin(i);\nEndFor\n");
  setenv("SPRINGPROOF_MESH_SECONDS", "1", 1);
  EXPECT_SAYS(message_of({.file = geo, .edge = 1}), "loop.geo: meshing took longer than 1 s and was ended");
  setenv("SPRINGPROOF_MESH_SECONDS", "soon", 1);
  EXPECT_SAYS(message_of({.file = geo, .edge = 1}), "SPRINGPROOF_MESH_SECONDS: 'soon' is no time limit");
}

TEST_F(Mesher, AMesherThatCrashesIsAnInputError) {
  const fs::path geo = write("box.geo", box_solid);
  use_program("echo 'out of luck' >&2; kill -ABRT $$");
  EXPECT_SAYS(message_of({.file = geo, .edge = 1}), "box.geo: the mesher was killed by signal 6 (Aborted) out of luck");
  use_program("exit 4");
  EXPECT_SAYS(message_of({.file = geo, .edge = 1}), "box.geo: the mesher failed with status 4");
}

TEST_F(Mesher, OddAnswersAreOneSentenceThatNamesProgramAndBody) {
  const fs::path geo = write("box.geo", box_solid);
  // Nothing, no CBOR, null, [], {}, {"mesh": {}}, a mesh with numbers for its nodes.
  for (const char* answer :
       {"", "nonsense", "\\366", "\\200", "\\240", "\\241dmesh\\240", "\\241dmesh\\241enodes\\001"}) {
    use_program("printf '" + std::string(answer) + "' > \"$2\"");
    try {
      mesh_body({.file = geo, .edge = 1});
      ADD_FAILURE() << "accepted: " << answer;
    } catch (const std::runtime_error& e) {
      EXPECT_EQ(
          std::string(e.what()),
          geo.string() +
              ": the answer of springproof-mesh cannot be used (build springproof and springproof-mesh together)");
    }
  }
}

TEST_F(Mesher, AnswersThatLeadOutsideTheMeshAreRefused) {
  const fs::path geo = write("box.geo", box_solid);
  const auto accepted = [&](const std::function<void(MeshedBody&)>& spoil) {
    MeshedBody body{block_mesh({1, 1, 1}, {2, 1, 1}), {}, 0, {}, {}, 0};
    spoil(body);
    std::ofstream(folder_.path / "answer", std::ios::binary) << to_cbor(body);
    use_program("cp '" + (folder_.path / "answer").string() + "' \"$2\"");
    try {
      mesh_body({.file = geo, .edge = 1});
      return true;
    } catch (const std::runtime_error&) {
      return false;
    }
  };
  EXPECT_TRUE(accepted([](auto&) {}));
  EXPECT_FALSE(accepted([](auto& b) { b.mesh.hexahedra[1][7] = 12; }));
  EXPECT_FALSE(accepted([](auto& b) { b.mesh.hexahedra[0][0] = -1; }));
  EXPECT_FALSE(accepted([](auto& b) { b.mesh.patches[0].facets[0][2] = 99; }));
  EXPECT_FALSE(accepted([](auto& b) { b.mesh.patches[0].facets[0][2] = -1; }));
  EXPECT_FALSE(accepted([](auto& b) { b.mesh.patches[0].facets[0] = {-1, 1, 2, -1}; }));
  EXPECT_TRUE(accepted([](auto& b) { b.mesh.patches[0].facets[0][3] = -1; }));
  EXPECT_FALSE(accepted([](auto& b) { b.mesh.grid->cell_index[1][0] = 2; }));
  EXPECT_FALSE(accepted([](auto& b) { b.mesh.grid->cell_index[0][1] = -1; }));
  EXPECT_FALSE(accepted([](auto& b) { b.mesh.grid->cells = {2, 1, 1000000000}; }));
  EXPECT_FALSE(accepted([](auto& b) { b.mesh.grid->spacing[2] = 0; }));
  EXPECT_FALSE(accepted([](auto& b) { b.mesh.grid->origin[2] = std::nan(""); }));
  EXPECT_FALSE(accepted([](auto& b) { b.mesh.nodes(3, 1) = std::nan(""); }));
  EXPECT_FALSE(accepted([](auto& b) { b.mesh.hexahedra.clear(); }));
  EXPECT_FALSE(accepted([](auto& b) { b.mesh.curved = NodalVectors::Zero(5, 3); }));
  EXPECT_FALSE(accepted([](auto& b) { b.coarser.push_back(Mesh()); }));
  EXPECT_FALSE(accepted([](auto& b) { b.facets.triangles = {{0, 1, 2}}; }));
}

TEST_F(Mesher, OwnScriptsCanBeRefused) {
  const fs::path geo = write("own.geo", box_solid), shadow = write("block.geo", box_solid);
  write("part.stl", "");
  setenv("SPRINGPROOF_NO_SCRIPTS", "1", 1);
  const auto found = [&](const std::string& name) -> std::string {
    try {
      return find_geo({name, {}, {}, {"case.toml", 2, 7}}, folder_.path / "case.toml");
    } catch (const InputError& e) {
      return e.what();
    }
  };
  EXPECT_SAYS(found("own.geo"), "case.toml:2:7: body.geo: 'own.geo' is a script, which may run any command");
  EXPECT_SAYS(found("block.geo"), "is a script");
  EXPECT_EQ(found("part.stl"), folder_.path / "part.stl");
  EXPECT_EQ(fs::path(found("sphere.geo")).filename(), "sphere.geo");
  unsetenv("SPRINGPROOF_NO_SCRIPTS");
  EXPECT_EQ(found("own.geo"), geo);
}

TEST_F(Mesher, FacetsByTheMillionAreRefusedAtOnce) {
  const std::uint32_t count = 6'000'000;
  const fs::path file =
      write("large.stl", std::string(80, ' ') + std::string(reinterpret_cast<const char*>(&count), 4));
  fs::resize_file(file, 84 + 50ull * count);  // takes no room
  EXPECT_SAYS(
      message_of({.file = file, .edge = 1}),
      "large.stl: about 6e+06 facets (allowed: up to 5e+06, as they take some 3.6e+02 s and the time limit is 300 s");
}

TEST_F(Mesher, FileNamesOfAnyBytesAndMeshesBeyondAllMeans) {
  const fs::path folder = folder_.path / "K\xf6rper";
  fs::create_directory(folder);
  fs::copy_file(write("box.geo", box_solid), folder / "box.geo");
  EXPECT_GT(mesh_body({.file = folder / "box.geo", .edge = 1}).mesh.tetrahedra.size(), 0u);
  const fs::path block = find_geo({"block.geo", {}, {}, {}}, "case.toml");
  EXPECT_SAYS(message_of({.file = block, .size = {1, 1, 1}, .cells = {1000, 1000, 1000}}),
              "1000 x 1000 x 1000 = 1e+09 cells (allowed: up to 5e+06");
}

}  // namespace
}  // namespace springproof::mesher_test
