#include "comparisons/report/page.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <stdexcept>

namespace springproof {

// "<" occurs only in strings, where it can be written as an escape.
std::string script_json(const nlohmann::json& json) {
  const std::string text = json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
  std::string out;
  out.reserve(text.size());
  for (char c : text) {
    if (c == '<')
      out += "\\u003c";
    else
      out += c;
  }
  return out;
}

std::string filled(std::string_view text, const std::map<std::string_view, std::string>& values) {
  std::string out;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t open = text.find('@', at);
    if (open == std::string_view::npos) return out.append(text.substr(at));
    const std::size_t close = text.find('@', open + 1);
    const auto name = close == std::string_view::npos ? "" : text.substr(open + 1, close - open - 1);
    const auto value = values.find(name);
    if (value == values.end()) throw std::logic_error(fmt::format("page template: @{}@ has no value", name));
    out.append(text.substr(at, open - at)).append(value->second);
    at = close + 1;
  }
  return out;
}

}  // namespace springproof
