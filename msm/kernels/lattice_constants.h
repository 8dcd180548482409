// The constants of laws in the units of the lattice kernels.
#pragma once

#include "msm/kernels/lattice_layout.h"

namespace springproof {

/// Of a hourglass correction in cells of this edge [m].
template <class Real>
LatticeHourglass<Real> lattice_constants(const HourglassCorrection::Stiffness& k, double edge) {
  const auto real = [&](double value) {
    return static_cast<Real>(value * edge / 8);
  };  // patterns have entries +-1, not +-1/sqrt(8)
  return {real(k.bending), real(k.coupling), real(k.torsion), real(k.torsion_coupling)};
}

/// Of averaged springs, times this factor.
template <class Real>
LatticeAveraged<Real> averaged_constants(const AveragedSprings& law, double factor) {
  const double G = factor * law.shear_modulus, lambda = factor * law.lame_lambda;
  const HourglassStiffness& h = law.hourglass;
  const auto stiffness = [&](double value) { return static_cast<Real>(G / 8 * value); };
  return {
      lattice_curve(law.curve), static_cast<Real>(G),  static_cast<Real>(lambda), static_cast<Real>(lambda + 2 * G / 3),
      stiffness(h.bending),     stiffness(h.coupling), stiffness(h.torsion),      stiffness(h.twist),
      stiffness(h.warping)};
}

/// Of averaged springs in cells of this edge [m]; of dashpots, times their time of retardation [s].
template <class Real>
LatticeAveraged<Real> lattice_constants(const AveragedSprings& law, double edge, double time = 1) {
  return averaged_constants<Real>(law, time * edge * edge);
}

}  // namespace springproof
