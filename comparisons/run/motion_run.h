// The motion of one network under the loads of its case ([dynamics]), with its history and the frames of an animation.
#pragma once

#include <utility>
#include <vector>

#include "comparisons/report/results.h"
#include "comparisons/run/prepared_case.h"
#include "msm/models.h"
#include "msm/statics/equilibrium.h"

namespace springproof {

/// What is recorded of a motion.
struct MotionRecord {
  HistoryRecord history;
  std::vector<std::pair<double, NodalVectors>> frames;  ///< time [s] and displacement of the lattice's mesh [m]
};

/// The state at the end of the case's motion; `path` gives the boundary conditions at a fraction of the load.
/// History, all at the time of the positions: kinetic_energy, elastic_energy (of conservative models) and
/// load_potential [J], linear [kg m/s] and angular momentum about the origin [kg m^2/s], volume_change [1], the force
/// of every support [N] and the displacement of every probe [m].
/// @throws InputError at time_step_s, if the step is not safe for the model.
Equilibrium run_motion(const PreparedCase& prepared, const Lattice& lattice, const EmbeddedModel& built,
                       const IsotropicMaterial& material, const LoadPath& path, MotionRecord& record);

/// Refuses a time step beyond the model's bound, and a motion of too many steps, before anything is run.
/// @throws InputError at time_step_s or [dynamics].
void check_motion(const MotionChoice& motion, const MassSpringModel& model, const IsotropicMaterial& material);

}  // namespace springproof
