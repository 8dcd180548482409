#include "msm/exchange/json_place.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "problem/system/input_error.h"
#include "problem/system/nearest_name.h"
#include "problem/system/shortened.h"

namespace springproof {
namespace {

using nlohmann::json;

std::string shown(const json& value) {
  switch (value.type()) {
    case json::value_t::object:
      return "an object";
    case json::value_t::array:
      return fmt::format("a list of {}", value.size());
    default:
      return value.dump(-1, ' ', true, json::error_handler_t::replace);
  }
}

/// `key` as a part of a JSON pointer, RFC 6901.
std::string pointer_part(const std::string& key) {
  std::string part = "/";
  for (const char c : key) c == '~' ? part += "~0" : c == '/' ? part += "~1" : part += c;
  return part;
}

std::string range_words(const char* kind, double least, double largest) {
  const bool below = least > -largest_number_of_file, above = largest < largest_number_of_file;
  return below && above ? fmt::format("{} from {:g} to {:g}", kind, least, largest)
         : below        ? fmt::format("{} >= {:g}", kind, least)
         : above        ? fmt::format("{} <= {:g}", kind, largest)
                        : std::string(kind);
}

bool is_in(const json& value, double least, double largest) {
  if (!value.is_number()) return false;
  const double x = value.get<double>();
  return x >= least && x <= largest;
}

}  // namespace

void JsonPlace::refuse(const std::string& what, const std::string& allowed) const {
  throw InputError(
      shortened(fmt::format("{}: {}: {} (allowed: {})", *file_, pointer_.empty() ? "/" : pointer_, what, allowed)));
}

std::optional<JsonPlace> JsonPlace::find(const std::string& key) const {
  if (!value_->is_object()) refuse("is " + shown(*value_), "an object");
  const auto at = value_->find(key);
  if (at == value_->end()) return {};
  return JsonPlace(*at, pointer_ + pointer_part(key), *file_);
}

JsonPlace JsonPlace::at(const std::string& key) const {
  const auto place = find(key);
  if (!place) JsonPlace(*value_, pointer_ + pointer_part(key), *file_).refuse("is missing", "a value, it is required");
  return *place;
}

std::vector<std::string> JsonPlace::keys() const {
  if (!value_->is_object()) refuse("is " + shown(*value_), "an object");
  std::vector<std::string> names;
  for (const auto& [key, value] : value_->items()) names.push_back(key);
  return names;
}

std::vector<JsonPlace> JsonPlace::items() const {
  if (!value_->is_array()) refuse("is " + shown(*value_), "a list");
  std::vector<JsonPlace> all;
  for (const json& item : *value_) all.emplace_back(item, fmt::format("{}/{}", pointer_, all.size()), *file_);
  return all;
}

void JsonPlace::require_known(const std::vector<std::string>& known) const {
  for (const std::string& key : keys())
    if (std::find(known.begin(), known.end(), key) == known.end())
      at(key).refuse("is an unknown key", fmt::format("{}{}", fmt::join(known, ", "), did_you_mean(key, known)));
}

bool JsonPlace::empty() const { return value_->empty(); }

bool JsonPlace::is_list() const { return value_->is_array(); }

bool JsonPlace::first_is_list() const { return value_->is_array() && !value_->empty() && value_->front().is_array(); }

double JsonPlace::number(double least, double largest) const {
  if (!is_in(*value_, least, largest)) refuse("is " + shown(*value_), range_words("a finite number", least, largest));
  return value_->get<double>();
}

bool JsonPlace::flag() const {
  if (!value_->is_boolean()) refuse("is " + shown(*value_), "true or false");
  return value_->get<bool>();
}

std::string JsonPlace::text() const {
  if (!value_->is_string()) refuse("is " + shown(*value_), "text");
  return value_->get<std::string>();
}

int JsonPlace::choice(std::span<const char* const> names) const {
  int number = 0;
  if (value_->is_string())
    for (const char* name : names) {
      if (value_->get_ref<const std::string&>() == name) return number;
      ++number;
    }
  refuse("is " + shown(*value_), fmt::format("{}", fmt::join(names, ", ")));
}

template <class Read>
void JsonPlace::for_each_number(int columns, std::size_t rows, const char* of, const Read& read) const {
  if (!value_->is_array()) refuse("is " + shown(*value_), "a list");
  if (of && value_->size() != rows)
    refuse(fmt::format("has {} {}", value_->size(), columns == 1 ? "numbers" : "rows"),
           fmt::format("{}, as there are {}", rows, of));
  std::size_t number = 0;
  for (const json& row : *value_) {
    const auto here = [&] { return fmt::format("{}/{}", pointer_, number); };
    if (columns == 1)
      read(row, here);
    else if (!row.is_array() || row.size() != static_cast<std::size_t>(columns))
      JsonPlace(row, here(), *file_).refuse("is " + shown(row), fmt::format("a list of {}", columns));
    else
      for (int c = 0; c < columns; ++c) read(row[c], [&] { return fmt::format("{}/{}", here(), c); });
    ++number;
  }
}

std::vector<double> JsonPlace::numbers(int columns, std::size_t rows, const char* of, double least,
                                       double largest) const {
  std::vector<double> values;
  for_each_number(columns, rows, of, [&](const json& value, const auto& here) {
    if (!is_in(value, least, largest)) JsonPlace(value, here(), *file_).number(least, largest);
    values.push_back(value.get<double>());
  });
  return values;
}

std::vector<int> JsonPlace::integers(int columns, int largest, std::size_t rows, const char* of) const {
  std::vector<int> values;
  for_each_number(columns, rows, of, [&](const json& value, const auto& here) {
    if (!value.is_number_integer() || !is_in(value, 0, largest))
      JsonPlace(value, here(), *file_)
          .refuse("is " + shown(value), fmt::format("a whole number from 0 to {}", largest));
    values.push_back(value.get<int>());
  });
  return values;
}

}  // namespace springproof
