// Results of a bench: rows, each with its baseline of the same run and its target.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

namespace springproof::bench {

struct Machine;

enum class Sense { none, at_least, at_most };

/// Target of the judged number of a row.
struct Target {
  Sense sense = Sense::none;
  double limit = 0;
};
inline Target at_least(double limit) { return {Sense::at_least, limit}; }
inline Target at_most(double limit) { return {Sense::at_most, limit}; }

/// How well a kernel uses the machine.
struct Usage {
  double bytes_per_node = 0;    ///< that the motion keeps, lists of springs included
  double bandwidth_share = 0;   ///< of the level of the memory that holds them
  double arithmetic_share = 0;  ///< of the limit of multiply-adds or of inverse roots, whichever is nearer
};

struct BenchRow {
  std::string subject;  ///< "dynamics"
  std::string what;     ///< "HybMSS-CF over LAMMPS"
  std::string size;     ///< "30^3"
  std::string unit;     ///< of the value and the baseline's value
  double value = 0;
  std::string baseline = {};  ///< what it is compared with; empty: nothing, and the value itself is judged
  double baseline_value = 0;
  Target target = {};
  std::optional<Usage> usage = {};
  std::string note = {};  ///< what computed it; why there is no result
  bool ok = true;         ///< false: no result

  /// Baseline over value, or, where it should be small, value over baseline; without a baseline the value.
  double judged() const;
};

/// "met", "missed", "no result"; without a target "".
std::string outcome(const BenchRow& row);

struct Findings {
  std::vector<BenchRow> rows;
  std::vector<std::string> remarks;  ///< what was left out and why
};

/// Whether every row has a result.
bool complete(const Findings& findings);

nlohmann::json to_json(const Findings& findings);

/// A table, under the machine and its limits.
std::string table_text(const Machine& machine, const Findings& findings);

}  // namespace springproof::bench
