#include "problem/system/run_cost.h"

#include <malloc.h>
#include <sys/resource.h>

#include <ctime>
#include <fstream>
#include <string>

namespace springproof {
namespace {

/// A line of /proc/self/status [MiB], e.g. "VmHWM:"; 0 if there is none.
double status_MiB(const std::string& name) {
  std::ifstream in("/proc/self/status");
  for (std::string word; in >> word;)
    if (double kB = 0; word == name && in >> kB) return kB / 1024;
  return 0;
}

}  // namespace

MemoryGrowth::MemoryGrowth() {
  malloc_trim(0);
  std::ofstream("/proc/self/clear_refs") << "5";  // resets the peak resident set to its current size
  before_MiB_ = status_MiB("VmRSS:");
}

double MemoryGrowth::most_MiB() const { return std::max(0.0, status_MiB("VmHWM:") - before_MiB_); }

double cpu_seconds() {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

double peak_memory_MiB() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024;
}

}  // namespace springproof
