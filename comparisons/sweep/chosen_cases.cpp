#include "comparisons/sweep/chosen_cases.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace springproof {

Experiment only(const std::vector<double>& wanted, Experiment e) {
  if (wanted.empty()) return e;
  const auto left_out = [&](double nu) {
    return std::none_of(wanted.begin(), wanted.end(), [&](double w) { return same_poisson_ratio(w, nu); });
  };
  const std::vector<double> has = e.settings();
  e.leave_out_settings(left_out);
  std::erase_if(e.expectations, [&](const Expectation& x) { return x.poisson_ratio && left_out(*x.poisson_ratio); });
  std::erase_if(e.published, [&](const PublishedValue& v) { return left_out(v.poisson_ratio); });
  if (e.settings().empty())
    throw InputError(fmt::format("{}: {}: none of those wanted (allowed: {})", e.file.string(), e.listed_words(),
                                 fmt::join(has, ", ")));
  return e;
}

Experiment finer(int times, Experiment e) {
  if (times == 1) return e;
  if (e.reference.cells[0] == 0 && e.reference.edge == 0)
    throw InputError(fmt::format(
        "--finer: {} leaves its reference grids to the program; give it [reference] cells or edge_m", e.file.string()));
  for (int& n : e.reference.cells)
    if (n > 1) n *= times;
  e.reference.edge /= times;
  return e;
}

}  // namespace springproof
