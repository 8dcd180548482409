// Smooth displacement fields known in closed form, for manufactured solutions: prescribe one on the whole surface, load
// the body by its body force, and the field is the solution.
#pragma once

#include <string>
#include <vector>

#include "problem/material.h"
#include "problem/vector.h"

namespace springproof {

/// "trigonometric": products of sines, three different components, none zero on the surface of the unit cube.
/// "solenoidal": the curl of such a field, hence divergence-free: its stress stays bounded as nu -> 1/2.
/// Both vary over 1 m and are of the order of 0.01 m.
std::vector<std::string> exact_field_names();

/// Displacement [m] at the rest position X [m].
/// @throws std::invalid_argument if there is no field of that name.
Vec3 exact_displacement(const std::string& field, const Vec3& X);

/// -div sigma = -(G laplace u + (lambda + G) grad div u) [N/m^3]: the body force that keeps the field in equilibrium in
/// a linear-elastic solid.
/// @throws std::invalid_argument if there is no field of that name.
Vec3 exact_body_force(const std::string& field, const Vec3& X, const IsotropicMaterial& material);

}  // namespace springproof
