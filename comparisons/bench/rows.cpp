#include "comparisons/bench/rows.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "comparisons/bench/machine.h"

namespace springproof::bench {
namespace {

nlohmann::json to_json(const BenchRow& row) {
  nlohmann::json j = {{"subject", row.subject}, {"what", row.what}, {"size", row.size},       {"unit", row.unit},
                      {"ok", row.ok},           {"note", row.note}, {"outcome", outcome(row)}};
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

/// Four digits.
std::string number(double x) {
  return !std::isfinite(x)               ? "-"
         : x != 0 && std::abs(x) < 0.001 ? fmt::format("{:.1e}", x)
         : std::abs(x) >= 1000           ? fmt::format("{:.0f}", x)
                                         : fmt::format("{:.4g}", x);
}

std::string percent(double share) { return fmt::format("{:.0f} %", 100 * share); }

std::string bytes_text(double bytes) {
  return bytes >= 1048576 ? fmt::format("{:g} MiB", bytes / 1048576) : fmt::format("{:g} KiB", bytes / 1024);
}

std::string machine_text(const Machine& machine) {
  std::string out = fmt::format("{}, {} cores", machine.processor, machine.cores);
  for (const MemoryLevel& l : machine.memory)
    if (l.bytes > 0) out += fmt::format(", {} {}", l.name, bytes_text(l.bytes));
  out += "\n";
  if (machine.arithmetic.empty()) return out;
  out += "\nLimits of one core       FMA FP64   FMA FP32      inverse root FP64   FP32\n";
  for (const Arithmetic& a : machine.arithmetic)
    out += fmt::format("  {:<20} {:>5.1f} GF/s {:>5.1f} GF/s   {:>12.3f} ns {:>11.3f} ns\n", a.instruction_set,
                       a.gflops64, a.gflops32, a.root64, a.root32);
  for (const MemoryLevel& l : machine.memory)
    out += fmt::format("  {:<20} {:>6.1f} GB/s{}\n", l.name + (l.bytes > 0 ? " read" : " triad"), l.GB_s,
                       l.all_cores > 0 ? fmt::format(", {} cores {:.1f} GB/s", machine.cores, l.all_cores) : "");
  return out;
}

/// "at least 5", "at most 1.35"; empty without a target.
std::string target_text(const Target& target) {
  if (target.sense == Sense::none) return "";
  return fmt::format("{} {:g}", target.sense == Sense::at_least ? "at least" : "at most", target.limit);
}

std::string line(const BenchRow& row, std::size_t width) {
  const std::string head = fmt::format("{:<{}} {:<18}", row.what, width, row.size);
  if (!row.ok) return fmt::format("{} NO RESULT: {}\n", head, row.note);
  const bool compared = !row.baseline.empty();
  std::string out = fmt::format("{} {:>9} {:<24} {:>9} {:<26} {:>8} {:<14} {:<7}", head, number(row.value), row.unit,
                                compared ? number(row.baseline_value) : "", row.baseline,
                                compared ? fmt::format("{:.2f}x", row.judged()) : "", target_text(row.target),
                                outcome(row) == "missed" ? "MISSED" : outcome(row));
  if (row.usage)
    out += fmt::format(" {:>5.0f} {:>6} {:>6}", row.usage->bytes_per_node, percent(row.usage->bandwidth_share),
                       percent(row.usage->arithmetic_share));
  while (out.ends_with(' ')) out.pop_back();
  return out + "\n";
}

}  // namespace

double BenchRow::judged() const {
  if (baseline.empty()) return value;
  return target.sense == Sense::at_most ? value / baseline_value : baseline_value / value;
}

std::string outcome(const BenchRow& row) {
  const auto [sense, limit] = row.target;
  if (!row.ok || !std::isfinite(row.judged())) return "no result";
  if (sense == Sense::none) return "";
  return (sense == Sense::at_least ? row.judged() >= limit : row.judged() <= limit) ? "met" : "missed";
}

bool complete(const Findings& findings) {
  return std::ranges::none_of(findings.rows, [](const BenchRow& row) { return outcome(row) == "no result"; });
}

nlohmann::json to_json(const Findings& findings) {
  nlohmann::json rows = nlohmann::json::array();
  for (const BenchRow& row : findings.rows) rows.push_back(to_json(row));
  return {{"rows", rows}, {"remarks", findings.remarks}};
}

std::string table_text(const Machine& machine, const Findings& findings) {
  std::string out = machine_text(machine), subject;
  std::size_t width = 30;
  for (const BenchRow& row : findings.rows) width = std::max(width, row.what.size());
  for (const BenchRow& row : findings.rows) {
    if (row.subject != subject) {
      subject = row.subject;
      out += fmt::format("\n{:<{}} {:<18} {:>9} {:<24} {:>9} {:<26} {:>8} {:<14} {:<7} {:>5} {:>6} {:>6}\n", subject,
                         width, "size", "ours", "unit", "baseline", "", "ratio", "target", "", "B/node", "bandw.",
                         "arith.");
    }
    out += line(row, width);
  }
  int met = 0, judged = 0;
  for (const BenchRow& row : findings.rows) met += outcome(row) == "met", judged += row.target.sense != Sense::none;
  if (judged > 0) out += fmt::format("\n{} of {} targets met\n", met, judged);
  for (const std::string& remark : findings.remarks) out += remark + "\n";
  return out;
}

}  // namespace springproof::bench
