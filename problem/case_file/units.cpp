#include "problem/case_file/units.h"

#include <algorithm>
#include <cctype>

#include "problem/case_file/keys.h"

namespace springproof {
namespace {

struct Row {
  std::string_view si, mm;
  double mm_in_si;
};

constexpr Row units_of_results[] = {{"m", "mm", 1e-3},       {"Pa", "MPa", 1e6},        {"N m", "N mm", 1e-3},
                                    {"J", "mJ", 1e-3},       {"J/m2", "mJ/mm2", 1e3},   {"1/m", "1/mm", 1e3},
                                    {"m/s²", "mm/s²", 1e-3}, {"kg/m³", "t/mm³", 1e12},  {"kg", "t", 1e3},
                                    {"kg m/s", "t mm/s", 1}, {"N m s", "N mm s", 1e-3}, {"kg m^2/s", "t mm^2/s", 1e-3}};

// Of the endings of keys, longer ones first; those with the same name in both hide the shorter ones that they end with.
constexpr Row endings_of_keys[] = {{"_kg_m3", "_t_mm3", 1e12}, {"_m_s2", "_mm_s2", 1e-3}, {"_m_s", "_mm_s", 1e-3},
                                   {"_Pa", "_MPa", 1e6},       {"_kg", "_t", 1e3},        {"_m", "_mm", 1e-3}};

bool is_part_of_a_key(char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '_'; }

bool is_key(std::string_view name) {
  const auto tables = key_tables();
  return std::ranges::any_of(tables, [&](const KeyTable& table) {
    return std::ranges::any_of(table.keys, [&](const Key& key) { return key.name == name; });
  });
}

}  // namespace

Named unit_in(Units units, std::string_view si) {
  if (units == Units::mm)
    for (const Row& row : units_of_results)
      if (row.si == si) return {std::string(row.mm), row.mm_in_si};
  return {std::string(si), 1};
}

Named key_in(Units units, std::string_view si) {
  if (units == Units::mm)
    for (const Row& row : endings_of_keys)
      if (si.ends_with(row.si))
        return {std::string(si.substr(0, si.size() - row.si.size())).append(row.mm), row.mm_in_si};
  return {std::string(si), 1};
}

std::string key_in_si(Units units, std::string_view name) {
  if (units == Units::mm)
    for (const Row& row : endings_of_keys)
      if (name.ends_with(row.mm)) return std::string(name.substr(0, name.size() - row.mm.size())).append(row.si);
  return std::string(name);
}

std::string with_keys_in(Units units, const std::string& text) {
  std::string out;
  for (auto at = text.begin(); at != text.end();) {
    const auto end = std::find_if_not(at, text.end(), is_part_of_a_key);
    const std::string word(at, end);
    out += is_key(word) ? key_in(units, word).name : word;
    at = end;
    if (at != text.end()) out += *at++;
  }
  return out;
}

}  // namespace springproof
