// Kernels of an instruction set, and the constants of laws in their units.
#pragma once

#include <algorithm>
#include <stdexcept>

#include "msm/kernels/instruction_set.h"
#include "msm/kernels/lattice_layout.h"

namespace springproof {

/// Those of one instruction set.
/// @throws std::invalid_argument for a set that is not usable here.
template <class Real>
LatticeKernels<Real> lattice_kernels(InstructionSet set) {
  const auto& usable = usable_instruction_sets();
  if (std::find(usable.begin(), usable.end(), set) == usable.end())
    throw std::invalid_argument("instruction set " + name_of(set) + " cannot be used here");
  LatticeKernels<Real> kernels;
#ifdef SPRINGPROOF_X86_KERNELS
  if (set == InstructionSet::avx512)
    avx512::get_lattice_kernels(kernels);
  else if (set == InstructionSet::avx2)
    avx2::get_lattice_kernels(kernels);
  else
#endif
    portable::get_lattice_kernels(kernels);
  return kernels;
}

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
