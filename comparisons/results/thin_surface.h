// Thins a surface for display: the nodes in each cube of a lattice become one.
#pragma once

#include <array>
#include <vector>

#include "problem/vector.h"

namespace springproof {

/// The facets (triangles: fourth number -1) unchanged if they make at most `most` triangles; else at most `most`
/// triangles between fewer of the same points [m]: of the points in a cube of a lattice the one nearest to their mean
/// represents all.  Features thinner than a cube may be lost; for display only.
std::vector<std::array<int, 4>> thinned(const NodalVectors& points, const std::vector<std::array<int, 4>>& facets,
                                        std::size_t most = 20000);

}  // namespace springproof
