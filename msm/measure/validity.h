// How far a model can be stretched before its homogeneous state has no equilibrium.
#pragma once

#include "msm/parameters/model_table.h"

namespace springproof {

/// Axial strain of uniaxial tension (free sides) at which a homogeneous cell loses equilibrium or stability;
/// +infinity if it does not up to 50 %.
struct StrainLimits {
  double bounded_energy;
  double paper_energy;
};

StrainLimits strain_limits(const ModelParameters& parameters, const IsotropicMaterial& material);

}  // namespace springproof
