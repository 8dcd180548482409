// Reading TOML against a list of keys (keys.h): every unknown key, missing key, wrong type and value out of range
// raises an InputError with its location and what is allowed.
#pragma once

#include <toml++/toml.h>

#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "problem/case_file/experiment.h"
#include "problem/case_file/keys.h"
#include "problem/case_file/units.h"

namespace springproof {

/// One node of the document with what an error message needs.
struct TomlValue {
  const toml::node* node;
  std::string key;  ///< "material.poisson_ratio"
  std::string file;
  Units units = Units::m;  ///< of the case
  double in_si = 1;        ///< by which numbers in it are multiplied
};

/// An interval of numbers; `low_in` and `high_in` include its ends.  Never contains inf or nan.
struct Range {
  const char* words;  ///< "> 0"
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  bool low_in = false;
  bool high_in = false;

  bool contains(double x) const { return (x > low || (low_in && x == low)) && (x < high || (high_in && x == high)); }
};

/// Magnitudes of nonzero numbers lie between these, so that products of a few of them neither overflow nor underflow.
inline constexpr double smallest_number = 1e-30, largest_number = 1e30;

inline constexpr Range any_number{"a finite number"};
inline constexpr Range positive_number{"a finite number > 0", 0};
inline constexpr Range not_negative{"a finite number >= 0", 0, std::numeric_limits<double>::infinity(), true};

/// @throws InputError "FILE:LINE:COLUMN: key: what is wrong (allowed: ...)"; `hint` follows, e.g. "; did you
/// mean 'x'?".
[[noreturn]] void refuse(const TomlValue& value, const std::string& what, const std::string& allowed,
                         const std::string& hint = "");

/// Refuses a table without a key.
[[noreturn]] void missing(const TomlValue& table, const std::string& key, const std::string& allowed);

SourceLocation location_of(const TomlValue& value);

inline constexpr std::size_t largest_case_file = 4 << 20;  ///< [bytes]

/// Refuses input that would exhaust the parser's stack or take it too long: files beyond 4 MiB, keys of more than 16
/// parts, tables and lists more than 16 deep.
/// @throws InputError
void require_bounded(std::string_view text, const std::string& file);

/// In SI; the range is that of the number in SI.
double as_number(const TomlValue& value, const Range& range = any_number);
int as_whole(const TomlValue& value, int low, int high);  ///< an integer from `low` to `high`
bool as_flag(const TomlValue& value);
std::string as_text(const TomlValue& value);  ///< not empty
std::string as_choice(const TomlValue& value, const std::vector<std::string>& names);
std::size_t as_choice_number(const TomlValue& value, const std::vector<std::string>& names);  ///< of the name
std::vector<TomlValue> as_list(const TomlValue& value, const std::string& words);             ///< not empty
std::vector<TomlValue> as_list_of(std::size_t count, const TomlValue& value, const std::string& words);
Vec3 as_vector(const TomlValue& value, const Range& range = any_number);
Vec3 as_direction(const TomlValue& value);  ///< not zero; returned with length 1
Cells as_cells(const TomlValue& value);     ///< three integers 1..1000

/// The value itself, or its items if it is a list: for keys that take one or several.
std::vector<TomlValue> one_or_several(const TomlValue& value);

/// A table whose keys have been checked against keys.h, and are found by their names in SI.
class TomlTable {
 public:
  /// @throws InputError if the value is no table, has a key that is not among these or lacks a required one.
  TomlTable(const TomlValue& value, std::span<const Key> keys);

  std::optional<TomlValue> find(const std::string& key) const;
  TomlValue at(const std::string& key) const;  ///< a key that is required
  const TomlValue& value() const { return value_; }

  /// The tables of [[key]], in order; none if the key is missing.
  std::vector<TomlValue> tables(const std::string& key) const;

 private:
  TomlValue value_;
};

}  // namespace springproof
