// Bodies of several materials, and what takes those of one only.
#pragma once

#include <algorithm>
#include <stdexcept>

#include "meshes/mesh.h"

namespace springproof {

/// @param mesh of a body
/// @throws std::invalid_argument if some of its cells are of another material than the body's own.
inline void require_one_material(const Mesh& mesh) {
  if (std::any_of(mesh.materials.begin(), mesh.materials.end(), [](int material) { return material != 0; }))
    throw std::invalid_argument(
        "has one material in all of the body, which has several (allowed: lattices of cells without momentum "
        "dispersion)");
}

}  // namespace springproof
