// Viscosity of a moving model: dashpots beside its springs, which resist the rate of strain and nothing else.
#pragma once

#include "msm/laws/laws.h"
#include "problem/material.h"

namespace springproof {

/// Averaged springs with a model's moduli at rest, for what acts beside its own laws.
/// @param model a model
/// @param material of the body
/// @return its own, or those exact for the material
AveragedSprings averaged_beside(const MassSpringModel& model, const IsotropicMaterial& material);

/// Kelvin-Voigt viscosity: a rate of strain adds `time` times Hooke's stress of a strain of that size.  A vibration of
/// circular frequency w loses the share w time / 2 of critical damping, a rigid motion nothing; both momenta are kept
/// at any deformation.
///  - Models of springs alone: a dashpot time * k along each spring.
///  - Measured cells: by their own forms, MeasuredCells::add_viscous_forces().
///  - Others, of cells: AveragedSprings::add_viscous_forces(), with lambda for every nu; below 1/4 dashpots along the
///    springs would resist changes of volume too much.
class Viscosity {
 public:
  /// None.
  Viscosity() = default;

  /// That of a model: along its springs, of its own cells, or of averaged springs exact for the material.
  /// @param time of retardation [s]; 0: none, for any model
  /// @throws InputError for a model that lacks Capability::viscosity, and for time < 0.
  static Viscosity of(const MassSpringModel& model, const IsotropicMaterial& material, double time);

  bool acts() const { return time_ > 0; }
  double time() const { return time_; }                        ///< of retardation [s]
  bool along_springs() const { return along_springs_; }        ///< dashpots are along springs, not of cells
  const AveragedSprings& cells() const { return cells_; }      ///< their stiffness at rest, times time(): the dashpots
  const MeasuredCells& measured() const { return measured_; }  ///< in their place, of a model of such cells
  bool of_measured() const { return !measured_.form.empty(); }

  /// f += viscous forces [N] at positions x [m] and velocities v [m/s], n x 3.
  void add_forces(const Network& network, const NodalVectors& x, const NodalVectors& v, NodalVectors& f) const;

 private:
  double time_ = 0;
  bool along_springs_ = false;
  AveragedSprings cells_;
  MeasuredCells measured_;
};

}  // namespace springproof
