// What is measured in the history of a motion.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "comparisons/models/motion_recorder.h"
#include "comparisons/results/records.h"

namespace springproof {

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
