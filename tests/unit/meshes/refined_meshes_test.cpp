// The search for meshes that differ enough, with laws of how many cells an edge makes instead of a mesher.
#include "meshes/mesher/refined_meshes.h"

#include <gtest/gtest.h>

#include <cmath>

namespace springproof::refined_meshes_test {
namespace {

OneMesh mesh_of(double count, double edge) {
  OneMesh made;
  made.mesh.nodes = NodalVectors::Zero(4, 3);
  for (int i = 0; i < 3; ++i) made.mesh.nodes(i + 1, i) = 1;
  made.mesh.tetrahedra.assign(static_cast<std::size_t>(std::max(1.0, std::round(count))), {0, 1, 2, 3});
  made.edge = edge;
  return made;
}

MeshAt law(double (*count)(double edge)) {
  return [=](double edge, double) { return mesh_of(count(edge), edge); };
}

MeshRequest three_meshes(double edge) {
  MeshRequest r;
  r.file = "body.stl";
  r.edge = edge;
  r.coarser = {2.25, 1.5};
  return r;
}

/// Of each mesh to the next finer one, coarsest first.
std::vector<double> ratios(const MeshedBody& body) {
  return {size_ratio(body.coarser.at(0), body.coarser.at(1)), size_ratio(body.coarser.at(1), body.mesh)};
}

void expect_near_those_wanted(const MeshedBody& body) {
  for (const double ratio : ratios(body)) {
    EXPECT_GE(ratio, 1.33);
    EXPECT_LE(ratio, 1.7);
  }
}

bool says(const std::vector<std::string>& notes, const std::string& words) {
  return std::any_of(notes.begin(), notes.end(),
                     [&](const std::string& note) { return note.find(words) != std::string::npos; });
}

std::string refusal(const MeshRequest& r, const MeshAt& at) {
  try {
    mesh_refined(r, at);
  } catch (const InputError& e) {
    return e.what();
  }
  return "accepted";
}

TEST(RefinedMeshes, FollowTheEdgesAtOnceWhereCellsGoByTheirCube) {
  int calls = 0;
  const MeshedBody body = mesh_refined(three_meshes(0.05), [&](double edge, double times) {
    ++calls;
    EXPECT_NEAR(times, edge / 0.05, 1e-12);
    return mesh_of(1 / std::pow(edge, 3), edge);
  });
  EXPECT_EQ(calls, 3);
  EXPECT_EQ(body.edge, 0.05);
  for (const double ratio : ratios(body)) EXPECT_NEAR(ratio, 1.5, 0.01);
}

TEST(RefinedMeshes, AreCountedAndNotMeasuredByTheirEdges) {
  // A plate of one layer; a body whose cells in the middle are larger; one whose number of cells scatters.
  expect_near_those_wanted(mesh_refined(three_meshes(0.01), law([](double h) { return 1 / (h * h); })));
  expect_near_those_wanted(mesh_refined(three_meshes(0.01), law([](double h) { return 0.3 / std::pow(h, 2.5); })));
  expect_near_those_wanted(
      mesh_refined(three_meshes(0.01), law([](double h) { return (1 + 0.3 * std::sin(400 * h)) / std::pow(h, 3); })));
}

TEST(RefinedMeshes, GoRoundEdgesThatCannotBeMeshed) {
  const MeshAt at = [](double edge, double) {
    if (std::abs(edge / 0.075 - 1) < 0.03) throw InputError("body.stl: facets that cut each other");
    return mesh_of(1 / std::pow(edge, 3), edge);
  };
  const MeshedBody body = mesh_refined(three_meshes(0.05), at);
  for (const double ratio : ratios(body)) EXPECT_GE(ratio, least_ratio);
  EXPECT_EQ(body.edge, 0.05);
}

TEST(RefinedMeshes, AreAllFinerWhereNoLongerEdgesAreToBeHad) {
  const MeshAt at = [](double edge, double) {
    if (edge > 0.1) throw InputError("body.stl: too thin");
    return mesh_of(1 / std::pow(edge, 3), edge);
  };
  const MeshedBody body = mesh_refined(three_meshes(0.09), at);
  EXPECT_LT(body.edge, 0.06);
  for (const double ratio : ratios(body)) EXPECT_GE(ratio, least_ratio);
  EXPECT_TRUE(says(body.notes, "finer than asked for (edges of"));
}

TEST(RefinedMeshes, HaveTheSameFewestCellsWhateverTheEdge) {
  // 3900 cells, some more or less, up to edges of 0.45: as a surface whose triangles stay small.
  const MeshAt at = [](double edge, double) {
    return mesh_of(3900 * std::pow(std::min(1.0, 0.45 / edge), 3) * std::pow(std::max(1.0, 0.12 / edge), 3) +
                       100 * std::sin(100 * edge),
                   edge);
  };
  const MeshedBody body = mesh_refined(three_meshes(0.18), at);
  for (const double ratio : ratios(body)) EXPECT_GE(ratio, least_ratio);
}

TEST(RefinedMeshes, AreRefusedWhereNoneIsCoarser) {
  for (const double count : {40.0, 4000.0, 400000.0}) {
    const std::string said = refusal(three_meshes(0.1), [=](double edge, double) { return mesh_of(count, edge); });
    EXPECT_EQ(said.find("body.stl: no mesh is coarser than that of"), 0u) << said;
    EXPECT_NE(said.find("by 1.2 or more"), std::string::npos) << said;
  }
  const std::string said = refusal(three_meshes(0.1), [](double edge, double times) {
    if (times > 1) throw InputError("body.stl: facets that cut each other");
    return mesh_of(1 / std::pow(edge, 3), edge);
  });
  EXPECT_NE(said.find("; facets that cut each other (take"), std::string::npos) << said;
}

TEST(RefinedMeshes, TheFinestHasShorterEdgesWhereTheBodyAsksForThem) {
  const MeshAt at = [](double edge, double) {
    if (edge > 0.15) throw InputError("body.stl: too round");
    return mesh_of(1 / std::pow(edge, 3), edge);
  };
  MeshRequest one = three_meshes(0.2);
  one.coarser.clear();
  const MeshedBody body = mesh_refined(one, at);
  EXPECT_LE(body.edge, 0.15);
  EXPECT_TRUE(says(body.notes, "edges of 0.14 m instead of 0.2 m: too round"));
  one.edge = 1;
  EXPECT_EQ(refusal(one, at), "body.stl: too round");
}

TEST(RefinedMeshes, EachKeepsItsNotes) {
  const MeshAt at = [](double edge, double times) {
    OneMesh made = mesh_of(1 / std::pow(edge, 3), edge);
    made.notes.push_back("made " + std::to_string(std::lround(100 * times)));
    return made;
  };
  const MeshedBody body = mesh_refined(three_meshes(0.05), at);
  for (const char* note : {"made 100", "coarser by 1.50: made 150", "coarser by 1.50: made 225"})
    EXPECT_TRUE(says(body.notes, note)) << note;
  EXPECT_TRUE(says(body.notes, "coarser by 1.50: 702 tetrahedra, mean edge"));
}

}  // namespace
}  // namespace springproof::refined_meshes_test
