// Removal of insufficiently connected nodes from a network.
#pragma once

#include "msm/topology/connect.h"
#include "msm/topology/random/random_network.h"

namespace springproof {

/// Removes floppy and detached nodes (NetworkRepair) with their bonds, repeatedly until there are none.
/// `box` [m]: the period of bonds with a shift.
NetworkRepair repair(std::vector<Vec3>& points, std::vector<Bond>& bonds, const Vec3& box);

}  // namespace springproof
