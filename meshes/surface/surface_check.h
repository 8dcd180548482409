// From the facets of a file to the surface of one body: closed, outward, welded, without self-intersections.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "meshes/surface/surface.h"

namespace springproof {

struct CheckedSurface {
  Surface surface;
  std::vector<std::string> notes;  ///< what was repaired, one sentence each
};

/// Makes the surface of one body from loose facets (each with points of its own, or welded already).
/// Points nearer to each other than 1e-6 of the diagonal of the bounding box become one.
/// Repaired, and listed in the notes: facets without area and facets that are there twice (removed), points whose
/// facets only meet when points up to 1e-4 of the diagonal apart become one (welded, if no facet is lost by it), facets
/// oriented against their neighbours, a surface inside out (both reoriented).
/// @throws InputError that begins with `name` and says how many, where the first one is (in the units of the surface)
/// and what
///         to do: no facets, coordinates that are no numbers, open edges, edges of more than two facets, a surface with
///         one side, points where parts only touch, facets that cut each other, several shells but for those of
///         cavities, no volume.
CheckedSurface check_surface(const Surface& raw, const std::string& name);

/// Pairs of facets of a welded surface that cut or touch each other elsewhere than at common points and edges; exact.
/// Stops at `most` pairs.  No facet may be without area.
std::vector<std::pair<int, int>> intersecting_facets(const Surface& surface, unsigned most);

/// The same body (surface as of check_surface) with no more facets than triangles of this edge would be, where it has
/// more than twice as many: flat faces and creases stay, noise is averaged, the volume changes by less than 0.1 %.
/// Shorter edges where that cannot be.
Surface thinned(const Surface& surface, double edge);

/// The same body (surface as of check_surface) with triangles of about this edge [m].  Edges where facets meet at more
/// than 40 degrees are kept as lines (unless lines of less than eight edges in all); elsewhere the new facets lie as
/// much inside of the old surface as outside of it (balanced.h).
/// @throws std::runtime_error, what it does, if that fails: the edge is too long for the body (its volume changes by
///         more than `most_change` before facets are balanced, or `most_balanced` after, or facets cut each other and
///         cannot be repaired), or too short (more than 4 million facets).
Surface remesh(const Surface& surface, double edge, double most_change = 0.01, double most_balanced = 0.01);

}  // namespace springproof
