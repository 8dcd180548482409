#include "comparisons/report/headline_words.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "comparisons/report/results.h"

namespace springproof::words {

std::string string_of(const Json& object, const char* key) {
  const auto found = object.find(key);
  return found != object.end() && found->is_string() ? found->get<std::string>() : "";
}

std::optional<double> number_of(const Json& object, const char* key) {
  const auto found = object.find(key);
  return found != object.end() && found->is_number() ? std::optional(found->get<double>()) : std::nullopt;
}

const Json& list_of(const Json& object, const char* key) {
  static const Json none = Json::array();
  const auto found = object.find(key);
  return found != object.end() && found->is_array() ? *found : none;
}

const Json& object_of(const Json& object, const char* key) {
  static const Json none = Json::object();
  const auto found = object.find(key);
  return found != object.end() && found->is_object() ? *found : none;
}

Cells cells_of(const Json& item) {
  const Json& list = list_of(item, "cells");
  Cells cells = {0, 0, 0};
  for (std::size_t d = 0; d < 3 && d < list.size(); ++d)
    if (list[d].is_number()) cells[d] = list[d].get<int>();
  return cells;
}

std::string minus(std::string number) {
  for (std::size_t i = 0; (i = number.find('-', i)) != std::string::npos; ++i) number.replace(i, 1, "−");
  return number;
}

std::string number_text(std::optional<double> x) { return x ? minus(fmt::format("{}", *x)) : "nothing"; }

std::string percent(double fraction) {
  const double x = 100 * fraction;
  if (x < 1e-3) return "0.001";
  return x >= 99.5 ? fmt::format("{:.0f}", x) : fmt::format("{:.2g}", x);
}

std::string nu_text(std::optional<double> nu) { return nu ? minus(fmt::format("{:.6g}", *nu)) : "nothing"; }

std::string at_nu(const std::string& name, std::optional<double> nu) {
  return fmt::format("{} at ν = {}", name, nu_text(nu));
}

std::string cells_words(const Json& item) {
  const Cells cells = cells_of(item);
  return cells_text(cells, "×") + (is_tetrahedra(cells) ? "" : " cells");
}

std::string listed(const std::vector<std::string>& items) {
  if (items.size() < 2) return items.empty() ? "" : items.front();
  return fmt::format("{} and {}", fmt::join(items.begin(), items.end() - 1, ", "), items.back());
}

}  // namespace springproof::words
