// Viscosity of a moving model: dashpots beside its springs, which resist the rate of strain and nothing else.
#pragma once

#include <string>

#include "msm/laws/laws.h"
#include "problem/material.h"

namespace springproof {

/// Kelvin-Voigt viscosity: a rate of strain adds `time` times Hooke's stress of a strain of that size.  A vibration of
/// circular frequency w loses the share w time / 2 of critical damping, a rigid motion nothing; both momenta are kept
/// at any deformation.
///  - Models of springs alone: a dashpot time * k along each spring.
///  - Others, of cells: AveragedSprings::add_viscous_forces(), with lambda for every nu; below 1/4 dashpots along the
///    springs would resist changes of volume too much.
struct Viscosity {
  double time = 0;             ///< of retardation [s]; 0: none
  bool along_springs = false;  ///< dashpots are along springs, not of cells
  AveragedSprings cells;       ///< whose stiffness at rest, times `time`, are the dashpots of cells

  /// Why a model cannot have viscosity; empty: it can.
  static std::string lacks(const MassSpringModel& model);

  /// Of a model that can have it: along its springs, of its own averaged springs, or of those exact for the material.
  static Viscosity of(const MassSpringModel& model, const IsotropicMaterial& material, double time);

  /// f += viscous forces [N] at positions x [m] and velocities v [m/s], n x 3.
  void add_forces(const Network& network, const NodalVectors& x, const NodalVectors& v, NodalVectors& f) const;
};

/// Largest safe step [s] of explicit integration whose viscous forces are those of the velocity half a step before:
/// (sqrt(c^2 + 4 w^2) - c) / w^2, with bounds w^2 on the squared frequencies and c on what viscosity adds.
/// @param model a model
/// @param density [kg/m^3]
/// @param viscosity of the model
/// @param elastic the step without viscosity, safe_time_step() [s]
double viscous_time_step(const MassSpringModel& model, double density, const Viscosity& viscosity, double elastic);

}  // namespace springproof
