// The subcommand that puts the parts of a sweep together.
#pragma once

#include "comparisons/sweep/sweep_report.h"

namespace CLI {
class App;
}

namespace springproof {

/// `springproof report FOLDER`.
class ReportCommand {
 public:
  void add_options(CLI::App& command);
  /// @return as report_sweep.
  int run() const;

 private:
  SweepReportOptions options_;
};

}  // namespace springproof
