// The units of a case file and of its results: inside the program everything is in SI.
#pragma once

#include <string>
#include <string_view>

namespace springproof {

enum class Units {
  m,  ///< SI: m, N, Pa, kg, s
  mm  ///< mm, N, MPa, tonnes, s
};

inline constexpr std::string_view names_of_units[] = {"m", "mm"};  ///< in the order of the enumeration

/// A unit, or a key that ends with one, as a case in these units has it.
struct Named {
  std::string name;
  double in_si;  ///< 1 of it in SI
};

/// What stands for a unit of SI as results have it: {"MPa", 1e6} for "Pa".  Others, like "1" and "s", are the same.
Named unit_in(Units units, std::string_view si);

/// How a key is written: {"size_mm", 1e-3} for "size_m".
Named key_in(Units units, std::string_view si);

/// The key whose name, in these units, this is: "size_m" of "size_mm"; the name itself, if it ends with no such unit.
std::string key_in_si(Units units, std::string_view name);

/// A text with every key in it as it is written in these units.
std::string with_keys_in(Units units, const std::string& text);

}  // namespace springproof
