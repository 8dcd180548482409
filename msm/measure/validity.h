// The homogeneous state of a model under large uniaxial strain: its stress, and where it has no equilibrium.
#pragma once

#include <optional>
#include <vector>

#include "msm/parameters/model_table.h"

namespace springproof {

/// Axial strain of uniaxial tension (free sides) at which a homogeneous cell loses equilibrium or stability;
/// +infinity if it does not up to 50 %.
struct StrainLimits {
  double bounded_energy;  ///< with VolumeEnergy::bounded [1]
  double paper_energy;    ///< with VolumeEnergy::paper [1]
};

/// Those of one cell of a model.
StrainLimits strain_limits(const ModelParameters& parameters, const IsotropicMaterial& material);

/// Stress [Pa], force over the area at rest, of a bar with free sides at one stretch (length over that at rest).
struct StressAtStretch {
  double stretch;               ///< [1]
  std::optional<double> model;  ///< of one cell; empty: no stable equilibrium
  double hencky;                ///< of Hencky's law
  double neo_hooke;             ///< of the neo-Hookean law
};

/// Stretches of 0.6 to 1.4.
std::vector<StressAtStretch> stress_curve(const ModelParameters& parameters, const IsotropicMaterial& material);

}  // namespace springproof
