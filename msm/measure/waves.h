// Plane waves of an infinite lattice of cells at rest: how fast they travel, and the softest of the short ones.
#pragma once

#include "msm/multigrid/cell_stiffness.h"

namespace springproof {

/// Largest relative error of a velocity over directions; negative: too slow.
struct VelocityError {
  double longitudinal;  ///< of the wave that moves along k [1]
  double transverse;    ///< of the two that move across it [1]
};

/// Of the crests, omega / k, and of a pulse, d omega / dk along k: three times as large for long waves.
struct WaveErrors {
  VelocityError phase, group;
};

/// Waves u exp(i k x) of K(k) u = omega^2 m(k) u, K(k) the sum of the blocks of a cell's stiffness times cos(k d), d
/// the distance of their corners, against the velocities of the solid.  `cells` per wavelength; `consistent`: share
/// theta of consistent mass, m(k) = rho l^3 (theta prod (2 + cos k_i l) / 3 + 1 - theta).
/// @throws std::invalid_argument unless the model consists of cells (msm/multigrid/cell_stiffness.h).
WaveErrors wave_errors(const MassSpringModel& model, double shear_modulus, double lame_lambda, double cells,
                       double consistent);

/// The wave of least energy among those shorter than four cells.
struct SoftestWave {
  double stiffness;  ///< smallest eigenvalue of K(k) over G l; 0: a mode without energy
  Vec3 k;            ///< in units of pi / l
};
/// Of a model of cells with the shear modulus G [Pa].
SoftestWave softest_wave(const MassSpringModel& model, double shear_modulus);

/// The wave that a homogeneously strained lattice resists least, relative to its steepness.
/// @param tangent of a cell (strained_cell()), equal along x and y
/// @param unit of stiffness, G l [N/m]
/// @return smallest eigenvalue of K(k) over `unit` sum_i (2 - 2 cos k_i l), over the Brillouin zone: at rest some 0.1
/// to
///   1; 0 or less: the wave grows.  Its k, of the long waves along a direction the one of an eighth of the zone.
SoftestWave weakest_wave(const CellMatrix& tangent, double unit);

}  // namespace springproof
