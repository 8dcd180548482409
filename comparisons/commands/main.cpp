// springproof: compares mass-spring models of elastic solids with finite elements.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdlib>
#include <vector>

#include "comparisons/commands/commands.h"
#include "msm/gpu/gpu.h"
#include "problem/system/streams.h"

namespace {

using namespace springproof;

enum class Reads { nothing, options, bodies };  ///< of bodies some are scripts

struct Subcommand {
  const char* name;
  const char* what;
  RunCommand (*make)(CLI::App&);
  Reads reads = Reads::options;
};

constexpr Subcommand subcommands[] = {
    {"compare", "Run cases with every model and the FEM reference; write results.csv, results.json and report.html",
     compare_command, Reads::bodies},
    {"report", "The results of a comparison whose parts were computed by shards: compare --shard, on several machines",
     report_command},
    {"list", "Built-in cases, models and measures; of cases named: their files", list_command, Reads::nothing},
    {"new", "A case of a body of your own, ready to run: its size, sides, resolutions, loads of 1 % strain",
     new_command, Reads::bodies},
    {"material",
     "Any two moduli in: spring constants, kappa, safe time step, validity range, and the moduli measured back",
     material_command},
    {"homogenise",
     "Effective moduli of the infinite periodic network of a model: "
     "stiffness, anisotropy, mean and spread over seeds",
     homogenise_command},
    {"export", "A case, or a body alone, for another program: the springs of its body, or an input deck",
     export_command, Reads::bodies},
    {"cross-check", "The same case by CalculiX and by our FEM reference, with both uncertainties", cross_check_command,
     Reads::bodies},
    {"frequencies", "Natural frequencies and modes of a case's models beside the finite element reference's",
     frequencies_command, Reads::bodies},
    {"identify", "Numbers of a case, such as moduli and densities, from what was measured; what it does not tell",
     identify_command, Reads::bodies},
    {"pictures", "The figures and bodies of a report as PNG files, without a display", pictures_command},
    {"reproduce",
     "The figures and tables of a paper, computed and drawn anew, each with a verdict: SVG, PDF, CSV, a page",
     reproduce_command},
    {"diff", "Which numbers of two results folders differ, by how much, beyond which uncertainty", diff_command},
    {"bench", "Measure what things cost, each beside its baseline (springproof bench --help)", bench_command},
    {"advise", "Which models and resolutions reach an error within a budget, predicted from coarse solves of the case",
     advise_command, Reads::bodies},
    {"describe", "The command line as a man page, or as completion for bash; the keys of a case file", describe_command,
     Reads::nothing},
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
    RunCommand run;
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
  const auto asked = std::ranges::find_if(commands, [](const Ready& r) { return r.command->parsed(); });
  if (asked->reads != Reads::nothing) gpu::wants_gpu();  // refuses what cannot be had before anything runs
  return asked->run();
}

}  // namespace

int main(int argc, char** argv) {
  return run_as_program([&] { return parse_and_run(argc, argv); });
}
