// The processes of a run under mpirun.  One process alone starts no MPI until PETSc needs it.  No deal.II in this
// header.
#pragma once

#include <functional>

namespace springproof::fem {

/// How many processes Open MPI or MPICH started; 1 without them.
int process_count();

/// Of this process, from 0; MPI must have been started if there are several.
int process_rank();

/// Starts MPI and PETSc, once, if the program has not; ends them with the program.
void start_mpi();

/// Runs f, which must not communicate.  Where it throws on any process, every process throws what the first of them
/// threw.
/// @throws InputError, std::runtime_error
void together(const std::function<void()>& f);

/// True if every process calls this within seconds: the error that led here is everybody's.
bool all_failed();

/// Ends every process, also those that wait for this one.
[[noreturn]] void end_all(int exit_status);

}  // namespace springproof::fem
