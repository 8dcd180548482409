// Facets that lie as much inside of a curved surface as outside of it.
#pragma once

#include <vector>

#include "meshes/surface/surface.h"

namespace springproof {

/// The surface with its points moved across that of the body, so that each facet has as much of the body above it as it
/// lies above the body.  Facets with their points on a curved surface are chords: they lose volume and stiffness as the
/// square of their edges, and meshes of different edges are different bodies.  Plane faces and creases between them
/// stay: a point moves as the facets at it demand, by least squares.
/// @param surface outward, its points near that of the body
/// @param body outward
Surface balanced(const Surface& surface, const Surface& body);

/// The same, by the mean heights of the body above the facets, along their normals.
Surface balanced(const Surface& surface, const std::vector<double>& heights);

}  // namespace springproof
