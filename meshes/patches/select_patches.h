// Patches by rules of the case file.
#pragma once

#include <string>
#include <vector>

#include "meshes/mesh.h"
#include "problem/patch_rule.h"

namespace springproof {

/// Adds a patch to the mesh for each rule (problem/patch_rule.h).  Tetrahedra are cut along the rules' borders
/// (meshes/patches/imprint.h); of hexahedra whole facets are taken, by their middles.
/// @param coarseness edges of this mesh over those of the finest one of the body
/// @return what the cuts have done to the cells, for the user
/// @throws InputError at a rule that selects no facet, with what each of its conditions holds alone, or that has the
/// name of
///   a patch which is there already.
std::vector<std::string> select_patches(const std::vector<PatchRule>& rules, Mesh& mesh, double coarseness = 1);

/// Whether the borders of the rules run along edges of the mesh's outer facets, so that every mesh with this property
/// has the same patches.
bool end_at_edges_of(const Mesh& mesh, const std::vector<PatchRule>& rules);

/// select_patches() for meshes of one body that are to have the same patches.
/// @throws InputError as it does, and at a rule whose border runs through facets of hexahedra.
void select_whole_facets(const std::vector<PatchRule>& rules, Mesh& mesh);

}  // namespace springproof
