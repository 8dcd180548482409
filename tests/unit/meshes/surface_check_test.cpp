#include "meshes/surface/surface_check.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include "meshes/surface/surface_files.h"
#include "meshes/surface/surface_repair.h"
#include "meshes/surface/surface_topology.h"
#include "problem/system/input_error.h"
#include "support/broken_stl.h"
#include "support/surfaces.h"
#include "support/tolerances.h"

namespace springproof::surface_check_test {
namespace {

namespace fs = std::filesystem;
using namespace test;
using std::numbers::pi;

/// Notes, or the message of the refusal; "clean" if there is nothing to say.
std::string outcome(const Surface& surface) {
  try {
    const CheckedSurface checked = check_surface(surface, "a.stl");
    return checked.notes.empty() ? "clean" : fmt::format("{}", fmt::join(checked.notes, "; "));
  } catch (const InputError& error) {
    return error.what();
  }
}

struct Shape {
  const char* name;
  Surface surface;
  double volume;     ///< of the smooth body
  double tolerance;  ///< of its facets, relative
};
const std::vector<Shape>& shapes() {
  static const std::vector<Shape> all = {
      {"sphere", sphere(1, 4), 4 * pi / 3, 0.004},
      {"noisy_sphere", noisy_sphere(1, 4, 0.02, 7), 4 * pi / 3, 0.01},
      {"torus", torus(2, 0.5, 100, 30), pi * pi, 0.01},
      {"trefoil", trefoil(0.4, 300, 20), pi * 0.16 * trefoil_length(), 0.02},
      {"scan", scan(4, 0.005, 3), scan_volume(), 0.015},
      {"box", box({1, 2, 3}, 20), 6, round_off},
  };
  return all;
}

TEST(TestSurfaces, HaveTheirVolumeAndNothingWrong) {
  for (const Shape& shape : shapes()) {
    EXPECT_GE(shape.surface.triangles.size(), 2000u) << shape.name;
    EXPECT_NEAR(volume(shape.surface), shape.volume, shape.tolerance * shape.volume) << shape.name;
    EXPECT_EQ(outcome(shape.surface), "clean") << shape.name;
    EXPECT_EQ(outcome(loose(shape.surface)), "clean") << shape.name;
  }
}

TEST(TestSurfaces, TheirVolumeConverges) {
  const auto ratio = [](double coarse, double fine, double exact) { return (coarse - exact) / (fine - exact); };
  EXPECT_NEAR(ratio(volume(sphere(1, 3)), volume(sphere(1, 4)), 4 * pi / 3), 4, 0.1);
  EXPECT_NEAR(ratio(volume(torus(2, 0.5, 60, 30)), volume(torus(2, 0.5, 120, 60)), pi * pi), 4, 0.1);
  EXPECT_NEAR(ratio(volume(trefoil(0.4, 300, 16)), volume(trefoil(0.4, 600, 32)), pi * 0.16 * trefoil_length()), 4,
              0.2);
  EXPECT_LT(std::abs(volume(scan(5, 0, 3)) / scan_volume() - 1),
            0.4 * std::abs(volume(scan(4, 0, 3)) / scan_volume() - 1));
}

TEST(CheckSurface, WeldsToTheSurfaceItWas) {
  for (const Shape& shape : shapes()) {
    const CheckedSurface checked = check_surface(loose(shape.surface), shape.name);
    EXPECT_EQ(checked.surface.points.size(), shape.surface.points.size()) << shape.name;
    EXPECT_EQ(checked.surface.triangles.size(), shape.surface.triangles.size()) << shape.name;
    EXPECT_NEAR(volume(checked.surface), volume(shape.surface), 1e-12 * shape.volume) << shape.name;
  }
}

TEST(CheckSurface, DoesNotMindUnitsNorPlace) {
  const Surface s = scan(3, 0.005, 3);
  for (const double scale : {1e-6, 1e-3, 1.0, 1e6})
    for (const Vec3& by : {Vec3(0, 0, 0), Vec3(100, -20, 3)}) {
      const Surface there = moved(s, scale, scale * by);
      EXPECT_EQ(outcome(loose(there)), "clean") << scale;
      EXPECT_NEAR(volume(check_surface(there, "a").surface), volume(s) * std::pow(scale, 3),
                  1e-9 * volume(s) * std::pow(scale, 3));
    }
}

class BrokenStl : public testing::TestWithParam<BrokenFile> {};

TEST_P(BrokenStl, GetsItsMessageOrIsMended) {
  const fs::path file = fs::temp_directory_path() / fmt::format("springproof_{}_{}.stl", GetParam().name, getpid());
  GetParam().write(file);
  std::string said;
  bool mended = true;
  try {
    const CheckedSurface checked = check_surface(read_stl(file), file.string());
    said = fmt::format("{}", fmt::join(checked.notes, "; "));
    EXPECT_EQ(outcome(checked.surface), "clean") << "what is mended needs no mending";
    EXPECT_GT(volume(checked.surface), 0.9);
  } catch (const InputError& error) {
    said = error.what();
    mended = false;
    EXPECT_EQ(said.find(file.string()), 0u) << said;
  }
  EXPECT_EQ(mended, GetParam().mended) << said;
  EXPECT_NE(said.find(GetParam().outcome), std::string::npos) << said;
  RecordProperty("said", said);
  fs::remove(file);
}
INSTANTIATE_TEST_SUITE_P(Files, BrokenStl, testing::ValuesIn(broken_files()),
                         [](const auto& i) { return i.param.name; });

// What is mended.

TEST(CheckSurface, MendingAFlippedFacetGivesTheSurfaceBack) {
  const CheckedSurface checked = check_surface(with_a_flipped_facet(), "a");
  EXPECT_EQ(volume(checked.surface), volume(pyramid_sphere()));
  EXPECT_EQ(outcome(turned(pyramid_sphere())), "the whole surface was inside out: turned");
  EXPECT_NEAR(volume(check_surface(turned(pyramid_sphere()), "a").surface), volume(pyramid_sphere()), 1e-12);
  Surface half = pyramid_sphere();
  for (std::size_t f = 0; f < half.triangles.size(); f += 3) std::swap(half.triangles[f][0], half.triangles[f][1]);
  EXPECT_NE(outcome(half).find("427 facets turned that faced the other way than their neighbours"), std::string::npos)
      << outcome(half);
  EXPECT_NEAR(volume(check_surface(half, "a").surface), volume(pyramid_sphere()), 1e-12);
}

TEST(CheckSurface, FacetsWithoutAreaGoWithoutAHole) {
  const CheckedSurface checked = check_surface(with_facets_without_area(), "a");
  EXPECT_NEAR(volume(checked.surface), 1, round_off);
  EXPECT_NEAR(area(checked.surface), 6, round_off);
  EXPECT_EQ(checked.notes.size(), 2u);
  EXPECT_NE(checked.notes[1].find("three corners on a line"), std::string::npos) << checked.notes[1];
  // A chain of them along one edge, as where a fine strip meets a coarse one.
  Surface chain = box({1, 1, 1}, 1);
  const auto [a, b, c] = chain.triangles[0];
  chain.triangles.erase(chain.triangles.begin());
  constexpr int pieces = 40;
  int last = a;
  for (int i = 1; i <= pieces; ++i) {
    const int next = i == pieces ? b : static_cast<int>(chain.points.size());
    if (i < pieces) chain.points.push_back(chain.points[a] + (chain.points[b] - chain.points[a]) * i / pieces);
    chain.triangles.push_back({last, next, c});
    if (i > 1) chain.triangles.push_back({a, next, last});
    last = next;
  }
  const CheckedSurface mended = check_surface(chain, "a");
  EXPECT_NEAR(volume(mended.surface), 1, round_off);
  EXPECT_NEAR(area(mended.surface), 6, round_off);
  EXPECT_EQ(outcome(mended.surface), "clean");
}

TEST(CheckSurface, EdgesAreDrawnAnewWithTheRightNeighbours) {
  Surface s = sphere(1, 2);
  for (std::size_t f = 0; f < s.triangles.size();
       f += 7) {  // a corner of every seventh facet moves into its opposite edge
    const auto& [a, b, c] = s.triangles[f];
    s.points[c] = (s.points[a] + s.points[b]) / 2;
  }
  Neighbours neighbours = neighbours_of(sides_by_edge(s), s.triangles.size());
  const Flattened flat = remove_flat_facets(s, neighbours, 1e-6);
  EXPECT_GT(flat.removed.size(), 20u);
  EXPECT_EQ(neighbours, neighbours_of(sides_by_edge(s), s.triangles.size()));
}

TEST(CheckSurface, CoarserWeldingMovesLittleAndLosesNoFacet) {
  const CheckedSurface checked = check_surface(unwelded(), "a");
  EXPECT_EQ(checked.surface.triangles.size(), 1280u);
  EXPECT_NEAR(volume(checked.surface), volume(pyramid_sphere()), 1e-4);
  // A corner of a facet smaller than the weld: refused.
  Surface small = unwelded();
  const Vec3 a = small.points[0], b = small.points[1], c = small.points[2];
  const Vec3 tip = a + 1e-4 * (b - a), side = a + 1e-4 * (c - a);
  small.triangles.erase(small.triangles.begin());
  for (const auto& [p, q, r] : {std::array{a, tip, side}, {tip, b, side}, {b, c, side}}) {
    const int n = static_cast<int>(small.points.size());
    small.points.insert(small.points.end(), {p, q, r});
    small.triangles.push_back({n, n + 1, n + 2});
  }
  EXPECT_NE(outcome(small).find("smaller than that would be lost: weld the points in a mesh editor"), std::string::npos)
      << outcome(small);
}

// What is refused.

TEST(CheckSurface, HolesAreCountedAndPlaced) {
  Surface s = box({1, 1, 1}, 10);
  std::erase_if(s.triangles, [&](const auto& t) {
    const Vec3 middle = (s.points[t[0]] + s.points[t[1]] + s.points[t[2]]) / 3;
    return middle.z() > 0.99 && ((middle.x() < 0.5 && middle.x() > 0.3 && middle.y() > 0.1 && middle.y() < 0.3) ||
                                 (middle.x() > 0.6 && middle.x() < 0.7 && middle.y() > 0.6 && middle.y() < 0.7));
  });
  const std::string said = outcome(s);
  EXPECT_NE(said.find("12 open edges round 2 holes"), std::string::npos) << said;
  EXPECT_TRUE(said.find("spans (0.3, 0.1, 1) to (0.5, 0.3, 1)") != std::string::npos ||
              said.find("spans (0.6, 0.6, 1) to (0.7, 0.7, 1)") != std::string::npos)
      << said;
  EXPECT_NE(said.find("close the holes in a mesh editor"), std::string::npos) << said;
}

TEST(CheckSurface, SelfIntersectionsArePlaced) {
  // Two boxes that overlap; a tube that runs through itself.
  const std::string overlap = outcome(both(box({1, 1, 1}, 4), moved(box({1, 1, 1}, 4), 1, {0.6, 0.33, 0.17})));
  EXPECT_NE(overlap.find("parts overlap: join them with a Boolean union"), std::string::npos) << overlap;
  const std::string knot = outcome(trefoil(1.2, 200, 12));
  EXPECT_NE(knot.find("pairs of facets cut each other"), std::string::npos) << knot;
  EXPECT_NE(knot.find("remove the self-intersections in a mesh editor"), std::string::npos) << knot;
  // A spike that pierces the far side at (0, 0, -1) only there.
  Surface spike = sphere(1, 3);
  const auto top = std::max_element(spike.points.begin(), spike.points.end(),
                                    [](const Vec3& p, const Vec3& q) { return p.z() < q.z(); });
  *top = Vec3(0, 0, -1.2);
  const auto pairs = intersecting_facets(spike, 10000);
  ASSERT_FALSE(pairs.empty());
  for (const auto& [f, g] : pairs) {
    double lowest = 1;
    for (const int facet : {f, g})
      for (const int p : spike.triangles[facet]) lowest = std::min(lowest, spike.points[p].z());
    EXPECT_LT(lowest, -0.9);
  }
}

TEST(CheckSurface, ManyIntersectionsEndTheSearch) {
  Surface crumpled = sphere(1, 4);
  std::mt19937 random(1);
  std::uniform_real_distribution<double> share(-1, 1);
  for (Vec3& p : crumpled.points) p = Vec3(share(random), share(random), share(random));
  EXPECT_NE(outcome(crumpled).find("at least 10000 pairs of facets cut each other"), std::string::npos)
      << outcome(crumpled);
}

TEST(CheckSurface, ShellsAndCavities) {
  const Surface ball = sphere(1, 2);
  EXPECT_NE(outcome(both(ball, moved(ball, 1, {2.5, 0, 0}))).find("2 shells that do not touch"), std::string::npos);
  for (const Surface& s :
       {both(ball, moved(turned(ball), 0.5, {0, 0, 0})), both(moved(ball, 0.5, {0.1, 0, 0}), ball)}) {
    const CheckedSurface checked = check_surface(s, "ball");  // whichever way it is turned
    EXPECT_NEAR(volume(checked.surface), 7.0 / 8 * volume(ball), 1e-9);
    EXPECT_NE(checked.notes.back().find("1 cavity inside of the body, of 12.5 %"), std::string::npos);
  }
  // In the box around the ring, but not in the ring.
  EXPECT_NE(outcome(both(torus(2, 0.5, 40, 20), moved(ball, 0.5, {0, 0, 0}))).find("2 shells that do not touch"),
            std::string::npos);
  const Surface two = both(both(ball, moved(ball, 0.1, {0.5, 0, 0})), moved(ball, 0.1, {-0.5, 0, 0}));
  EXPECT_NEAR(volume(check_surface(two, "ball").surface), (1 - 2e-3) * volume(ball), 1e-9);
  EXPECT_NE(outcome(both(both(ball, moved(ball, 0.5, {0, 0, 0})), moved(ball, 0.1, {0, 0, 0})))
                .find("is in the cavity of another one"),
            std::string::npos);
}

TEST(CheckSurface, WhatIsNoManifold) {
  // Boxes that touch along an edge, at a corner, at a face.
  const Surface unit = box({1, 1, 1}, 2);
  EXPECT_NE(
      outcome(both(unit, moved(unit, 1, {1, 1, 0}))).find("2 edges of more than two facets, the first at (1, 1, "),
      std::string::npos)
      << outcome(both(unit, moved(unit, 1, {1, 1, 0})));
  EXPECT_NE(outcome(both(unit, moved(unit, 1, {1, 1, 1})))
                .find("1 point where parts of the surface only touch, the first at (1, 1, 1)"),
            std::string::npos)
      << outcome(both(unit, moved(unit, 1, {1, 1, 1})));
  EXPECT_NE(outcome(both(unit, moved(unit, 1, {1, 0, 0}))).find("edges of more than two facets"), std::string::npos);
  // A facet too many.
  Surface wing = unit;
  wing.points.push_back({2, 2, 2});
  wing.triangles.push_back({wing.triangles[0][0], wing.triangles[0][1], static_cast<int>(wing.points.size()) - 1});
  EXPECT_NE(outcome(wing).find("1 edge of more than two facets"), std::string::npos) << outcome(wing);
}

/// Closed, every edge of two facets, but with one side.
Surface klein_bottle() {
  constexpr int n = 40, m = 21;  // odd: no points where the surface passes through itself
  Surface s;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < m; ++j) {
      const double u = 2 * pi * i / n, v = 2 * pi * j / m;
      const double r = 3 + std::cos(u / 2) * std::sin(v) - std::sin(u / 2) * std::sin(2 * v);
      s.points.emplace_back(r * std::cos(u), r * std::sin(u),
                            std::sin(u / 2) * std::sin(v) + std::cos(u / 2) * std::sin(2 * v));
    }
  const auto number = [](int i, int j) { return i < n ? i * m + (j + m) % m : (2 * m - j) % m; };
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < m; ++j) {
      s.triangles.push_back({number(i, j), number(i + 1, j), number(i + 1, j + 1)});
      s.triangles.push_back({number(i, j), number(i + 1, j + 1), number(i, j + 1)});
    }
  return s;
}

TEST(CheckSurface, WhatBoundsNoBody) {
  EXPECT_EQ(outcome({}), "a.stl: has no facets");
  EXPECT_NE(outcome(klein_bottle()).find("the surface has only one side"), std::string::npos)
      << outcome(klein_bottle());
  Surface point = box({1, 1, 1}, 1);
  for (Vec3& p : point.points) p = Vec3(1, 2, 3);
  EXPECT_EQ(outcome(point), "a.stl: all facets are one point");
  for (Vec3& p : point.points) p = Vec3(1, 2, 3) + 1e-20 * Vec3::Random();
  EXPECT_NE(outcome(point), "clean");
  Surface line = box({1, 1, 1}, 1);
  for (Vec3& p : line.points) p.y() = p.z() = 0;
  EXPECT_NE(outcome(line), "clean");
  Surface flat = box({1, 1, 1}, 3);
  for (Vec3& p : flat.points) p.z() = 0;
  EXPECT_NE(outcome(flat), "clean");
  Surface nan = box({1, 1, 1}, 1);
  nan.points[nan.triangles[4][0]].x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_NE(outcome(nan).find("a coordinate is not a finite number"), std::string::npos);
  EXPECT_NE(outcome(moved(box({1, 1, 1}, 1), 1e-20, Vec3::Zero())).find("diagonal of its bounding box is 1.73e-20"),
            std::string::npos);
  EXPECT_NE(outcome(moved(box({1, 1, 1}, 1), 1e200, Vec3::Zero())).find("diagonal of its bounding box"),
            std::string::npos);
  EXPECT_NE(outcome(moved(box({1, 1, 1}, 1), 1, Vec3(1e12, 0, 0))).find("times its diagonal away from the origin"),
            std::string::npos);
}

}  // namespace
}  // namespace springproof::surface_check_test
