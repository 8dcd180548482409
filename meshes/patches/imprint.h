// Borders of rules cut into a mesh.
#pragma once

#include "meshes/patches/cut_mesh.h"
#include "meshes/patches/rule_region.h"

namespace springproof {

/// Cuts the mesh so that each outer facet lies within the rule or without, and puts those within into the patch of that
/// number. Planes run along edges then.  The circle of a sphere becomes a polygon, of the circle's area where its
/// corners can be moved so. Facets are refined to a quarter of the patch's extent, of one within a sphere to a sixth
/// and where its circle runs to a sixth of the radius, times `coarseness`: meshes that differ by a factor of their
/// edges do so at the patch, too.
/// @return how many facets lie within
std::size_t imprint(const PatchRule& rule, int patch, double coarseness, CutMesh& mesh);

}  // namespace springproof
