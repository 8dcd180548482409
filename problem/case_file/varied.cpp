#include "problem/case_file/varied.h"

#include <fmt/format.h>

#include <charconv>

#include "problem/case_file/experiment_parts.h"

namespace springproof {
namespace {

/// What a path names: a key of a table, or an item of a list.
struct Place {
  toml::node* parent = nullptr;
  std::string key = {};    ///< of a table
  std::size_t number = 0;  ///< of a list

  toml::node* node() const {
    if (toml::table* table = parent->as_table()) return table->get(key);
    return parent->as_array()->get(number);
  }
};

bool is_whole_number(const std::string& text, std::size_t& number) {
  const char* end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data(), end, number);
  return error == std::errc() && rest == end;
}

/// "body.size_m[2]" from the root; empty: there is no such key or item.
std::optional<Place> place_of(toml::table& document, const std::string& path) {
  Place place{&document};
  toml::node* node = &document;
  for (std::size_t at = 0; at < path.size();) {
    const bool item = path[at] == '[';
    if (at > 0 && !item && path[at] != '.') return {};
    const std::size_t begin = at + (item || at > 0 ? 1 : 0), found = path.find_first_of(item ? "]" : ".[", begin);
    if (item && found == std::string::npos) return {};
    const std::size_t end = std::min(found, path.size());
    const std::string part = path.substr(begin, end - begin);
    at = end + (item ? 1 : 0);
    place = {node, part};
    if (part.empty() || !node || !(item ? node->is_array() : node->is_table())) return {};
    if (item && !is_whole_number(part, place.number)) return {};
    node = place.node();
  }
  return place;
}

template <class Value>
void set(const Place& place, const Value& value) {
  if (toml::table* table = place.parent->as_table())
    table->insert_or_assign(place.key, value);
  else
    place.parent->as_array()->replace(place.parent->as_array()->begin() + static_cast<std::ptrdiff_t>(place.number),
                                      value);
}

bool has(toml::table& document, const std::string& path) {
  const std::optional<Place> place = place_of(document, path);
  return place && place->node();
}

/// Refuses a table in place of another, or of a list: what a key with dots means unless it is quoted.
void check_quotes(const TomlValue& change, const Place& place) {
  const toml::node* there = place.node();
  if (change.node->is_table() && there && (there->is_table() || there->is_array()))
    refuse(change, fmt::format("'{}' would be replaced by a table", place.key),
           "a key of it, in quotes: \"mass[0].mass_kg\"");
}

/// Sets what the keys of `with` name, but for those of `whole`, where it is given, that the document has no more.
void replace(const TomlValue& with, toml::table* whole, toml::table& document) {
  const toml::table* changes = with.node->as_table();
  if (!changes || changes->empty()) refuse(with, "is no change", "keys of the case with other values");
  for (const auto& [key, value] : *changes) {
    const std::string path(key.str());
    if (whole && has(*whole, path) && !has(document, path)) continue;
    const std::optional<Place> place = place_of(document, path);
    const auto* list = value.as_array();
    const bool leaves_out = list && list->empty();
    if (!place || ((leaves_out || place->parent->is_array()) && !place->node()))
      refuse({&value, with.key, with.file}, fmt::format("'{}' names nothing in the case", path),
             "a key as written here, mass[0].mass_kg");
    check_quotes({&value, with.key, with.file}, *place);
    if (leaves_out && place->parent->is_table())
      place->parent->as_table()->erase(place->key);
    else
      value.visit([&](const auto& v) { set(*place, v); });
  }
}

/// Adds its u to the numbers that an input is.
void add(const TomlValue& input, bool must_be_there, toml::table& document) {
  const toml::table& table = *input.node->as_table();
  const double u = *table.get("u")->value<double>();
  for (const TomlValue& item : one_or_several({table.get("of"), input.key + ".of", input.file})) {
    const std::optional<Place> place = place_of(document, as_text(item));
    const toml::node* number = place ? place->node() : nullptr;
    if (number && number->is_number())
      set(*place, *number->value<double>() + u);
    else if (must_be_there)
      refuse(item, fmt::format("'{}' is no number of the case", as_text(item)),
             "a key as written here, body.size_m[2], or a list of such");
  }
}

TomlValue table_of(toml::table& document, const char* name, std::size_t number, const std::string& file) {
  return {document.get_as<toml::array>(name)->get(number), name, file};
}

/// Refuses a path to an item of a list that a load case has replaced: it may be another one there.
void check_items(const TomlValue& value, const std::string& path, const toml::table& replaced) {
  for (const auto& [key, list] : replaced) {
    const toml::array* items = list.as_array();
    if (items && !items->empty() && !items->front().is_number() && path.starts_with(std::string(key.str()) + '['))
      refuse(value, fmt::format("'{}' is of a list that a load case replaces", path),
             fmt::format("a load case with changes in its items, {}", path));
  }
}

/// Of the paths of an [[input]].
void check_items(const TomlValue& input, const toml::table& replaced) {
  const toml::table& table = *input.node->as_table();
  if (const toml::node* with = table.get("with"); with && with->is_table())
    for (const auto& [key, value] : *with->as_table())
      check_items({&value, "input.with", input.file}, std::string(key.str()), replaced);
  if (const toml::node* of = table.get("of"))
    for (const TomlValue& item : one_or_several({of, "input.of", input.file}))
      check_items(item, as_text(item), replaced);
}

/// Sets numbers that are there.
void set_numbers(const std::vector<OtherNumber>& numbers, toml::table& document) {
  for (const OtherNumber& number : numbers)
    for (const std::string& path : number.of) set(place_of(document, path).value(), number.value);
}

}  // namespace

std::optional<double> number_of(const Experiment& e, const std::string& path) {
  toml::table document = toml::parse(e.text, e.file.string());
  const std::optional<Place> place = place_of(document, path);
  const toml::node* node = place ? place->node() : nullptr;
  return node && node->is_number() ? node->value<double>() : std::optional<double>();
}

Experiment varied(const Experiment& e, const Variation& variation) {
  const std::string file = e.file.string();
  toml::table as_written = toml::parse(e.text, file), document = as_written;
  set_numbers(variation.numbers, document);
  SourceLocation where;
  const LoadCase& loads = e.load_cases.at(variation.load_case);
  if (loads.table > 0) {
    const TomlValue load_case = table_of(as_written, "load_case", loads.table, file);
    where = location_of(load_case);
    const toml::node* with = load_case.node->as_table()->get("with");
    replace({with, "load_case.with", file}, nullptr, document);
    if (variation.input) check_items(table_of(as_written, "input", *variation.input, file), *with->as_table());
  }
  if (loads.loaded_for)
    if (const auto place = place_of(document, "material.relaxation.equilibrium_after_s"))
      set(*place, *loads.loaded_for);
  if (variation.input) {
    const TomlValue input = table_of(as_written, "input", *variation.input, file);
    where = location_of(input);
    if (const toml::node* with = input.node->as_table()->get("with"))
      replace({with, "input.with", file}, loads.table > 0 ? &as_written : nullptr, document);
    else
      add(input, loads.table == 0, document);
  }
  for (const char* name : {"measured", "load_case", "input", "identify", "expect", "published"}) document.erase(name);
  try {
    Experiment changed = read_document(document, e);
    changed.measures = e.measures;
    return changed;
  } catch (const InputError& refused) {
    throw InputError(where, fmt::format("with this change the case is refused: {}", refused.what()));
  }
}

}  // namespace springproof
