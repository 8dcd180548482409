// Benchmark of the finite element reference: ratios of runs on this machine, one after the other.
#pragma once

#include <string>

namespace springproof::fem {

struct BenchOptions {
  int cells = 24;         ///< along each side of the cube of the comparison; a multiple of 8
  bool baseline = true;   ///< also run the assembled baseline, which is slow and takes much memory
  std::string json_file;  ///< output file for JSON; empty: none
};

/// Prints a table to standard output, progress to standard error.
/// @throws std::runtime_error if the JSON file cannot be written.
void bench(const BenchOptions& options);

}  // namespace springproof::fem
