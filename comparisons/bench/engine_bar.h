// The body of the bench of engines, a bar of 4 x 1 x 1 m clamped at x = 0: its loads, measures and prescribed fields.
#pragma once

#include <string>
#include <vector>

#include "meshes/mesh.h"
#include "problem/loads.h"
#include "problem/material.h"

namespace springproof::bench {

struct EngineBar {
  Cells cells;
  Mesh mesh;
  Eigen::VectorXd mass;         ///< an eighth of each cell's mass per corner [kg]
  std::vector<int> watched;     ///< the nine nodes of the face x = 4 m that all resolutions have
  std::vector<double> weights;  ///< of these in a mean (trapezoidal rule)
};

/// @throws std::invalid_argument unless the section has an even number of cells.
EngineBar engine_bar(const Cells& cells);

/// E = 1e6 Pa, 1000 kg/m^3.
IsotropicMaterial bar_material(double poisson_ratio);

enum class BarLoad { gravity, torque, pressure };

inline constexpr double bar_gravity = 0.3;  ///< along -z [m/s^2]

/// The load, with the clamp if `held`.
std::vector<Load> loads_of(BarLoad load, bool held = true);

/// Consistent nodal forces of a load [N], those on held nodes included.
NodalVectors forces_of(BarLoad load, const EngineBar& bar);

/// What is measured under a load: mean sinking of the end face [m], its mean rotation [rad], relative change of volume
/// [1], all linear in the displacement `u` of the nodes [m].
double measure_of(BarLoad load, const EngineBar& bar, const NodalVectors& u);

/// The same of the displacements of the nine nodes alone; for gravity and torque.
double measure_of_face(BarLoad load, const NodalVectors& points, const NodalVectors& u,
                       const std::vector<double>& weights);

/// A displacement field of constant or linear strain, at most about 1e-3, and its energy in an isotropic solid.
struct TestField {
  std::string name;
  NodalVectors u;  ///< at the nodes [m]
  double energy;   ///< [J]
};

/// stretch (uniaxial stress), lateral (strain yy alone), shear (xz), bending (about y, with its anticlastic part),
/// torsion (without warping), hydrostatic.
std::vector<TestField> test_fields(const EngineBar& bar, const IsotropicMaterial& material);

/// Velocities [m/s] of the first bending mode (Euler's beam) along a unit vector `d` normal to x, with this velocity of
/// the tip.
NodalVectors bending_velocities(const EngineBar& bar, const Vec3& d, double tip_velocity);

/// Velocities [m/s] of a rotation about the z axis through the centre [rad/s].
NodalVectors spin_velocities(const EngineBar& bar, double rate);

}  // namespace springproof::bench
