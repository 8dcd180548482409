#include "problem/case_file/toml_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "problem/system/nearest_name.h"

namespace springproof {
namespace {

std::string type_of(const toml::node& node) {
  switch (node.type()) {
    case toml::node_type::table:
      return "a table";
    case toml::node_type::array:
      return "a list";
    case toml::node_type::string:
      return fmt::format("the string '{}'", node.ref<std::string>());
    case toml::node_type::integer:
      return fmt::format("the integer {}", node.ref<std::int64_t>());
    case toml::node_type::floating_point:
      return fmt::format("the number {}", node.ref<double>());
    case toml::node_type::boolean:
      return node.ref<bool>() ? "true" : "false";
    default:
      return "a date or time";
  }
}

[[noreturn]] void wrong_type(const TomlValue& value, const std::string& allowed) {
  refuse(value, "is " + type_of(*value.node), allowed);
}

std::string join_key(const std::string& table, std::string_view key) {
  return table.empty() ? std::string(key) : fmt::format("{}.{}", table, key);
}

// What stands here for a key by another name that is usual, or that there is nothing of the kind.
// clang-format off
constexpr std::pair<std::string_view, std::string_view> usual_names[] = {
  {"damping_ratio",   "loss_factor with band_Hz is twice the damping ratio"},
  {"damping",         "damping_1_s is a rate, loss_factor with band_Hz twice the damping ratio"},
  {"E",               "youngs_modulus_Pa is Young's modulus"},
  {"youngs_modulus",  "youngs_modulus_Pa is Young's modulus"},
  {"nu",              "poisson_ratio is Poisson's ratio"},
  {"poissons_ratio",  "poisson_ratio is Poisson's ratio"},
  {"rho",             "density_kg_m3 is the density"},
  {"density",         "density_kg_m3 is the density"},
  {"fixed",           "displacement_m = [0, 0, 0] in a [[load]] holds a patch"},
  {"fix",             "displacement_m = [0, 0, 0] in a [[load]] holds a patch"},
  {"support",         "displacement_m = [0, 0, 0] in a [[load]] holds a patch"},
  {"gravity",         "gravity_m_s2 in a [[load]] is gravity"},
  {"force",           "force_N in a [[load]] is a force"},
  {"pressure",        "pressure_Pa in a [[load]] is a pressure"},
  {"thickness",       "there are no shells: a body is a solid, and a thin one has cells that are smaller than it is thick"},
  {"shell",           "there are no shells: a body is a solid, and a thin one has cells that are smaller than it is thick"},
  {"cloth",           "there is no cloth: a body is a solid"},
  {"contact",         "there is no contact but with a plane: plane of [dynamics]"},
  {"self_contact",    "there is no contact but with a plane: plane of [dynamics]"},
  {"sphere",          "there is no contact but with a plane: plane of [dynamics]"},
  {"regions",         "[[region]] is a part of the body of another material"},
  {"materials",       "[material] is the body's, [[region]] that of a part of it"},
  {"inclusion",       "[[region]] is a part of the body of another material"},
  {"fibres",          "materials are isotropic: there are no fibres"},
  {"fibers",          "materials are isotropic: there are no fibres"},
};
// clang-format on

/// Why a key may have been written that is none of these.
std::string hint(const std::string& name, const std::vector<std::string>& names, Units units) {
  const bool mm = units == Units::mm;
  const std::string in_these = mm ? key_in(units, name).name : key_in_si(Units::mm, name);
  if (in_these != name && std::ranges::find(names, in_these) != names.end())
    return mm ? fmt::format("; under units = \"mm\" it is {}", in_these)
              : fmt::format("; {}, or units = \"mm\" at the top of the file", in_these);
  for (const auto& [usual, words] : usual_names)
    if (usual == name) return fmt::format("; {}", with_keys_in(units, std::string(words)));
  return did_you_mean(name, names);
}

void refuse_unknown_keys(const TomlValue& value, const toml::table& table, std::span<const Key> keys) {
  std::vector<std::string> names;
  for (const Key& key : keys) names.push_back(key_in(value.units, key.name).name);
  for (const auto& [key, node] : table) {
    const std::string name(key.str());
    if (std::ranges::find(names, name) != names.end()) continue;
    const auto begin = key.source().begin;
    throw InputError(SourceLocation{value.file, static_cast<int>(begin.line), static_cast<int>(begin.column)},
                     fmt::format("{}: unknown key (allowed: {}){}", join_key(value.key, name), fmt::join(names, ", "),
                                 hint(name, names, value.units)));
  }
}

/// Scans TOML, skipping strings and comments, and limits the nesting depth of keys, tables and lists.
class DepthCounter {
 public:
  DepthCounter(std::string_view text, const std::string& file) : text_(text), file_(file) {}

  void run() {
    while (at_ < text_.size()) step();
  }

 private:
  static constexpr int deepest = 16;

  void step() {
    const char c = text_[at_];
    if (c == '"' || c == '\'') return skip_string(c);
    if (c == '#') return skip_to(text_.find('\n', at_));
    if (c == '.') count(parts_, "parts of a key");
    if (c == '[' || c == '{') count(open_, "tables and lists in each other");
    if (c == ']' || c == '}') open_ = std::max(0, open_ - 1);
    if (std::string_view("\n=,[]{}").find(c) != std::string_view::npos) parts_ = 0;
    if (c == '\n') ++line_;
    ++at_;
  }

  void count(int& counter, const char* what) {
    if (++counter > deepest)
      throw InputError(SourceLocation{file_, line_, 1},
                       fmt::format("more than {} {} (allowed: no more)", deepest, what));
  }

  // An unterminated string is left to the parser to report.
  void skip_string(char quote) {
    const bool several_lines = text_.substr(at_, 3) == std::string(3, quote);
    const std::string end = several_lines ? std::string(3, quote) : std::string(1, quote);
    for (at_ += end.size(); at_ < text_.size() && text_.substr(at_, end.size()) != end; ++at_) {
      if (text_[at_] == '\\' && quote == '"') ++at_;
      if (at_ >= text_.size() || text_[at_] != '\n') continue;
      if (!several_lines) return;
      ++line_;
    }
    skip_to(at_ + end.size());
  }

  void skip_to(std::size_t place) { at_ = std::min(place, text_.size()); }

  std::string_view text_;
  const std::string& file_;
  std::size_t at_ = 0;
  int line_ = 1, parts_ = 0, open_ = 0;
};

}  // namespace

void require_bounded(std::string_view text, const std::string& file) {
  if (text.size() > largest_case_file)
    throw InputError(SourceLocation{file, 0, 0},
                     fmt::format("has {} bytes (allowed: a case file of up to {})", text.size(), largest_case_file));
  DepthCounter(text, file).run();
}

void refuse(const TomlValue& value, const std::string& what, const std::string& allowed, const std::string& hint) {
  const std::string key = value.key.empty() ? "" : value.key + ": ";
  throw InputError(location_of(value),
                   key + with_keys_in(value.units, fmt::format("{} (allowed: {}){}", what, allowed, hint)));
}

void missing(const TomlValue& table, const std::string& key, const std::string& allowed) {
  const std::string name = join_key(table.key, key_in(table.units, key).name);
  refuse({table.node, name, table.file, table.units}, "is missing", allowed);
}

SourceLocation location_of(const TomlValue& value) {
  const auto begin = value.node->source().begin;
  return {value.file, static_cast<int>(begin.line), static_cast<int>(begin.column)};
}

double as_number(const TomlValue& value, const Range& range) {
  if (!value.node->is_number()) wrong_type(value, range.words);
  const auto* integer = value.node->as_integer();  // value<double>() is empty where no double is exact
  const double given = integer ? static_cast<double>(integer->get()) : value.node->ref<double>();
  const double x = given * value.in_si;
  if (!range.contains(x)) refuse(value, fmt::format("is {}", given), range.words);
  if (x != 0 && (std::abs(x) < smallest_number || std::abs(x) > largest_number))
    refuse(value, fmt::format("is {}", given),
           fmt::format("{}, {}{:g} to {:g} in size", range.words, range.contains(0) ? "0 or " : "", smallest_number,
                       largest_number));
  return x;
}

std::string as_text(const TomlValue& value) {
  const auto* text = value.node->as_string();
  if (!text) wrong_type(value, "a string");
  if (text->get().empty()) refuse(value, "is empty", "a string that is not empty");
  return text->get();
}

bool as_flag(const TomlValue& value) {
  const auto* flag = value.node->as_boolean();
  if (!flag) wrong_type(value, "true or false");
  return flag->get();
}

std::size_t as_choice_number(const TomlValue& value, const std::vector<std::string>& names) {
  const std::string allowed = fmt::format("{}", fmt::join(names, ", "));
  if (!value.node->is_string()) wrong_type(value, allowed);
  const std::string& name = value.node->ref<std::string>();
  const auto at = std::ranges::find(names, name);
  if (at == names.end()) refuse(value, fmt::format("'{}' is not known", name), allowed, did_you_mean(name, names));
  return static_cast<std::size_t>(at - names.begin());
}

std::string as_choice(const TomlValue& value, const std::vector<std::string>& names) {
  return names[as_choice_number(value, names)];
}

std::vector<TomlValue> as_list(const TomlValue& value, const std::string& words) {
  const auto* array = value.node->as_array();
  if (!array) wrong_type(value, words);
  if (array->empty()) refuse(value, "is an empty list", words);
  std::vector<TomlValue> items;
  for (const toml::node& node : *array) items.push_back({&node, value.key, value.file, value.units, value.in_si});
  return items;
}

std::vector<TomlValue> as_list_of(std::size_t count, const TomlValue& value, const std::string& words) {
  std::vector<TomlValue> items = as_list(value, words);
  if (items.size() != count) refuse(value, fmt::format("is a list of {}", items.size()), words);
  return items;
}

Vec3 as_vector(const TomlValue& value, const Range& range) {
  const auto items = as_list_of(3, value, fmt::format("[x, y, z], each {}", range.words));
  return {as_number(items[0], range), as_number(items[1], range), as_number(items[2], range)};
}

Vec3 as_direction(const TomlValue& value) {
  const Vec3 direction = as_vector(value);
  if (direction.isZero(0)) refuse(value, "is the zero vector", "[x, y, z] with a direction");
  // A vector of length 1 is returned unchanged, so that a direction that was written is read back bit for bit.
  const double length = direction.stableNorm();
  if (std::abs(length - 1) <= 4 * std::numeric_limits<double>::epsilon()) return direction;
  return direction.stableNormalized();
}

Cells as_cells(const TomlValue& value) {
  const std::string words = "[nx, ny, nz], integers from 1 to 1000";
  const auto items = as_list_of(3, value, words);
  Cells cells;
  for (int c = 0; c < 3; ++c) {
    if (!items[c].node->is_integer()) wrong_type(items[c], words);
    const std::int64_t n = items[c].node->ref<std::int64_t>();
    if (n < 1 || n > 1000) refuse(items[c], fmt::format("is {}", n), words);
    cells[c] = static_cast<int>(n);
  }
  return cells;
}

int as_whole(const TomlValue& value, int low, int high) {
  const std::string words = fmt::format("an integer from {} to {}", low, high);
  const auto* n = value.node->as_integer();
  if (!n || n->get() < low || n->get() > high)
    refuse(value, n ? fmt::format("is {}", n->get()) : "is no integer", words);
  return static_cast<int>(n->get());
}

std::vector<TomlValue> one_or_several(const TomlValue& value) {
  if (!value.node->is_array()) return {value};
  return as_list(value, "one value or a list that is not empty");
}

TomlTable::TomlTable(const TomlValue& value, std::span<const Key> keys) : value_(value) {
  const toml::table* table = value.node->as_table();
  if (!table) wrong_type(value, "a table");
  refuse_unknown_keys(value, *table, keys);
  for (const Key& key : keys)
    if (!key.otherwise && !find(key.name)) missing(value, key.name, key.allowed);
}

std::optional<TomlValue> TomlTable::find(const std::string& key) const {
  const Named written = key_in(value_.units, key);
  const toml::node* node = value_.node->as_table()->get(written.name);
  if (!node) return std::nullopt;
  return TomlValue{node, join_key(value_.key, written.name), value_.file, value_.units, written.in_si};
}

TomlValue TomlTable::at(const std::string& key) const { return find(key).value(); }

std::vector<TomlValue> TomlTable::tables(const std::string& key) const {
  const auto value = find(key);
  if (!value) return {};
  const std::string words = fmt::format("tables headed [[{}]]", key);
  const auto items = as_list(*value, words);
  for (const TomlValue& item : items)
    if (!item.node->is_table()) wrong_type(item, words);
  return items;
}

}  // namespace springproof
