// What a run costs, as the system counts it.
#pragma once

namespace springproof {

double cpu_seconds();      ///< CPU time of the calling thread [s]
double peak_memory_MiB();  ///< largest resident memory of this program so far

}  // namespace springproof
