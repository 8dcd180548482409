#include "msm/laws/cell_forms.h"

#include <map>

namespace springproof {

CellForms::CellForms(const AveragedSprings& law, const CellSet& cells) {
  std::map<double, int> full;  // by edge
  for (std::size_t c = 0; c < cells.size(); ++c) {
    const auto make = [&] {
      forms_.push_back(cell_form(law, cells.shape(c)));
      return static_cast<int>(forms_.size()) - 1;
    };
    if (!cells.is_full(c))
      of_cell_.push_back(make());
    else if (const auto known = full.find(cells.edge_of(c)); known != full.end())
      of_cell_.push_back(known->second);
    else
      of_cell_.push_back(full[cells.edge_of(c)] = make());
  }
}

}  // namespace springproof
