#include "comparisons/commands/calculix_command.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <fstream>

#include "comparisons/calculix/deck.h"
#include "comparisons/run/case_run.h"
#include "comparisons/run/find_cases.h"
#include "comparisons/run/prepare.h"
#include "comparisons/run/suite.h"
#include "meshes/mesher/mesher.h"

namespace springproof {
namespace {

Cells to_cells(const std::vector<int>& cells) {
  return cells.empty() ? Cells{0, 0, 0} : Cells{cells[0], cells[1], cells[2]};
}

std::filesystem::path one_case(const std::string& name) {
  const std::vector<std::filesystem::path> found = find_cases({name});
  if (found.size() > 1) throw InputError(fmt::format("{} is a folder of {} cases; name one", name, found.size()));
  return found.front();
}

}  // namespace

void ExportCommand::add_options(CLI::App& command) {
  command.add_option("CASE", case_, "case file (*.toml) or built-in name (springproof list)")->required();
  command.add_option("--to", to_, "calculix: a deck for CalculiX and Abaqus")
      ->required()
      ->check(CLI::IsMember({"calculix"}));
  command.add_option("--poisson-ratio", poisson_ratio_, "one of the case's (default: its first)");
  command.add_option("--cells", cells_, "elements along each side (default: the case's first resolution)")
      ->expected(3)
      ->check(CLI::Range(1, 1000));
  command.add_option("--out", out_, "file to write (default: NAME.inp here)");
}

int ExportCommand::run() const {
  const Experiment experiment = read_experiment(one_case(case_));
  calculix::require_counterpart(experiment);
  const IsotropicMaterial material = material_of(experiment, poisson_ratio_);
  const PreparedCase prepared = prepare(experiment);
  if (experiment.body.is_voxels() && !cells_.empty())
    throw InputError("--cells: is for bodies of hexahedra; the tetrahedra of this one have [reference] edge_m");
  const Cells cells = cells_.empty() && !experiment.body.is_voxels() ? experiment.body.cells.front() : to_cells(cells_);
  const Mesh mesh =
      experiment.body.is_voxels() ? *prepared.tetrahedra.back() : mesh_geo(prepared.geo, experiment.body.size, cells);
  const calculix::Deck deck = calculix::make_deck(experiment, material, mesh);
  const std::string file = out_.empty() ? experiment.name + ".inp" : out_;
  std::ofstream out(file);
  calculix::write(deck, out);
  out.close();
  if (!out) throw InputError(fmt::format("--out: cannot write {}", file));
  fmt::print("{}: {} nodes, {} elements {}, nu = {:g}\n", file, deck.mesh.nodes.rows(), deck.mesh.elements.size(),
             deck.element, material.poisson_ratio);
  return 0;
}

void CrossCheckCommand::add_options(CLI::App& command) {
  command.add_option("CASE", cases_, "case files (*.toml), folders of them, or built-in names (springproof list)")
      ->required();
  command.add_option("--poisson-ratio", options_.poisson_ratio, "one of the case's (default: all)");
  command
      .add_option("--cells", cells_,
                  "CalculiX' finest grid, divisible by 4 (default: about 1728 elements, 512 at finite strain)")
      ->expected(3)
      ->check(CLI::Range(4, 1000));
  command.add_option("--time-limit", options_.time_limit, "per run of ccx [s]")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  command.footer(
      "Exit status: 0 every quantity agrees within the two uncertainties, 1 one does not or has no answer, 2 "
      "the input is\n"
      "unusable, 3 ccx (apt-get install calculix-ccx) or springproof-fem is not here, 130 interrupted.");
}

int CrossCheckCommand::run() const {
  CrossCheckOptions options = options_;
  options.cells = to_cells(cells_);
  int worst = 0;
  for (const auto& file : find_cases(cases_)) {
    const int status = cross_check(file, options);
    if (status > some_differ) return status;
    worst = std::max(worst, status);
  }
  return worst;
}

}  // namespace springproof
