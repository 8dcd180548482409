// What a program sets before it initialises MPI.  No MPI in this header.
#pragma once

#include <cstdlib>

namespace springproof {

/// Without mpirun: keeps Open MPI from starting a daemon, from looking for networks, for which it waits .3 s at each
/// start, and from a folder in /tmp that all such programs share and the first to end removes, so that another could
/// not start.  What the user has set stays.
inline void start_mpi_without_network() {
  for (const char* several : {"OMPI_COMM_WORLD_SIZE", "PMI_SIZE"})
    if (std::getenv(several)) return;
  setenv("OMPI_MCA_ess_singleton_isolated", "1", 0);
  setenv("OMPI_MCA_orte_create_session_dirs", "0", 0);
  setenv("OMPI_MCA_pml", "ob1", 0);
}

}  // namespace springproof
