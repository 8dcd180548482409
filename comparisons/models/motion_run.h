// The motion of one network under the loads of its case ([dynamics]), with its history and the frames of an animation.
#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "comparisons/prepare/prepared_case.h"
#include "comparisons/results/records.h"
#include "msm/dynamics/dynamics.h"
#include "msm/models.h"
#include "msm/statics/equilibrium.h"

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

/// The network of a case that moves.
struct MovingNetwork {
  const PreparedCase& prepared;
  const Lattice& lattice;
  const EmbeddedModel& built;
  const IsotropicMaterial& material;

  const Network& network() const { return built.model.network; }
  const MotionChoice& motion() const { return *prepared.experiment.dynamics; }
  Eigen::VectorXd masses() const { return springproof::masses(network(), material.density); }  ///< [kg]
};

/// What is recorded of a motion.
struct MotionRecord {
  HistoryRecord history;
  std::vector<std::pair<double, NodalVectors>> frames;  ///< time [s] and displacement of the lattice's mesh [m]
};

/// The state at the end of the case's motion; `path` gives the boundary conditions at a fraction of the load.
/// History, all at the time of the positions: kinetic_energy, elastic_energy (of conservative models), branch_energy
/// and dissipated_energy (of a material that relaxes) and load_potential [J], linear [kg m/s] and angular momentum
/// about the origin [kg m^2/s], volume_change [1], the force of every support [N] and the displacement of every probe
/// [m].
/// @throws InputError as steps_of().
Equilibrium run_motion(const MovingNetwork& moving, const LoadPath& path, MotionRecord& record);

/// The values of a quantity; nullptr: it is not recorded.
const std::vector<double>* series(const HistoryRecord& history, const std::string& name);

/// The component of the probe's displacement that varies most: "displacement.PROBE.z".
std::string liveliest(const HistoryRecord& history, const std::string& probe);

/// "period" [s] and "amplitude" [m] of HistoryRecord::probe once the loads have their final size, of a shaken body from
/// the start; of a pulse the "arrival" [s], of a damped motion the "damping_ratio"; each if there is one.
std::map<std::string, double> measured_in_time(const Experiment& experiment, const HistoryRecord& history);

/// Period and amplitude of the first probe, and what is conserved: the energy of undamped motions after the loads have
/// their final size, the momentum along axes in which nothing is held or loaded.
/// @param moving what moved
/// @param last conditions at the end
/// @param history gets HistoryRecord::probe and HistoryRecord::measured
void measure(const MovingNetwork& moving, const BoundaryConditions& last, HistoryRecord& history);

}  // namespace springproof
