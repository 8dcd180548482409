// springproof: compares mass-spring models of elastic solids with finite elements.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdlib>
#include <functional>
#include <memory>
#include <vector>

#include "comparisons/commands/advise_command.h"
#include "comparisons/commands/bench_command.h"
#include "comparisons/commands/calculix_command.h"
#include "comparisons/commands/compare_command.h"
#include "comparisons/commands/describe/describe_command.h"
#include "comparisons/commands/describe/list_command.h"
#include "comparisons/commands/describe/versions.h"
#include "comparisons/commands/diff_command.h"
#include "comparisons/commands/export/export_command.h"
#include "comparisons/commands/frequencies_command.h"
#include "comparisons/commands/identify_command.h"
#include "comparisons/commands/material/homogenise_command.h"
#include "comparisons/commands/material/material_command.h"
#include "comparisons/commands/new_command.h"
#include "comparisons/commands/pictures_command.h"
#include "comparisons/commands/report_command.h"
#include "comparisons/commands/reproduce_command.h"
#include "msm/gpu/gpu.h"
#include "problem/system/streams.h"

namespace {

using namespace springproof;

/// What runs a subcommand once its options, which are added to the parser, have been read.
template <class Command>
std::function<int()> made(CLI::App& command) {
  const auto object = std::make_shared<Command>();
  object->add_options(command);
  return [object] { return object->run(); };
}

enum class Reads { nothing, options, bodies };  ///< of bodies some are scripts

struct Subcommand {
  const char* name;
  const char* what;
  std::function<int()> (*make)(CLI::App&);
  Reads reads = Reads::options;
};

constexpr Subcommand subcommands[] = {
    {"compare", "Run cases with every model and the FEM reference; write results.csv, results.json and report.html",
     made<CompareCommand>, Reads::bodies},
    {"report", "The results of a comparison whose parts were computed by shards: compare --shard, on several machines",
     made<ReportCommand>},
    {"list", "Built-in cases, models and measures; of cases named: their files", made<ListCommand>, Reads::nothing},
    {"new", "A case of a body of your own, ready to run: its size, sides, resolutions, loads of 1 % strain",
     made<NewCommand>, Reads::bodies},
    {"material",
     "Any two moduli in: spring constants, kappa, safe time step, validity range, and the moduli measured back",
     made<MaterialCommand>},
    {"homogenise",
     "Effective moduli of the infinite periodic network of a model: "
     "stiffness, anisotropy, mean and spread over seeds",
     made<HomogeniseCommand>},
    {"export", "A case, or a body alone, for another program: the springs of its body, or an input deck",
     made<ExportCommand>, Reads::bodies},
    {"cross-check", "The same case by CalculiX and by our FEM reference, with both uncertainties",
     made<CrossCheckCommand>, Reads::bodies},
    {"frequencies", "Natural frequencies and modes of a case's models beside the finite element reference's",
     made<FrequenciesCommand>, Reads::bodies},
    {"identify", "Numbers of a case, such as moduli and densities, from what was measured; what it does not tell",
     made<IdentifyCommand>, Reads::bodies},
    {"pictures", "The figures and bodies of a report as PNG files, without a display", made<PicturesCommand>},
    {"reproduce",
     "The figures and tables of a paper, computed and drawn anew, each with a verdict: SVG, PDF, CSV, a page",
     made<ReproduceCommand>},
    {"diff", "Which numbers of two results folders differ, by how much, beyond which uncertainty", made<DiffCommand>},
    {"bench", "Measure what things cost, each beside its baseline (springproof bench --help)", made<BenchCommand>},
    {"advise", "Which models and resolutions reach an error within a budget, predicted from coarse solves of the case",
     made<AdviseCommand>, Reads::bodies},
    {"describe", "The command line as a man page, or as completion for bash; the keys of a case file",
     made<DescribeCommand>, Reads::nothing},
};

constexpr const char* tasks =
    R"(Mass-spring models of elastic solids, proved against finite elements.

Springs of my body:        springproof export body.stl --scale 0.001 -E 5e3 --nu 0.45 --hold bottom --to springs --out body.json
Is my case right?          springproof new body.stl --scale 0.001 > case.toml
                           springproof compare case.toml
My model beside yours:     [[external]] in case.toml, or models = {"mine": f} in Python (docs/python.md)

What is built in:          springproof list
Every command and option:  springproof --help, springproof COMMAND --help
)";

int parse_and_run(int argc, char** argv) {
  CLI::App app{"Mass-spring models of elastic solids, proved against finite elements.", "springproof"};
  app.require_subcommand(0, 1);
  app.set_version_flag("--version", versions);
  struct Ready {
    CLI::App* command;
    Reads reads;
    std::function<int()> run;
  };
  std::vector<Ready> commands;
  for (const Subcommand& s : subcommands) {
    CLI::App* command = app.add_subcommand(s.name, s.what);
    commands.push_back({command, s.reads, s.make(*command)});
    if (s.reads == Reads::bodies)
      command->add_flag_callback(
          "--no-scripts", [] { setenv("SPRINGPROOF_NO_SCRIPTS", "1", 1); },
          "refuse .geo scripts other than the built-in ones: a script can run any command");
  }
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& e) {
    return app.exit(e) == 0 ? 0 : 2;
  }
  if (app.get_subcommands().empty()) {
    to_stdout("{}", tasks);
    return 0;
  }
  const auto asked = std::find_if(commands.begin(), commands.end(), [](const Ready& r) { return r.command->parsed(); });
  if (asked->reads != Reads::nothing) gpu::wants_gpu();  // refuses what cannot be had before anything runs
  return asked->run();
}

}  // namespace

int main(int argc, char** argv) {
  return run_as_program([&] { return parse_and_run(argc, argv); });
}
