// Why the grids of a reference show no limit, and what to do about it.
#pragma once

#include <string>

#include "comparisons/reference/reference_grids.h"

namespace springproof {

/// The likeliest cause that three grids do not converge in a measure, with a remedy, as a clause for the record's note:
/// meshes of one fineness, an element that locks, a probe at the rim of a patch, a surface or a rim that differs from
/// mesh to mesh, a grid too coarse across the body, or else the rims of supports, where stresses are singular.
std::string cause_and_remedy(const PreparedCase& prepared, const IsotropicMaterial& material, const ElementGrids& grids,
                             const std::string& measure);

}  // namespace springproof
