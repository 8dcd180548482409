// The list of all force laws, each a plain value, and the model that they form with a network.  The law suite of tests
// fails for a law of this list that it has no case for (tests/laws/law_suite_test.cpp).
#pragma once

#include <variant>
#include <vector>

#include "msm/laws/anchors.h"
#include "msm/laws/angular_springs.h"
#include "msm/laws/averaged_springs.h"
#include "msm/laws/hourglass_correction.h"
#include "msm/laws/momentum_dispersion.h"
#include "msm/laws/springs.h"
#include "msm/laws/volume_correction.h"

namespace springproof {

using ForceLaw = std::variant<Springs, VolumeCorrection, HourglassCorrection, MomentumDispersion, AngularSprings,
                              AveragedSprings, Anchors>;

inline const LawTraits& traits(const ForceLaw& law) {
  return std::visit([](const auto& l) -> const LawTraits& { return l.traits; }, law);
}

/// A mass-spring model: a network and its force laws.
struct MassSpringModel {
  Network network;
  std::vector<ForceLaw> laws;
  bool small_displacements_only = false;  ///< valid for linear kinematics only
};

double energy(const MassSpringModel& model, const NodalVectors& x);  ///< elastic energy [J] of a conservative model
NodalVectors forces(const MassSpringModel& model, const NodalVectors& x);  ///< internal forces -dE/dx [N]
Tangent tangent(const MassSpringModel& model, const NodalVectors& x);      ///< -df/dx [N/m]

/// Recomputes a tangent made by tangent() at another state, keeping its sparsity pattern.
void update_tangent(const MassSpringModel& model, const NodalVectors& x, Tangent& K);

/// The model's momentum dispersion; nullptr if it has none.
const MomentumDispersion* dispersion_of(const MassSpringModel& model);

/// The model's averaged springs; nullptr if it has none.
const AveragedSprings* averaged_springs_of(const MassSpringModel& model);

/// Whether the forces derive from an energy, so that the tangent is symmetric.
bool conservative(const MassSpringModel& model);

}  // namespace springproof
