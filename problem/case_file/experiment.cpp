#include "problem/case_file/experiment.h"

#include <fmt/format.h>

#include <algorithm>

#include "problem/case_file/experiment_parts.h"
#include "problem/files/files.h"
#include "problem/large_strain.h"
#include "problem/system/nearest_name.h"

namespace springproof {
namespace {

std::vector<std::string> kinematics_names() {
  std::vector<std::string> names = {"linear"};
  names.insert(names.end(), laws_of_large_strain.begin(), laws_of_large_strain.end());
  return names;
}

std::vector<Cells> read_resolutions(const TomlValue& cells) {
  const auto items = as_list(cells, "[nx, ny, nz] or a list of such, integers from 1 to 1000");
  if (!items.front().node->is_array()) return {as_cells(cells)};
  std::vector<Cells> resolutions;
  for (const TomlValue& item : items) {
    const Cells resolution = as_cells(item);
    if (std::ranges::find(resolutions, resolution) != resolutions.end())
      refuse(item, fmt::format("[{}] is named twice", fmt::join(resolution, ", ")), "each resolution once");
    resolutions.push_back(resolution);
  }
  return resolutions;
}

template <class T>
std::vector<T> read_each_once(const TomlValue& value, const Range& range) {
  std::vector<T> numbers;
  for (const TomlValue& item : one_or_several(value)) {
    const double given = as_number(item, range);
    const T number = static_cast<T>(given);
    if (number != given) refuse(item, fmt::format("is {}", given), range.words);
    if (std::ranges::find(numbers, number) != numbers.end())
      refuse(item, fmt::format("{} is named twice", number), "each once");
    numbers.push_back(number);
  }
  return numbers;
}

Body read_body(const TomlValue& value) {
  const TomlTable table(value, keys_of("body"));
  Body body;
  body.where = location_of(table.at("geo"));
  body.geo = as_text(table.at("geo"));
  const bool script = body.is_script();
  if (const auto size = table.find("size_m")) {
    if (!script) refuse(*size, "is a parameter of .geo scripts", "scale, to multiply the coordinates of a file");
    // gmsh merges points that are 1e-8 apart.
    body.size =
        as_vector(*size, {"a finite number > 0, from 1e-6 to 1e9 [m]", smallest_body, largest_body, true, true});
  } else if (script) {
    missing(value, "size_m", "[x, y, z], lengths > 0");
  }
  if (const auto scale = table.find("scale")) {
    if (script) refuse(*scale, "is for files", "size_m, for .geo scripts");
    body.scale = as_number(*scale, positive_number);
  }
  if (!script && !body.states_its_unit()) body.scale *= unit_in(value.units, "m").in_si;
  const auto cells = table.find("cells"), voxels = table.find("voxels"), edges = table.find("voxel_edge_m");
  constexpr const char* fineness =
      "one of cells = [nx, ny, nz] (bodies of hexahedra), voxels = 5000 (about so many cubes), voxel_edge_m = 0.01; "
      "each may be a list";
  const int said = cells.has_value() + voxels.has_value() + edges.has_value();
  if (said == 0) missing(value, "cells", fineness);
  if (said > 1) refuse(value, "says twice how fine the lattices are", fineness);
  if (cells) body.cells = read_resolutions(*cells);
  if (voxels)
    body.voxel_counts =
        read_each_once<int>(*voxels, {"a whole number from 1 to 4e6, or a list of such", 1, 4e6, true, true});
  if (edges) body.voxel_edges = read_each_once<double>(*edges, positive_number);
  if (const auto cut = table.find("cut")) {
    if (cells) refuse(*cut, "is for bodies of voxels", "voxels or voxel_edge_m");
    body.cut = as_flag(*cut);
  }
  if (const auto accuracy = table.find("accuracy")) {
    body.accuracies =
        read_each_once<double>(*accuracy, {"a number from 0.001 to 0.5, or a list of such", 0.001, 0.5, true, true});
    std::sort(body.accuracies.rbegin(), body.accuracies.rend());
    if (body.voxel_edges.size() + body.voxel_counts.size() != 1 || !body.cut)
      refuse(*accuracy, "starts from one lattice of cut cells", "one voxels or voxel_edge_m, and not cut = false");
  }
  if (const auto coarsened = table.find("coarsened")) {
    if (cells || !body.cut) refuse(*coarsened, "measures cut cells", "voxels or voxel_edge_m, and not cut = false");
    if (!body.accuracies.empty())
      refuse(*coarsened, "measures cells of one size, accuracy makes several", "one of coarsened and accuracy");
    body.coarsened = as_flag(*coarsened);
  }
  if (cells && !script) refuse(*cells, "is for bodies of hexahedra", "voxels or voxel_edge_m");
  return body;
}

/// Each Poisson's ratio once.
std::vector<IsotropicMaterial> read_materials(const TomlValue& value) {
  std::vector<IsotropicMaterial> materials = read_moduli(TomlTable(value, keys_of("material")), 1000);
  for (std::size_t i = 0; i < materials.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      if (materials[i].poisson_ratio == materials[j].poisson_ratio)
        refuse(value, fmt::format("has the Poisson's ratio {} twice", materials[i].poisson_ratio),
               "each Poisson's ratio once");
  return materials;
}

std::vector<Probe> read_probes(const TomlTable& document) {
  std::vector<Probe> probes;
  for (const TomlValue& value : document.tables("probe")) {
    const TomlTable table(value, keys_of("probe"));
    probes.push_back({read_own_name(table.at("name"), probes, " probe"), as_vector(table.at("at_m"))});
  }
  return probes;
}

Section read_section(const TomlValue& value) {
  const TomlTable table(value, keys_of("section"));
  return {as_vector(table.at("point_m")), as_direction(table.at("normal"))};
}

ReferenceChoice read_reference(const TomlValue& value, bool voxels) {
  const TomlTable table(value, keys_of("reference"));
  ReferenceChoice reference;
  if (voxels) reference.elements = {"p2"};
  for (const char* key : {"edge_m", "refine"})
    if (const auto given = table.find(key); given && !voxels)
      refuse(*given, "is for bodies of voxels", "cells and grading, for bodies of hexahedra");
  if (const auto edge = table.find("edge_m")) reference.edge = as_number(*edge, positive_number);
  for (const char* key : {"cells", "grading"})
    if (const auto given = table.find(key); given && voxels)
      refuse(*given, "is for bodies of hexahedra", "edge_m, for bodies of voxels");
  if (const auto in_time = table.find("in_time")) reference.in_time = as_flag(*in_time);
  if (const auto integrator = table.find("integrator")) {
    if (!reference.in_time) refuse(*integrator, "is that of finite elements in time", "in_time = true beside it");
    reference.energy_momentum = as_choice(*integrator, {"midpoint", "energy_momentum"}) == "energy_momentum";
  }
  if (const auto cells = table.find("cells")) reference.cells = as_cells(*cells);
  if (const auto elements = table.find("elements")) {
    reference.elements.clear();
    if (const auto* array = elements->node->as_array(); !array || !array->empty())
      reference.elements = read_elements(*elements, voxels ? std::vector<std::string>{"p2", "p1"} : element_names());
  }
  if (const auto times = table.find("refine")) {
    reference.refine = as_number(*times, {"a number from 1 to 10", 1, 10, true, true});
    if (std::ranges::count(reference.elements, "p2") == 0)
      refuse(*times, "cuts tetrahedra of second order", "\"p2\" among the elements, or no such key");
  }
  if (const auto grading = table.find("grading"))
    reference.grading = as_number(*grading, {"a number from 1 to 3", 1, 3, true, true});
  if (const auto smooth = table.find("smooth")) reference.smooth = as_flag(*smooth);
  return reference;
}

/// A case of motions alone has no equilibrium that finite elements would be compared at, unless it asks for them.
void leave_out_equilibria(const TomlTable& document, Experiment& experiment) {
  const auto& motion = experiment.dynamics;
  if (!motion || motion->equilibrium || motion->released) return;
  const auto reference = document.find("reference");
  if (!reference || !TomlTable(*reference, keys_of("reference")).find("elements"))
    experiment.reference.elements.clear();
}

/// Gravity requires a density.
void require_density(const TomlTable& document, const Experiment& experiment) {
  const bool weighs =
      std::ranges::any_of(experiment.loads, [](const Load& load) { return std::holds_alternative<Gravity>(load); });
  if (weighs && !TomlTable(document.at("material"), keys_of("material")).find("density_kg_m3"))
    missing(document.at("material"), "density_kg_m3", "a finite number > 0, since a load is gravity_m_s2");
}

/// Grading would move the borders of the patches and regions of a block, which are lines of its grids.
void keep_grids_even(const TomlTable& document, Experiment& experiment) {
  if ((experiment.patches.empty() && experiment.regions.empty()) || experiment.body.is_voxels()) return;
  experiment.reference.grading = 1;
  const auto reference = document.find("reference");
  if (!reference) return;
  const auto grading = TomlTable(*reference, keys_of("reference")).find("grading");
  if (grading && as_number(*grading, positive_number) != 1)
    refuse(*grading, "would move the border of a [[patch]] or [[region]], which is a line of the grid",
           "1, beside a [[patch]] or [[region]]");
}

Experiment read_tables(const TomlTable& document, Experiment experiment) {
  if (const auto cite = document.find("cite")) experiment.cite = as_text(*cite);
  if (const auto what = document.find("what")) experiment.what = as_text(*what);
  if (const auto name = document.find("kinematics")) experiment.kinematics = as_choice(*name, kinematics_names());
  experiment.body = read_body(document.at("body"));
  experiment.patches = read_patch_rules(document);
  experiment.materials = read_materials(document.at("material"));
  experiment.regions = read_regions(document, experiment);
  experiment.listed = read_listed(document, experiment);
  for (const TomlValue& value : document.tables("load"))
    for (const Load& load : read_load(value)) {
      experiment.loads.push_back(load);
      experiment.load_locations.push_back(location_of(value));
    }
  if (experiment.loads.empty() && !document.find("dynamics"))
    throw InputError({experiment.file.string(), 1, 1},
                     "load: is missing (allowed: at least one [[load]], or none beside [dynamics])");
  read_masses(document, experiment);
  require_density(document, experiment);
  if (const auto section = document.find("section")) experiment.section = read_section(*section);
  experiment.probes = read_probes(document);
  if (const auto reference = document.find("reference"))
    experiment.reference = read_reference(*reference, experiment.body.is_voxels());
  else if (experiment.body.is_voxels())
    experiment.reference.elements = {"p2"};
  keep_grids_even(document, experiment);
  settle_kelvin(experiment);
  read_line(document, experiment);
  read_dynamics(document, experiment);
  read_relaxation(document, experiment);
  leave_out_equilibria(document, experiment);
  read_fracture(document, experiment);
  read_compare(document, experiment);
  check_loads(experiment);
  if (experiment.reference.cells[0] > 0) check_reference_cells(document.at("reference"), experiment);
  read_measured(document, experiment);
  read_expectations(document, experiment);
  read_published(document, experiment);
  if (document.find("identify")) check_identifications(experiment);
  check_regions(experiment);
  check_relaxation(experiment);
  return experiment;
}

}  // namespace

std::vector<std::string> read_elements(const TomlValue& value, const std::vector<std::string>& allowed) {
  std::vector<std::string> elements;
  for (const TomlValue& item : as_list(value, "a list of elements: q1, q2, p1, p2")) {
    const std::string element = as_choice(item, allowed);
    if (std::ranges::find(elements, element) != elements.end())
      refuse(item, fmt::format("'{}' is named twice", element), "each element once");
    elements.push_back(element);
  }
  return elements;
}

std::vector<std::string> element_names() { return {"q1", "q2", "p1", "p2"}; }

IsotropicMaterial Experiment::at_rest(const IsotropicMaterial& material) const {
  const double creep = relaxation.creep_after(loaded_for);
  return creep == 1 ? material : with_shear(material, 1 / creep);
}

std::vector<double> Experiment::settings() const {
  std::vector<double> values;
  for (const IsotropicMaterial& m : listed.region > 0 ? listed.materials : materials)
    values.push_back(listed_modulus(m));
  return values;
}

double Experiment::setting_of(const IsotropicMaterial& rest) const {
  return listed_modulus(listed.region > 0 ? regions[listed.region - 1].material : rest);
}

Experiment Experiment::at(std::size_t setting) const {
  Experiment one = *this;
  if (listed.region == 0) return one;
  one.regions[listed.region - 1].material = listed.materials[setting];
  one.listed.materials = {listed.materials[setting]};
  return one;
}

std::vector<IsotropicMaterial> Experiment::materials_of_part(std::size_t region) const {
  if (region > 0) return region == listed.region ? listed.materials : std::vector{regions[region - 1].material};
  return listed.region > 0 ? std::vector{materials.front()} : materials;
}

const IsotropicMaterial& Experiment::body_material(std::size_t setting) const {
  return materials[listed.region > 0 ? 0 : setting];
}

std::string Experiment::listed_symbol() const {
  if (listed.region == 0) return "ν";
  return (listed.stiffness ? "E of " : "ν of ") + regions[listed.region - 1].name;
}

std::string Experiment::listed_words() const {
  if (listed.region == 0) return "Poisson's ratio";
  return (listed.stiffness ? "Young's modulus of " : "Poisson's ratio of ") + regions[listed.region - 1].name;
}

Experiment parse_experiment(const std::string& text, const std::filesystem::path& file) {
  Experiment experiment;
  experiment.file = file;
  experiment.name = file.stem().string();
  experiment.folder = std::filesystem::absolute(file).parent_path().filename().string();
  experiment.text = text;
  require_bounded(text, file.string());
  toml::table document;
  try {
    document = toml::parse(text, file.string());
  } catch (const toml::parse_error& error) {
    const auto begin = error.source().begin;
    throw InputError({file.string(), static_cast<int>(begin.line), static_cast<int>(begin.column)},
                     fmt::format("not valid TOML: {}", error.description()));
  }
  if (document.empty())
    throw InputError({file.string(), 0, 0}, "the case file is empty (needed: [body], [material], [[load]])");
  return read_document(document, experiment);
}

Experiment read_document(const toml::table& document, const Experiment& of) {
  Experiment experiment;
  experiment.file = of.file;
  experiment.name = of.name;
  experiment.folder = of.folder;
  experiment.text = of.text;
  const std::string file = of.file.string();
  if (const toml::node* units = document.get("units"))
    experiment.units = as_choice({units, "units", file}, {"m", "mm"}) == "mm" ? Units::mm : Units::m;
  return read_tables(TomlTable({&document, "", file, experiment.units}, keys_of("")), std::move(experiment));
}

Experiment read_experiment(const std::filesystem::path& file) {
  return parse_experiment(read_named_file(file, "a case file, NAME.toml", largest_case_file), file);
}

void check_patches(const Experiment& experiment, const std::vector<std::string>& patches) {
  for (const AttachedMass& mass : experiment.masses)
    if (!mass.on.empty() && std::ranges::find(patches, mass.on) == patches.end())
      throw InputError({experiment.file.string(), 0, 0},
                       fmt::format("mass '{}': on: the body has no patch '{}' (allowed: {}){}", mass.name, mass.on,
                                   fmt::join(patches, ", "), did_you_mean(mass.on, patches)));
  for (std::size_t i = 0; i < experiment.loads.size(); ++i) {
    const std::string* on = patch_of(experiment.loads[i]);
    if (!on || std::ranges::find(patches, *on) != patches.end()) continue;
    throw InputError(experiment.load_locations[i],
                     fmt::format("load.on: the body has no patch '{}' (allowed: {}){}", *on, fmt::join(patches, ", "),
                                 did_you_mean(*on, patches)));
  }
}

}  // namespace springproof
