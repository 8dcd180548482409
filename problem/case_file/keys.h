// The keys of a case file: what each is, what it may be, what holds without it.  The readers check against them, and
// docs/keys.md is printed from them.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace springproof {

/// A key of a table.
struct Key {
  const char* name;       ///< ends with the unit of its value, if that has one: "duration_s"
  const char* what;       ///< its meaning
  const char* allowed;    ///< type and range of its value, in the words of a refusal
  const char* otherwise;  ///< what holds without it; null: it is required
  const char* example;    ///< a value in TOML; "": it heads a table of its own
};

/// A table of the case file, or one kind of its [[load]]s.
struct KeyTable {
  const char* name;     ///< "dynamics.plane", "load.pressure_Pa"; "" for the file itself
  const char* heading;  ///< "[dynamics]"; of a [[load]] its kind, "a rotation"; "" of a table inside another
  const char* what;     ///< what it says, and in which cases it may stand
  std::span<const Key> keys;
};

/// All tables, in the order in which they are explained.
std::span<const KeyTable> key_tables();

/// The keys of a table.
/// @throws std::logic_error if there is no table of this name.
std::span<const Key> keys_of(std::string_view table);

/// The tables as a page in Markdown, docs/keys.md.
std::string keys_page();

}  // namespace springproof
