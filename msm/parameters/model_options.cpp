// Model options of a case file: one row per option.
#include "msm/parameters/model_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <set>

#include "msm/exchange/springs_file.h"
#include "msm/parameters/model_table.h"
#include "problem/system/nearest_name.h"

namespace springproof {
namespace {

using Value = std::variant<bool, double, std::string>;

using Type = ModelOption::Type;

/// An option and its setter, which returns the allowed values if the given one is invalid.
struct Option {
  const char* name;
  const char* what;
  Type type;
  std::function<std::optional<std::string>(const Value&, ModelParameters&)> set;
  bool of_body = false;
};

Option of_body(Option option) {
  option.of_body = true;
  return option;
}

template <class T>
T& place_of(T ModelParameters::*member, ModelParameters& p) {
  return p.*member;
}

template <class T>
T& place_of(T RandomParameters::*member, ModelParameters& p) {
  return p.random.*member;
}

/// A setter of a member of ModelParameters or RandomParameters.
template <class T, class Owner>
auto stored(T Owner::*member) {
  return [=](auto value, ModelParameters& p) { place_of(member, p) = static_cast<T>(value); };
}

/// An option whose value is a name from a list of names and their meanings.
template <class T, class Owner>
Option choice(const char* name, const char* what, T Owner::*member, std::vector<std::pair<std::string, T>> allowed) {
  return {name, what, Type::name, [=](const Value& value, ModelParameters& p) -> std::optional<std::string> {
            const std::string* given = std::get_if<std::string>(&value);
            std::vector<std::string> names;
            for (const auto& [known, meaning] : allowed) {
              if (given && *given == known) {
                place_of(member, p) = meaning;
                return {};
              }
              names.push_back('"' + known + '"');
            }
            return fmt::format("must be {}", fmt::join(names, " or "));
          }};
}

std::optional<std::string> set_face_to_cube(const Value& value, ModelParameters& p) {
  const double* A = std::get_if<double>(&value);
  if (!A || !(*A >= 0)) return "must be a number >= 0";
  if (!p.row.any_face_to_cube && *A != p.row.face_to_cube)
    return fmt::format("is {} by definition of this model", p.row.face_to_cube);
  p.face_to_cube = *A;
  return {};
}

/// All enumerators by their names.
template <class Enum, class Member>
std::vector<std::pair<std::string, Member>> all_of() {
  std::vector<std::pair<std::string, Member>> all;
  for (const char* name : names_of(Enum{})) all.emplace_back(name, static_cast<Enum>(all.size()));
  return all;
}

/// Yes or no.
Option flag(const char* name, const char* what, std::function<void(bool, ModelParameters&)> set) {
  return {name, what, Type::flag, [=](const Value& value, ModelParameters& p) -> std::optional<std::string> {
            const bool* on = std::get_if<bool>(&value);
            if (!on) return "must be true or false";
            set(*on, p);
            return {};
          }};
}

/// A number in a range, stored by `set`; `kind`: "whole " or none.
Option number(const char* name, const char* what, std::pair<double, double> range,
              std::function<void(double, ModelParameters&)> set, std::string kind = "") {
  return {name, what, Type::number, [=](const Value& value, ModelParameters& p) -> std::optional<std::string> {
            const double* given = std::get_if<double>(&value);
            if (!given || !(*given >= range.first && *given <= range.second) ||
                (!kind.empty() && *given != std::floor(*given)))
              return fmt::format("must be a {}number, {:g} <= {} <= {:g}", kind, range.first, name, range.second);
            set(*given, p);
            return {};
          }};
}

std::vector<Option> random_options() {
  return {
      number("min_length", "random: least distance of two nodes over the spacing (default 0.8)", {0.1, 0.95},
             stored(&RandomParameters::min_length)),
      number("max_length", "random: longest spring over the spacing, instead of springs_per_node", {0.5, 4},
             stored(&RandomParameters::max_length)),
      number("springs_per_node", "random: mean number of springs at a node (default 15; emsm_patch: 50)", {4, 60},
             stored(&RandomParameters::springs_per_node)),
      number("stiffness_exponent", "random: p in k ~ L^-p (default 0)", {-4, 4},
             stored(&RandomParameters::stiffness_exponent)),
      of_body(number("nodes_per_m3", "random: nodes per cubic metre (default: one per cube of the lattice)",
                     {1e-12, 1e24}, stored(&ModelParameters::node_density))),
      number("seed", "random: first seed (default 1)", {1, 4294967295.0}, stored(&RandomParameters::seed), "whole "),
      number("seeds", "random: number of networks (default 1)", {1, 1000}, stored(&ModelParameters::seeds), "whole "),
      choice<bool>("surface", "random: nodes on the surface (default), or cut, whose springs are left as they are made",
                   &RandomParameters::surface_nodes, {{"nodes", true}, {"cut", false}}),
      flag("windows", "random: nodes in stages, by spherical windows, as the paper; with surface = \"cut\"",
           stored(&RandomParameters::windows))};
}

Option hold_option() {
  return of_body(flag("hold_rigid_motions", "rigid motions that the loads leave free are constrained, not refused",
                      stored(&ModelParameters::hold_rigid_motions)));
}

Option grip_option() {
  return of_body(number("grip", "depth, in node spacings, to which supports hold nodes that are not the mesh's",
                        {0, 100}, stored(&ModelParameters::grip)));
}

std::vector<Option> averaging_options() {
  return {
      choice<std::optional<StrainCurve>>("curve", "averaged springs: law of large strain (default: the case's)",
                                         &ModelParameters::curve, all_of<StrainCurve, std::optional<StrainCurve>>()),
      choice<bool>("torsion", "averaged springs: exact (default), or slender, of bodies two and more cells across",
                   &ModelParameters::slender, {{"exact", false}, {"slender", true}})};
}

std::vector<Option> dispersion_options(const ModelRow& row) {
  auto forms = all_of<Dispersion, Dispersion>();
  if (row.topology == Topology::hexagonal)
    std::erase_if(forms, [](const auto& form) { return form.second == Dispersion::finite_strain; });
  return {choice<Dispersion>("dispersion", "eMSM: form of the dispersion (default symmetric)",
                             &ModelParameters::dispersion, std::move(forms)),
          choice<std::optional<bool>>("weights", "eMSM, symmetric or finite_strain (default: by the sign of q)",
                                      &ModelParameters::exact_volumes, {{"volume", true}, {"kL", false}})};
}

/// The options that a model has.
std::vector<Option> options_of(const ModelRow& row) {
  if (row.topology == Topology::file) return {hold_option(), grip_option()};
  std::vector<Option> options = {flag("paper_e_form", "springs from E as in the tables of Golec et al. (2019)",
                                      stored(&ModelParameters::paper_e_form))};
  if ((row.topology == Topology::cells || row.topology == Topology::centres) && row.extension != Extension::averaging)
    options.push_back({"face_to_cube", "lattices: A = k_f / k_c", Type::number, set_face_to_cube});
  if (row.extension == Extension::averaging) options = averaging_options();
  if (row.topology == Topology::random) options = random_options();
  if (passes_patch_test(row))  // needs nodes on the surface, and chooses the springs' constants itself
    std::erase_if(options, [](const Option& o) {
      return std::set<std::string>{"surface", "windows", "stiffness_exponent"}.contains(o.name);
    });
  if (row.topology == Topology::centres)
    options.push_back(
        of_body(number("turned_deg", "node-centred lattices: angle about z between lattice and axes", {-90, 90},
                       [](double v, ModelParameters& p) { p.turned = v * std::numbers::pi / 180; })));
  options.push_back(hold_option());
  if (row.topology == Topology::cells && row.extension != Extension::momentum_dispersion) {
    options.push_back(of_body(flag("cut", "cut cells of a body of voxels, or whole cubes (default: as the body says)",
                                   stored(&ModelParameters::cut))));
    options.push_back(of_body(
        flag("coarsened", "cut cells whose stiffness is measured in a finer lattice (default: as the body says)",
             stored(&ModelParameters::coarsened))));
    options.push_back(of_body(number("shift",
                                     "averaged springs, cut cells: part of the way from the middle of a cell to the "
                                     "centroid of its filled part, at which the strain is taken (default 0)",
                                     {0, 1}, stored(&ModelParameters::shift))));
  }
  if (row.topology != Topology::cells) options.push_back(grip_option());
  if (row.extension == Extension::volume_correction)
    options.push_back(choice<VolumeEnergy>("volume_energy", "volume correction: bounded (default), or the paper's",
                                           &ModelParameters::volume_energy, all_of<VolumeEnergy, VolumeEnergy>()));
  if (row.extension == Extension::momentum_dispersion)
    for (Option& option : dispersion_options(row)) options.push_back(std::move(option));
  if (row.topology == Topology::random && !passes_patch_test(row))
    options.push_back(choice<bool>("calibration",
                                   "random: homogenised (default, as compare), or affine (the papers' formulas)",
                                   &ModelParameters::homogenised, {{"homogenised", true}, {"affine", false}}));
  return options;
}

/// "a number >= 0": what the setter says against a value of another type.
std::string allowed_by(const Option& option, const ModelRow& row) {
  ModelParameters p;
  p.row = row;
  const Value wrong = option.type == Type::number ? Value(false) : Value(0.0);
  return option.set(wrong, p).value().substr(std::string("must be ").size());
}

[[noreturn]] void refuse_option(const ModelChoice& choice, const std::string& message) {
  throw InputError(choice.where, fmt::format("models: {}: {}", choice.name, message));
}

/// @throws InputError for a name that is not in the table.
const ModelRow& row_of(const ModelChoice& choice) {
  const auto& table = model_table();
  const auto row = std::find_if(table.begin(), table.end(), [&](const ModelRow& r) { return r.name == choice.name; });
  if (row == table.end()) {
    std::vector<std::string> names;
    for (const ModelRow& r : table) names.push_back(r.name);
    throw InputError(choice.where, fmt::format("models: unknown model '{}' (allowed: {}){}", choice.name,
                                               fmt::join(names, ", "), did_you_mean(choice.name, names)));
  }
  return *row;
}

/// A springs file instead of a row of the table.
ModelParameters read_own_model(const ModelChoice& choice) try {
  ModelParameters p;
  p.springs = std::make_shared<SpringsFile>(read_springs(choice.file));
  p.row = {choice.name,
           "springs of a file",
           Topology::file,
           0,
           false,
           Extension::none,
           p.springs->model.small_displacements_only,
           false,
           Calibration::shear_modulus};
  return p;
} catch (const InputError& e) {
  throw InputError(choice.where, fmt::format("compare.models: {}", e.what()));
}

ModelParameters of_row(const ModelRow& row) {
  ModelParameters p;
  p.row = row;
  p.face_to_cube = row.face_to_cube;
  if (passes_patch_test(row)) {
    p.homogenised = false;  // the springs have the modulus exactly
    p.random.springs_per_node = 50;
    p.random.least_springs = 30;
    p.random.edge_clearance = 0.6;
  }
  return p;
}

}  // namespace

std::vector<ModelOption> model_options() {
  std::vector<ModelOption> all;
  for (const ModelRow& row : model_table())
    for (const Option& o : options_of(row))
      if (std::none_of(all.begin(), all.end(), [&](const ModelOption& known) { return known.name == o.name; }))
        all.push_back({o.name, o.what, allowed_by(o, row), o.type, o.of_body});
  return all;
}

ModelParameters resolve(const ModelChoice& choice) {
  ModelParameters p = choice.file.empty() ? of_row(row_of(choice)) : read_own_model(choice);
  const std::vector<Option> options = options_of(p.row);
  std::vector<std::string> known;
  for (const Option& option : options) known.emplace_back(option.name);
  for (const auto& [key, value] : choice.options) {
    const auto option = std::find_if(options.begin(), options.end(), [&](const Option& o) { return o.name == key; });
    if (option == options.end())
      refuse_option(choice, fmt::format("unknown option '{}' (allowed: {}){}", key, fmt::join(known, ", "),
                                        did_you_mean(key, known)));
    if (const auto allowed = option->set(value, p)) refuse_option(choice, fmt::format("{} {}", key, *allowed));
  }
  return p;
}

}  // namespace springproof
