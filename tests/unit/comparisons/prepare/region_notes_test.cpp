// What is said of regions that cells do not resolve.
#include "comparisons/prepare/region_notes.h"

#include <gtest/gtest.h>

#include "meshes/regions/mark_regions.h"
#include "support/says.h"
#include "support/solids.h"

namespace springproof::region_notes_test {
namespace {

MaterialRegion region(const std::string& name, const RegionPlace& place) {
  return {name, {1, 0.3, 1000}, {"case.toml", 7, 1}, place};
}

Mesh cube(const std::vector<MaterialRegion>& regions) {
  Mesh mesh = test::solid_of(block_mesh({1, 1, 1}, {6, 6, 6}));
  mark_regions(regions, 1, mesh);
  return mesh;
}

std::string said(const std::vector<std::string>& notes) {
  std::string all;
  for (const std::string& note : notes) all += note + "\n";
  return all;
}

TEST(RegionNotes, NothingIsSaidOfWhatIsResolved) {
  const std::vector<MaterialRegion> regions = {region("ball", PatchRule::Near{{0.5, 0.5, 0.5}, 0.3})};
  EXPECT_EQ(said(region_notes(regions, cube(regions), 0.1)), "");
}

TEST(RegionNotes, SmallAndThinOnesAreNamedInCells) {
  const std::vector<MaterialRegion> small = {region("ball", PatchRule::Near{{0.5, 0.5, 0.5}, 0.1})},
                                    sheet = {region("skin", PatchRule::Box{{0.25, 0.25, 0.5}, {0.75, 0.75, 0.55}})};
  EXPECT_WORDS(said(region_notes(small, cube(small), 0.2)), "region 'ball' is about 0.9");
  EXPECT_WORDS(said(region_notes(small, cube(small), 0.2)), "30 to 80 % off");
  EXPECT_WORDS(said(region_notes(sheet, cube(sheet), 0.2)), "region 'skin' is 0.21 cells thick");
}

TEST(RegionNotes, GapsBetweenRegionsAreNamedWithTheirShare) {
  const std::vector<MaterialRegion> halves = {region("low", PatchRule::Box{{0, 0, 0}, {1, 1, 0.49}}),
                                              region("high", PatchRule::Box{{0, 0, 0.51}, {1, 1, 1}})};
  EXPECT_WORDS(said(region_notes(halves, cube(halves), 0.1)),
               "a gap of 0.19 cells between 'low' and 'high', 2 % of the volume, is filled with [material]");
}

TEST(RegionNotes, WhatNoCellKeepsIsRefusedWithAnEdgeThatWould) {
  const std::vector<MaterialRegion> small = {region("ball", PatchRule::Near{{0.5, 0.5, 0.5}, 0.02})};
  try {
    require_resolved(small, cube(small), 0.5);
    FAIL() << "accepted";
  } catch (const InputError& e) {
    EXPECT_WORDS(e.what(), "case.toml:7:1: region: 'ball', of ");
    EXPECT_WORDS(e.what(), "(allowed: voxel_edge_m up to 0.01,");
  }
  require_resolved(small, cube(small), 0.02);
}

}  // namespace
}  // namespace springproof::region_notes_test
