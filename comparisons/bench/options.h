// Command-line options of the bench.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace springproof::bench {

struct BenchOptions {
  std::string what;  ///< "dynamics", "statics", "fem", "experiments", "gpu", "engines", "all" (but engines)
  std::filesystem::path json, out;         ///< file for the figures; folder for bench.html and bench.json; empty: none
  bool quick = false;                      ///< small sizes, few samples: some 30 s for everything
  std::string engine;                      ///< engines: only set-ups with this in their name
  bool install = false;                    ///< engines: npm ci first
  int threads = 2;                         ///< of the rows that compare several threads with one
  std::vector<std::string> fem_arguments;  ///< passed on to springproof-fem
};

}  // namespace springproof::bench
