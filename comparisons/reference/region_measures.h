// What regions of a body and the interfaces between them measure, of finite elements or springs, by the names of rows.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "fem_reference/exchange/request.h"
#include "problem/region.h"

namespace springproof {

/// region.<region>.<quantity>, of the means over each region, of finite elements or springs; an energy of NaN is none.
std::map<std::string, double> region_measures(const std::vector<MaterialRegion>& regions,
                                              const std::vector<fem::RegionMeans>& means);

/// interface.<region>.<other>.force of all that meet, of finite elements or springs.
std::map<std::string, double> interface_measures(const std::vector<MaterialRegion>& regions,
                                                 const std::vector<fem::InterfaceForce>& interfaces);

}  // namespace springproof
