// Loads and prescribed displacements of a body.  Geometry appears only as patch names and points.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <variant>

#include "problem/kelvin.h"
#include "problem/vector.h"

namespace springproof {

/// Displacement given on a patch, component by component; an empty component is free.
struct PrescribedDisplacement {
  std::string on;                                     ///< patch name
  std::array<std::optional<double>, 3> displacement;  ///< [m]
};

/// An affine displacement u = gradient * X + offset on a patch (the patch test).
struct PrescribedAffine {
  std::string on;                                      ///< patch name
  Eigen::Matrix3d gradient = Eigen::Matrix3d::Zero();  ///< [1]
  Vec3 offset = Vec3::Zero();                          ///< [m]
};

/// Rigid rotation of a patch about an axis.
/// Under linear kinematics the rotation is the linearised one, u = angle * axis x (X - point).
struct PrescribedRotation {
  std::string on;             ///< patch name
  Vec3 point = Vec3::Zero();  ///< a point of the axis [m]
  Vec3 axis = Vec3::UnitZ();  ///< direction, normalised by the reader
  double angle = 0;           ///< [rad]
};

/// A named displacement field, prescribed on a patch (problem/exact_field.h); "kelvin": that of the case's point force.
struct PrescribedField {
  std::string on;                             ///< patch name
  std::string field;                          ///< name of the field
  std::optional<KelvinSolution> kelvin = {};  ///< of the field "kelvin"
};

/// Resultant of a load: force [N], and moment [N m] about a point [m].
struct Wrench {
  Vec3 force = Vec3::Zero();   ///< [N]
  Vec3 moment = Vec3::Zero();  ///< [N m]
  Vec3 about = Vec3::Zero();   ///< point that the moment refers to [m]
};

// The loads below may carry their resultant on the true body.  A discretisation, whose patches and volume only
// approximate the body's, then adds the field a + b x (X - c), over the patch's area or the volume, so that its
// resultant is exactly this wrench.  `wrench` empty: no field is added.

/// Force per rest area, constant in direction (dead load) [Pa].
struct Traction {
  std::string on;                     ///< patch name
  Vec3 traction = Vec3::Zero();       ///< [Pa]
  std::optional<Wrench> wrench = {};  ///< resultant on the true body
};

/// Traction -pressure * outward rest normal (dead load) [Pa]; positive presses on the body.
struct Pressure {
  std::string on;                     ///< patch name
  double pressure = 0;                ///< [Pa]
  std::optional<Wrench> wrench = {};  ///< resultant on the true body
};

/// Total force [N], spread over the patch as a uniform traction.
struct PatchForce {
  std::string on;                     ///< patch name
  Vec3 force = Vec3::Zero();          ///< [N]
  std::optional<Wrench> wrench = {};  ///< resultant on the true body
};

/// Acceleration field acting on the whole body [m/s^2].
struct Gravity {
  Vec3 acceleration = Vec3::Zero();   ///< [m/s^2]
  std::optional<Wrench> wrench = {};  ///< resultant on the true body
};

/// Force [N] at the rest point `at` [m]; distributed over the nodes of the element that contains the point.
struct PointForce {
  Vec3 at = Vec3::Zero();     ///< [m]
  Vec3 force = Vec3::Zero();  ///< [N]
};

/// The body force that keeps a named displacement field in equilibrium (problem/exact_field.h); small strains.
struct FieldBodyForce {
  std::string field;  ///< name of the field
};

/// Any load or prescribed displacement.
using Load = std::variant<PrescribedDisplacement, PrescribedAffine, PrescribedRotation, PrescribedField, Traction,
                          Pressure, PatchForce, Gravity, PointForce, FieldBodyForce>;

/// Name of the patch a load acts on; nullptr for gravity, point and body forces.
const std::string* patch_of(const Load& load);

/// The wrench that a load carries, or nullptr for the kinds that carry none.
const std::optional<Wrench>* wrench_of(const Load& load);
std::optional<Wrench>* wrench_of(Load& load);  ///< the same, to be set

/// The field a + b x (X - c) of force per area or volume, determined by the moments of the region that it acts on.
struct RigidField {
  Vec3 a = Vec3::Zero();  ///< [Pa], of a body force [N/m^3]
  Vec3 b = Vec3::Zero();  ///< [Pa/m], [N/m^4]
  Vec3 c = Vec3::Zero();  ///< [m]

  /// Its value at rest position X.
  Vec3 at(const Vec3& X) const;
};

/// Moments of a region, from which the rigid field with a given resultant follows.
struct RegionMoments {
  double measure = 0;                                ///< area [m^2] or volume [m^3]
  Vec3 first = Vec3::Zero();                         ///< integral of X
  Eigen::Matrix3d second = Eigen::Matrix3d::Zero();  ///< integral of X X^T

  /// Adds a piece of the region: its area or volume, at X.
  void add(double weight, const Vec3& X);
};

/// The rigid field whose resultant over the region is the wrench.
/// @throws std::invalid_argument if the region has zero measure, or is a line, which cannot carry a moment about
/// itself.
RigidField rigid_field(const RegionMoments& region, const Wrench& wrench);

/// The wrench about another point.
Wrench moved(const Wrench& wrench, const Vec3& about);

/// True for the loads that prescribe displacement.
bool prescribes_displacement(const Load& load);

/// Small displacements from rest, or any.
enum class Kinematics { linear, finite };

/// Displacement along x, y and z [m]; empty where it is free.
using PrescribedValue = std::array<std::optional<double>, 3>;

/// Displacement [m] that `load` prescribes at rest position X when a fraction `factor` of it is applied.
/// Free components are empty; loads that prescribe none return three empty components.
/// Rotations turn by factor * angle (finite) or are linearised (linear).
PrescribedValue prescribed_displacement(const Load& load, const Vec3& X, Kinematics kinematics, double factor = 1.0);

}  // namespace springproof
