#include "comparisons/bench/experiments.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "comparisons/bench/interrupt.h"
#include "comparisons/bench/timer.h"
#include "problem/system/child.h"
#include "problem/system/streams.h"

namespace springproof::bench {
namespace {

using Json = nlohmann::json;
namespace fs = std::filesystem;

struct Solvers {
  double springs = 0, finite_elements = 0;  ///< CPU [s]
  int runs = 0;
};

Solvers solver_times(const Json& results) {
  Solvers s;
  for (const Json& result : results.at("cases"))
    for (const Json& run : result.at("runs")) {
      (run.at("kind") == "msm" ? s.springs : s.finite_elements) += run.at("seconds").get<double>();
      ++s.runs;
    }
  return s;
}

void run_case(const fs::path& springproof, const std::string& name, Findings& findings) {
  to_stderr("experiments: {} ...\n", name);
  const TemporaryFolder folder;
  const double start = seconds_of(Clock::wall);
  const ChildEnd end = run_child({springproof,
                                  {"compare", name, "--jobs", "1", "--out", (folder.path / "report").string()},
                                  {},
                                  folder.path / "output",
                                  folder.path / "errors"});
  const double wall = seconds_of(Clock::wall) - start;
  throw_if_interrupted();
  const std::string text = text_of_file(folder.path / "report" / "results.json");
  BenchRow row{"experiments", name, "whole", "wall s", wall};
  if (end.kind != ChildEnd::exited || end.status > 1 || text.empty()) {
    row.ok = false;
    row.note = trimmed(text_of_file(folder.path / "errors"));
    findings.rows.push_back(row);
    return;
  }
  const Solvers solvers = solver_times(Json::parse(text));
  row.note =
      fmt::format("{} runs, one at a time{}", solvers.runs, end.status == 0 ? "" : "; an expectation does not hold");
  findings.rows.push_back(row);
  const auto add = [&](const char* stage, double seconds) {
    findings.rows.push_back({"experiments", name, stage, "CPU s", seconds});
  };
  add("all", end.seconds);
  add("springs", solvers.springs);
  add("finite elements", solvers.finite_elements);
  add("the rest: meshes, set-up, measures, report", end.seconds - solvers.springs - solvers.finite_elements);
}

}  // namespace

void bench_experiments(const BenchOptions& options, Findings& findings) {
  const fs::path springproof = find_program("springproof", "SPRINGPROOF_PROGRAM");
  if (springproof.empty())
    return findings.remarks.push_back(
        "springproof is neither beside this program nor named by SPRINGPROOF_PROGRAM: no experiments");
  std::vector<std::string> names = {"golec_2019/compression", "golec_2019/tension", "golec_2019/shear",
                                    "golec_2019/bending",     "golec_2019/torsion", "kot_2014/fig_13",
                                    "kot_2015/fig_7_surface", "bodies/rabbit"};
  if (options.quick) names = {"kot_2014/fig_13"};
  for (const std::string& name : names) run_case(springproof, name, findings);
}

}  // namespace springproof::bench
