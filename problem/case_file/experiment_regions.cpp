#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "problem/case_file/experiment_parts.h"
#include "problem/moduli.h"

namespace springproof {
namespace {

Range range_of(const ModulusName& modulus) {
  if (modulus.member == &Moduli::poisson_ratio) return {"-1 < poisson_ratio < 0.5", -1, 0.5};
  return modulus.member == &Moduli::lame_lambda ? any_number : positive_number;
}

/// In the lengths of the body's file, if it has no unit of its own.
EnclosedPlace read_enclosed(const TomlTable& table, const TomlValue& stl, const Experiment& e) {
  const double unit = unit_in(table.value().units, "m").in_si;
  const auto scale = table.find("scale");
  const bool as_body = !scale && !e.body.is_script() && !e.body.states_its_unit();
  return {e.file.parent_path() / as_text(stl),
          as_body ? e.body.scale : unit * (scale ? as_number(*scale, positive_number) : 1)};
}

/// The one thing that says where a region lies.
RegionPlace read_place(const TomlTable& table, const Experiment& e) {
  constexpr const char* one = "one of volume, box_m, near, beyond, stl";
  std::vector<RegionPlace> places;
  if (const auto volume = table.find("volume")) {
    const toml::value<std::int64_t>* number = volume->node->as_integer();
    places.emplace_back(number ? std::to_string(number->get()) : as_text(*volume));
  }
  if (const auto box = table.find("box_m")) places.emplace_back(read_box(*box));
  if (const auto near = table.find("near")) places.emplace_back(read_near(*near));
  if (const auto beyond = table.find("beyond")) places.emplace_back(read_beyond(*beyond));
  const auto stl = table.find("stl");
  if (stl) places.emplace_back(read_enclosed(table, *stl, e));
  if (const auto scale = table.find("scale"); scale && !stl) refuse(*scale, "is of a file", "beside stl");
  if (places.empty()) refuse(table.value(), "does not say where it lies", one);
  if (places.size() > 1) refuse(table.value(), "says twice where it lies", one);
  return places.front();
}

MaterialRegion read_region(const TomlValue& value, const Experiment& e) {
  const TomlTable table(value, keys_of("region"));
  return {as_text(table.at("name")), read_moduli(table, e.materials.front().density).front(), location_of(value),
          read_place(table, e)};
}

/// The first modulus of a table that is a list of at least so many.
std::optional<TomlValue> list_in(const TomlTable& table, std::size_t fewest) {
  for (const ModulusName& modulus : modulus_names)
    if (const auto given = table.find(modulus.key);
        given && given->node->is_array() && one_or_several(*given).size() >= fewest)
      return given;
  return {};
}

/// Of which modulus a region's materials are a list: Poisson's ratio, or where it is the same of all (a list of one: is
/// no list), Young's modulus.
ListedModuli told_apart(std::size_t region, std::vector<IsotropicMaterial> materials, const TomlValue& list) {
  const double nu = materials.front().poisson_ratio;
  const bool of_one = materials.size() == 1;
  const bool stiffness =
      of_one ? !list.key.ends_with("poisson_ratio")
             : std::ranges::all_of(materials, [&](const auto& m) { return same_poisson_ratio(m.poisson_ratio, nu); });
  ListedModuli listed{region, stiffness, std::move(materials)};
  std::vector<double> known;
  for (const IsotropicMaterial& m : listed.materials) {
    const double value = stiffness ? m.youngs_modulus : m.poisson_ratio;
    if (std::ranges::find(known, value) != known.end())
      refuse(list, fmt::format("gives the {} {} twice", stiffness ? "Young's modulus" : "Poisson's ratio", value),
             "each once");
    known.push_back(value);
  }
  return listed;
}

}  // namespace

std::vector<IsotropicMaterial> read_moduli(const TomlTable& table, double density) {
  const TomlValue& value = table.value();
  if (const auto given = table.find("density_kg_m3")) density = as_number(*given, positive_number);
  std::vector<std::string> names;
  std::vector<Moduli> solids(1);
  for (const ModulusName& modulus : modulus_names) {
    const auto given = table.find(modulus.key);
    if (!given) continue;
    names.emplace_back(modulus.key);
    const auto items = one_or_several(*given);
    if (solids.size() == 1) solids.resize(items.size(), solids.front());
    if (items.size() != 1 && items.size() != solids.size())
      refuse(*given, fmt::format("is a list of {}", items.size()),
             fmt::format("a list of {}, as above", solids.size()));
    for (std::size_t i = 0; i < solids.size(); ++i)
      solids[i].*modulus.member = as_number(items[items.size() == 1 ? 0 : i], range_of(modulus));
  }
  if (names.size() != 2)
    refuse(value,
           fmt::format("has {} elastic moduli{}{}", names.size(), names.empty() ? "" : ": ", fmt::join(names, ", ")),
           "exactly two of youngs_modulus_Pa, poisson_ratio, shear_modulus_Pa, bulk_modulus_Pa, lame_lambda_Pa");
  std::vector<IsotropicMaterial> materials;
  for (const Moduli& given : solids) try {
      materials.push_back(material_from(given, density));
    } catch (const std::invalid_argument& error) {
      throw InputError(location_of(value), fmt::format("{}: {}", value.key, error.what()));
    }
  return materials;
}

std::vector<MaterialRegion> read_regions(const TomlTable& document, const Experiment& experiment) {
  constexpr std::size_t most = 255;  // numbers of Mesh::materials
  std::vector<MaterialRegion> regions;
  for (const TomlValue& value : document.tables("region")) {
    const TomlValue name = TomlTable(value, keys_of("region")).at("name");
    if (read_own_name(name, regions, " region") == "body")  // as interface.NAME.body names what is in none
      refuse(name, "'body' is the rest of the body", "another name");
    regions.push_back(read_region(value, experiment));
    if (regions.size() > most) refuse(value, fmt::format("is number {}", regions.size()), "up to 255 regions");
  }
  return regions;
}

ListedModuli read_listed(const TomlTable& document, const Experiment& e) {
  ListedModuli listed;
  std::optional<TomlValue> first = list_in(TomlTable(document.at("material"), keys_of("material")), 2);
  const std::vector<TomlValue> tables = document.tables("region");
  for (std::size_t r = 0; r < tables.size(); ++r) {
    const TomlTable table(tables[r], keys_of("region"));
    const std::optional<TomlValue> list = list_in(table, 1);
    if (!list) continue;
    if (first)
      refuse(*list,
             fmt::format("of '{}' is a list, and {} in line {} is one", e.regions[r].name, first->key,
                         location_of(*first).line),
             "a list in one place of the file");
    first = list;
    listed = told_apart(r + 1, read_moduli(table, e.materials.front().density), *list);
  }
  return listed;
}

void check_regions(const Experiment& e) {
  if (e.regions.empty()) return;
  const auto refuse_if = [&, &first = e.regions.front()](bool is_there, const char* what, const char* allowed) {
    if (is_there)
      throw InputError(first.where, fmt::format("region: '{}': {} (allowed: {})", first.name, what, allowed));
  };
  refuse_if(e.reference.smooth, "strains jump where materials meet", "smooth = false in [reference]");
  refuse_if(e.asks_for("promised_error"), "strains jump where materials meet, which promised_error takes for an error",
            "other measures");
  refuse_if(e.parts, "the parts of errors are of one material", "no parts in [compare]");
  refuse_if(e.fracture.has_value(), "drying bodies are of one material", "no [fracture]");
  refuse_if(e.relaxation.acts(), "relaxation is of one material", "no [material.relaxation]");
  refuse_if(e.line || !e.exact.empty(), "exact fields are of one material", "no [line] and no exact");
  const auto by_field = [](const Load& load) {
    return std::holds_alternative<FieldBodyForce>(load) || std::holds_alternative<PrescribedField>(load);
  };
  refuse_if(std::ranges::any_of(e.loads, by_field), "exact fields are of one material", "no load by a field");
}

void require_one_listed(const Experiment& e) {
  if (e.listed.materials.size() < 2) return;
  throw InputError(e.regions[e.listed.region - 1].where,
                   fmt::format("region: {} is a list (allowed here: one number, or --poisson-ratio with one of {})",
                               e.listed_words(), fmt::join(e.settings(), ", ")));
}

void require_one_material(const Experiment& e, const std::string& what) {
  if (e.regions.empty()) return;
  const MaterialRegion& first = e.regions.front();
  throw InputError(first.where,
                   fmt::format("region: '{}': {} is for bodies of one material (allowed: no [[region]], or "
                               "springproof compare)",
                               first.name, what));
}

}  // namespace springproof
