// Forms of the cells of a network, each made once.
#pragma once

#include <vector>

#include "msm/laws/averaged_springs.h"

namespace springproof {

/// What the energy of each cell depends on beside the positions of its corners: one of full cells of a size and
/// material, one of each cut cell.
class CellForms {
 public:
  CellForms() = default;
  CellForms(const AveragedSprings& law, const CellSet& cells);

  const CellForm& operator[](std::size_t cell) const { return forms_[of_cell_[cell]]; }

 private:
  std::vector<CellForm> forms_;
  std::vector<int> of_cell_;
};

}  // namespace springproof
