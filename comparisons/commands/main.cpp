// springproof: compares mass-spring models of elastic solids with finite elements.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <csignal>
#include <cstdlib>
#include <filesystem>

#include "comparisons/commands/advise_command.h"
#include "comparisons/commands/calculix_command.h"
#include "comparisons/commands/describe.h"
#include "comparisons/commands/diff_command.h"
#include "comparisons/commands/export_command.h"
#include "comparisons/commands/frequencies_command.h"
#include "comparisons/commands/homogenise_command.h"
#include "comparisons/commands/material_command.h"
#include "comparisons/commands/pictures_command.h"
#include "comparisons/commands/report_command.h"
#include "comparisons/commands/reproduce_command.h"
#include "comparisons/commands/versions.h"
#include "comparisons/reproduce/figures.h"
#include "comparisons/run/find_cases.h"
#include "comparisons/run/suite.h"
#include "fem_reference/exchange/reference.h"
#include "msm/gpu/gpu.h"
#include "msm/parameters/made_of.h"
#include "msm/parameters/model_table.h"
#include "problem/case_file/experiment.h"
#include "problem/case_file/measures.h"
#include "problem/system/child.h"
#include "problem/system/streams.h"

namespace {

using namespace springproof;

/// Without names all that is built in, else the files of these cases.
int list(const std::vector<std::string>& names) {
  if (!names.empty()) {
    for (const auto& file : find_cases(names)) to_stdout("{}\n", file.string());
    return 0;
  }
  to_stdout("Cases (springproof compare NAME):\n");
  for (const auto& file : built_in_cases()) {
    to_stdout("  {:<38} {}\n", case_name(file), read_experiment(file).what);
  }
  to_stdout("\nModels ([compare] models = [...]):\n");
  for (const ModelRow& row : model_table()) to_stdout("  {:<15} {:<26} {}\n", row.name, made_of(row), row.what);
  to_stdout("\nMeasures ([compare] measures = [...]):\n");
  for (const Measure& measure : measure_table()) to_stdout("  {:<28}{}\n", measure.name, measure.what);
  return 0;
}

/// The built live page.
std::filesystem::path live_page() {
  const std::filesystem::path page = data_folder("live", SPRINGPROOF_LIVE_DIR) / "live.html";
  if (!std::filesystem::exists(page))
    throw InputError(
        fmt::format("--live: the live page is not built, {} is not there (in the sources: "
                    "comparisons/live/build.sh, which needs Debian's packages emscripten and node-acorn)",
                    page.string()));
  return page;
}

int run_bench(const std::vector<std::string>& arguments) {
  const std::filesystem::path program = find_program("springproof-bench", "SPRINGPROOF_BENCH_PROGRAM");
  if (program.empty())
    throw std::runtime_error(
        "the program springproof-bench is neither beside this one nor named by SPRINGPROOF_BENCH_PROGRAM");
  std::signal(SIGINT, [](int) { interrupt_children(); });
  std::signal(SIGTERM, [](int) { interrupt_children(); });
  const ChildEnd end = run_child({program, arguments, {}, {}, {}});
  if (end.kind == ChildEnd::killed) throw std::runtime_error("springproof-bench " + words_for(end));
  return end.status;
}

int describe(const CLI::App& app, const std::string& form) {
  std::vector<std::string> cases, models, paper_names;
  for (const Paper& paper : papers()) paper_names.push_back(paper.name);
  for (const auto& file : built_in_cases()) cases.push_back(case_name(file));
  for (const ModelRow& row : model_table()) models.push_back(row.name);
  to_stdout("{}", form == "man" ? man_page(app, SPRINGPROOF_VERSION)
                                : bash_completion(app, {{"CASE", cases}, {"--model", models}, {"PAPER", paper_names}}));
  return 0;
}

int parse_and_run(int argc, char** argv) {
  CLI::App app{"Mass-spring models of elastic solids, proved against finite elements.", "springproof"};
  app.require_subcommand(1);
  app.set_version_flag("--version", versions);

  std::vector<std::string> names;
  SuiteOptions options;
  CLI::App* compare_command = app.add_subcommand(
      "compare", "Run cases with every model and the FEM reference; write results.csv, results.json and report.html");
  compare_command
      ->add_option("CASE", names, "case files (*.toml), folders of them, or built-in names (springproof list)")
      ->required();
  CLI::Option* out = compare_command->add_option("--out", options.out, "folder for the results")->capture_default_str();
  compare_command->add_option("--jobs", options.jobs, "parts to run at once (0: one per core)");
  compare_command
      ->add_option("--poisson-ratio", options.poisson_ratios, "only these of the cases' Poisson's ratios (0.25,0.49)")
      ->delimiter(',')
      ->take_all();
  compare_command
      ->add_option("--finer", options.finer,
                   "reference grids with so many times the cells along each direction (known values for a calibration)")
      ->check(CLI::Range(1, 16));
  compare_command->add_flag("--resume", options.resume, "keep what an interrupted run finished");
  compare_command->add_flag("--quiet", options.quiet, "say nothing of what is under way");
  compare_command->add_flag("--verbose", options.verbose,
                            "also print a sentence on every model, and how far each case deforms");
  CLI::Option* live = compare_command->add_flag_callback(
      "--live", [&] { options.live_page = live_page(); },
      "also copy the page in which the bodies can be pulled (live.html) beside the report, with a link");
  compare_command
      ->add_option_function<std::string>(
          "--shard", [&](const std::string& text) { options.shard = parse_shard(text); },
          "only the K-th of N shares of the parts, K/N, into a folder that all shards share; then: springproof report")
      ->needs(out)
      ->excludes(live);
  compare_command->add_flag("--vtu,!--no-vtu", options.vtu, "also write a VTU file of every run, for ParaView");
  compare_command->add_flag("--vtu-single", options.vtu_single, "VTU files in single precision, half the size")
      ->needs("--vtu");
  compare_command->footer(
      "Exit status: 0 every expectation holds, 1 one does not or cannot be judged, or a reference or every run failed, "
      "or nothing was compared, 2 the input is unusable, 130 interrupted; with --shard 0 its parts are there.");

  ReportCommand sweep_report;
  CLI::App* report_command = app.add_subcommand(
      "report",
      "The results of a comparison whose parts were computed by shards: compare --shard, on several machines");
  sweep_report.add_options(*report_command, live_page);

  CLI::App* list_command =
      app.add_subcommand("list", "Built-in cases, models and measures; of cases named: their files");
  list_command->add_option("CASE", names, "built-in cases or folders, whose files are listed");

  MaterialCommand material;
  CLI::App* material_command = app.add_subcommand(
      "material",
      "Any two moduli in: spring constants, kappa, safe time step, validity range, and the moduli measured back");
  material.add_options(*material_command);

  HomogeniseCommand homogenisation;
  CLI::App* homogenise_command = app.add_subcommand("homogenise",
                                                    "Effective moduli of the infinite periodic network of a model: "
                                                    "stiffness, anisotropy, mean and spread over seeds");
  homogenisation.add_options(*homogenise_command);

  ExportCommand export_case;
  CLI::App* export_command = app.add_subcommand(
      "export", "A case, or a body alone, for another program: the springs of its body, or an input deck");
  export_case.add_options(*export_command);

  CrossCheckCommand second_opinion;
  CLI::App* cross_check_command =
      app.add_subcommand("cross-check", "The same case by CalculiX and by our FEM reference, with both uncertainties");
  second_opinion.add_options(*cross_check_command);

  FrequenciesCommand frequencies;
  CLI::App* frequencies_command = app.add_subcommand(
      "frequencies", "Natural frequencies and modes of a case's models beside the finite element reference's");
  frequencies.add_options(*frequencies_command);

  PicturesCommand pictures;
  CLI::App* pictures_command =
      app.add_subcommand("pictures", "The figures and bodies of a report as PNG files, without a display");
  pictures.add_options(*pictures_command);

  ReproduceCommand reproduction;
  CLI::App* reproduce_command = app.add_subcommand(
      "reproduce",
      "The figures and tables of a paper, computed and drawn anew, each with a verdict: SVG, PDF, CSV, a page");
  reproduction.add_options(*reproduce_command);

  DiffCommand diff;
  CLI::App* diff_command =
      app.add_subcommand("diff", "Which numbers of two results folders differ, by how much, beyond which uncertainty");
  diff.add_options(*diff_command);

  CLI::App* bench_command =
      app.add_subcommand("bench", "Measure what things cost, each beside its baseline (springproof bench --help)");
  bench_command->set_help_flag();
  bench_command->prefix_command();  // its options are parsed by the program that it starts

  AdviseCommand advice;
  CLI::App* advise_command = app.add_subcommand(
      "advise",
      "Which models and resolutions reach an error within a budget, predicted from coarse solves of the case");
  advice.add_options(*advise_command);

  std::string form;
  CLI::App* describe_command =
      app.add_subcommand("describe", "The command line as a man page, or as completion for bash")->group("");
  describe_command->add_option("FORM", form)->required()->check(CLI::IsMember({"man", "bash"}));

  for (CLI::App* command : {advise_command, compare_command, export_command, cross_check_command, frequencies_command})
    command->add_flag_callback(
        "--no-scripts", [] { setenv("SPRINGPROOF_NO_SCRIPTS", "1", 1); },
        "refuse .geo scripts other than the built-in ones: a script can run any command");

  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& e) {
    return app.exit(e) == 0 ? 0 : 2;
  }
  if (*list_command) return list(names);
  if (*describe_command) return describe(app, form);
  springproof::gpu::wants_gpu();  // refuses what cannot be had before anything runs
  if (*compare_command) return compare(find_cases(names), options);
  if (*report_command) return sweep_report.run();
  if (*bench_command) return run_bench(bench_command->remaining());
  if (*homogenise_command) return homogenisation.run();
  if (*export_command) return export_case.run();
  if (*frequencies_command) return frequencies.run();
  if (*pictures_command) return pictures.run();
  if (*advise_command) return advice.run();
  if (*diff_command) return diff.run();
  if (*reproduce_command) return reproduction.run();
  if (*cross_check_command) return second_opinion.run();
  return material.run();
}

}  // namespace

int main(int argc, char** argv) {
  return run_as_program([&] { return parse_and_run(argc, argv); });
}
