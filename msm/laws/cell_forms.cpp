#include "msm/laws/cell_forms.h"

#include <map>
#include <utility>

namespace springproof {

CellForms::CellForms(const AveragedSprings& law, const CellSet& cells) {
  std::map<std::pair<double, int>, int> full;  // by edge and material
  for (std::size_t c = 0; c < cells.size(); ++c) {
    const auto make = [&] {
      forms_.push_back(cell_form(law, cells.shape(c)));
      return static_cast<int>(forms_.size()) - 1;
    };
    const std::pair key(cells.edge_of(c), cells.material(c));
    if (!cells.is_full(c))
      of_cell_.push_back(make());
    else if (const auto known = full.find(key); known != full.end())
      of_cell_.push_back(known->second);
    else
      of_cell_.push_back(full[key] = make());
  }
}

}  // namespace springproof
