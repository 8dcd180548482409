#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "comparisons/commands/commands.h"
#include "comparisons/reproduce/reproduce.h"
#include "comparisons/sweep/find_cases.h"
#include "comparisons/sweep/suite.h"
#include "problem/system/input_error.h"
#include "problem/system/streams.h"

namespace springproof {
namespace {

/// The cases of the figures, each once.
std::vector<std::string> cases_of(const std::vector<PaperFigure>& figures) {
  std::vector<std::string> all;
  for (const PaperFigure& figure : figures)
    for (const std::string& name : figure.cases)
      if (std::ranges::find(all, name) == all.end()) all.push_back(name);
  return all;
}

std::string names_of_papers() {
  std::string names;
  for (const Paper& paper : papers()) names += (names.empty() ? "" : ", ") + paper.name;
  return names;
}

/// `springproof reproduce PAPER`.
class ReproduceCommand {
 public:
  void add_options(CLI::App& command);

  /// @return as `springproof compare`; with --from 0.
  /// @throws InputError if there is no such paper or figure, or --from holds results of none of its figures.
  int run();

 private:
  std::string paper_;
  std::vector<std::string> figures_;
  std::vector<std::filesystem::path> from_;
  SuiteOptions options_;
};

void ReproduceCommand::add_options(CLI::App& command) {
  options_.out.clear();
  command.add_option("PAPER", paper_, names_of_papers())->required();
  command.add_option("--figure", figures_, "only these figures and tables: 13, table2, sec6.2 (3,4,table2)")
      ->delimiter(',')
      ->take_all();
  command.add_option("--out", options_.out,
                     "folder for the figures, and for the results of the cases (default: PAPER-redone)");
  command.add_option("--from", from_, "results folders of the cases; nothing is computed")->take_all();
  command.add_option("--jobs", options_.jobs, "parts to run at once (0: one per core)");
  command.add_flag("--resume", options_.resume, "keep what an interrupted run finished");
  command.add_flag("--quiet", options_.quiet, "say nothing of what is under way");
  command.footer(
      "Runs the paper's cases as `springproof compare` does, and writes OUT/reproduce.html and, of each figure,\n"
      "OUT/figures/NAME.svg, .csv (a column per curve) and, where rsvg-convert is installed (librsvg2-bin), .pdf.\n"
      "docs/measured/reproducing.md lists them. On one core golec_2019 takes five minutes, kot_2014 three, kot_2015\n"
      "thirteen.\n"
      "Exit status: that of `springproof compare`: 0 every expectation of the cases holds, 1 one does not, 2 the "
      "input\n"
      "is unusable, 130 interrupted (--resume goes on). A figure that differs from the paper is no error.");
}

int ReproduceCommand::run() {
  const Paper& paper = paper_named(paper_);
  const std::vector<PaperFigure> figures = figures_named(paper, figures_);
  const std::vector<std::string> cases = cases_of(figures);
  if (options_.out.empty()) options_.out = paper.name + "-redone";
  int status = 0;
  if (from_.empty()) {
    if (!cases.empty()) status = compare(find_cases(cases), options_);
    if (status == 130) return status;
    if (!cases.empty()) from_ = {options_.out};
  }
  const PaperResults results(from_);
  if (!cases.empty() && std::ranges::none_of(cases, [&](const std::string& name) { return results.has(name); }))
    throw InputError(fmt::format("--from: holds results of none of the cases of these figures (wanted: {})",
                                 fmt::join(cases, ", ")));
  std::vector<DrawnFigure> drawn;
  for (const PaperFigure& figure : figures) drawn.push_back(draw_figure(results, figure));
  const bool pdfs = write_figures(drawn, paper, options_.out);
  to_stdout("\n{}", verdict_table(drawn));
  if (!pdfs) to_stdout("note: no PDF: rsvg-convert is not installed (Debian: sudo apt-get install librsvg2-bin)\n");
  to_stdout("figures: {}\n", (options_.out / "reproduce.html").string());
  return status;
}

}  // namespace

RunCommand reproduce_command(CLI::App& parser) { return made<ReproduceCommand>(parser); }

}  // namespace springproof
