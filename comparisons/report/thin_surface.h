// Fewer triangles for a picture: nodes of one lattice cube become one.
#pragma once

#include <array>
#include <vector>

#include "problem/vector.h"

namespace springproof {

/// The facets (triangles: fourth number -1) as they are if they come to at most `most` triangles; else triangles
/// between fewer of the same points [m], at most `most`: of the points in a cube of a lattice the one nearest to their
/// mean stands for all.  What is thinner than a cube may be lost; for looking at only.
std::vector<std::array<int, 4>> thinned(const NodalVectors& points, const std::vector<std::array<int, 4>>& facets,
                                        std::size_t most = 20000);

}  // namespace springproof
