// Patches by rules of the case file.
#pragma once

#include <vector>

#include "meshes/mesh.h"
#include "problem/patch_rule.h"

namespace springproof {

/// Adds a patch to the mesh for each rule, of the outer facets that the rule selects (problem/patch_rule.h).
/// @throws InputError at a rule that selects no facet, with what each of its conditions holds alone, or that has the name of
///   a patch which is there already.
void select_patches(const std::vector<PatchRule>& rules, Mesh& mesh);

}  // namespace springproof
