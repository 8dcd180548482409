#include "comparisons/results/facts.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

namespace springproof {
namespace {

struct Words {
  bool percent;

  std::string operator()(std::monostate) const { return fmt::format("{:>12}", "none"); }
  std::string operator()(bool yes) const { return fmt::format("{:>12}", yes ? "yes" : "no"); }
  std::string operator()(double x) const {
    return percent ? fmt::format("{:>+12.3g}", 100 * x) : fmt::format("{:>12.6g}", x);
  }
  std::string operator()(const std::string& word) const { return fmt::format("{:>12}", word); }
  std::string operator()(const std::vector<double>& v) const { return fmt::format("({:.3g})", fmt::join(v, ", ")); }
};

std::string line_of(const FactRow& row, std::size_t width) {
  std::string line = fmt::format("  {:<{}}", row.label, width);
  for (const Fact& fact : row.facts) line += " " + std::visit(Words{row.unit == "%"}, fact.value);
  if (!row.unit.empty()) line += " " + row.unit;
  return line + (row.note.empty() ? "" : "   " + row.note) + "\n";
}

}  // namespace

FactValue if_finite(double x) { return std::isfinite(x) ? FactValue(x) : FactValue(); }

std::string text_of(const std::vector<FactGroup>& groups) {
  std::string text;
  for (const FactGroup& group : groups) {
    std::size_t width = 0;
    for (const FactRow& row : group.rows) width = std::max(width, row.label.size());
    if (width == 0 && !group.rows.empty()) continue;  // in JSON alone
    text += (text.empty() ? "" : "\n") + group.title + "\n";
    for (const FactRow& row : group.rows)
      if (!row.label.empty()) text += line_of(row, width);
  }
  return text;
}

nlohmann::json json_of(const std::vector<FactGroup>& groups) {
  nlohmann::json out = nlohmann::json::object();
  for (const FactGroup& group : groups)
    for (const FactRow& row : group.rows)
      for (const Fact& fact : row.facts)
        std::visit(
            [&at = out[nlohmann::json::json_pointer(fact.key)]](const auto& value) {
              if constexpr (!std::is_same_v<decltype(value), const std::monostate&>) at = value;
            },
            fact.value);
  return out;
}

}  // namespace springproof
