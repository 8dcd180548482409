// MPI processes of a run under mpirun.  A single process does not start MPI until PETSc needs it.  No deal.II in this
// header.
#pragma once

#include <functional>
#include <string>

namespace springproof::fem {

/// How many processes Open MPI or MPICH started; 1 without them.
int process_count();

/// Rank of this process, from 0; MPI must have been started if there are several.
int process_rank();

/// Initialises MPI and PETSc, unless this has been done; they are finalised when the program ends.
void start_mpi();

/// Runs f, which must not communicate.  If it throws on any process, every process throws the error of the first of
/// these.
/// @throws InputError, std::runtime_error
void together(const std::function<void()>& f);

/// The bytes of the first process.
std::string from_first(const std::string& bytes);

/// True if every process calls this within seconds, that is, if all have failed.
bool all_failed();

/// Aborts every process, including those waiting for this one.
[[noreturn]] void end_all(int exit_status);

}  // namespace springproof::fem
