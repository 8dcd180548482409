#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <sstream>

#include "comparisons/calculix/cross_check.h"
#include "comparisons/calculix/deck.h"
#include "comparisons/calculix/opinions.h"
#include "comparisons/commands/commands.h"
#include "comparisons/commands/export/export_request.h"
#include "comparisons/run/prepare.h"
#include "comparisons/sweep/status.h"
#include "msm/exchange/lammps.h"
#include "msm/laws/capabilities.h"
#include "msm/parameters/model_options.h"
#include "problem/files/files.h"
#include "problem/system/number_checks.h"
#include "problem/system/streams.h"

namespace springproof {
namespace {

namespace fs = std::filesystem;

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
  calculix::counterpart(experiment);
  const IsotropicMaterial& material = experiment.materials.front();
  const std::string file = request.out.empty() ? experiment.name + ".inp" : request.out;
  require_writable(file);
  Status status(false);
  const Status::Working working(status, request.what);
  const PreparedCase prepared = prepare(experiment);
  const Body& body = experiment.body;
  if (body.is_voxels() && request.cells)
    throw InputError("--cells: is for bodies of hexahedra; the tetrahedra of this one have [reference] edge_m");
  const Mesh mesh = body.is_voxels()
                        ? *prepared.body.tetrahedra.back()
                        : mesh_of_cells(experiment, prepared.body.geo, request.cells.value_or(body.cells.front()));
  const calculix::Deck deck = calculix::make_deck(experiment, material, mesh);
  std::ostringstream out;
  calculix::write(deck, out);
  write_named_file(file, out.view());
  to_stdout("{}: {} nodes, {} elements {}, nu = {:g}{}\n", file, deck.mesh.nodes.rows(), deck.mesh.elements.size(),
            deck.element, material.poisson_ratio, words_of(deck.experiment.regions));
  return 0;
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
    const bool plain = std::ranges::all_of(name, [](unsigned char c) { return std::isalnum(c) || c == '_'; });
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
      .add_option_function<std::vector<int>>(
          "--cells",
          [&r](const std::vector<int>& n) {
            r.cells = {n[0], n[1], n[2]};
          },
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
