#include "comparisons/commands/describe/list_command.h"

#include <CLI/CLI.hpp>

#include "comparisons/sweep/find_cases.h"
#include "msm/parameters/made_of.h"
#include "msm/parameters/model_table.h"
#include "problem/case_file/experiment.h"
#include "problem/case_file/measures.h"
#include "problem/system/streams.h"

namespace springproof {

void ListCommand::add_options(CLI::App& command) {
  command.add_option("CASE", names_, "built-in cases or folders, whose files are listed");
}

int ListCommand::run() const {
  if (!names_.empty()) {
    for (const auto& file : find_cases(names_)) to_stdout("{}\n", file.string());
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

}  // namespace springproof
