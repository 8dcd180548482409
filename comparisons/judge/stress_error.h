// Stresses against those of the reference.
#pragma once

#include "comparisons/judge/measures.h"

namespace springproof {

/// How far stresses are off.
struct StressDifference {
  double von_mises = 0;  ///< L2 norm over the body, relative to that of von Mises' stress [1]
  double hydrostatic =
      0;            ///< of the mean normal stress; relative to its norm, or a tenth of von Mises' if that is more [1]
  double peak = 0;  ///< largest von Mises' stress, relative; negative: too small [1]
  Eigen::Index place = 0;  ///< row of the largest true one
};

/// @param volumes of the points [m^3]; 0: for the peak alone
StressDifference stress_difference(const ProbeStresses& stress, const ProbeStresses& truth,
                                   const Eigen::VectorXd& volumes);

/// Largest von Mises' stress [Pa].
double peak_stress(const ProbeStresses& stress);

/// Whether the peaks of three grids, coarse to fine, have a limit: at a singular edge or corner each step is as large
/// as the last.
bool peaks_converge(double coarse, double middle, double fine);

}  // namespace springproof
