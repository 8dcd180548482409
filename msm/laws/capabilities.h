// What a model can be given to: kernels, solvers, integrators and files ask here, and nowhere else.
#pragma once

#include <string>

#include "msm/laws/laws.h"

namespace springproof {

/// Why a law cannot.
/// @param law any of the list
/// @param what is asked of it
/// @return a sentence; empty: it can
std::string lacks(const ForceLaw& law, Capability what);

/// Why a network cannot, whatever its laws.
/// @param network of a model
/// @param what is asked of it
/// @return a sentence; empty: it can
std::string lacks(const Network& network, Capability what);

/// Why a model cannot, by its laws, how they occur together, and its network.
/// @param model a model
/// @param what is asked of it
/// @return a sentence; empty: it can
std::string lacks(const MassSpringModel& model, Capability what);

/// Whether a model can.
/// @param model a model
/// @param what is asked of it
/// @return true: it lacks nothing
inline bool can(const MassSpringModel& model, Capability what) { return lacks(model, what).empty(); }

}  // namespace springproof
