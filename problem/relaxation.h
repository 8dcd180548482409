// A material that relaxes: Maxwell elements beside the long-time solid, and their exact course over a time step.
#pragma once

#include <vector>

#include "problem/material.h"

namespace springproof {

/// A Maxwell element beside the long-time solid: a spring whose overstrain Q follows Q' + Q / time = E', E the
/// deviatoric strain.  Its stress is 2 share G Q.
struct RelaxationBranch {
  double share;  ///< of its shear modulus in the long-time one, G [1]
  double time;   ///< of relaxation [s]
};

/// Branches beside a solid whose moduli are those at long times.  The bulk modulus does not relax.
struct Relaxation {
  std::vector<RelaxationBranch> branches = {};

  bool acts() const { return !branches.empty(); }

  /// @return the shear modulus of a sudden strain over that at long times [1]
  double instantaneous() const;
  /// @param time after a sudden strain [s]
  /// @return stress over that at long times [1]
  double modulus_after(double time) const;
  /// @param time under a constant stress [s]; infinity: 1
  /// @return strain over that at long times [1]
  double creep_after(double time) const;
  /// @param rate circular frequency of a vibration [1/s]
  /// @return G', the stress in phase with the strain, over G [1]
  double storage(double rate) const;
  /// @param rate circular frequency of a vibration [1/s]
  /// @return G'', the stress ahead of the strain by a quarter of a period, over G [1]
  double loss(double rate) const;
};

/// A solid with another shear modulus and the same bulk modulus.
/// @param material any
/// @param factor of its shear modulus, > 0 [1]
/// @return E and nu of the other
IsotropicMaterial with_shear(const IsotropicMaterial& material, double factor);

/// What becomes of an overstrain Q over a step in which the strain changes linearly, exactly at any step: at its end
/// decay Q + phi dE, in the mean phi Q + psi dE, dE the change of strain.  x = step / time -> 0: the midpoint;
/// x -> infinity: time dE / step, a dashpot.
struct BranchStep {
  double decay, phi, psi;

  /// @param ratio of the step to the branch's time, x >= 0
  static BranchStep of(double ratio);

  template <class Strain>
  Strain end(const Strain& Q, const Strain& change) const {
    return decay * Q + phi * change;
  }
  template <class Strain>
  Strain mean(const Strain& Q, const Strain& change) const {
    return phi * Q + psi * change;
  }
};

}  // namespace springproof
