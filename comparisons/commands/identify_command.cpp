#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <string>
#include <vector>

#include "comparisons/commands/commands.h"
#include "comparisons/identify/identified.h"
#include "comparisons/sweep/find_cases.h"
#include "comparisons/sweep/folder_lock.h"
#include "comparisons/sweep/status.h"
#include "problem/files/files.h"
#include "problem/processes/child.h"
#include "problem/processes/interrupts.h"
#include "problem/system/streams.h"

namespace springproof {
namespace {

namespace fs = std::filesystem;

/// The wanted ones of a case, from another start where there is one.
std::vector<Identification> wanted_of(const Experiment& e, const std::vector<std::string>& only,
                                      const std::vector<double>& start) {
  std::vector<Identification> all = identifications(e);
  if (all.empty())
    throw InputError(
        fmt::format("{}: seeks nothing (allowed: a case with [[identify]], docs/keys.md)", e.file.string()));
  std::vector<std::string> names;
  for (const Identification& i : all) names.push_back(i.name);
  for (const std::string& name : only)
    if (std::ranges::find(names, name) == names.end())
      throw InputError(
          fmt::format("--only: '{}' is no [[identify]] of the case (allowed: {})", name, fmt::join(names, ", ")));
  if (!only.empty())
    std::erase_if(all, [&](const Identification& i) { return std::ranges::find(only, i.name) == only.end(); });
  for (Identification& i : all)
    for (std::size_t p = 0; !start.empty() && p < i.parameters.size(); ++p) {
      SoughtParameter& sought = i.parameters[p];
      if (start.size() != i.parameters.size() || !(start[p] >= sought.lower && start[p] <= sought.upper))
        throw InputError(
            fmt::format("--start: {} (allowed: {} of '{}', each within its bounds)", fmt::join(start, ","),
                        start.size() == i.parameters.size()
                            ? fmt::format("{} is to be from {:g} to {:g}", sought.name, sought.lower, sought.upper)
                            : fmt::format("{} numbers", i.parameters.size()),
                        i.name));
      sought.start = start[p];
    }
  return all;
}

/// `springproof identify CASE`.
class IdentifyCommand {
 public:
  void add_options(CLI::App& command);
  /// @return 0, or 1 if one has no result; 130 if interrupted.
  int run() const;

 private:
  std::string case_, out_ = "springproof-identify";
  std::vector<std::string> only_;
  std::vector<double> start_;
  int synthetic_ = 0;
  bool resume_ = false, json_ = false;
};

void IdentifyCommand::add_options(CLI::App& command) {
  command.add_option("CASE", case_, "case file (*.toml) or built-in name (springproof list), with [[identify]]")
      ->required();
  command.add_option("--only", only_, "only the [[identify]] of this name; several: --only A --only B");
  command.add_option("--start", start_, "from these numbers, one of each parameter (1e5,0.49)")->delimiter(',');
  command.add_option("--synthetic", synthetic_, "also fit so many sets of values that are made of the fit, with noise")
      ->check(CLI::Range(0, 10000));
  command.add_option("--out", out_, "folder for identify.json, identify.html and what has been run")
      ->capture_default_str();
  command.add_flag("--resume", resume_, "take what has been run from there");
  command.add_flag("--json", json_, "print JSON");
  command.footer("Exit status: 0 all have a result, 1 one has none, 2 the input is unusable, 130 interrupted.");
}

int IdentifyCommand::run() const {
  const Experiment e = read_experiment(find_case(case_));
  const std::vector<Identification> wanted = wanted_of(e, only_, start_);
  end_at_interrupts();
  const fs::path runs = fs::path(out_) / "runs";
  fs::create_directories(out_);
  const FolderLock lock(out_);
  if (!resume_) RunKeeper(runs, "", {}).forget();
  Status status(json_);
  std::vector<Identified> all;
  for (const Identification& sought : wanted) {
    const Status::Working working(status, fmt::format("{}, {}", e.name, sought.name));
    all.push_back(identify(e, sought, runs, synthetic_));
    if (children_interrupted()) return interrupted_status;
    if (!json_) to_stdout("{}", text_of(all.back()));
    std::fflush(stdout);
  }
  write_file(fs::path(out_) / "identify.json", json_text(all));
  write_file(fs::path(out_) / "identify.html", identify_page(all));
  if (json_) to_stdout("{}", json_text(all));
  return std::ranges::all_of(all, [](const Identified& i) { return i.ok; }) ? 0 : 1;
}

}  // namespace

RunCommand identify_command(CLI::App& parser) { return made<IdentifyCommand>(parser); }

}  // namespace springproof
