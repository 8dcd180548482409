#include "comparisons/run/variations.h"

namespace springproof {
namespace {

template <class T>
void keep_first(std::vector<T>& all) {
  if (all.size() > 1) all.resize(1);
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
  keep_first(changed.models);
  if (!variation.input) return changed;
  changed.elements.clear();
  changed.reference.elements.clear();
  for (auto* numbers : {&changed.body.voxel_edges, &changed.body.accuracies}) keep_first(*numbers);
  keep_first(changed.body.voxel_counts);
  keep_first(changed.body.cells);
  return changed;
}

}  // namespace springproof
