#include "comparisons/reference/vtu_output.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <map>
#include <memory>
#include <vector>

#include "comparisons/judge/stress_error.h"
#include "meshes/field.h"
#include "meshes/voxels/cells_apart.h"
#include "problem/files/file_name.h"

namespace springproof {

static std::string reference_name(const std::string& element, double poisson_ratio) {
  return fmt::format("reference_{}_nu{}.vtu", element, poisson_ratio);
}

std::string reference_file(const VtuOutput& vtu, const std::string& element, double poisson_ratio) {
  if (vtu.folder.empty()) return "";
  return std::filesystem::absolute(vtu.folder / reference_name(element, poisson_ratio)).string();
}

VtuNotes vtu_notes(const std::string& case_name, const RunKey& key, double youngs_modulus, bool single) {
  return {{{"case", case_name}, {"model", key.model}, {"cells", cells_text(key.cells)}},
          {{"poisson_ratio", key.poisson_ratio}, {"youngs_modulus_Pa", youngs_modulus}},
          single};
}

NodalFields stress_fields(const NodalStresses& stress) {
  return {{"stress", stress}, {"von_mises", invariants(stress).col(0)}};
}

void write_cells(const std::filesystem::path& file, const CutBody& cut, const NodalVectors& displacement,
                 const VtuNotes& notes, const NodalStresses& stress) {
  const auto mesh = std::make_shared<Mesh>();
  std::vector<double> filled, edge, material;
  for (const CutCell& cell : cut.cells) {
    filled.push_back(cell.filled.fraction);
    edge.push_back(cell.size * cut.grid.edge);
    material.push_back(cell.material);
  }
  CellsApart parts = apart(cut);
  mesh->hexahedra = std::move(parts.corners);
  mesh->nodes = cut.points(parts.node, Eigen::all);
  Field field;
  field.mesh = mesh;
  field.displacement = displacement(parts.node, Eigen::all);
  NodalFields extra;
  if (stress.rows() > 0) extra = stress_fields(stress);
  write_vtu(file, field, extra, notes, {{"filled_fraction", filled}, {"edge_m", edge}, {"material", material}});
}

void write_series(const CaseResult& result, const std::filesystem::path& folder) {
  std::map<std::string, std::map<double, std::string>> series;
  std::vector<RunKey> keys(result.runs.begin(), result.runs.end());
  const std::vector<double> settings = result.experiment.settings();
  for (const double setting : settings)
    for (const Cells& cells : result.cells) keys.push_back({"fem", setting, cells});
  for (const RunKey& key : keys) {
    const std::string file = file_stem(key) + ".vtu";
    if (std::filesystem::exists(folder / file))
      series[fmt::format("{}_{}", file_name(key.model), fmt::join(key.cells, "x"))][key.poisson_ratio] = file;
  }
  for (const std::string& element : result.experiment.reference.elements)
    for (const double setting : settings)
      if (const std::string file = reference_name(element, setting); std::filesystem::exists(folder / file))
        series["reference_" + element][setting] = file;
  for (const auto& [name, files] : series)
    if (files.size() > 1) write_pvd(folder / (name + ".pvd"), {files.begin(), files.end()});
}

}  // namespace springproof
