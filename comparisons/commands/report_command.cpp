#include "comparisons/commands/report_command.h"

#include <CLI/CLI.hpp>

#include "comparisons/commands/live_page.h"

namespace springproof {

void ReportCommand::add_options(CLI::App& command) {
  command.add_option("FOLDER", options_.folder, "what `springproof compare --shard K/N --out FOLDER` wrote")
      ->required();
  command.add_flag("--partial", options_.partial,
                   "also where parts are missing: a report of those that are there, with exit status 1");
  command.add_flag_callback(
      "--live", [this] { options_.live_page = live_page(); },
      "also copy the page in which the bodies can be pulled (live.html) beside the report, with a link");
  command.footer(
      "Computes nothing. Missing parts are named with their shards, which are to be started again.\n"
      "Exit status: 0 every expectation holds, 1 one does not or cannot be judged, 2 parts are missing, or there is no "
      "sweep.");
}

int ReportCommand::run() const { return report_sweep(options_); }

}  // namespace springproof
