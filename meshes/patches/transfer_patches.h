// Patches from one mesh of a body to another.
#pragma once

#include "meshes/locate/outer_facets.h"

namespace springproof {

/// Adds the patches of `from` to `to`: each outer facet of `to` gets those of the outer facet of `from` (`facets`) that
/// is nearest to its middle (none, if that one has none).  A patch that no middle is near to gets the facet whose
/// middle is nearest to its centroid.
/// @return the names of such patches
std::vector<std::string> transfer_patches(const Mesh& from, const std::vector<OuterFacet>& facets, Mesh& to);

}  // namespace springproof
