#include "problem/constraints.h"

#include <Eigen/Geometry>
#include <cmath>
#include <type_traits>

#include "problem/exact_field.h"

namespace springproof {
namespace {

PrescribedValue all_components(const Vec3& u) {
  return {u.x(), u.y(), u.z()};
}

PrescribedValue value_at(const PrescribedDisplacement& load, const Vec3&, Kinematics, double factor) {
  PrescribedValue u;
  for (int c = 0; c < 3; ++c)
    if (load.displacement[c]) u[c] = factor * *load.displacement[c];
  return u;
}

PrescribedValue value_at(const PrescribedAffine& load, const Vec3& X, Kinematics, double factor) {
  return all_components(factor * (load.gradient * X + load.offset));
}

PrescribedValue value_at(const PrescribedRotation& load, const Vec3& X, Kinematics kinematics,
                         double factor) {
  const Vec3 arm = X - load.point;
  const double angle = factor * load.angle;
  if (kinematics == Kinematics::linear) return all_components(angle * load.axis.cross(arm));
  // Rodrigues' formula for R arm - arm, with 1 - cos written so that small angles keep their digits.
  const double half_sine = std::sin(angle / 2);
  const Vec3 turned = load.axis.cross(arm);
  return all_components(std::sin(angle) * turned + 2 * half_sine * half_sine * load.axis.cross(turned));
}

PrescribedValue value_at(const PrescribedField& load, const Vec3& X, Kinematics, double factor) {
  return all_components(factor * (load.kelvin ? kelvin_displacement(*load.kelvin, X) : exact_displacement(load.field, X)));
}

template <class OtherLoad>
PrescribedValue value_at(const OtherLoad&, const Vec3&, Kinematics, double) {
  return {};
}

template <class T>
constexpr bool prescribes = std::is_same_v<T, PrescribedDisplacement> || std::is_same_v<T, PrescribedAffine> ||
                            std::is_same_v<T, PrescribedRotation> || std::is_same_v<T, PrescribedField>;

}  // namespace

const std::string* patch_of(const Load& load) {
  return std::visit(
      [](const auto& l) -> const std::string* {
        if constexpr (requires { l.on; })
          return &l.on;
        else
          return nullptr;
      },
      load);
}

bool prescribes_displacement(const Load& load) {
  return std::visit([](const auto& l) { return prescribes<std::decay_t<decltype(l)>>; }, load);
}

PrescribedValue prescribed_displacement(const Load& load, const Vec3& X, Kinematics kinematics,
                                        double factor) {
  return std::visit([&](const auto& l) { return value_at(l, X, kinematics, factor); }, load);
}

}  // namespace springproof
