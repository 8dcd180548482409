#include <fmt/format.h>

#include <utility>

#include "problem/case_file/keys.h"
#include "problem/case_file/units.h"

namespace springproof {
namespace {

/// What a refusal says of a value, and how the page says it.
constexpr std::pair<std::string_view, std::string_view> on_page[] = {
    {", each a finite number or \"free\"", ", \"free\" in place of any"},
    {"each a finite number >", "each >"},
    {", each a finite number", ""},
    {"a finite number", "number"},
    {"a whole number", "integer"},
    {"an integer", "integer"},
    {"a number", "number"},
    {", or a list of such", " or list"},
};

/// "" of a key that heads a table of its own.
std::string value_of(const Key& key) {
  std::string value = *key.example ? key.allowed : "";
  for (const auto& [said, shorter] : on_page)
    if (const auto at = value.find(said); at != std::string::npos) value.replace(at, said.size(), shorter);
  return value;
}

std::string section_of(std::string_view heading, std::string_view what) {
  return fmt::format("\n## {}\n\n{}{}| key | what | value | default | example |\n|---|---|---|---|---|\n", heading,
                     what, what.empty() ? "" : "\n\n");
}

/// `inside`: "plane." of a key of the table plane of [dynamics].
std::string row_of(const Key& key, std::string_view inside) {
  return fmt::format("| `{}{}` | {} | {} | {} | {} |\n", inside, key.name, key.what, value_of(key),
                     key.otherwise ? key.otherwise : "required",
                     *key.example ? fmt::format("`{}`", key.example) : "below");
}

/// Whether a table above it with the same root has the same key.
bool stands_above(const KeyTable& table, const Key& key) {
  const auto root = [](std::string_view name) { return name.substr(0, name.find('.')); };
  for (const KeyTable* above = key_tables().data(); above != &table; ++above)
    if (root(above->name) == root(table.name))
      for (const Key& other : above->keys)
        if (std::string_view(other.name) == key.name && std::string_view(other.what) == key.what) return true;
  return false;
}

}  // namespace

std::string keys_page() {
  std::string page =
      "# Keys of a case file\n\n"
      "Printed by `springproof describe keys`. A case is a file in TOML; the [tutorial](tutorial.md) has a first one. "
      "Any other key, type or number is refused with its line, what is allowed and the nearest key. Numbers are "
      "finite, in the unit that their key ends with; x, y, z are numbers.\n";
  bool loads = false;
  for (const KeyTable& table : key_tables()) {
    const std::string_view name = table.name;
    const bool load = name.starts_with("load.");
    if (load && !std::exchange(loads, true))
      page += section_of("[[load]]",
                         "One of these kinds; all but the last three act on a patch or a list of patches: "
                         "`on = \"x_min\"`.");
    if (load)
      page += fmt::format("| *{}* | {} | | | |\n", table.heading, table.what);
    else if (*table.heading)
      page += section_of(table.heading, table.what);
    const std::string inside = *table.heading ? "" : fmt::format("{}.", name.substr(name.find('.') + 1));
    for (const Key& key : table.keys)
      if (load ? std::string_view(key.name) != "on" : inside.empty() || !stands_above(table, key))
        page += row_of(key, inside);
  }
  page +=
      "\n## Units\n\nUnder `units = \"mm\"` keys end as below; files of bodies (but STEP, which states its unit) "
      "and of `[[external]]` are in mm, values of `[[expect]]`, `[[published]]`, results and report in mm, N, MPa "
      "and t. Springs files, VTU, glTF and notes stay in SI.\n\n"
      "| `units` | in place of `_m` | `_Pa` | `_kg_m3` | `_kg` | `_m_s2` | `_m_s` |\n|---|---|---|---|---|---|---|\n| "
      "`\"mm\"` |";
  for (const char* ending : {"_m", "_Pa", "_kg_m3", "_kg", "_m_s2", "_m_s"})
    page += fmt::format(" `{}` |", key_in(Units::mm, ending).name);
  return page + "\n";
}

}  // namespace springproof
