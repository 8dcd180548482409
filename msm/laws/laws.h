// The list of all force laws, each a plain value, and the model that they form with a network.  The law suite of tests
// fails for a law of this list that it has no case for (tests/laws/law_suite_test.cpp).
#pragma once

#include <algorithm>
#include <utility>
#include <variant>
#include <vector>

#include "msm/laws/anchors.h"
#include "msm/laws/angular_springs.h"
#include "msm/laws/averaged_springs.h"
#include "msm/laws/hourglass_correction.h"
#include "msm/laws/measured_cells.h"
#include "msm/laws/momentum_dispersion.h"
#include "msm/laws/springs.h"
#include "msm/laws/volume_correction.h"

namespace springproof {

/// Any of the force laws.
using ForceLaw = std::variant<Springs, VolumeCorrection, HourglassCorrection, MomentumDispersion, AngularSprings,
                              AveragedSprings, MeasuredCells, Anchors>;

/// Properties of a law.
/// @param law any of the list
/// @return its `traits`
inline const LawTraits& traits(const ForceLaw& law) {
  return std::visit([](const auto& l) -> const LawTraits& { return l.traits; }, law);
}

/// A mass-spring model: a network and its force laws.
struct MassSpringModel {
  Network network;                        ///< nodes, springs and cells
  std::vector<ForceLaw> laws;             ///< their forces are added
  bool small_displacements_only = false;  ///< valid for linear kinematics only
};

/// Elastic energy; the sum of those of the laws.
/// @param model a model; laws without an energy count 0 (Capability::energy)
/// @param x positions [m], n x 3
/// @return [J]; +infinity where a law has none, as in an inverted cell
double energy(const MassSpringModel& model, const NodalVectors& x);

/// Internal forces, -dE/dx of a conservative model, by plain loops on one thread.
/// @param model a model
/// @param x positions [m], n x 3
/// @return force on each node [N], n x 3
NodalVectors forces(const MassSpringModel& model, const NodalVectors& x);

/// Tangent stiffness.
/// @param model a model
/// @param x positions [m], n x 3
/// @return -df/dx [N/m]
Tangent tangent(const MassSpringModel& model, const NodalVectors& x);

/// Recomputes a tangent made by tangent() at another state, keeping its sparsity pattern.
/// @param model the same model
/// @param x positions [m], n x 3
/// @param K the tangent, overwritten
void update_tangent(const MassSpringModel& model, const NodalVectors& x, Tangent& K);

/// The model's law of a kind.
/// @param model a model
/// @return the first one, or nullptr if the model has none
template <class Law>
const Law* law_of(const MassSpringModel& model) {
  for (const ForceLaw& law : model.laws)
    if (const auto* found = std::get_if<Law>(&law)) return found;
  return nullptr;
}
/// The same, to be changed.
/// @param model a model
/// @return the first one, or nullptr if the model has none
template <class Law>
Law* law_of(MassSpringModel& model) {
  return const_cast<Law*>(law_of<Law>(std::as_const(model)));
}

/// Whether a model has laws of these kinds only.
/// @param model a model
/// @return true: it has no other
template <class... Laws>
bool consists_of(const MassSpringModel& model) {
  return std::all_of(model.laws.begin(), model.laws.end(),
                     [](const ForceLaw& law) { return (std::holds_alternative<Laws>(law) || ...); });
}

/// Takes the laws of a kind from a model.
/// @param model a model
template <class Law>
void erase_laws(MassSpringModel& model) {
  std::erase_if(model.laws, [](const ForceLaw& law) { return std::holds_alternative<Law>(law); });
}

/// The model's momentum dispersion.
/// @param model a model
/// @return it, or nullptr if the model has none
const MomentumDispersion* dispersion_of(const MassSpringModel& model);

/// The model's averaged springs.
/// @param model a model
/// @return them, or nullptr if the model has none
const AveragedSprings* averaged_springs_of(const MassSpringModel& model);

}  // namespace springproof
