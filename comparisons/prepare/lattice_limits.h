// Which models of a case may lose their equilibrium, known before they are run.
#pragma once

#include <vector>

#include "comparisons/prepare/prepared_case.h"
#include "comparisons/results/records.h"

namespace springproof {

/// Nominal strains along the axes that pairs of moved supports impose, the most negative and the most positive
/// (msm/measure/validity.h); 0: none.
struct ImposedStrain {
  double compression = 0, tension = 0;
};
ImposedStrain imposed_strain(const PreparedCase& prepared);

/// Of large displacements: every model of whole cells and every Poisson's ratio at which the lattice is not stable up
/// to 1.25 times the imposed strain, with free or with held sides.  Forces impose no strain that is known before.
std::vector<LatticeLimit> lattice_limits(const PreparedCase& prepared);

}  // namespace springproof
