#include <fmt/format.h>
#include <fmt/ranges.h>

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "comparisons/sweep/find_cases.h"
#include "comparisons/sweep/folder_lock.h"
#include "comparisons/sweep/suite.h"
#include "comparisons/sweep/suite_results.h"
#include "comparisons/sweep/sweep.h"
#include "problem/system/streams.h"

namespace springproof {
namespace {

namespace fs = std::filesystem;

/// What is missing of a sweep: titles of parts, by shard.
using Missing = std::map<int, std::vector<std::string>>;

/// The part, or why it is not there.
struct Found {
  std::optional<Part> part;
  std::string why;
};

Found find_part(const fs::path& folder, const PlannedPart& planned) try {
  const fs::path file = folder / "parts" / planned.file;
  Found found{load_part(file, planned.stamp), ""};
  if (!found.part && fs::exists(file)) found.why = " (computed from other inputs)";
  return found;
} catch (const DamagedFile&) {
  return {{}, " (damaged)"};
}

/// The case with the parts that are there.  Poisson's ratios without are left out and said; a case without any part
/// keeps them, and has nothing that was compared.
CaseResult collect(const fs::path& folder, const Sweep& sweep, const PlannedCase& planned, Missing& missing) {
  CaseResult result;
  const bool meshed = load_meshed(folder, planned.key, result);
  std::vector<double> ratios, present;
  std::vector<std::string> absent;
  for (const PlannedPart& p : planned.parts) {
    ratios.push_back(p.poisson_ratio);
    Found found = find_part(folder, p);
    if (found.part && !meshed) found = {{}, fmt::format(" ({}.case.cbor is missing or damaged)", planned.key)};
    if (found.part) {
      append(*found.part, result);
      present.push_back(p.poisson_ratio);
    } else {
      missing[p.shard].push_back(title_of(planned, p) + found.why);
      absent.push_back(fmt::format("{}", p.poisson_ratio));
    }
  }
  result.experiment =
      finer(sweep.finer, only(present.empty() ? ratios : present, parse_experiment(planned.text, planned.file)));
  if (!absent.empty()) {
    const std::string note =
        fmt::format("Not computed: {} {}.", result.experiment.listed_words(), fmt::join(absent, ", "));
    result.notes.push_back(note);
    result.experiment.what += (result.experiment.what.empty() ? "" : " ") + note;
  }
  return result;
}

void say(const Missing& missing, const Sweep& sweep, const fs::path& folder) {
  for (const auto& [shard, titles] : missing)
    to_stderr("shard {}/{}{}: {} part{} missing: {}\n", shard, sweep.shards,
              is_locked(sweep_file(folder), shard) ? " (at work)" : "", titles.size(), titles.size() == 1 ? "" : "s",
              fmt::join(titles, ", "));
}

}  // namespace

int report_sweep(SuiteOptions options, bool partial) {
  const FolderLock lock(options.out, FolderLock::beside_shards);
  const Sweep sweep = read_plan(options.out);
  const ByteLock one_report(
      sweep_file(options.out), 0,
      fmt::format("{}: another springproof writes its report (wait for its end)", options.out.string()));
  Missing missing;
  std::vector<CaseResult> results;
  for (const PlannedCase& planned : sweep.cases) results.push_back(collect(options.out, sweep, planned, missing));
  say(missing, sweep, options.out);
  std::vector<int> shards;
  for (const auto& [shard, titles] : missing) shards.push_back(shard);
  if (!missing.empty() && !partial)
    throw InputError(
        fmt::format("{}: parts are missing (start shard{} {} again, or add --partial for a report of what "
                    "is there)",
                    options.out.string(), shards.size() == 1 ? "" : "s", fmt::join(shards, ",")));
  options.vtu = sweep.vtu;
  return write_results(std::move(results), sweep.libraries, options) && missing.empty() ? 0 : 1;
}

}  // namespace springproof
