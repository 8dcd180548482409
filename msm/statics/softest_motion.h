// The motion that a state of equilibrium resists least.
#pragma once

#include "msm/statics/equilibrium.h"
#include "msm/statics/stiffness_solver.h"

namespace springproof {

/// By inverse iteration with the tangent K of the state against that at rest, on the free unknowns: a state that is
/// about to be lost has a stiffness near 0, and the motion that grows there.
/// @param model a conservative one
/// @param K its tangent at the state, positive definite
/// @param fixed unknowns
SoftestMotion softest_motion(const MassSpringModel& model, const StiffnessSolver& K, const std::vector<char>& fixed);

}  // namespace springproof
