// The subcommand that puts the parts of a sweep together.
#pragma once

#include <filesystem>
#include <functional>

#include "comparisons/run/sweep_report.h"

namespace CLI {
class App;
}

namespace springproof {

/// `springproof report FOLDER`.
class ReportCommand {
 public:
  /// `live_page`: the file that --live copies.
  void add_options(CLI::App& command, std::function<std::filesystem::path()> live_page);
  /// @return as report_sweep.
  int run() const;

 private:
  SweepReportOptions options_;
};

}  // namespace springproof
