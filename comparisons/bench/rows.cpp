#include "comparisons/bench/rows.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <nlohmann/json.hpp>

namespace springproof::bench {
namespace {

nlohmann::json to_json(const BenchRow& row) {
  nlohmann::json j = {{"subject", row.subject},
                      {"what", row.what},
                      {"size", row.size},
                      {"unit", row.unit},
                      {"ok", row.ok},
                      {"note", row.note},
                      {"outcome", to_string(outcome(row))}};
  if (row.ok) j["value"] = row.value;
  if (row.ok && !row.baseline.empty()) j["baseline"] = {{"name", row.baseline}, {"value", row.baseline_value}};
  if (row.ok) j["judged"] = row.judged();
  if (row.target.sense != Sense::none)
    j["target"] = {{row.target.sense == Sense::at_least ? "at_least" : "at_most", row.target.limit}};
  if (row.usage)
    j["usage"] = {{"bytes_per_node", row.usage->bytes_per_node},
                  {"bandwidth_share", row.usage->bandwidth_share},
                  {"arithmetic_share", row.usage->arithmetic_share}};
  return j;
}

nlohmann::json to_json(const RooflinePoint& p) {
  return {{"name", p.name},
          {"size", p.size},
          {"level", p.level},
          {"flops_per_byte", p.flops_per_byte},
          {"gflops", p.gflops}};
}

template <class T>
void append(std::vector<T>& more, std::vector<T>& to) {
  to.insert(to.end(), std::make_move_iterator(more.begin()), std::make_move_iterator(more.end()));
}

}  // namespace

double BenchRow::judged() const {
  if (baseline.empty()) return value;
  return target.sense == Sense::at_most ? value / baseline_value : baseline_value / value;
}

Outcome outcome(const BenchRow& row) {
  if (!row.ok || !std::isfinite(row.judged())) return Outcome::no_result;
  switch (row.target.sense) {
    case Sense::at_least:
      return row.judged() >= row.target.limit ? Outcome::met : Outcome::missed;
    case Sense::at_most:
      return row.judged() <= row.target.limit ? Outcome::met : Outcome::missed;
    default:
      return Outcome::information;
  }
}

std::string to_string(Outcome outcome) {
  switch (outcome) {
    case Outcome::met:
      return "met";
    case Outcome::missed:
      return "missed";
    case Outcome::no_result:
      return "no result";
    default:
      return "";
  }
}

std::string to_string(const Target& target) {
  if (target.sense == Sense::none) return "";
  return fmt::format("{} {:g}", target.sense == Sense::at_least ? "at least" : "at most", target.limit);
}

void Findings::add(Findings more) {
  append(more.rows, rows);
  append(more.points, points);
  append(more.remarks, remarks);
}

bool complete(const Findings& findings) {
  return std::none_of(findings.rows.begin(), findings.rows.end(),
                      [](const BenchRow& row) { return outcome(row) == Outcome::no_result; });
}

nlohmann::json to_json(const Findings& findings) {
  nlohmann::json rows = nlohmann::json::array(), points = nlohmann::json::array();
  for (const BenchRow& row : findings.rows) rows.push_back(to_json(row));
  for (const RooflinePoint& point : findings.points) points.push_back(to_json(point));
  return {{"rows", rows}, {"roofline", points}, {"remarks", findings.remarks}};
}

}  // namespace springproof::bench
