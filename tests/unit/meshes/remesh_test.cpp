#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "meshes/surface/surface_check.h"
#include "meshes/surface/surface_topology.h"
#include "support/surfaces.h"
#include "support/tolerances.h"

namespace springproof::remesh_test {
namespace {

using namespace test;
using std::numbers::pi;

struct Case {
  const char* name;
  Surface surface;
  double edge;
  double volume_change;  ///< at most, relative
};

/// Lengths of the edges, ascending.
std::vector<double> edge_lengths(const Surface& s) {
  std::vector<double> lengths;
  for_each_edge(sides_by_edge(s), [&](std::span<const Side> edge) {
    lengths.push_back((s.points[edge[0].low] - s.points[edge[0].high]).norm());
  });
  std::sort(lengths.begin(), lengths.end());
  return lengths;
}

TEST(Remesh, GivesEvenTrianglesOfTheSameBody) {
  const Case cases[] = {
      {"sphere", sphere(1, 4), 0.1, 0.003},
      {"noisy_sphere", noisy_sphere(1, 4, 0.01, 7), 0.1, 0.005},
      {"torus", torus(2, 0.5, 100, 30), 0.12, 0.005},
      {"trefoil", trefoil(0.4, 300, 20), 0.08, 0.005},
      {"scan", scan(4, 0.005, 3), 0.2, 0.005},
      {"box", box({1, 2, 3}, 20), 0.2, 0.001},
      {"box_of_12_facets", box({1, 2, 3}, 1), 0.2, 0.001},
  };
  for (const Case& c : cases) {
    const Surface fine = remesh(c.surface, c.edge);
    const double change = volume(fine) / volume(c.surface) - 1;
    const std::vector<double> lengths = edge_lengths(fine);
    const double middle = lengths[lengths.size() / 2];
    const std::string said = std::to_string(fine.triangles.size()) + " facets, volume " + std::to_string(100 * change) +
                             " %, edges " + std::to_string(lengths.front() / c.edge) + " " +
                             std::to_string(middle / c.edge) + " " + std::to_string(lengths.back() / c.edge);
    RecordProperty(c.name, said);
    EXPECT_LT(std::abs(change), c.volume_change) << c.name << ": " << said;
    // Edges between 4/5 and 4/3 of the target are left as they are.
    EXPECT_NEAR(middle, c.edge, 0.25 * c.edge) << c.name << ": " << said;
    EXPECT_LT(lengths.back(), 2 * c.edge) << c.name << ": " << said;
    EXPECT_TRUE(check_surface(fine, c.name).notes.empty()) << c.name;
  }
}

TEST(Remesh, KeepsSharpEdgesAndCorners) {
  const Surface fine = remesh(box({1, 2, 3}, 1), 0.15);
  EXPECT_NEAR(volume(fine), 6, 1e-9);
  EXPECT_NEAR(area(fine), 22, 1e-9);
  for (const double x : {0.0, 1.0})
    for (const double y : {0.0, 2.0})
      for (const double z : {0.0, 3.0})
        EXPECT_TRUE(
            std::any_of(fine.points.begin(), fine.points.end(), [&](const Vec3& p) { return p == Vec3(x, y, z); }))
            << x << y << z;
}

TEST(Remesh, NoiseIsNoLine) {
  // Ten times more facets than the noise leaves room for would stay if its creases were kept.
  const Surface s = thinned(noisy_sphere(1, 6, 0.01, 7), 0.06);
  const double edge = 0.12, facets = area(s) / (std::sqrt(3.0) / 4 * edge * edge);
  EXPECT_LT(double(remesh(s, edge).triangles.size()), 1.5 * facets);
}

TEST(Thinned, KeepsFlatFacesCreasesAndCorners) {
  const Vec3 size(1, 2, 3);
  const Surface thin = thinned(box(size, 40), 0.2);
  EXPECT_LT(thin.triangles.size(), 1300u);
  EXPECT_NEAR(volume(thin), 6, 1e-9);
  EXPECT_NEAR(area(thin), 22, 1e-9);
  for (const Vec3& p : thin.points)
    EXPECT_LT(std::min(p.cwiseAbs().minCoeff(), (p - size).cwiseAbs().minCoeff()), 1e-9);
}

TEST(Thinned, KeepsTheBody) {
  const Surface bodies[] = {noisy_sphere(1, 6, 0.01, 7), torus(2, 0.2, 300, 60), trefoil(0.4, 300, 40)};
  for (const Surface& s : bodies) {
    const double edge = std::sqrt(area(s) / 1000);
    const Surface thin = thinned(s, edge);
    EXPECT_LT(2 * thin.triangles.size(), s.triangles.size());
    EXPECT_NEAR(volume(thin) / volume(s), 1, 1e-3);
    EXPECT_TRUE(check_surface(thin, "thin").notes.empty());
  }
}

TEST(Thinned, LeavesASurfaceThatIsNotDense) {
  const Surface s = globe(1, 24, 48);
  EXPECT_EQ(thinned(s, 0.1).points.size(), s.points.size());
}

TEST(Remesh, AnEdgeTooLongOrTooShortIsAnError) {
  EXPECT_THROW(remesh(sphere(1, 3), 2), std::runtime_error);
  EXPECT_THROW(remesh(torus(2, 0.1, 200, 20), 0.5), std::runtime_error);
  EXPECT_THROW(remesh(sphere(1, 3), 1e-4), std::runtime_error);
  EXPECT_THROW(remesh(sphere(1, 3), 0), std::runtime_error);
}

}  // namespace
}  // namespace springproof::remesh_test
