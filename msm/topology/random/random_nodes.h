// Node positions of disordered networks.
#pragma once

#include "msm/topology/random/random_network.h"

namespace springproof {

// All throw std::invalid_argument if random addition jams before the density 1/l^3 is reached.

/// Nodes on corners, sharp edges and faces, then in the inside.
std::vector<Vec3> nodes_from_surface(const Region& region, const RandomParameters& parameters);

/// A sample of a box that is larger than the body by `margin` [m], cut by the surface; in windows if asked for.
std::vector<Vec3> nodes_cut_by_surface(const Region& region, const RandomParameters& parameters, double margin);

/// V/l^3 nodes in the periodic box [0, box].
std::vector<Vec3> periodic_nodes(const Vec3& box, const RandomParameters& parameters);

/// The same, or as many of them as fit.
std::vector<Vec3> periodic_nodes_up_to_jamming(const Vec3& box, const RandomParameters& parameters);

}  // namespace springproof
