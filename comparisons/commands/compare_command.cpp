#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "comparisons/commands/commands.h"
#include "comparisons/sweep/find_cases.h"
#include "comparisons/sweep/suite.h"
#include "problem/processes/child.h"
#include "problem/system/input_error.h"

namespace springproof {
namespace {

/// The page in which bodies can be pulled, which --live copies beside a report.
/// @throws InputError saying how it is built, where it is not.
std::filesystem::path live_page() {
  const std::filesystem::path page = data_folder("live", SPRINGPROOF_LIVE_DIR) / "live.html";
  if (!std::filesystem::exists(page))
    throw InputError(
        fmt::format("--live: the live page is not built, {} is not there (in the sources: "
                    "comparisons/live/build.sh, which needs Debian's packages emscripten and node-acorn)",
                    page.string()));
  return page;
}

/// `springproof compare CASE...`.
class CompareCommand {
 public:
  void add_options(CLI::App& command);
  /// @return as compare().
  int run() const;

 private:
  std::vector<std::string> names_;
  SuiteOptions options_;
};

void CompareCommand::add_options(CLI::App& command) {
  command.add_option("CASE", names_, "case files (*.toml), folders of them, or built-in names (springproof list)")
      ->required();
  CLI::Option* out = command.add_option("--out", options_.out, "folder for the results")->capture_default_str();
  command.add_option("--jobs", options_.jobs, "parts to run at once (0: one per core)");
  command
      .add_option("--poisson-ratio", options_.poisson_ratios, "only these of the cases' Poisson's ratios (0.25,0.49)")
      ->delimiter(',')
      ->take_all();
  command
      .add_option("--finer", options_.finer,
                  "reference grids with so many times the cells along each direction (known values for a calibration)")
      ->check(CLI::Range(1, 16));
  command.add_flag("--resume", options_.resume, "keep what an interrupted run finished");
  command.add_flag("--quiet", options_.quiet, "say nothing of what is under way");
  command.add_flag("--verbose", options_.verbose,
                   "also print a sentence on every model, and how far each case deforms");
  CLI::Option* live = command.add_flag_callback(
      "--live", [this] { options_.live_page = live_page(); },
      "also copy the page in which the bodies can be pulled (live.html) beside the report, with a link");
  command
      .add_option_function<std::string>(
          "--shard", [this](const std::string& text) { options_.shard = parse_shard(text); },
          "only the K-th of N shares of the parts, K/N, into a folder that all shards share; then: springproof report")
      ->needs(out)
      ->excludes(live);
  command.add_flag("--vtu,!--no-vtu", options_.vtu, "also write a VTU file of every run, for ParaView");
  command.add_flag("--vtu-single", options_.vtu_single, "VTU files in single precision, half the size")->needs("--vtu");
  command.add_flag("--gltf", options_.gltf,
                   "also write the deformed surface of every run as OUT/gltf/CASE/RUN.glb, moving as the body does");
  command.footer(
      "Exit status: 0 every expectation holds, 1 one does not or cannot be judged, or a reference or every run failed, "
      "or nothing was compared, 2 the input is unusable, 130 interrupted; with --shard 0 its parts are there.");
}

int CompareCommand::run() const { return compare(find_cases(names_), options_); }

/// `springproof report FOLDER`.
class ReportCommand {
 public:
  void add_options(CLI::App& command);
  /// @return as report_sweep.
  int run() const;

 private:
  SuiteOptions options_;
  bool partial_ = false;
};

void ReportCommand::add_options(CLI::App& command) {
  command.add_option("FOLDER", options_.out, "what `springproof compare --shard K/N --out FOLDER` wrote")->required();
  command.add_flag("--partial", partial_,
                   "also where parts are missing: a report of those that are there, with exit status 1");
  command.add_flag_callback(
      "--live", [this] { options_.live_page = live_page(); },
      "also copy the page in which the bodies can be pulled (live.html) beside the report, with a link");
  command.footer(
      "Computes nothing. Missing parts are named with their shards, which are to be started again.\n"
      "Exit status: 0 every expectation holds, 1 one does not or cannot be judged, 2 parts are missing, or there is no "
      "sweep.");
}

int ReportCommand::run() const { return report_sweep(options_, partial_); }

}  // namespace

RunCommand compare_command(CLI::App& parser) { return made<CompareCommand>(parser); }

RunCommand report_command(CLI::App& parser) { return made<ReportCommand>(parser); }

}  // namespace springproof
