// The results of a comparison that several machines have computed into one folder.
#pragma once

#include <filesystem>

namespace springproof {

struct SweepReportOptions {
  std::filesystem::path folder;
  bool partial = false;             ///< also without all of its parts
  std::filesystem::path live_page;  ///< copied beside the report, which links it; empty: none
};

/// Puts the parts together: results.csv, results.json, report.html and series of VTU files, as compare() writes them.
/// Missing parts, those damaged and those of other inputs are named by shard on stderr.
/// @return 0: every expectation holds; 1: one does not, or cannot be judged, or parts are missing.
/// @throws InputError if the folder holds no sweep, or parts are missing and `partial` is not set.
int report_sweep(const SweepReportOptions& options);

}  // namespace springproof
