#include "msm/topology/cells.h"

namespace springproof {
namespace {

/// Those of these numbers, of a list that has one per cell or is empty.
template <class Value>
std::vector<Value> of_numbers(const std::vector<Value>& all, const std::vector<int>& numbers) {
  std::vector<Value> some;
  for (std::size_t i = 0; !all.empty() && i < numbers.size(); ++i) some.push_back(all[numbers[i]]);
  return some;
}

}  // namespace

CellKind CellSet::kind() const {
  if (corners.empty()) return CellKind::none;
  if (!edges.empty()) return CellKind::sizes;
  if (cut()) return CellKind::cut;
  return (proportions.array() != 1).any() ? CellKind::boxes : CellKind::cubes;
}

const FilledPart& CellSet::part(std::size_t cell) const {
  static const FilledPart full;
  return cut() ? filled[cell] : full;
}

CellSet CellSet::of(const std::vector<int>& numbers) const {
  CellSet some;
  some.corners = of_numbers(corners, numbers);
  some.edge = edge;
  some.proportions = proportions;
  some.edges = of_numbers(edges, numbers);
  some.filled = of_numbers(filled, numbers);
  some.materials = of_numbers(materials, numbers);
  some.relative_densities = relative_densities;
  some.carried = carried;
  some.springs = springs;
  return some;
}

}  // namespace springproof
