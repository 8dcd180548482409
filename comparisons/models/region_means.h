// Means over the regions of a body of springs.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "msm/topology/network.h"
#include "problem/region.h"

namespace springproof {

/// region.<region>.<quantity> of cells, at small strain: volume_change, mean_stress, pressure by the mean strain of
/// each cell and Hooke's law, displacement.  No energy: that of hourglass modes is none of a mean strain.
std::map<std::string, double> region_means(const Network& network, const std::vector<MaterialRegion>& regions,
                                           const NodalVectors& u);

}  // namespace springproof
