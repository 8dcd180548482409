#include "comparisons/run/variations.h"

#include <algorithm>
#include <functional>

#include "comparisons/results/records.h"

namespace springproof {
namespace {

template <class T, class Before>
void keep_first(std::vector<T>& all, Before before) {
  if (!all.empty()) all = {*std::min_element(all.begin(), all.end(), before)};
}

}  // namespace

std::vector<Variation> variations(const Experiment& e) {
  std::vector<Variation> all;
  if (e.measured.empty()) return all;
  for (std::size_t c = 0; c < e.load_cases.size(); ++c)
    for (std::size_t i = 0; i <= e.inputs.size(); ++i)
      if (c > 0 || i > 0) all.push_back({c, i > 0 ? std::optional(i - 1) : std::nullopt});
  return all;
}

Experiment case_of(const Experiment& e, const Variation& variation) {
  Experiment changed = varied(e, variation);
  if (changed.models.size() > 1) changed.models.resize(1);
  if (!variation.input) return changed;
  changed.elements.clear();
  changed.reference.elements.clear();
  keep_first(changed.body.cells, [](const Cells& a, const Cells& b) { return cell_count(a) < cell_count(b); });
  keep_first(changed.body.voxel_counts, std::less<>());
  for (auto* numbers : {&changed.body.voxel_edges, &changed.body.accuracies}) keep_first(*numbers, std::greater<>());
  return changed;
}

}  // namespace springproof
