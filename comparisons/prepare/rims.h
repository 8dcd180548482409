// Where the patches of a body of voxels end, and what is too near to it for the reference's elements.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "comparisons/prepare/prepared_case.h"

namespace springproof {

/// Mean edge of the tetrahedra of the finest mesh [m].
double element_size(const PreparedCase& prepared);

/// A point nearer to the rim of a loaded or held patch than an element is long.  Only facets are refined there, and
/// each mesh has another polygon for a circle.
struct NearRim {
  std::string patch;
  double distance = 0;  ///< [m]
};

/// The nearest such rim to each of the probes, or nothing.  Rims along edges of the body count as none: they are the
/// same on every mesh.
std::vector<std::optional<NearRim>> rims_near(const PreparedCase& prepared, const std::vector<Probe>& probes);

/// Loaded or held patches that are chosen by their facets' normals and end on a curved surface, at no edge of the
/// body: their border differs from mesh to mesh.
std::vector<std::string> ragged_patches(const PreparedCase& prepared);

}  // namespace springproof
