// The springs of a case or of a body alone, for every format that has springs.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "comparisons/calculix/cross_check.h"
#include "comparisons/commands/export/export_request.h"
#include "comparisons/prepare/case_checks.h"
#include "comparisons/prepare/springs_of_case.h"
#include "comparisons/run/prepare.h"
#include "comparisons/sweep/find_cases.h"
#include "comparisons/sweep/status.h"
#include "meshes/mesher/mesher.h"
#include "meshes/mesher/mesher_exchange.h"
#include "msm/models.h"
#include "msm/topology/cubic_lattice.h"
#include "problem/case_file/experiment.h"
#include "problem/system/nearest_name.h"

namespace springproof {
namespace {

/// The model of the case with this label, or a row of the table; by default the case's first.
ModelChoice chosen_model(const Experiment& e, const std::string& name) {
  std::vector<std::string> known;
  for (const ModelChoice& m : e.models) known.push_back(m.label);
  const auto at = std::ranges::find(known, name);
  if (at != known.end()) return e.models[static_cast<std::size_t>(at - known.begin())];
  if (name.empty() && !e.models.empty()) return e.models.front();
  for (const ModelRow& row : model_table()) {
    if (row.name == name) return named_model(name);
    if (std::ranges::find(known, row.name) == known.end()) known.push_back(row.name);
  }
  throw InputError(fmt::format("--model: unknown model '{}' (allowed: {}){}", name, fmt::join(known, ", "),
                               did_you_mean(name, known)));
}

/// The case with one material, one model and one resolution, without what is computed of it.
Experiment one_of_each(Experiment e, const ExportRequest& request) {
  if (request.moduli.youngs_modulus || request.scale != 1 || !request.size.empty() || !request.hold.empty() ||
      !request.load.empty())
    throw InputError(
        fmt::format("{}: a case has its own material, patches and size (allowed: --poisson-ratio, --model, --cells, "
                    "--voxels)",
                    request.what));
  e = at_wanted(e, request.moduli.poisson_ratio);
  std::erase_if(e.models, is_external);
  e.models = {chosen_model(e, request.model)};
  if (!e.body.cells.empty()) e.body.cells.resize(1);
  if (e.body.voxel_edges.size() > 1) e.body.voxel_edges.resize(1);
  if (e.body.voxel_counts.size() > 1) e.body.voxel_counts.resize(1);
  if (e.body.accuracies.size() > 1) e.body.accuracies.resize(1);
  if (request.voxels) {
    e.body.accuracies.clear();
    if (!e.body.is_voxels()) throw InputError("--voxels: is for bodies of voxels; this one has --cells NX NY NZ");
    e.body.voxel_edges.clear();
    e.body.voxel_counts = {*request.voxels};
  }
  const bool measured = resolve(e.models.front()).coarsened.value_or(e.body.coarsened);
  if (measured) require_one_material(e, "export of coarsened cells");
  if (e.body.accuracies.empty() && !measured) {  // cells are refined for the loads, and measured on the supports
    e.loads.clear();
    e.load_locations.clear();
  }
  e.probes.clear();
  e.measures.clear();
  e.elements.clear();
  e.reference.elements.clear();
  return e;
}

/// @throws InputError for cells that are boxes where the other program gets springs or nodes of cubes.
void require_cubes(const ExportRequest& request, const Mesh& mesh) {
  if (!mesh.grid || has_cubes(*mesh.grid)) return;
  const Vec3& edge = mesh.grid->spacing;
  throw InputError(fmt::format(
      "{}: the cells are {:.6g} x {:.6g} x {:.6g} m (allowed with --to {}: cubes, --cells NX NY NZ in proportion "
      "to the size; boxes of hybmss_avg with --to springs)",
      request.what, edge[0], edge[1], edge[2], request.to));
}

/// The vertices of --carry, in the body's lengths.
/// @throws InputError if they are not where the body is.
Mesh carried_vertices(const ExportRequest& request, const PreparedCase& prepared) {
  const Body& of = prepared.experiment.body;
  Mesh vertices =
      mesh_body({.file = request.carry, .kind = {.vertices = true}, .scale = of.is_script() ? 1 : of.scale}).mesh;
  const NodalVectors& body = prepared.lattices.front().mesh->nodes;
  const Eigen::RowVector3d low = body.colwise().minCoeff(), high = body.colwise().maxCoeff(), size = high - low,
                           least = vertices.nodes.colwise().minCoeff(), most = vertices.nodes.colwise().maxCoeff();
  const double outside = std::max((low - least).maxCoeff(), (most - high).maxCoeff());
  if (outside > 0.1 * size.norm())
    throw InputError(fmt::format(
        "--carry: {} lies from ({:.4g}, {:.4g}, {:.4g}) to ({:.4g}, {:.4g}, {:.4g}) m, the body from ({:.4g}, {:.4g}, "
        "{:.4g}) to ({:.4g}, {:.4g}, {:.4g}) m (allowed: vertices of the body, in its units)",
        request.carry, least[0], least[1], least[2], most[0], most[1], most[2], low[0], low[1], low[2], high[0],
        high[1], high[2]));
  return vertices;
}

}  // namespace

bool is_body(const std::string& name) {
  const auto& endings = body_file_endings();
  return std::ranges::find(endings, extension_of(name)) != endings.end();
}

Experiment read_case(const ExportRequest& request) {
  Experiment experiment = read_experiment(find_case(request.what));
  const bool holds_branches = request.to == "springs" && fs::path(request.out).extension() != ".vtu";
  if (experiment.relaxation.acts() && !holds_branches)
    throw InputError(experiment.relaxation_where,
                     fmt::format("material.relaxation: has no place in this file, --to {}, whose springs would not "
                                 "relax (allowed with branches: --to springs, as .json or .npz)",
                                 request.to));
  return experiment;
}

SpringsFile springs_of(const ExportRequest& request, bool cut) {
  const Experiment of_case = is_body(request.what) ? Experiment() : read_case(request);
  if (!cut && request.to != "jolt")  // each of its springs has a stiffness of its own
    require_one_material(of_case, fmt::format("export --to {} of whole cubes", request.to));
  Experiment e = is_body(request.what) ? body_alone(request) : one_of_each(of_case, request);
  if (request.cells) {
    if (e.body.is_voxels()) throw InputError("--cells: is for bodies of hexahedra; this one has --voxels N");
    e.body.cells = {*request.cells};
  }
  if (!cut) {
    if (!e.body.accuracies.empty())
      throw InputError(
          fmt::format("{}: body.accuracy: cells of several sizes are cut cells (allowed: --to springs without "
                      "--whole-cubes, or --voxels N)",
                      request.what));
    e.body.cut = e.body.coarsened = false;
    for (ModelChoice& m : e.models)
      for (const char* of_cut_cells : {"cut", "coarsened"}) m.options.erase(of_cut_cells);
  }
  Status status(false);
  const Status::Working working(status, request.what);
  const PreparedCase prepared = prepare_lattices(e);
  if (of_case.body.is_voxels()) check_supports(of_case, *prepared.body.tetrahedra.back());
  if (!e.patches.empty() && is_body(request.what)) refuse_whole_surface(prepared);
  const Topology of = prepared.models.front().row.topology;
  if (request.to != "springs" && (of == Topology::cells || of == Topology::centres))
    require_cubes(request, *prepared.lattices.front().mesh);
  if (request.carry.empty()) return springs_of(prepared);
  if (request.to != "springs") throw InputError(fmt::format("--carry: is for --to springs, not {}", request.to));
  const Mesh vertices = carried_vertices(request, prepared);
  return springs_of(prepared, &vertices);
}

}  // namespace springproof
