#include <fmt/format.h>

#include <algorithm>
#include <numbers>

#include "problem/case_file/experiment_parts.h"
#include "problem/exact_field.h"

namespace springproof {
namespace {

constexpr const char* patch_words = "a patch name or a list of them";
constexpr const char* vector_words = "[x, y, z]";

constexpr Key on_key = {"on", patch_words};

constexpr Key displacement_schema[] = {on_key, {"displacement_m", "[x, y, z], each a number or \"free\""}};
constexpr Key affine_schema[] = {on_key, {"displacement_gradient", "3 rows of 3 numbers"}, {"displacement_m"}};
constexpr Key rotation_schema[] = {on_key,
                                   {"rotation_deg", "an angle"},
                                   {"axis", "[x, y, z], the direction of the axis"},
                                   {"about_m", "[x, y, z], a point of the axis"}};
constexpr Key field_schema[] = {on_key, {"field", "the name of an exact field"}};
constexpr Key pressure_schema[] = {on_key, {"pressure_Pa", "a number"}};
constexpr Key body_force_schema[] = {{"body_force_of", "the name of an exact field"}};
constexpr Key traction_schema[] = {on_key, {"traction_Pa", vector_words}};
constexpr Key patch_force_schema[] = {on_key, {"force_N", vector_words}};
constexpr Key point_force_schema[] = {{"force_N", vector_words}, {"at_m", "[x, y, z], a rest position"}};
constexpr Key gravity_schema[] = {{"gravity_m_s2", vector_words}};

constexpr Key any_load_schema[] = {
    {"on"},    {"displacement_m"}, {"displacement_gradient"}, {"rotation_deg"}, {"axis"},         {"about_m"},
    {"field"}, {"traction_Pa"},    {"pressure_Pa"},           {"force_N"},      {"gravity_m_s2"}, {"body_force_of"},
    {"at_m"}};

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

Load read_field(const TomlTable& table, const std::string& on) {
  std::vector<std::string> names = exact_field_names();
  names.emplace_back("kelvin");
  return PrescribedField{on, as_choice(table.at("field"), names)};
}

Load read_pressure(const TomlTable& table, const std::string& on) {
  return Pressure{on, as_number(table.at("pressure_Pa"))};
}

Load read_traction(const TomlTable& table, const std::string& on) {
  return Traction{on, as_vector(table.at("traction_Pa"))};
}

Load read_patch_force(const TomlTable& table, const std::string& on) {
  return PatchForce{on, as_vector(table.at("force_N"))};
}

Load read_point_force(const TomlTable& table, const std::string&) {
  return PointForce{as_vector(table.at("at_m")), as_vector(table.at("force_N"))};
}

Load read_gravity(const TomlTable& table, const std::string&) { return Gravity{as_vector(table.at("gravity_m_s2"))}; }

Load read_body_force(const TomlTable& table, const std::string&) {
  return FieldBodyForce{as_choice(table.at("body_force_of"), exact_field_names())};
}

/// A kind of load is recognised by its keys and then read with its own schema.
struct LoadKind {
  const char* marks[2];  ///< keys that must all be present (nullptr: no second)
  std::span<const Key> schema;
  Load (*read)(const TomlTable&, const std::string& on);
};

// The first matching kind is used, so the affine kind precedes the plain displacement and the point force the patch
// force.
const LoadKind load_kinds[] = {
    {{"displacement_gradient", nullptr}, affine_schema, read_affine},
    {{"displacement_m", nullptr}, displacement_schema, read_displacement},
    {{"rotation_deg", nullptr}, rotation_schema, read_rotation},
    {{"field", nullptr}, field_schema, read_field},
    {{"traction_Pa", nullptr}, traction_schema, read_traction},
    {{"pressure_Pa", nullptr}, pressure_schema, read_pressure},
    {{"force_N", "at_m"}, point_force_schema, read_point_force},
    {{"force_N", nullptr}, patch_force_schema, read_patch_force},
    {{"gravity_m_s2", nullptr}, gravity_schema, read_gravity},
    {{"body_force_of", nullptr}, body_force_schema, read_body_force},
};

const LoadKind& kind_of(const TomlTable& table) {
  for (const LoadKind& kind : load_kinds)
    if (table.find(kind.marks[0]) && (!kind.marks[1] || table.find(kind.marks[1]))) return kind;
  refuse(table.value(), "says where but not what",
         "displacement_m, displacement_gradient, rotation_deg, field, traction_Pa, pressure_Pa, force_N, gravity_m_s2, "
         "body_force_of");
}

std::vector<std::string> read_patches(const TomlValue& value) {
  std::vector<std::string> patches;
  for (const TomlValue& item : one_or_several(value)) {
    const std::string patch = as_text(item);
    if (std::find(patches.begin(), patches.end(), patch) != patches.end())
      refuse(item, fmt::format("names '{}' twice", patch), "each patch once");
    patches.push_back(patch);
  }
  return patches;
}

}  // namespace

std::vector<Load> read_load(const TomlValue& value) {
  const LoadKind& kind = kind_of(TomlTable(value, any_load_schema));
  const TomlTable table(value, kind.schema);
  const auto on = table.find("on");
  if (!on) return {kind.read(table, "")};
  std::vector<Load> loads;
  for (const std::string& patch : read_patches(*on)) loads.push_back(kind.read(table, patch));
  return loads;
}

}  // namespace springproof
