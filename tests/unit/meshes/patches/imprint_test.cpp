// Patches have the area of their rules, on every mesh, and the body stays as it is.
#include "meshes/patches/imprint.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <filesystem>
#include <map>

#include "meshes/mesher/mesher.h"
#include "meshes/patches/select_patches.h"
#include "meshes/volume.h"
#include "support/bodies.h"
#include "support/surfaces.h"

namespace springproof::imprint_test {
namespace {

constexpr double pi = M_PI;

const Eigen::Matrix3d turn = Eigen::AngleAxisd(0.7, Vec3(1, 2, -1).normalized()).toRotationMatrix();
const Vec3 shift(3, -2, 0.5);
Vec3 tilted(const Vec3& x) { return turn * x + shift; }

Mesh tilted(Mesh mesh) {
  for (auto row : mesh.nodes.rowwise()) row = tilted(Vec3(row.transpose())).transpose();
  return mesh;
}

/// The unit cube as tetrahedra of gmsh.
Mesh cube(double edge) {
  static std::map<double, Mesh> made;
  const auto file = std::filesystem::temp_directory_path() / ("springproof_cube_" + std::to_string(getpid()) + ".stl");
  if (!made.contains(edge)) {
    test::write_stl_binary(file, test::box({1, 1, 1}, 1));
    made[edge] = mesh_body({.file = file, .edge = edge}).mesh;
    made[edge].patches.clear();
    std::filesystem::remove(file);
  }
  return made[edge];
}

Mesh built_in(const std::string& geo, const Vec3& size, double edge) {
  return mesh_body({.file = find_geo({geo, {}, {}, {}}, "case.toml"), .size = size, .edge = edge}).mesh;
}

PatchRule named(const std::string& name) {
  PatchRule rule;
  rule.name = name;
  rule.where = {"case.toml", 7, 1};
  return rule;
}

PatchRule boxed(const Vec3& low, const Vec3& high) {
  PatchRule r = named("box");
  r.box = PatchRule::Box{low, high};
  return r;
}

PatchRule beyond(const Vec3& point, const Vec3& normal) {
  PatchRule r = named("half");
  r.beyond = PatchRule::Beyond{point, normal.normalized()};
  return r;
}

PatchRule near(const Vec3& point, double radius) {
  PatchRule r = named("disc");
  r.near = PatchRule::Near{point, radius};
  return r;
}

double area(const Mesh& mesh, const std::string& name) { return nodal_areas(mesh, patch(mesh, name)).sum(); }

double area(const std::vector<FacetPart>& parts) {
  double sum = 0;
  for (const FacetPart& p : parts) sum += p.area.norm();
  return sum;
}

double smallest_volume(const Mesh& mesh) { return cell_volumes(mesh, mesh.nodes).minCoeff(); }

/// @param change of the body's volume and surface that is allowed, relative
Mesh expect_imprinted(const Mesh& before, const std::vector<PatchRule>& rules, const std::vector<double>& areas,
                      double change = 1e-12) {
  Mesh mesh = before;
  select_patches(rules, mesh);
  for (std::size_t i = 0; i < rules.size(); ++i) {
    EXPECT_NEAR(area(mesh, rules[i].name), areas[i], 1e-9 * areas[i]) << rules[i].name;
    EXPECT_NEAR(area(parts_of(rules[i], mesh)), areas[i], 1e-9 * areas[i]) << rules[i].name;
    EXPECT_NEAR(area(parts_of(rules[i], before)), areas[i], 1e-9 * areas[i]) << rules[i].name;
  }
  const double v = volume(before, before.nodes), s = area(outside_of(before));
  EXPECT_NEAR(volume(mesh, mesh.nodes), v, change * v);
  EXPECT_NEAR(area(outside_of(mesh)), s, change * s);
  EXPECT_NEAR(volume(outside_of(mesh)), v, change * v);  // closed: faces match
  EXPECT_GT(smallest_volume(mesh), 0);
  return mesh;
}

class Imprint : public testing::TestWithParam<double> {};

TEST_P(Imprint, BoxOnACube) {
  for (const double at : {0.2, 0.31, 0.34})
    expect_imprinted(cube(GetParam()), {boxed({at, at, 0.9}, {at + 0.32, at + 0.32, 1.1})}, {0.32 * 0.32});
  expect_imprinted(cube(GetParam()), {boxed({0.41, 0.52, 0.9}, {0.413, 0.56, 1.1})}, {0.003 * 0.04});
}

TEST_P(Imprint, DiscOnACube) {
  for (const double radius : {0.15, 0.3, 0.03})
    expect_imprinted(cube(GetParam()), {near({0.45, 0.52, 1.3}, radius)}, {pi * radius * radius});
  expect_imprinted(cube(GetParam()), {near({0.45, 1, 1.3}, 0.2)},
                   {pi * 0.04});  // half on one side and half on the next
  expect_imprinted(cube(GetParam()), {near({1, 1, 1}, 0.2)}, {3 * pi * 0.04 / 4});
}

TEST_P(Imprint, HalfSpacesOfACube) {
  expect_imprinted(cube(GetParam()), {beyond({0, 0, 0.37}, {0, 0, -1})}, {1 + 4 * 0.37});
  expect_imprinted(cube(GetParam()), {beyond({0.2, 0, 0}, {-1, -1, -1})}, {3 * 0.2 * 0.2 / 2});
  expect_imprinted(cube(GetParam()), {beyond({0, 0, 1}, {0, 0, 1})}, {1});
  expect_imprinted(cube(GetParam()), {beyond({0, 0, 1 - 1e-11}, {0, 0, 1})}, {1});  // to round-off the face itself
}

/// A plane that runs beside a face, as a tolerance puts it, cuts no slivers off the faces next to it.
TEST_P(Imprint, PlanesBesideFacesLeaveNoSlivers) {
  const Mesh before = cube(GetParam());
  for (const double beside : {1e-8, 1e-6, 3e-5})
    for (const PatchRule& rule : {beyond({0, 0, 1 - beside}, {0, 0, 1}), beyond({beside, 0, 0}, {-1, 0, 0})}) {
      Mesh mesh = before;
      select_patches({rule}, mesh);
      EXPECT_NEAR(area(mesh, rule.name), 1, 1e-12) << beside;
      EXPECT_EQ(CutMesh(mesh).worst_shape(), CutMesh(before).worst_shape()) << beside;
    }
}

TEST_P(Imprint, TiltedCube) {
  const Mesh body = tilted(cube(GetParam()));
  expect_imprinted(body, {near(tilted({0.45, 0.52, 1.3}), 0.2)}, {pi * 0.04});
  expect_imprinted(body, {beyond(tilted({0, 0, 0.37}), turn * Vec3(0, 0, -1))}, {1 + 4 * 0.37});
  PatchRule corner = beyond(tilted({0, 0.61, 0}), turn * Vec3::UnitY());
  corner.facing = PatchRule::Facing{turn * Vec3::UnitZ(), 10};
  expect_imprinted(body, {corner}, {0.39});
}

TEST_P(Imprint, SeveralRulesThatOverlap) {
  PatchRule a = boxed({0.2, 0.2, 0.9}, {0.6, 0.6, 1.1}), b = near({0.55, 0.55, 1}, 0.2),
            c = beyond({0.5, 0, 0}, {1, 0.2, 0}), d = boxed({0.2, 0.5, 0.9}, {0.6, 0.8, 1.1});
  d.name = "other";
  expect_imprinted(cube(GetParam()), {a, c, d}, {0.16, 2 * 0.6 + 1 + 0.5 + 0.7, 0.12});
  expect_imprinted(cube(GetParam()), {b, a}, {pi * 0.04, 0.16});
}

TEST_P(Imprint, PatchesOfTheBodyKeepTheirArea) {
  const Mesh body = built_in("cylinder.geo", {1, 1, 1}, 2 * GetParam());
  const Mesh cut = expect_imprinted(body, {near({0.5, 0.5, 1}, 0.3), boxed({0.3, 0.3, -1}, {0.62, 0.62, 0.1})},
                                    {pi * 0.09, 0.32 * 0.32});
  for (const char* name : {"bottom", "top", "side"}) EXPECT_NEAR(area(cut, name), area(body, name), 1e-12) << name;
}

INSTANTIATE_TEST_SUITE_P(Edges, Imprint, testing::Values(0.27, 0.18, 0.12),
                         [](const auto& i) { return std::to_string(int(100 * i.param)); });

/// On curved bodies the rule's part of the facets.
TEST(ImprintCurved, AreaIsThatOfTheFacetsWithinTheRule) {
  for (const double edge : {0.3, 0.2}) {
    const Mesh ball = built_in("sphere.geo", {2, 2, 2}, edge), rod = built_in("cylinder.geo", {1, 1, 2}, edge / 1.5);
    const std::vector<std::pair<Mesh, PatchRule>> pairs = {{ball, beyond({1, 1, 1.6}, {0, 0.3, 1})},
                                                           {ball, near({2, 1, 1.2}, 0.5)},
                                                           {ball, boxed({0.7, 0.8, 1}, {1.35, 1.3, 3})},
                                                           {rod, beyond({0, 0, 0.77}, {0, 0, 1})},
                                                           {rod, near({0.9, 0.9, 1}, 0.3)},
                                                           {tilted(rod), near(tilted({0.9, 0.9, 1}), 0.3)}};
    for (const auto& [body, rule] : pairs) {
      Mesh mesh = body;
      select_patches({rule}, mesh);
      const double wanted = area(parts_of(rule, body)), v = volume(body, body.nodes), outside = area(outside_of(body));
      EXPECT_NEAR(area(mesh, rule.name), area(parts_of(rule, mesh)), 2e-5 * wanted) << rule.name;
      EXPECT_NEAR(area(mesh, rule.name), wanted, 1e-3 * wanted) << rule.name;
      EXPECT_NEAR(volume(mesh, mesh.nodes), v, 2e-4 * v);
      EXPECT_NEAR(volume(outside_of(mesh)), volume(mesh, mesh.nodes), 1e-12 * v);  // closed
      EXPECT_NEAR(area(outside_of(mesh)), outside, 2e-4 * outside);
      EXPECT_GT(smallest_volume(mesh), 0);
      EXPECT_GT(CutMesh(mesh).worst_shape(), 1e-3);
    }
  }
}

}  // namespace
}  // namespace springproof::imprint_test
