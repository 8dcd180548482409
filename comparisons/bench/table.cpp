#include "comparisons/bench/table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace springproof::bench {
namespace {

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

std::string line(const BenchRow& row, std::size_t width) {
  const std::string head = fmt::format("{:<{}} {:<18}", row.what, width, row.size);
  if (!row.ok) return fmt::format("{} NO RESULT: {}\n", head, row.note);
  const bool compared = !row.baseline.empty();
  std::string out = fmt::format("{} {:>9} {:<24} {:>9} {:<26} {:>8} {:<14} {:<7}", head, number(row.value), row.unit,
                                compared ? number(row.baseline_value) : "", row.baseline,
                                compared ? fmt::format("{:.2f}x", row.judged()) : "", to_string(row.target),
                                outcome(row) == Outcome::missed ? "MISSED" : to_string(outcome(row)));
  if (row.usage)
    out += fmt::format(" {:>5.0f} {:>6} {:>6}", row.usage->bytes_per_node, percent(row.usage->bandwidth_share),
                       percent(row.usage->arithmetic_share));
  while (out.ends_with(' ')) out.pop_back();
  return out + "\n";
}

}  // namespace

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
  for (const BenchRow& row : findings.rows)
    met += outcome(row) == Outcome::met, judged += row.target.sense != Sense::none;
  if (judged > 0) out += fmt::format("\n{} of {} targets met\n", met, judged);
  for (const std::string& remark : findings.remarks) out += remark + "\n";
  return out;
}

}  // namespace springproof::bench
