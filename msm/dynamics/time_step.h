// Stable time step of explicit integration, from bounds on the frequencies of any network.
#pragma once

#include "msm/dynamics/terms/viscosity.h"
#include "msm/laws/laws.h"

namespace springproof {

/// Largest time step [s] of undamped explicit integration (semi-implicit Euler, central differences) about the state at
/// rest: 2 / omega, omega a bound on the frequencies of the network under any supports.  omega^2 combines safe bounds:
///  - springs: k dL^2 <= sum over both ends of k (1 + sqrt(m / m_other)) (n . u)^2, which leaves one 3x3 block per
///    node;
///  - momentum dispersion: additional springs k (R_i + R_j), with R_n of MomentumDispersion::stiffness_bound(); of the
///    volumes of nodes the same along the g of NodalGradients;
///  - volume and hourglass corrections of a lattice of equal cells: with the springs, the stiffest single cell (Irons
///    and Treharne);
///  - averaged springs, in whole or cut cells: the stiffest cell alone, or the norms of the blocks, whichever is less;
///    where bonds tie the cells (InterfaceBond), the stiffest cell or bond alone;
///  - anchors: nothing, as the nodes at them have a support mass (inertia.h);
///  - any other law: the norms of the 3x3 blocks of its stiffness.
/// With a share theta of consistent mass (MassAverage) all of it grows by its largest gain, or for full cells the
/// stiffest one has the mass alpha L - beta theta (L - C), alpha = (1 + 2 a) / (1 + a)^2, beta = 1 / (1 + a)^2,
/// a = 2 theta / 3: not above W^-1, as the tangent of the convex 1 / (1 + z) at a, and a sum over the cells.  So
/// uniform strains, the stiffest motions of most cells, have the factor 1 + 2 theta / 3 that they have in an infinite
/// lattice. A non-conservative form of dispersion can have complex frequencies, whose flutter only damping prevents, no
/// time step; its bound is that of their real part.
/// @param model a model
/// @param density [kg/m^3]
/// @param lagged dispersion of the J of the previous step (DynamicsOptions::lagged), for which a negative dispersed
///   fraction needs a smaller step
/// @param theta share of consistent mass, 0 to 1
/// @return [s]
/// @throws std::invalid_argument if a node has no mass.
double safe_time_step(const MassSpringModel& model, double density, bool lagged = false, double theta = 0);

/// Softens the bonds of a model for explicit motion, so that its step is four fifths or more of that of its full cells:
/// those of two cells together to K <= w^2/4 / sum_a w_a^2/m_a, w the largest frequency of a full cell of the stiffer
/// of their materials; and the same across the interface as along it, so that they keep both momenta at any rotation.
/// @param model of several materials; with none it stays as it is
/// @param density of the body's own material [kg/m^3]
void soften_bonds(MassSpringModel& model, double density);

/// Largest safe step [s] of explicit integration whose viscous forces are those of the velocity half a step before:
/// (sqrt(c^2 + 4 w^2) - c) / w^2, with bounds w^2 on the squared frequencies and c on what viscosity adds.
/// @param model a model
/// @param density [kg/m^3]
/// @param viscosity of the model
/// @param elastic the step without viscosity, safe_time_step() [s]
/// @param theta share of consistent mass, 0 to 1
double viscous_time_step(const MassSpringModel& model, double density, const Viscosity& viscosity, double elastic,
                         double theta = 0);

/// Bound on omega*^2 [1/s^2], the part of the squared frequencies that momentum dispersion adds; 0 if it adds none or
/// reduces them.
/// @param model a model
/// @param density [kg/m^3]
/// @return [1/s^2]
double dispersion_frequency_squared(const MassSpringModel& model, double density);

}  // namespace springproof
