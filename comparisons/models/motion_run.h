// The motion of one network under the loads of its case ([dynamics]), with its history and the frames of an animation.
#pragma once

#include <map>
#include <utility>
#include <vector>

#include "comparisons/prepare/prepared_case.h"
#include "comparisons/results/records.h"
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

/// The values of a quantity; nullptr: it is not recorded.
const std::vector<double>* series(const HistoryRecord& history, const std::string& name);

/// The component of the probe's displacement that varies most: "displacement.PROBE.z".
std::string liveliest(const HistoryRecord& history, const std::string& probe);

/// "period" [s] and "amplitude" [m] of HistoryRecord::probe once the loads have their final size, of a shaken body from
/// the start; of a pulse the "arrival" [s], of a damped motion the "damping_ratio"; each if there is one.
std::map<std::string, double> measured_in_time(const MotionChoice& motion, const HistoryRecord& history);

/// Refuses a time step beyond the model's bound, and a motion of too many steps, before anything is run.
/// @throws InputError at time_step_s or [dynamics].
void check_motion(const MotionChoice& motion, const MassSpringModel& model, const IsotropicMaterial& material);

}  // namespace springproof
