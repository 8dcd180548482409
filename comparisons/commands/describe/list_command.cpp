#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "comparisons/commands/commands.h"
#include "comparisons/run/expected_runs.h"
#include "comparisons/sweep/find_cases.h"
#include "comparisons/sweep/status.h"
#include "msm/parameters/model_options.h"
#include "msm/parameters/model_table.h"
#include "problem/case_file/experiment.h"
#include "problem/case_file/measures.h"
#include "problem/system/streams.h"

namespace springproof {
namespace {

using Files = std::vector<std::filesystem::path>;

/// Folders of the built-in cases; one without a row here has no words.
constexpr std::pair<const char*, const char*> folders[] = {
    {"bodies", "bodies that are no blocks: cut cells beside finite elements"},
    {"boxes", "blocks of cells that are longer than wide"},
    {"calibration", "does the reference's uncertainty hold? beside exact solutions"},
    {"cost", "error against time, springs and elements on the same cells"},
    {"cross_check", "laws that CalculiX has too: springproof cross-check"},
    {"golec_2019", "the experiments of Golec et al. (2019)"},
    {"kot_2014", "those of Kot et al. (2014)"},
    {"kot_2015", "those of Kot and Nagahashi (2015)"},
    {"large_strain", "strains of a fifth and more"},
    {"measured", "bodies beside what was measured of them"},
    {"motion", "in time: swings, waves, falls"},
    {"verification", "benchmarks with a known solution: Lame, MacNeal and Harder, Cook, fields"},
};

/// "golec_2019" of "golec_2019/tables/table2"
std::string folder_of(const std::string& name) { return name.substr(0, name.find('/')); }

/// About how long a comparison takes, two parts at once: "40 s".
std::string time_of(const Experiment& e) {
  double sum = 0, longest = 0;
  for (std::size_t s = 0; s < e.settings().size(); ++s) {
    const double part = unmeshed_seconds(e, e.body_material(s));
    sum += part;
    longest = std::max(longest, part);
  }
  return time_words(std::max({1.0, longest, sum / 2}));
}

void list_cases(const Files& files) {
  std::string folder;
  for (const auto& file : files) {
    const std::string name = case_name(file);
    if (folder_of(name) != folder && name.find('/') != std::string::npos) {
      folder = folder_of(name);
      const auto* row =
          std::find_if(std::begin(folders), std::end(folders), [&](const auto& f) { return f.first == folder; });
      to_stdout("{}/{}{}\n", folder, row == std::end(folders) ? "" : "  ", row == std::end(folders) ? "" : row->second);
    }
    const Experiment e = read_experiment(file);
    to_stdout("  {:<46} {:>7}  {}\n", name, time_of(e), e.what);
  }
}

void list_models() {
  for (const ModelRow& row : model_table()) to_stdout("  {:<15} {:<26} {}\n", row.name, made_of(row), row.what);
}

void list_measures() {
  for (const Measure& measure : measure_table()) to_stdout("  {:<28}{}\n", measure.name, measure.what);
}

/// `springproof list [models | measures | CASE...]`.
class ListCommand {
 public:
  void add_options(CLI::App& command);
  /// Without names all that is built in; "models", "measures"; of a folder its cases; of a case its file.
  int run() const;

 private:
  std::vector<std::string> names_;
};

void ListCommand::add_options(CLI::App& command) {
  command.add_option("WHAT", names_, "models; measures; a folder of cases; a case, whose file is named (default: all)");
}

int ListCommand::run() const {
  for (const std::string& name : names_) {
    if (name == "models") {
      list_models();
    } else if (name == "measures") {
      list_measures();
    } else if (const Files files = find_cases({name}); files.size() > 1) {
      list_cases(files);
    } else {
      to_stdout("{}\n", files.front().string());
    }
  }
  if (!names_.empty()) return 0;
  to_stdout(
      "Begin here: springproof compare golec_2019/compression    (a cube, every model beside finite elements, "
      "seconds)\n"
      "Of your own body: springproof new BODY.stl > case.toml\n\n"
      "Cases (springproof compare NAME, or FOLDER), and about how long on two cores:\n");
  list_cases(built_in_cases());
  to_stdout("\nModels ([compare] models = [...]):\n");
  list_models();
  to_stdout("\nMeasures ([compare] measures = [...]):\n");
  list_measures();
  return 0;
}

}  // namespace

RunCommand list_command(CLI::App& parser) { return made<ListCommand>(parser); }

}  // namespace springproof
