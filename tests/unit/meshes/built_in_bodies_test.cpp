// The built-in bodies of tetrahedra: they fill their box, every surface facet has one name, the volume settles.
#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>
#include <set>

#include "meshes/locate/outer_facets.h"
#include "meshes/mesher/mesher.h"
#include "meshes/volume.h"

namespace springproof::built_in_bodies_test {
namespace {

using std::numbers::pi;

struct BuiltIn {
  const char* geo;
  Vec3 size;            ///< [m]
  double edge;          ///< [m]
  double volume;        ///< of the box's volume [1]; a closed form; rabbit, hand, armadillo: measured
  double volume_error;  ///< relative, at this edge; of facets with all corners on curved faces 2 to 100 times as much
  double box_error;     ///< of each side of the box, relative
  std::set<std::string> patches;
};

void PrintTo(const BuiltIn& body, std::ostream* out) { *out << body.geo; }

const double fillet = 0.04 * (1 - pi / 4);  // fifths of both sides

const BuiltIn bodies[] = {
    {"sphere.geo", {2, 2, 2}, 0.1, pi / 6, 2e-4, 0.005, {"surface"}},
    {"bar.geo", {0.4, 0.1, 0.08}, 0.02, 1, 1e-9, 1e-9, {"x_min", "x_max", "y_min", "y_max", "z_min", "z_max"}},
    {"cylinder.geo", {0.1, 0.08, 0.2}, 0.01, pi / 4, 1e-3, 0.02, {"bottom", "top", "side"}},
    {"l_bracket.geo",
     {0.1, 0.05, 0.12},
     0.005,
     0.36 + fillet,
     1e-4,
     1e-9,
     {"wall", "end", "top", "bottom", "fillet", "skin"}},
    {"plate_with_hole.geo",
     {0.2, 0.1, 0.01},
     0.005,
     1 - pi / 4 / 16 / 2,
     1e-5,
     1e-9,
     {"x_min", "x_max", "y_min", "y_max", "z_min", "z_max", "hole"}},
    {"rabbit.geo", {0.2, 0.12, 0.25}, 0.01, 0.2626, 2e-3, 0.01, {"feet", "ears", "head", "skin"}},
    {"hand.geo",
     {0.137, 0.035, 0.188},
     0.006,
     0.3144,
     2e-3,
     0.01,
     {"wrist", "thumb", "index", "middle", "ring", "little", "skin"}},
    {"armadillo.geo",
     {0.21, 0.22, 0.25},
     0.01,
     0.0992,
     2e-3,
     0.01,
     {"feet", "left_arm", "right_arm", "head", "tail", "skin"}},
};

class BuiltInBodies : public testing::TestWithParam<BuiltIn> {};

TEST_P(BuiltInBodies, FillTheirBoxAndNameTheirSurface) {
  const BuiltIn& body = GetParam();
  const Mesh mesh =
      mesh_body({.file = find_geo({body.geo, {}, {}, {}}, "case.toml"), .size = body.size, .edge = body.edge}).mesh;
  const Vec3 low = mesh.nodes.colwise().minCoeff(), high = mesh.nodes.colwise().maxCoeff();
  for (int c = 0; c < 3; ++c) {
    EXPECT_NEAR(low[c], 0, body.box_error * body.size[c]) << c;
    EXPECT_NEAR(high[c], body.size[c], body.box_error * body.size[c]) << c;
  }
  EXPECT_NEAR(volume(mesh, mesh.nodes) / body.size.prod(), body.volume, body.volume_error * body.volume);
  std::set<std::string> names;
  std::set<std::array<int, 4>> facets;
  std::size_t count = 0;
  for (const Patch& p : mesh.patches) {
    EXPECT_FALSE(p.facets.empty()) << p.name;
    names.insert(p.name);
    count += p.facets.size();
    for (std::array<int, 4> f : p.facets) {
      std::sort(f.begin(), f.end());
      facets.insert(f);
    }
  }
  EXPECT_EQ(names, body.patches);
  EXPECT_EQ(count, facets.size()) << "each facet in one patch";
  EXPECT_EQ(count, outer_facets(mesh).size());
}

INSTANTIATE_TEST_SUITE_P(Geo, BuiltInBodies, testing::ValuesIn(bodies), [](const auto& instance) {
  const std::string geo = instance.param.geo;
  return geo.substr(0, geo.find('.'));
});

}  // namespace
}  // namespace springproof::built_in_bodies_test
