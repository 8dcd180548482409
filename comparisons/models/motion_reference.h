// Finite elements in time, the reference of models in motion ([reference] in_time).
#pragma once

#include <map>
#include <optional>
#include <string>

#include "comparisons/judge/reference_value.h"
#include "comparisons/prepare/prepared_case.h"
#include "comparisons/reference/run_keeper.h"
#include "comparisons/results/records.h"
#include "fem_reference/exchange/reference.h"

namespace springproof {

/// The displacements of the probes in time, with their uncertainty.
struct MotionReference {
  HistoryRecord history;   ///< at the times of steps: displacements, and the finest grid's kinetic energy
  double uncertainty = 0;  ///< of the displacements, relative to their norm over time
  std::map<std::string, ReferenceValue> measured;  ///< as measured_in_time()
  Run run;                                         ///< of the finest grid; `message`: why there is no reference
};

/// What steps of dt lack, from the same with 2 dt, of second order.
NodalVectors step_correction(const NodalVectors& fine, const NodalVectors& coarse);

/// What solve_motion() asks the finite elements.
fem::Request motion_request(const PreparedCase& prepared, const IsotropicMaterial& material);

/// Integrates in time on three grids with equal steps, and on the middle one with steps twice as long, whose difference
/// gives the error of the steps (order two).  The displacements are corrected by it and extrapolated over the grids;
/// three times the correction, which first order would need, counts as uncertainty beside that of the grids.  Blocks:
/// Q2, on coarser grids than equilibria, as each step takes as long as one; bodies of voxels: P2 on the three meshes of
/// the static reference.
MotionReference solve_motion(const PreparedCase& prepared, const IsotropicMaterial& material,
                             const RunKeeper& keeper = {});

/// What three grids and two steps say together.
/// @param solutions of motion_request(), with `time` and `path`, by this or another program
/// @return without a history, and with `run.message`, where one of them has no result or nothing moves
MotionReference limit_of_motion(const PreparedCase& prepared, std::vector<fem::Solution> solutions);

/// Distance of the probes' displacements from the reference in time: root of the mean square over time, divided by
/// that of the reference.
double history_error(const HistoryRecord& model, const HistoryRecord& reference);

/// A quantity at `time`, by the cubic polynomial through the nearest four of its values.
double at_time(const std::vector<double>& times, const std::vector<double>& values, double time);

}  // namespace springproof
