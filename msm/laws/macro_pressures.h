// The volume term of macro-cells with pressures as unknowns, for nu near 1/2.
#pragma once

#include "msm/laws/macro_springs.h"

namespace springproof {

/// A macro-cell whose term (lambda - G) V <U(theta)> is replaced by p . theta, p the pressures of its four modes.
struct MacroPressureForm {
  MacroTangent tangent;                   ///< springs: of all but p . theta's modulus, at these pressures
  Eigen::Matrix<double, 81, 1> gradient;  ///< dE/dx [N]
  Eigen::Vector4d slope;                  ///< V d<U>/dtheta [m^3]; (lambda - G) slope = p in equilibrium
};

/// @param law of the cell
/// @param network that it is in
/// @param cell number of the macro-cell
/// @param x positions [m], n x 3
/// @param pressures p of its modes [Pa m^3]
/// @return NaN if the cell is inverted at a point
MacroPressureForm pressure_form(const MacroSprings& law, const Network& network, std::size_t cell,
                                const NodalVectors& x, const Eigen::Vector4d& pressures);

}  // namespace springproof
