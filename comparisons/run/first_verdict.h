// What is known of the models before the reference is: their distance from its coarsest grid.
#pragma once

#include <string>

#include "comparisons/run/part_run.h"

namespace springproof {

/// "beside the coarsest grid alone: hybmss_avg 2.1 %, emsm 4.3 %", the closest first, on the finest lattice; empty
/// where no model has a displacement at rest.
/// @param coarsest displacement at the nodes of all lattices [m]
std::string first_verdict(const PartRun& run, const NodalVectors& coarsest);

}  // namespace springproof
