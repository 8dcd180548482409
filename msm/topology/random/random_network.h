// Disordered networks: random sequential addition of nodes, springs between all nearby nodes (Kot et al. 2014, sec.
// 3.3).
#pragma once

#include <cstdint>
#include <optional>

#include "msm/topology/network.h"
#include "msm/topology/region.h"

namespace springproof {

/// How nodes are placed and joined.
struct RandomParameters {
  double spacing;                    ///< l = (V/N)^(1/3) [m]
  double min_length = 0.8;           ///< minL / l; addition jams near 0.895
  std::optional<double> max_length;  ///< maxL / l; if empty, chosen to give springs_per_node
  double springs_per_node = 15;      ///< mean number `<S>` inside the bulk
  double edge_clearance = 0;         ///< distance / l that nodes on faces keep from sharp edges
  int least_springs = 0;             ///< nodes that have fewer are joined to the nearest within 2 maxL as well
  double stiffness_exponent = 0;     ///< p: k = (L/l)^-p [N/m]
  std::uint64_t seed = 1;            ///< the same seed gives the same network, to the last bit, on every machine
  bool windows = false;       ///< nodes in stages, by spherical windows, as the paper; without surface nodes only
  bool surface_nodes = true;  ///< nodes on the surface first; false: the surface cuts the sample, as in the paper
};

/// Nodes removed because they are insufficiently connected.
struct NetworkRepair {
  int floppy_nodes = 0;    ///< fewer than 4 springs, or springs so badly spread that the smallest eigenvalue of
                           ///< sum n n^T is below 0.05 of a third of its trace
  int detached_nodes = 0;  ///< in parts that are not connected with the largest part
};

/// Network of a body.  Springs join all nodes closer than maxL whose line stays in the body (tested at three points).
/// If max_length is empty, maxL is that of a periodic sample of 8000 nodes with the same minL/l and `<S>` =
/// springs_per_node.  Volume shares: nearest node of each point of a lattice of l/3, scaled to the body's volume.
/// With surface nodes: corners, sharp edges and faces are filled first, to one node per l, l^2; then the inside, to the
/// number that gives the density 1/l^3 far from the surface.
/// @throws std::invalid_argument: parameters out of range; more nodes than random addition can place (the message gives
///   the largest possible minL/l); more than 20 % of the nodes removed as floppy or detached.
Network random_network(const Region& region, const RandomParameters& parameters, NetworkRepair* repaired = nullptr);

/// Network of the periodic box [0, box], N = V/l^3 nodes.  maxL follows from the network's own pairs, so `<S>` is
/// exact. A spring that crosses the box ends on a ghost (Network::image_of), which has no volume.
/// @throws std::invalid_argument as above, and for a box narrower than 3 maxL.
Network periodic_random_network(const Vec3& box, const RandomParameters& parameters, NetworkRepair* repaired = nullptr);

}  // namespace springproof
