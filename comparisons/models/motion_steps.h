// The time steps of a model of a case ([dynamics]).
#pragma once

#include "msm/dynamics/motion.h"
#include "problem/case_file/experiment.h"

namespace springproof {

/// The steps of a motion.
struct MotionSteps {
  MotionOptions options;  ///< with a time step
  long stride;            ///< from one sample of the history to the next
};

/// Those of a model, checked before anything is run.
/// @param experiment a case with [dynamics]
/// @param model a model of the case
/// @param material its material
/// @return the integrator, which "auto" leaves open, and its steps
/// @throws InputError at the key of [dynamics] or [material] that does not suit the model, or of too many steps.
MotionSteps steps_of(const Experiment& experiment, const MassSpringModel& model, const IsotropicMaterial& material);

}  // namespace springproof
