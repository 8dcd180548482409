// The bodies of the verification cases: hexahedra and tetrahedra of the right volume, every surface facet in one patch.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <map>
#include <numbers>
#include <set>

#include "meshes/mesher/mesher.h"
#include "support/tolerances.h"

namespace springproof::benchmark_bodies_test {
namespace {

using std::numbers::pi;

struct BenchmarkBody {
  const char* geo;
  Vec3 size;
  Cells cells;
  double volume;      ///< of the true body [m^3]
  double flat_error;  ///< relative error of the volume with straight edges, at most
  std::set<std::string> patches;
};

void PrintTo(const BenchmarkBody& body, std::ostream* out) { *out << body.geo; }

const std::set<std::string> faces = {"x_min", "x_max", "y_min", "y_max", "z_min", "z_max"};

const BenchmarkBody bodies[] = {
    {"block.geo", {1, 2, 3}, {2, 3, 4}, 6, 1e-12, faces},
    {"block_distorted.geo", {1, 1, 1}, {6, 6, 6}, 1, 1e-12, faces},
    {"cooks_membrane.geo", {48, 60, 1}, {4, 4, 1}, 1440, 1e-12, faces},
    {"thick_cylinder.geo",
     {9, 9, 1},
     {4, 8, 1},
     pi / 4 * 72,
     0.01,
     {"x_min", "y_min", "z_min", "z_max", "inner", "outer"}},
    {"thick_sphere.geo", {2, 2, 2}, {4, 4, 4}, pi / 6 * 7, 0.02, {"x_min", "y_min", "z_min", "inner", "outer"}},
    {"elliptic_plate.geo",
     {3.25, 2.75, 0.6},
     {4, 8, 3},
     pi / 4 * (3.25 * 2.75 - 2) * 0.6,
     0.01,
     {"x_min", "y_min", "bottom", "top", "hole", "edge_low", "edge_middle", "edge_high"}},
    {"twisted_beam.geo", {12, 1.1, 0.32}, {24, 2, 2}, 12 * 1.1 * 0.32, 0.01, {"root", "tip", "sides"}},
    {"curved_beam.geo",
     {4.32, 4.32, 0.1},
     {8, 2, 2},
     pi / 4 * (4.32 * 4.32 - 4.12 * 4.12) * 0.1,
     0.01,
     {"root", "tip", "inner", "outer", "z_min", "z_max"}},
};

using Sorted = std::array<int, 4>;

Sorted sorted(std::array<int, 4> facet) {
  std::sort(facet.begin(), facet.end());
  return facet;
}

/// Facets of one cell only.
std::set<Sorted> surface(const Mesh& mesh) {
  std::map<Sorted, int> count;
  for (const Hexahedron& cell : mesh.hexahedra)
    for (int f = 0; f < 6; ++f) ++count[sorted(face_of(cell, f))];
  for (const auto& [a, b, c, d] : mesh.tetrahedra)
    for (const Sorted& facet : {Sorted{a, b, c, -1}, {a, b, d, -1}, {a, c, d, -1}, {b, c, d, -1}})
      ++count[sorted(facet)];
  std::set<Sorted> outside;
  for (const auto& [facet, times] : count)
    if (times == 1) outside.insert(facet);
  return outside;
}

class BenchmarkBodies : public testing::TestWithParam<std::tuple<BenchmarkBody, bool>> {};

TEST_P(BenchmarkBodies, HaveTheirVolumeAndAllTheirSurfaceNamed) {
  const auto& [body, tetrahedra] = GetParam();
  const auto geo = find_geo({body.geo, {}, {}, {}}, "case.toml");
  const Mesh mesh = mesh_geo(geo, body.size, body.cells, {.tetrahedra = tetrahedra, .second_order = false});
  EXPECT_EQ(mesh.hexahedra.empty(), tetrahedra);
  EXPECT_EQ(mesh.tetrahedra.empty(), !tetrahedra);
  EXPECT_NEAR(nodal_volumes(mesh).sum(), body.volume, body.flat_error * body.volume);
  std::set<std::string> names;
  std::set<Sorted> named;
  std::size_t facets = 0;
  for (const Patch& p : mesh.patches) {
    names.insert(p.name);
    facets += p.facets.size();
    for (const auto& facet : p.facets) named.insert(sorted(facet));
  }
  EXPECT_EQ(names, body.patches);
  EXPECT_EQ(named, surface(mesh));
  EXPECT_EQ(facets, named.size()) << "each facet in one patch";
}

INSTANTIATE_TEST_SUITE_P(Geo, BenchmarkBodies, testing::Combine(testing::ValuesIn(bodies), testing::Bool()),
                         [](const auto& instance) {
                           const std::string geo = std::get<0>(instance.param).geo;
                           return geo.substr(0, geo.find('.')) +
                                  (std::get<1>(instance.param) ? "_tetrahedra" : "_hexahedra");
                         });

/// Surface nodes lie where the benchmark puts them.
TEST(BenchmarkSphere, ItsNodesLieOnTheSpheres) {
  const auto geo = find_geo({"thick_sphere.geo", {}, {}, {}}, "case.toml");
  const Mesh mesh = mesh_geo(geo, {2, 2, 2}, {4, 4, 4});
  for (const auto& [name, radius] : {std::pair("inner", 1.0), std::pair("outer", 2.0)})
    for (int node : nodes_of(patch(mesh, name))) EXPECT_NEAR(mesh.nodes.row(node).norm(), radius, 1e-9) << name;
}

TEST(BenchmarkDistortedBlock, NoTwoCellsAreAlikeAndHalvedGridsNest) {
  const auto geo = find_geo({"block_distorted.geo", {}, {}, {}}, "case.toml");
  const Mesh coarse = mesh_geo(geo, {1, 1, 1}, {3, 3, 3}), fine = mesh_geo(geo, {1, 1, 1}, {6, 6, 6});
  EXPECT_FALSE(coarse.grid);
  for (Eigen::Index n = 0; n < coarse.nodes.rows(); ++n) {
    const double nearest = (fine.nodes.rowwise() - coarse.nodes.row(n)).rowwise().norm().minCoeff();
    EXPECT_LE(nearest, 1e-9) << coarse.nodes.row(n);
  }
}

}  // namespace
}  // namespace springproof::benchmark_bodies_test
