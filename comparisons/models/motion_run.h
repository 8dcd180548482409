// The motion of one network under the loads of its case ([dynamics]), with its history and the frames of an animation.
#pragma once

#include "comparisons/models/motion_recorder.h"
#include "msm/statics/equilibrium.h"

namespace springproof {

/// The state at the end of the case's motion; `path` gives the boundary conditions at a fraction of the load.
/// History, all at the time of the positions: kinetic_energy, elastic_energy (of conservative models), branch_energy
/// and dissipated_energy (of a material that relaxes) and load_potential [J], linear [kg m/s] and angular momentum
/// about the origin [kg m^2/s], volume_change [1], the force of every support [N] and the displacement of every probe
/// [m].
/// @throws InputError as steps_of().
Equilibrium run_motion(const MovingNetwork& moving, const LoadPath& path, MotionRecord& record);

}  // namespace springproof
