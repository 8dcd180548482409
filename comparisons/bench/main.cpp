// springproof-bench, started by `springproof bench`: benchmarks on this machine, each with its baseline.
//
// A separate program because it may link PETSc, whose libraries would slow the start of springproof.

#include <CLI/CLI.hpp>
#include <csignal>
#include <nlohmann/json.hpp>

#include "comparisons/bench/benches.h"
#include "msm/kernels/instruction_set.h"
#include "problem/files/files.h"
#include "problem/processes/child.h"
#include "problem/processes/interrupts.h"
#include "problem/system/input_error.h"
#include "problem/system/streams.h"

namespace {

using namespace springproof;
using namespace springproof::bench;
using Json = nlohmann::json;

void add_options(CLI::App& app, Options& options) {
  app.add_option(
         "WHAT", options.what,
         "dynamics (steps, against LAMMPS and a plain loop), statics (equilibrium, against PETSc CG + GAMG and damped "
         "dynamics), fem (the finite element reference, against PETSc CG + GAMG and CalculiX), gpu (steps of lattices "
         "on the GPU against this processor), all of these")
      ->required()
      ->check(CLI::IsMember({"dynamics", "statics", "fem", "gpu", "all"}));
  app.add_option("--json", options.json, "write the figures to this file too");
  app.add_flag("--quick", options.quick, "small sizes: a look at the table in half a minute, no measurement");
  app.add_option("--threads", options.threads, "of the rows that compare several threads with one")
      ->check(CLI::Range(2, 256))
      ->capture_default_str();
  const auto pass_on = [&options](const char* option, const std::string& value) {
    options.fem_arguments.insert(options.fem_arguments.end(), {option, value});
  };
  app.add_option_function<int>(
         "--cells", [pass_on](int n) { pass_on("--bench-cells", std::to_string(n)); },
         "fem: cells along the side of the cube, a multiple of 8 (default 24)")
      ->check(CLI::Range(8, 96));
  app.add_flag_callback(
      "--no-baseline", [&options] { options.fem_arguments.push_back("--no-baseline"); },
      "fem: leave the assembled baseline out (some 3 GB at 24 cells)");
  app.footer(
      "Missed targets are printed as MISSED; they do not change the exit status.\n"
      "Exit status: 0 every row has a result, 1 one has not, 2 the input is unusable, 130 interrupted (what is "
      "measured is written).");
}

bool wants(const Options& options, const char* what) { return options.what == what || options.what == "all"; }

void measure(const Options& options, Machine& machine, Findings& findings, Json& fem) {
  if (wants(options, "statics")) bench_statics(options, findings);
  if (wants(options, "dynamics")) {
    to_stderr("limits of this machine ...\n");
    measure_limits(options.quick, machine);
    bench_dynamics(options, machine, findings);
  }
  if (wants(options, "fem")) fem = bench_fem(options, findings);
  if (wants(options, "gpu")) bench_gpu(options, findings);
}

int run(const Options& options) {
  for (const int signal : {SIGINT, SIGTERM}) std::signal(signal, [](int) { interrupt_children(); });
  Machine machine = this_machine();
  Findings findings;
  Json fem;
  try {
    measure(options, machine, findings, fem);
  } catch (const std::runtime_error&) {
    if (!children_interrupted()) throw;
    findings.remarks.push_back("interrupted: the rows are those measured before");
  }
  if (options.quick)
    findings.remarks.push_back("quick: small sizes and few samples; the targets are those of the full ones");
  Json document = to_json(findings);
  document["program"] = {
      {"version", SPRINGPROOF_VERSION}, {"instruction_set", name_of(instruction_set())}, {"quick", options.quick}};
  document["machine"] = to_json(machine);
  if (!fem.is_null()) document["fem"] = fem;
  to_stdout("{}", table_text(machine, findings));
  if (!options.json.empty())
    write_named_file(options.json, document.dump(1, ' ', false, Json::error_handler_t::replace));
  if (children_interrupted()) return interrupted_status;
  return complete(findings) ? 0 : 1;
}

int parse_and_run(int argc, char** argv) {
  CLI::App app{"What things cost on this machine: each row beside its baseline, measured in the same run.",
               "springproof bench"};
  Options options;
  add_options(app, options);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& e) {
    return app.exit(e) == 0 ? 0 : 2;
  }
  return run(options);
}

}  // namespace

int main(int argc, char** argv) {
  return springproof::run_as_program([&] { return parse_and_run(argc, argv); });
}
