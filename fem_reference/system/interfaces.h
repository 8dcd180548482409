// Forces that the materials of a body exert on each other.
#pragma once

#include <vector>

#include "fem_reference/exchange/request.h"
#include "fem_reference/system/elastic_system.h"

namespace springproof::fem {

/// Forces between materials at their common nodes: of each the internal force of its cells less `loads` on them, which
/// balances the other loads on the material to the solver's tolerance, whatever edges the border has.  Where a support
/// holds common nodes each side has half of what it does not balance.
/// @param loads of each material, load_vector() [N]
std::vector<InterfaceForce> measure_interfaces(const ElasticSystem& system, const ElasticAnswer& answer,
                                               const DofVector& displacement, const std::vector<DofVector>& loads);

}  // namespace springproof::fem
