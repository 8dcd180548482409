// Networks whose nodes are the vertices of a body's tetrahedra.
#pragma once

#include "msm/topology/network.h"

namespace springproof {

/// Springs of stiffness 1 N/m between each vertex and the nearest `springs_per_node` others to which the line passes in
/// the body (tested at fifteen points): not across a gap.  Nodes have the volume of a quarter of their tetrahedra.
/// @param tetrahedra of the body
/// @param springs_per_node of each node at least, if so many are seen within six spacings
/// @throws std::invalid_argument unless there are more vertices than that.
Network vertex_network(const Mesh& tetrahedra, int springs_per_node);

}  // namespace springproof
