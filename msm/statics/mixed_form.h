// The mixed form of a lattice at rest: its volume term by pressures, for nu near 1/2.
#pragma once

#include <memory>

#include "msm/algebra/saddle_point.h"
#include "msm/laws/laws.h"

namespace springproof {

/// Whether a model is a lattice of cells, full or cut, that has a mixed form if it has a volume term.
bool on_lattice(const MassSpringModel& model);

/// Whether its volume term, of several materials the stiffest relative to shear, is so stiff that pressures as unknowns
/// are worth it.
bool mixed_form_pays(const MassSpringModel& model);

/// Its saddle point at rest, with a pressure per node for momentum dispersion, else one per cell, in units of its shear
/// modulus and the edge of its cells.
/// @param model on_lattice(), which must outlive the result
/// @param fixed unknowns, carried ones included
/// @throws std::invalid_argument if it has no volume term.
std::unique_ptr<SaddlePoint> saddle_point_at_rest(const MassSpringModel& model, const std::vector<char>& fixed);

}  // namespace springproof
