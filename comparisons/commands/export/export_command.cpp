#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <sstream>

#include "comparisons/calculix/cross_check.h"
#include "comparisons/calculix/deck.h"
#include "comparisons/commands/commands.h"
#include "comparisons/commands/export/body_alone.h"
#include "comparisons/commands/export/export_engines.h"
#include "comparisons/commands/export/export_request.h"
#include "comparisons/prepare/case_checks.h"
#include "comparisons/prepare/springs_of_case.h"
#include "comparisons/run/prepare.h"
#include "comparisons/sweep/find_cases.h"
#include "comparisons/sweep/status.h"
#include "meshes/mesher/mesher.h"
#include "meshes/mesher/mesher_exchange.h"
#include "meshes/patches/select_patches.h"
#include "meshes/regions/mark_regions.h"
#include "msm/exchange/lammps.h"
#include "msm/laws/capabilities.h"
#include "msm/models.h"
#include "msm/parameters/model_options.h"
#include "msm/topology/cubic_lattice.h"
#include "problem/case_file/external.h"
#include "problem/files/named_files.h"
#include "problem/system/nearest_name.h"
#include "problem/system/number_checks.h"
#include "problem/system/streams.h"

namespace springproof {
namespace {

namespace fs = std::filesystem;

Cells cells_of_option(const std::vector<int>& cells) {
  return cells.empty() ? Cells{0, 0, 0} : Cells{cells[0], cells[1], cells[2]};
}

bool is_body(const std::string& name) {
  const auto& endings = body_file_endings();
  return std::find(endings.begin(), endings.end(), extension_of(name)) != endings.end();
}

Experiment read_case(const ExportRequest& request) {
  const std::string& name = request.what;
  const std::vector<fs::path> found = find_cases({name});
  if (found.size() > 1) throw InputError(fmt::format("{} is a folder of {} cases; name one", name, found.size()));
  Experiment experiment = read_experiment(found.front());
  const bool holds_branches = request.to == "springs" && fs::path(request.out).extension() != ".vtu";
  if (experiment.relaxation.acts() && !holds_branches)
    throw InputError(experiment.relaxation_where,
                     fmt::format("material.relaxation: has no place in this file, --to {}, whose springs would not "
                                 "relax (allowed with branches: --to springs, as .json or .npz)",
                                 request.to));
  return experiment;
}

/// Before the work.
void require_writable(const fs::path& file) {
  const fs::path folder = file.has_parent_path() ? file.parent_path() : fs::path(".");
  const char* why = fs::is_directory(file)                ? "is a folder"
                    : !fs::is_directory(folder)           ? "its folder does not exist"
                    : ::access(folder.c_str(), W_OK) != 0 ? "its folder is write-protected"
                                                          : nullptr;
  if (why)
    throw InputError(fmt::format("--out: cannot write {}: {} (allowed: a name in a folder that can be written)",
                                 file.string(), why));
}

/// "; core: E = 1e+06 Pa, nu = 0.3" of each region.
template <class Regions>
std::string words_of(const Regions& regions) {
  std::string words;
  for (const auto& r : regions)
    words += fmt::format("; {}: E = {:g} Pa, nu = {:g}", r.name, r.material.youngs_modulus, r.material.poisson_ratio);
  return words;
}

int export_calculix(const ExportRequest& request) {
  if (is_body(request.what))
    throw InputError(fmt::format("{}: is a body without loads (allowed with --to calculix: a case)", request.what));
  if (!request.model.empty() || request.voxels || request.moduli.youngs_modulus || !request.size.empty() ||
      !request.hold.empty() || !request.load.empty())
    throw InputError("--to calculix: a deck has the case's elements and material (allowed: --poisson-ratio, --cells)");
  const Experiment experiment = at_wanted(read_case(request), request.moduli.poisson_ratio);
  calculix::require_counterpart(experiment);
  const IsotropicMaterial& material = experiment.materials.front();
  const std::string file = request.out.empty() ? experiment.name + ".inp" : request.out;
  require_writable(file);
  Status status(false);
  const Status::Working working(status, request.what);
  const PreparedCase prepared = prepare(experiment);
  if (experiment.body.is_voxels() && !request.cells.empty())
    throw InputError("--cells: is for bodies of hexahedra; the tetrahedra of this one have [reference] edge_m");
  const Cells cells = request.cells.empty() && !experiment.body.is_voxels() ? experiment.body.cells.front()
                                                                            : cells_of_option(request.cells);
  Mesh mesh = experiment.body.is_voxels()
                  ? *prepared.body.tetrahedra.back()
                  : mesh_geo(prepared.body.geo, experiment.body.size, cells, {}, volumes_of(experiment.regions));
  if (!experiment.body.is_voxels()) {
    mark_regions(experiment.regions, 1, mesh);
    select_whole_facets(experiment.patches, mesh);
  }
  const calculix::Deck deck = calculix::make_deck(experiment, material, mesh);
  std::ostringstream out;
  calculix::write(deck, out);
  write_named_file(file, out.view());
  to_stdout("{}: {} nodes, {} elements {}, nu = {:g}{}\n", file, deck.mesh.nodes.rows(), deck.mesh.elements.size(),
            deck.element, material.poisson_ratio, words_of(deck.experiment.regions));
  return 0;
}

/// The model of the case with this label, or a row of the table; by default the case's first.
ModelChoice chosen_model(const Experiment& e, const std::string& name) {
  std::vector<std::string> known;
  for (const ModelChoice& m : e.models) known.push_back(m.label);
  const auto at = std::find(known.begin(), known.end(), name);
  if (at != known.end()) return e.models[static_cast<std::size_t>(at - known.begin())];
  if (name.empty() && !e.models.empty()) return e.models.front();
  for (const ModelRow& row : model_table()) {
    if (row.name == name) return named_model(name);
    if (std::find(known.begin(), known.end(), row.name) == known.end()) known.push_back(row.name);
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

/// `cut`: of cut cells where the model has them and the case does not say otherwise.
SpringsFile springs_of(const ExportRequest& request, bool cut = false) {
  const Experiment of_case = is_body(request.what) ? Experiment() : read_case(request);
  if (!cut && request.to != "jolt")  // each of its springs has a stiffness of its own
    require_one_material(of_case, fmt::format("export --to {} of whole cubes", request.to));
  Experiment e = is_body(request.what) ? body_alone(request) : one_of_each(of_case, request);
  if (!request.cells.empty()) {
    if (e.body.is_voxels()) throw InputError("--cells: is for bodies of hexahedra; this one has --voxels N");
    e.body.cells = {cells_of_option(request.cells)};
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

fs::path out_or(const ExportRequest& request, const std::string& ending) {
  return request.out.empty() ? fs::path(request.what).stem().string() + ending : request.out;
}

/// What the forces are made of, with how many there are: "springs + a term per cell (5856 springs, 384 cells)".
std::string parts_of(const SpringsFile& s) {
  const Network& network = s.model.network;
  const std::string made = made_of(s.model);
  const std::string springs =
      network.springs.empty() ? "no springs" : fmt::format("{} springs", network.springs.size());
  if (made.find("per cell") == std::string::npos) return fmt::format("{} ({})", made, springs);
  return fmt::format("{} ({}, {} {})", made, springs, network.cells.size(),
                     network.cells.cut() ? "cut cells" : "cells");
}

void report(const fs::path& file, const SpringsFile& s) {
  to_stdout("{}: {}, {} nodes, {}, {:.4g} kg, safe time step {:.4g} s, nu = {:g}{}\n", file.string(), s.origin.model,
            s.model.network.nodes(), parts_of(s), s.derived.at("mass_kg"), s.derived.at("safe_time_step_s"),
            s.material->poisson_ratio, words_of(s.regions));
}

/// Says so where the cells of a cut body hold something else than the model has by its name.
void report_averaging(const SpringsFile& s) {
  for (const ModelRow& row : model_table())
    if (row.name == s.origin.model && s.model.network.cells.cut() && made_of(row) != made_of(s.model))
      to_stdout(
          "note: {} is {} on whole cubes; cut cells hold its springs averaged over each cell, which leaves {} "
          "(--whole-cubes: the springs)\n",
          row.name, made_of(row), made_of(s.model));
}

int export_springs(const ExportRequest& request) {
  const fs::path file = out_or(request, ".json");
  require_springs_ending(file);
  require_writable(file);
  const SpringsFile springs = springs_of(request, !request.whole_cubes);
  if (!springs.regions.empty() && !springs.model.network.cells.cut())
    throw InputError(fmt::format(
        "{}: region '{}': whole cubes of several materials are in no springs file (allowed: cut cells, of a body of "
        "voxels without cut = false or --whole-cubes)",
        request.what, springs.regions.front().name));
  write_springs(file, springs);
  report(file, springs);
  report_averaging(springs);
  return 0;
}

/// One line for each patch whose nodes LAMMPS can name.
std::string groups_of(const SpringsFile& springs) {
  constexpr std::size_t most_groups = 31;
  std::string out;
  std::size_t count = 0;
  for (const auto& [name, nodes] : springs.patches) {
    const bool plain =
        std::all_of(name.begin(), name.end(), [](unsigned char c) { return std::isalnum(c) || c == '_'; });
    if (!plain || nodes.empty() || ++count > most_groups) continue;
    out += "group " + name + " id";
    for (const int n : nodes) out += fmt::format(" {}", n + 1);
    out += '\n';
  }
  return out;
}

int export_lammps(const ExportRequest& request) {
  const fs::path data = out_or(request, ".data"), input = fs::path(data).replace_extension(".in");
  if (data.extension() != ".data")
    throw InputError(fmt::format("--out: is {} (allowed: a name that ends in .data; the input gets the same with .in)",
                                 data.string()));
  const SpringsFile springs = springs_of(request);
  if (!can(springs.model, Capability::lammps)) {
    std::vector<std::string> able;
    for (const ModelRow& row : model_table())
      if (can(row, Capability::lammps)) able.push_back(row.name);
    throw InputError(fmt::format("--model: {} has forces that LAMMPS does not compute (allowed: {})",
                                 springs.origin.model, fmt::join(able, ", ")));
  }
  const MassSpringModel& model = springs.model;
  const Eigen::VectorXd mass = masses(model.network, springs.density);
  write_named_file(data, lammps_data(model, model.network.X, mass));
  write_named_file(input,
                   lammps_input(model, mass, data.filename().string(), 0.95 * springs.derived.at("safe_time_step_s")) +
                       groups_of(springs) + "run 0\n");
  report(data, springs);
  return 0;
}

int export_engine(const ExportRequest& request) {
  const SpringsFile springs = springs_of(for_engine(request));
  return export_to_engine(request, springs,
                          is_body(request.what) ? held_patches(request) : held_patches(read_case(request)));
}

/// A form of export: a row.
struct ExportForm {
  const char* name;
  const char* what;
  int (*write)(const ExportRequest&);
};
constexpr ExportForm forms[] = {
    {"calculix", "a deck for CalculiX and Abaqus", export_calculix},
    {"springs", "all that the springs of a body are, as .json, .npz or .vtu by the name's ending", export_springs},
    {"lammps", "a data file and an input for LAMMPS", export_lammps},
    {"jolt", "springs of nu = 1/4 for Jolt Physics, as .json", export_engine},
    {"bullet", "tetrahedra for Bullet's deformable bodies, as .json", export_engine},
    {"mujoco", "tetrahedra for MuJoCo, as .xml", export_engine}};

/// `springproof export CASE --to FORM`.
class ExportCommand {
 public:
  void add_options(CLI::App& command);
  /// @return 0.  @throws InputError, std::runtime_error if the file cannot be written.
  int run() const;

 private:
  ExportRequest request_;
};

void ExportCommand::add_options(CLI::App& command) {
  ExportRequest& r = request_;
  std::vector<std::string> names, words;
  for (const ExportForm& form : forms) {
    names.emplace_back(form.name);
    words.push_back(fmt::format("{}: {}", form.name, form.what));
  }
  command.add_option("CASE", r.what, "case file (*.toml), built-in name (springproof list), or a body (*.stl, ...)")
      ->required();
  command.add_option("--to", r.to, fmt::format("{}", fmt::join(words, "; ")))->required()->check(CLI::IsMember(names));
  command.add_option("--out", r.out, "file to write (default: NAME.inp, NAME.json, NAME.data, NAME.xml here)");
  command.add_option("--poisson-ratio,--nu", r.moduli.poisson_ratio, "of a case: one of its own (default: its first)");
  command
      .add_option("--cells", r.cells,
                  "cells along each side of a body of hexahedra (default: the case's first resolution)")
      ->expected(3)
      ->check(CLI::Range(1, 1000));
  command.add_option("--model", r.model,
                     fmt::format("springs: a model of the case or of the table (default: the case's first; {})",
                                 recommended_model().name));
  command.add_option("--voxels", r.voxels, "springs: about so many cubes (default: the case's first; 2000)")
      ->check(CLI::Range(1, 4000000));
  command.add_flag("--whole-cubes", r.whole_cubes,
                   "springs: whole cubes of a body that is no block (default: cells cut along its surface)");
  command.add_option(
      "--carry", r.carry,
      "springs: an .stl, .obj, .ply or .msh file whose vertices the springs carry, in its order, in place "
      "of the body's surface");
  command.add_option("--youngs-modulus,-E", r.moduli.youngs_modulus, "of a body alone: Young's modulus [Pa]");
  command
      .add_option(
          "--hold", r.hold,
          "of a body alone: what a support holds: left, right, front, back, bottom, top (-x, x, -y, y, -z, z), or "
          "keys of [[patch]], 'near = { point_m = [0, 0, 0.1], radius_m = 0.02 }'; again for another")
      ->allow_extra_args(false);
  command.add_option("--load", r.load, "of a body alone: what loads act on, named like --hold")
      ->allow_extra_args(false);
  command.add_option("--density", r.density, "of a body alone [kg/m^3]")->check(positive())->capture_default_str();
  command.add_option("--scale", r.scale, "of a body alone: its coordinates are multiplied by it")
      ->check(positive())
      ->capture_default_str();
  command.add_option("--size", r.size, "of a script for gmsh (*.geo): its size_x size_y size_z [m]")
      ->expected(3)
      ->check(positive());
}

int ExportCommand::run() const {
  const auto form =
      std::find_if(std::begin(forms), std::end(forms), [&](const ExportForm& f) { return f.name == request_.to; });
  return form->write(request_);
}

}  // namespace

RunCommand export_command(CLI::App& parser) { return made<ExportCommand>(parser); }

}  // namespace springproof
