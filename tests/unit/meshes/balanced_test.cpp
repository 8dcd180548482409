// Facets that lie as much inside of a curved surface as outside of it.
#include "meshes/surface/balanced.h"

#include <gtest/gtest.h>

#include <numbers>

#include "meshes/surface/surface_check.h"
#include "support/surfaces.h"

namespace springproof::balanced_test {
namespace {

using namespace test;
using std::numbers::pi;

/// With which so many facets cover the surface [m].
double edge_of(const Surface& surface, double facets) {
  return std::sqrt(area(surface) / facets / (std::sqrt(3.0) / 4));
}

// Chords of a sphere lose 1/8 to 1/4 of the edge squared of its volume; balanced, a tenth of that, whichever the edge.
TEST(Balanced, AMeshOfASphereHasItsVolume) {
  const Surface ball = sphere(1, 5);
  double before = 0;
  for (const double edge : {0.5, 0.3, 0.2}) {
    const double off = volume(remesh(ball, edge, 0.2)) / volume(ball) - 1;
    EXPECT_LT(std::abs(off), 0.03 * edge * edge) << edge;
    EXPECT_TRUE(before == 0 || std::abs(off) < std::abs(before)) << edge;
    before = off;
  }
}

// Balanced facets of a rough or a thick body may cut each other: only their points go back, else 5 % were lost.
TEST(Balanced, OnlyFacetsThatCutEachOtherStayChords) {
  for (const Surface& body : {trefoil(0.6, 300, 30), noisy_sphere(1, 4, 0.05, 7)}) {
    const double edge = edge_of(body, 1600);
    EXPECT_NEAR(volume(remesh(body, edge, 0.2)) / volume(body), 1, 2e-3);
  }
}

// What chords lose of a coarse mesh balancing gives back; what is lost with a part of the body it cannot.
TEST(Balanced, ACoarseMeshWithoutAPartOfTheBodyIsRefused) {
  const Surface hollow = both(sphere(1, 4), turned(moved(sphere(1, 3), 0.3, {0, 0.3, 0})));
  EXPECT_NEAR(volume(remesh(hollow, 0.25, 0.1)) / volume(hollow), 1, 0.01);
  EXPECT_THROW(remesh(hollow, 0.6, 0.1), std::runtime_error);
}

// Where points may not leave a plane nor a crease they move along it.
TEST(Balanced, PlaneFacesAndCreasesStay) {
  const Surface block = box({1, 2, 3}, 4);
  const Surface same = balanced(block, block);
  for (std::size_t p = 0; p < block.points.size(); ++p) EXPECT_LT((same.points[p] - block.points[p]).norm(), 1e-12);
  // A prism of 12 sides as a mesh of a cylinder of 96: it grows to its volume, and its ends stay where they are.
  const auto prism = [](int sides) {
    Surface s;
    for (const double z : {0.0, 1.0})
      for (int i = 0; i < sides; ++i)
        s.points.emplace_back(std::cos(2 * pi * i / sides), std::sin(2 * pi * i / sides), z);
    for (int i = 0; i < sides; ++i) {
      const int j = (i + 1) % sides;
      s.triangles.push_back({i, j, sides + j});
      s.triangles.push_back({i, sides + j, sides + i});
      if (i > 1) s.triangles.push_back({0, i, i - 1});
      if (i > 1) s.triangles.push_back({sides, sides + i - 1, sides + i});
    }
    return s;
  };
  const Surface coarse = prism(12), fine = prism(96), grown = balanced(coarse, fine);
  EXPECT_LT(volume(coarse) / volume(fine), 0.96);
  EXPECT_NEAR(volume(grown) / volume(fine), 1, 0.005);
  for (std::size_t p = 0; p < grown.points.size(); ++p)
    EXPECT_NEAR(grown.points[p].z(), coarse.points[p].z(), 1e-3) << p;
}

}  // namespace
}  // namespace springproof::balanced_test
