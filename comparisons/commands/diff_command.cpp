#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>

#include "comparisons/commands/commands.h"
#include "comparisons/judge/differences.h"
#include "problem/system/streams.h"

namespace springproof {
namespace {

constexpr std::size_t most_lines = 20;  // of the largest differences, and of runs without a partner

std::string times_uncertainty(const Difference& d) {
  return std::isnan(d.of_uncertainty) ? "" : fmt::format("{:.2g}", d.of_uncertainty);
}

/// Rows that have no partner, counted by case and model.
void print_lonely(const std::filesystem::path& folder, const std::vector<Row>& rows) {
  if (rows.empty()) return;
  std::map<std::string, int> counts;
  for (const Row& row : rows) ++counts[fmt::format("{}  nu {}  {}", row.case_name, row.poisson_ratio, row.model)];
  to_stdout("\n{} numbers are in {} alone:\n", rows.size(), folder.string());
  std::size_t printed = 0;
  for (const auto& [run, count] : counts)
    if (printed++ < most_lines) to_stdout("  {:<60} {}\n", run, count);
  if (printed > most_lines) to_stdout("  ... and of {} other runs\n", printed - most_lines);
}

void print_changed(const Differences& all) {
  if (all.changed.empty()) return;
  to_stdout("\n{:<26} {:>7} {:<12} {:<10} {:<32} {:>13} {:>13} {:<4} {:>8} {:>12}\n", "case", "nu", "model", "cells",
            "measure", "first", "second", "", "relative", "uncertainties");
  for (std::size_t i = 0; i < std::min(most_lines, all.changed.size()); ++i) {
    const Difference& d = all.changed[i];
    const std::string measure = d.what == "value" ? d.row.measure : fmt::format("{} ({})", d.row.measure, d.what);
    to_stdout("{:<26} {:>7} {:<12} {:<10} {:<32} {:>13.6g} {:>13.6g} {:<4} {:>8.1e} {:>12}\n", d.row.case_name,
              d.row.poisson_ratio, d.row.model, cells_text(d.row.cells), measure, d.first, d.second, d.row.unit,
              d.relative, times_uncertainty(d));
  }
  if (all.changed.size() > most_lines) to_stdout("... and {} more\n", all.changed.size() - most_lines);
}

/// `springproof diff FIRST SECOND`.
class DiffCommand {
 public:
  void add_options(CLI::App& command);
  /// @return 0: no number differs by more than the tolerance, and both have the same ones; 1: else.
  /// @throws InputError if a folder holds no results.
  int run() const;

 private:
  std::filesystem::path first_, second_;
  double tolerance_ = 1e-9;
};

void DiffCommand::add_options(CLI::App& command) {
  command.add_option("FIRST", first_, "what `springproof compare` wrote")->required();
  command.add_option("SECOND", second_, "the same of another run")->required();
  command.add_option("--tolerance", tolerance_, "relative difference up to which two numbers are the same")
      ->check(CLI::Range(0.0, 1.0))
      ->capture_default_str();
  command.footer(
      "Relative: to the larger of the two numbers or, for a component, of all components of that vector.\n"
      "Uncertainties: the difference divided by the uncertainty of the reference.\n"
      "Exit status: 0 the same numbers to the tolerance, 1 others, more or fewer, 2 the input is unusable.");
}

int DiffCommand::run() const {
  const ResultsFolder first = read_results(first_), second = read_results(second_);
  for (const auto& [folder, results] : {std::pair{&first_, &first}, std::pair{&second_, &second}})
    if (results->rows.empty())
      throw InputError(fmt::format("{}: holds no number (allowed: results of at least one run)", folder->string()));
  const Differences all = differences(first, second, tolerance_);
  for (const auto& [folder, results] : {std::pair{&first_, &first}, std::pair{&second_, &second}})
    to_stdout("{}: {} numbers, version {}, {}\n", folder->string(), results->rows.size(), results->version,
              results->generated);
  to_stdout(
      "{} numbers are in both; {} values, references and uncertainties of them differ by more than {:g}, the "
      "largest by {:.1e}\n",
      all.in_both, all.changed.size(), tolerance_, all.largest);
  const auto beyond = std::ranges::count_if(
      all.changed, [](const Difference& d) { return d.what != "reference_uncertainty" && d.of_uncertainty > 1; });
  if (!all.changed.empty()) to_stdout("{} of the differences exceed the uncertainty of the reference\n", beyond);
  print_changed(all);
  print_lonely(first_, all.only_first);
  print_lonely(second_, all.only_second);
  if (!all.none())
    for (const ResultsFolder* side : {&first, &second})
      for (const auto& [name, words] : side->listed) to_stdout("\nnu of {} is {}\n", name, words);
  return all.none() ? 0 : 1;
}

}  // namespace

RunCommand diff_command(CLI::App& parser) { return made<DiffCommand>(parser); }

}  // namespace springproof
