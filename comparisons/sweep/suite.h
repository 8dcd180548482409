// Runs many cases on several worker threads, keeps finished parts when interrupted, and writes the results.
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "comparisons/sweep/sweep.h"

namespace springproof {

struct SuiteOptions {
  std::filesystem::path out = "springproof-report";
  int jobs = 0;                        ///< parts at once; 0 = one per processor core
  bool resume = false;                 ///< take finished parts from `out`
  bool vtu = false;                    ///< write a VTU per run
  bool vtu_single = false;             ///< in single precision
  bool gltf = false;                   ///< write the deformed surface of each run
  bool quiet = false;                  ///< show no progress
  bool verbose = false;                ///< also print a sentence on every model
  std::filesystem::path live_page;     ///< copied beside the report, which links it; empty: none
  std::vector<double> poisson_ratios;  ///< only these of each case; empty: all
  int finer = 1;                       ///< reference grids with so many times the cells along each direction
  std::optional<Shard> shard;          ///< only this share of the parts, without results; finished parts are kept
};

/// The parts of the cases, as compare() runs and keeps them: shared out if that is wanted.
Sweep planned(const std::vector<Experiment>& cases, const SuiteOptions& options);

/// Runs the cases and writes results.csv, results.json, report.html and vtu/ into options.out; of a shard only its
/// parts, for report_sweep().
/// Progress goes to stderr (comparisons/sweep/status.h), before a run of more than a minute also its estimated
/// duration.
/// @return 0: every expectation holds; 1: one does not, or cannot be judged, or a case had no reference, no result or
/// nothing to compare; 130: interrupted (finished parts are kept).  Of a shard 0: its parts are there.
/// @throws InputError for unusable input or output folder, before anything is computed.
int compare(const std::vector<std::filesystem::path>& cases, const SuiteOptions& options);

/// Puts the parts together that shards have computed into options.out: results.csv, results.json, report.html and
/// series of VTU files, as compare() writes them.  Missing parts, those damaged and those of other inputs are named by
/// shard on stderr.
/// @param options of which `out` and `live_page` count
/// @param partial also without all of its parts
/// @return 0: every expectation holds; 1: one does not, or cannot be judged, or parts are missing.
/// @throws InputError if the folder holds no sweep, or parts are missing and `partial` is not set.
int report_sweep(SuiteOptions options, bool partial);

}  // namespace springproof
