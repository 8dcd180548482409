// How large a step explicit integration may take: bounds on the frequencies of any network.
#pragma once

#include "msm/laws/laws.h"

namespace springproof {

/// Largest time step [s] of undamped explicit integration (semi-implicit Euler, central differences) about the state at
/// rest: 2 / omega, omega a bound on the frequencies of any network of the kind, however it is held.  It is the safe
/// side of:
///  - springs: k dL^2 <= sum over both ends of k (1 + sqrt(m / m_other)) (n . u)^2, so that 3x3 blocks of the nodes
///  remain;
///  - momentum dispersion: springs k (R_i + R_j) beside them, with R_n of MomentumDispersion::stiffness_bound();
///  - volume and hourglass corrections: with the springs, the stiffest single cell (Irons and Treharne);
///  - any other law: the norms of the 3x3 blocks of its stiffness.
/// A non-conservative form of dispersion can have complex frequencies, whose flutter no step cures, only damping; its
/// bound is that of their real part.
/// `lagged`: dispersion from the step before (DynamicsOptions::lagged), where a negative one needs a smaller step.
/// @throws std::invalid_argument if a node has no mass.
double safe_time_step(const MassSpringModel& model, double density, bool lagged = false);

/// Bound on omega*^2 [1/s^2], the part of the squared frequencies that momentum dispersion adds; 0 if it adds none or
/// takes away.
double dispersion_frequency_squared(const MassSpringModel& model, double density);

}  // namespace springproof
