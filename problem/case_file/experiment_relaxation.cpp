// The [material.relaxation] table.
#include <fmt/format.h>

#include <algorithm>

#include "problem/case_file/experiment_parts.h"

namespace springproof {
namespace {

constexpr const char* branch_words = "a list of up to 8 { share, time_s }";
constexpr std::size_t most_branches = 8;

std::vector<RelaxationBranch> read_branches(const TomlValue& value) {
  const std::vector<TomlValue> items = as_list(value, branch_words);
  if (items.size() > most_branches) refuse(value, fmt::format("has {} branches", items.size()), branch_words);
  std::vector<RelaxationBranch> branches;
  for (const TomlValue& item : items) {
    const TomlTable table(item, keys_of("material.relaxation.branches"));
    const RelaxationBranch branch{as_number(table.at("share"), {"a number from 1e-6 to 1000", 1e-6, 1000, true, true}),
                                  as_number(table.at("time_s"), positive_number)};
    if (std::any_of(branches.begin(), branches.end(), [&](const auto& other) { return other.time == branch.time; }))
      refuse(table.at("time_s"), fmt::format("{} s is that of another branch", branch.time),
             "one branch of each time, with the sum of their shares");
    branches.push_back(branch);
  }
  return branches;
}

}  // namespace

void read_relaxation(const TomlTable& document, Experiment& experiment) {
  const auto value = TomlTable(document.at("material"), keys_of("material")).find("relaxation");
  if (!value) return;
  if (document.find("fracture"))
    refuse(*value, "stands beside [fracture], whose springs do not relax", "one of the two");
  const TomlTable table(*value, keys_of("material.relaxation"));
  experiment.relaxation.branches = read_branches(table.at("branches"));
  experiment.relaxation_where = location_of(*value);
  const auto after = table.find("equilibrium_after_s");
  if (!after) return;
  if (experiment.dynamics)
    refuse(*after, "stands beside [dynamics], whose motions end at equilibria of long times", "one of the two");
  experiment.loaded_for = as_number(*after, positive_number);
}

void check_relaxation(const Experiment& e) {
  const auto is_exact = [](const Load& load) {
    const auto* field = std::get_if<PrescribedField>(&load);
    return field && field->kelvin;
  };
  if (!e.relaxation.acts() || !(e.line || std::any_of(e.loads.begin(), e.loads.end(), is_exact))) return;
  throw InputError(e.relaxation_where,
                   "material.relaxation: stands beside an exact line or field, which is of a material that does not "
                   "relax (allowed: one of the two)");
}

}  // namespace springproof
