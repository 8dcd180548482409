// The stiffness of a model at rest as that of its springs and of pressures: what stays well-conditioned as nu -> 1/2.
#pragma once

#include "msm/distribution/model_part.h"

namespace springproof {

/// K = A + B^T C^-1 B, A the stiffness of `springs`: with a pressure p = C^-1 B u per cell (volume correction, averaged
/// springs), or per node (momentum dispersion).
struct PressureForm {
  MassSpringModel springs;  ///< the model without its volume term, but in materials where that softens: nu < 1/4
  NodalForms B;             ///< of cells dV/du [m^2], of nodes dJ/du [N]; places x 3 n, no force on a carried node
  Eigen::VectorXd C;        ///< one per place [m^3/Pa, N m]; 0: no pressure there
};

/// Of a conservative model, or a part of one, with a volume term that adds to lambda: volume_stiffness_ratio() > 0
/// (msm/parameters/calibrate.h).
PressureForm pressure_form(const MassSpringModel& model);

}  // namespace springproof
