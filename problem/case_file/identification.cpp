#include "problem/case_file/identification.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "problem/case_file/experiment_parts.h"
#include "problem/case_file/varied.h"

namespace springproof {
namespace {

/// What a number may be where the case does not say it.
struct UsualBounds {
  const char* key;  ///< the last part of its path begins with it
  double lower, upper;
  bool of_start;  ///< times the start
};
constexpr UsualBounds usual_bounds[] = {{"poisson_ratio", -0.99, 0.4999, false},
                                        {"youngs_modulus", 1e-3, 1e3, true},
                                        {"shear_modulus", 1e-3, 1e3, true},
                                        {"bulk_modulus", 1e-3, 1e3, true},
                                        {"density", 1e-2, 1e2, true},
                                        {"share", 1e-3, 1e3, true},
                                        {"time_s", 1e-3, 1e3, true},
                                        {"viscosity_s", 1e-3, 1e3, true}};

/// "share" of "material.relaxation.branches[0].share".
std::string last_part(const std::string& path) {
  const auto dot = path.rfind('.');
  return dot == std::string::npos ? path : path.substr(dot + 1);
}

/// "branches[0].share": what tells it from others.
std::string short_name(const std::string& path) {
  const auto item = path.rfind(']');
  if (item == std::string::npos) return last_part(path);
  const auto dot = path.rfind('.', item);
  return dot == std::string::npos ? path : path.substr(dot + 1);
}

void read_bounds(const TomlTable& table, SoughtParameter& p) {
  if (const auto bounds = table.find("bounds")) {
    const std::vector<TomlValue> ends = as_list_of(2, *bounds, "two numbers, the lower first");
    p.lower = as_number(ends[0]);
    p.upper = as_number(ends[1]);
    if (!(p.lower < p.upper))
      refuse(*bounds, fmt::format("{:g} is not below {:g}", p.lower, p.upper), "the lower first");
    return;
  }
  const std::string key = last_part(p.of.front());
  for (const UsualBounds& usual : usual_bounds)
    if (key.starts_with(usual.key)) {
      p.lower = usual.lower * (usual.of_start ? p.start : 1);
      p.upper = usual.upper * (usual.of_start ? p.start : 1);
    }
  if (!(p.lower < p.upper))
    refuse(table.at("of"), fmt::format("of '{}' no usual bounds are known", p.of.front()),
           "bounds = [lower, upper] beside it");
}

SoughtParameter read_parameter(const TomlValue& value, const Experiment& e) {
  const TomlTable table(value, keys_of("identify.parameters"));
  SoughtParameter p;
  std::optional<double> written;
  for (const TomlValue& item : one_or_several(table.at("of"))) {
    const std::optional<std::string> path = item.node->value<std::string>();
    const std::optional<double> number = path ? number_of(e, *path) : std::nullopt;
    if (!number)
      refuse(item, path ? fmt::format("'{}' is no number of the case", *path) : "is no key",
             "a key as written here, material.youngs_modulus_Pa, or a list of such");
    p.of.push_back(*path);
    if (!written) written = number;
  }
  p.name = short_name(p.of.front());
  const auto start = table.find("start");
  p.start = start ? as_number(*start) : *written;
  read_bounds(table, p);
  if (p.start < p.lower || p.start > p.upper)
    refuse(start.value_or(table.at("of")), fmt::format("starts at {:g}, outside its bounds", p.start),
           fmt::format("a number from {:g} to {:g}, or other bounds", p.lower, p.upper));
  p.logarithmic = p.lower > 0 && !p.name.starts_with("poisson_ratio");
  return p;
}

std::vector<std::size_t> read_fitted(const TomlTable& table, const Experiment& e) {
  std::vector<std::size_t> fitted;
  std::vector<std::string> names;
  for (std::size_t m = 0; m < e.measured.size(); ++m) {
    names.push_back(e.measured[m].name);
    if (e.measured[m].fitted) fitted.push_back(m);
  }
  const auto chosen = table.find("fit");
  if (!chosen) {
    if (fitted.empty())
      refuse(table.value(), "has nothing to fit", "fit, a list of measured values, or use = \"fit\" there");
    return fitted;
  }
  fitted.clear();
  for (const TomlValue& item : as_list(*chosen, "a list of names of measured values")) {
    const std::size_t number = as_choice_number(item, names);
    if (std::ranges::find(fitted, number) != fitted.end())
      refuse(item, fmt::format("'{}' is named twice", names[number]), "each value once");
    if (!std::isfinite(e.measured[number].value))
      refuse(item, fmt::format("'{}' is not measured yet", names[number]), "values that are");
    fitted.push_back(number);
  }
  return fitted;
}

std::string read_model(const TomlTable& table, const Experiment& e) {
  std::vector<std::string> allowed;
  for (const ModelChoice& m : e.models) allowed.push_back(m.label);
  for (const std::string& element : element_names()) allowed.push_back("fem_" + element);
  const auto model = table.find("model");
  return model ? as_choice(*model, allowed) : e.models.front().label;
}

/// The inputs with an uncertainty, those that the case fits among them.
std::vector<OtherInput> other_inputs(const toml::table& document, const Experiment& e,
                                     const std::vector<SoughtParameter>& parameters) {
  std::vector<OtherInput> inputs;
  for (std::size_t i = 0; i < e.inputs.size(); ++i) {
    if (e.inputs[i].kind == UncertainInput::Kind::alternative) continue;
    std::vector<std::string> changed;
    const toml::node* of = document["input"][i]["of"].node();
    if (const toml::array* several = of->as_array())
      for (const toml::node& path : *several) changed.push_back(path.value_or(std::string()));
    else
      changed.push_back(of->value_or(std::string()));
    OtherInput input{i, {}};
    for (std::size_t p = 0; p < parameters.size(); ++p)
      if (std::ranges::any_of(changed, [&](const std::string& path) {
            return std::find(parameters[p].of.begin(), parameters[p].of.end(), path) != parameters[p].of.end();
          }))
        input.sought.push_back(p);
    inputs.push_back(std::move(input));
  }
  return inputs;
}

/// @throws InputError for a number that two parameters are.
void check_parameters_differ(const TomlValue& place, const std::vector<SoughtParameter>& parameters) {
  std::set<std::string> seen;
  for (const SoughtParameter& p : parameters)
    for (const std::string& path : p.of)
      if (!seen.insert(path).second) refuse(place, fmt::format("'{}' is sought twice", path), "each number once");
}

Identification read_identification(const TomlValue& value, const Experiment& e) {
  const TomlTable table(value, keys_of("identify"));
  if (e.measured.empty()) refuse(value, "has nothing to fit", "beside [[measured]], or no such table");
  Identification out{as_text(table.at("name")), {}, read_fitted(table, e), read_model(table, e), {}, {}};
  const TomlValue parameters = table.at("parameters");
  for (const TomlValue& item : as_list(parameters, "a list of { of, start, bounds }"))
    out.parameters.push_back(read_parameter(item, e));
  check_parameters_differ(parameters, out.parameters);
  if (out.parameters.size() > out.fitted.size())
    refuse(parameters, fmt::format("{} parameters for {} fitted values", out.parameters.size(), out.fitted.size()),
           "as many values as parameters at least: more in fit, or fewer parameters");
  if (const auto cells = table.find("cells")) {
    if (e.body.is_voxels()) refuse(*cells, "is for blocks", "none beside a body of voxels");
    for (const TomlValue& item : as_list(*cells, "a list of [nx, ny, nz]")) out.cells.push_back(as_cells(item));
  }
  return out;
}

}  // namespace

void check_identifications(const Experiment& experiment) { identifications(experiment); }

std::vector<Identification> identifications(const Experiment& e) {
  const std::string file = e.file.string();
  const toml::table document = toml::parse(e.text, file);
  std::vector<Identification> all;
  const toml::node* tables = document.get("identify");
  if (!tables) return all;
  for (const TomlValue& value : TomlTable({&document, "", file, e.units}, keys_of("")).tables("identify")) {
    all.push_back(read_identification(value, e));
    all.back().inputs = other_inputs(document, e, all.back().parameters);
    for (std::size_t i = 0; i + 1 < all.size(); ++i)
      if (all[i].name == all.back().name)
        refuse(value, fmt::format("'{}' is the name of another", all[i].name), "a name of its own");
  }
  return all;
}

}  // namespace springproof
