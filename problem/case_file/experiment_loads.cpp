#include <fmt/format.h>

#include <algorithm>
#include <numbers>

#include "problem/case_file/experiment_parts.h"
#include "problem/exact_field.h"

namespace springproof {
namespace {

Load read_displacement(const TomlTable& table, const std::string& on) {
  PrescribedDisplacement load{on, {}};
  const TomlValue value = table.at("displacement_m");
  const std::string words = "[x, y, z], each a finite number or \"free\"";
  const auto items = as_list_of(3, value, words);
  bool any = false;
  for (int c = 0; c < 3; ++c) {
    if (const auto* text = items[c].node->as_string(); text && text->get() == "free") continue;
    load.displacement[c] = as_number(items[c], Range{"a finite number or \"free\""});
    any = true;
  }
  if (!any) refuse(value, "prescribes nothing", "at least one number");
  return load;
}

Load read_affine(const TomlTable& table, const std::string& on) {
  PrescribedAffine load{on};
  const auto rows = as_list_of(3, table.at("displacement_gradient"), "3 rows of 3 finite numbers");
  for (int r = 0; r < 3; ++r) load.gradient.row(r) = as_vector(rows[r]).transpose();
  if (const auto offset = table.find("displacement_m")) load.offset = as_vector(*offset);
  return load;
}

Load read_rotation(const TomlTable& table, const std::string& on) {
  const double degrees = as_number(table.at("rotation_deg"));
  return PrescribedRotation{on, as_vector(table.at("about_m")), as_direction(table.at("axis")),
                            degrees * std::numbers::pi / 180};
}

/// A kind of load is recognised by its keys and then read with those of its own.
struct LoadKind {
  const char* table;     ///< its keys in keys.h: "load." and the key that it is recognised by
  const char* together;  ///< a second key that must be there; null: none
  Load (*read)(const TomlTable&, const std::string& on);

  const char* mark() const { return table + std::string_view("load.").size(); }
};

std::vector<std::string> names_of_fields() {
  std::vector<std::string> names = exact_field_names();
  names.emplace_back("kelvin");
  return names;
}

using Table = const TomlTable&;
using Patch = const std::string&;

// The first matching kind is used, so the affine kind precedes the plain displacement and the point force the patch
// force.
// clang-format off
const LoadKind load_kinds[] = {
    {"load.displacement_gradient", nullptr, read_affine},
    {"load.displacement_m", nullptr, read_displacement},
    {"load.rotation_deg", nullptr, read_rotation},
    {"load.field", nullptr, [](Table t, Patch on) -> Load { return PrescribedField{on, as_choice(t.at("field"), names_of_fields())}; }},
    {"load.traction_Pa", nullptr, [](Table t, Patch on) -> Load { return Traction{on, as_vector(t.at("traction_Pa"))}; }},
    {"load.pressure_Pa", nullptr, [](Table t, Patch on) -> Load { return Pressure{on, as_number(t.at("pressure_Pa"))}; }},
    {"load.at_m", "force_N", [](Table t, Patch) -> Load { return PointForce{as_vector(t.at("at_m")), as_vector(t.at("force_N"))}; }},
    {"load.force_N", nullptr, [](Table t, Patch on) -> Load { return PatchForce{on, as_vector(t.at("force_N"))}; }},
    {"load.gravity_m_s2", nullptr, [](Table t, Patch) -> Load { return Gravity{as_vector(t.at("gravity_m_s2"))}; }},
    {"load.body_force_of", nullptr, [](Table t, Patch) -> Load { return FieldBodyForce{as_choice(t.at("body_force_of"), exact_field_names())}; }},
};
// clang-format on

/// The keys of loads of all kinds.
std::vector<Key> keys_of_loads() {
  std::vector<Key> keys;
  for (const LoadKind& kind : load_kinds)
    for (Key key : keys_of(kind.table)) {
      key.otherwise = "";  // none is required before the kind is known
      if (std::ranges::none_of(keys, [&](const Key& k) { return std::string_view(k.name) == key.name; }))
        keys.push_back(key);
    }
  return keys;
}

const LoadKind& kind_of(const TomlTable& table) {
  for (const LoadKind& kind : load_kinds)
    if (table.find(kind.mark()) && (!kind.together || table.find(kind.together))) return kind;
  refuse(table.value(), "says where but not what",
         "displacement_m, displacement_gradient, rotation_deg, field, traction_Pa, pressure_Pa, force_N, gravity_m_s2, "
         "body_force_of");
}

std::vector<std::string> read_patches(const TomlValue& value) {
  std::vector<std::string> patches;
  for (const TomlValue& item : one_or_several(value)) {
    const std::string patch = as_text(item);
    if (std::ranges::find(patches, patch) != patches.end())
      refuse(item, fmt::format("names '{}' twice", patch), "each patch once");
    patches.push_back(patch);
  }
  return patches;
}

}  // namespace

std::vector<Load> read_load(const TomlValue& value) {
  const LoadKind& kind = kind_of(TomlTable(value, keys_of_loads()));
  const TomlTable table(value, keys_of(kind.table));
  const auto on = table.find("on");
  if (!on) return {kind.read(table, "")};
  std::vector<Load> loads;
  for (const std::string& patch : read_patches(*on)) loads.push_back(kind.read(table, patch));
  return loads;
}

namespace {

/// A point, or the two ends of a segment.
std::vector<Vec3> read_place(const TomlValue& value) {
  constexpr const char* words = "[x, y, z], or two such";
  if (!as_list(value, words).front().node->is_array()) return {as_vector(value)};
  std::vector<Vec3> ends;
  for (const TomlValue& end : as_list_of(2, value, words)) ends.push_back(as_vector(end));
  if (ends[0] == ends[1]) refuse(value, "has no length", "two different ends, or one point");
  return ends;
}

AttachedMass read_mass(const TomlValue& value) {
  const TomlTable table(value, keys_of("mass"));
  AttachedMass mass{as_text(table.at("name")), "", {}, as_number(table.at("mass_kg"), positive_number)};
  const auto on = table.find("on"), at = table.find("at_m");
  if (on.has_value() == at.has_value())
    refuse(value, on ? "is both on a patch and at a place" : "has no place", "one of on and at_m");
  if (on) mass.on = as_text(*on);
  if (at) mass.at = read_place(*at);
  if (const auto weighs = table.find("weighs")) mass.weighs = as_flag(*weighs);
  return mass;
}

}  // namespace

void read_masses(const TomlTable& document, Experiment& experiment) {
  for (const TomlValue& value : document.tables("mass")) {
    const AttachedMass mass = read_mass(value);
    for (const AttachedMass& other : experiment.masses)
      if (other.name == mass.name)
        refuse(value, fmt::format("has the name '{}' of another mass", mass.name), "a name of its own");
    experiment.masses.push_back(mass);
    experiment.mass_locations.push_back(location_of(value));
    for (Load& load : weight_of(mass, experiment.loads)) {
      experiment.loads.push_back(std::move(load));
      experiment.load_locations.push_back(location_of(value));
      ++experiment.weights;
    }
  }
}

}  // namespace springproof
