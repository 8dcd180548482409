#include "fem_reference/grid/processes.h"

#include <deal.II/base/mpi.h>
#include <deal.II/lac/la_parallel_vector.h>
#include <deal.II/lac/vector_memory.h>
#include <boost/serialization/utility.hpp>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <thread>
#include <utility>

#include "problem/processes/mpi_start.h"
#include "problem/system/input_error.h"

namespace springproof::fem {

int process_count() {
  for (const char* name : {"OMPI_COMM_WORLD_SIZE", "PMI_SIZE"})
    if (const char* size = std::getenv(name)) return std::max(1, std::atoi(size));
  return 1;
}

int process_rank() { return process_count() > 1 ? int(dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD)) : 0; }

void start_mpi() {
  int started = 0;
  MPI_Initialized(&started);
  if (started) return;
  // deal.II clears its static vector memory pools when the session ends, so they are created before it and destroyed
  // after it.
  dealii::GrowingVectorMemory<dealii::LinearAlgebra::distributed::Vector<double>>::release_unused_memory();
  dealii::GrowingVectorMemory<dealii::LinearAlgebra::distributed::Vector<float>>::release_unused_memory();
  static int argc = 1;
  static char name[] = "springproof-fem";
  static char* arguments[] = {name, nullptr};
  static char** argv = arguments;
  start_mpi_without_network();
  static const dealii::Utilities::MPI::MPI_InitFinalize session(argc, argv, 1);
}

void together(const std::function<void()>& f) {
  if (process_count() == 1) return f();
  std::pair<int, std::string> failure;  // kind of error: 0 none, 2 InputError, 1 any other
  try {
    f();
  } catch (const InputError& e) {
    failure = {2, e.what()};
  } catch (const std::exception& e) {
    failure = {1, e.what()};
  }
  for (const auto& [kind, message] : dealii::Utilities::MPI::all_gather(MPI_COMM_WORLD, failure)) {
    if (kind == 2) throw InputError(message);
    if (kind == 1) throw std::runtime_error(message);
  }
}

std::string from_first(const std::string& bytes) { return dealii::Utilities::MPI::broadcast(MPI_COMM_WORLD, bytes); }

bool all_failed() {
  if (process_count() == 1) return true;
  MPI_Request request;
  MPI_Ibarrier(MPI_COMM_WORLD, &request);
  int done = 0;
  for (int tries = 0; tries < 500 && !done; ++tries) {
    MPI_Test(&request, &done, MPI_STATUS_IGNORE);
    if (!done) std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  return done;
}

void end_all(int exit_status) {
  MPI_Abort(MPI_COMM_WORLD, exit_status);
  std::abort();
}

}  // namespace springproof::fem
