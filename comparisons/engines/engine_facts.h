// What real-time engines take for a material, for `springproof material`: docs/engines.md.
#pragma once

#include <array>

#include "comparisons/results/facts.h"
#include "problem/material.h"

namespace springproof {

struct EngineFacts {
  const IsotropicMaterial& material;
  double edge;                  ///< of the cells [m]
  std::array<double, 3> inner;  ///< stiffness of springs inside the lattice [N/m]: cell edges, face diagonals, cube
                                ///< diagonals; 0: none
  double correction;            ///< bulk modulus that the model adds to its springs' [Pa]
  double frequency;             ///< of a vibration [Hz]
};

/// Compliances of springs inside, on the surface and on the edges of a lattice, of the constraint on 6 V of a corner
/// tetrahedron (a sixth of a cell) that adds the correction, Bullet's constants, the damping by implicit Euler and the
/// smallest step of single precision 1 m from the origin under 9.81 m/s^2.
FactGroup facts_of(const EngineFacts& facts);

}  // namespace springproof
