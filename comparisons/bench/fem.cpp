#include "comparisons/bench/fem.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "comparisons/bench/interrupt.h"
#include "fem_reference/exchange/reference.h"
#include "problem/system/child.h"

namespace springproof::bench {
namespace {

using Json = nlohmann::json;

Target target_of(const Json& figures, const std::string& what) {
  const Json targets = figures.value("targets", Json::object());
  if (!targets.contains(what)) return {};
  const Json& t = targets.at(what);
  return t.contains("at_least") ? at_least(t.at("at_least")) : at_most(t.at("at_most"));
}

BenchRow run_row(const Json& run) {
  BenchRow row{"fem", run.at("name"), fmt::format("{}^3", run.at("cells").get<int>()), "CPU s", run.at("cpu_seconds")};
  row.ok = run.at("ok");
  row.note = fmt::format("{}, nu = {:g}, {} unknowns, {} iterations, {:.0f} MiB", run.at("form").get<std::string>(),
                         run.at("poisson_ratio").get<double>(), run.at("unknowns").get<long>(),
                         run.at("iterations").get<int>(), run.at("memory_MiB").get<double>());
  return row;
}

}  // namespace

Json bench_fem(const BenchOptions& options, Findings& findings) {
  if (!fem::available()) {
    findings.remarks.push_back(
        "springproof-fem is neither beside this program nor named by SPRINGPROOF_FEM_PROGRAM: no rows of the "
        "reference");
    return nullptr;
  }
  const TemporaryFolder folder;
  std::vector<std::string> arguments = {"--bench", "--json", (folder.path / "fem.json").string()};
  if (options.quick) arguments.insert(arguments.end(), {"--bench-cells", "8"});
  arguments.insert(arguments.end(), options.fem_arguments.begin(), options.fem_arguments.end());
  const int status = fem::run_program(arguments);
  throw_if_interrupted();
  if (status != 0) throw std::runtime_error(fmt::format("springproof-fem --bench ended with {}", status));
  const Json figures = Json::parse(text_of_file(folder.path / "fem.json"));
  for (const Json& run : figures.at("rows")) findings.rows.push_back(run_row(run));
  for (const auto& [what, value] : figures.at("ratios").items())
    findings.rows.push_back({"fem", what, "", "ratio", value.get<double>(), "", 0, target_of(figures, what)});
  return figures;
}

}  // namespace springproof::bench
