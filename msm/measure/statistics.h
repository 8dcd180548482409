// Statistics of a network as in Kot et al. (2014), sec. 3.3.
#pragma once

#include "msm/topology/network.h"

namespace springproof {

/// Counts and means of a network.
struct NetworkStatistics {
  long nodes;               ///< number N
  long springs;             ///< number
  double springs_per_node;  ///< `<S>`: mean number of springs that meet at a node
  double mean_length;       ///< `<L>` [m]
  double length_deviation;  ///< standard deviation of L [m]
  double spacing;           ///< l = n^(-1/3) [m]
  double density;           ///< n = N/V [1/m^3]
};

/// Statistics of all nodes and springs; `<S>` = 2 springs / nodes, including surface nodes, which have fewer.  Images
/// of a periodic network are not counted as nodes, so that its statistics are those of the infinite network.
NetworkStatistics statistics(const Network& network);

}  // namespace springproof
