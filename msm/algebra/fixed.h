// Vectors over all unknowns of which some are fixed.
#pragma once

#include <cstddef>
#include <vector>

namespace springproof {

/// Sets the entries of `v` that are `fixed` to zero.
template <class Vector>
void clear_fixed(const std::vector<char>& fixed, Vector& v) {
  for (std::size_t i = 0; i < fixed.size(); ++i)
    if (fixed[i]) v[static_cast<std::ptrdiff_t>(i)] = 0;
}

}  // namespace springproof
