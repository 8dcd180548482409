#include "problem/loads.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>
#include <stdexcept>
#include <type_traits>

#include "problem/exact_field.h"

namespace springproof {
namespace {

PrescribedValue all_components(const Vec3& u) { return {u.x(), u.y(), u.z()}; }

PrescribedValue value_at(const PrescribedDisplacement& load, const Vec3&, Kinematics, double factor) {
  PrescribedValue u;
  for (int c = 0; c < 3; ++c)
    if (load.displacement[c]) u[c] = factor * *load.displacement[c];
  return u;
}

PrescribedValue value_at(const PrescribedAffine& load, const Vec3& X, Kinematics, double factor) {
  return all_components(factor * (load.gradient * X + load.offset));
}

PrescribedValue value_at(const PrescribedRotation& load, const Vec3& X, Kinematics kinematics, double factor) {
  const Vec3 arm = X - load.point;
  const double angle = factor * load.angle;
  if (kinematics == Kinematics::linear) return all_components(angle * load.axis.cross(arm));
  // Rodrigues' formula for R arm - arm, with 1 - cos = 2 sin^2(angle / 2) to avoid cancellation at small angles.
  const double half_sine = std::sin(angle / 2);
  const Vec3 turned = load.axis.cross(arm);
  return all_components(std::sin(angle) * turned + 2 * half_sine * half_sine * load.axis.cross(turned));
}

PrescribedValue value_at(const PrescribedField& load, const Vec3& X, Kinematics, double factor) {
  return all_components(factor *
                        (load.kelvin ? kelvin_displacement(*load.kelvin, X) : exact_displacement(load.field, X)));
}

template <class OtherLoad>
PrescribedValue value_at(const OtherLoad&, const Vec3&, Kinematics, double) {
  return {};
}

template <class T>
constexpr bool prescribes = std::is_same_v<T, PrescribedDisplacement> || std::is_same_v<T, PrescribedAffine> ||
                            std::is_same_v<T, PrescribedRotation> || std::is_same_v<T, PrescribedField>;

template <class OptionalWrench, class AnyLoad>
OptionalWrench* wrench_in(AnyLoad& load) {
  return std::visit(
      [](auto& l) -> OptionalWrench* {
        if constexpr (requires { l.wrench; })
          return &l.wrench;
        else
          return nullptr;
      },
      load);
}

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

std::optional<Wrench>* wrench_of(Load& load) { return wrench_in<std::optional<Wrench>>(load); }
const std::optional<Wrench>* wrench_of(const Load& load) { return wrench_in<const std::optional<Wrench>>(load); }

void RegionMoments::add(double weight, const Vec3& X) {
  measure += weight;
  first += weight * X;
  second += weight * X * X.transpose();
}

RigidField rigid_field(const RegionMoments& region, const Wrench& wrench) {
  if (!(region.measure > 0)) throw std::invalid_argument("a load acts on nothing: the patch has no area");
  RigidField field;
  field.c = region.first / region.measure;
  field.a = wrench.force / region.measure;
  const Eigen::Matrix3d central = region.second - region.measure * field.c * field.c.transpose();
  const Eigen::Matrix3d inertia = central.trace() * Eigen::Matrix3d::Identity() - central;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(inertia);
  if (!(eigen.eigenvalues()[0] > 1e-10 * eigen.eigenvalues()[2]))
    throw std::invalid_argument("a load acts on a line: the patch bears no moment about it");
  field.b = inertia.inverse() * moved(wrench, field.c).moment;
  return field;
}

Vec3 RigidField::at(const Vec3& X) const { return a + b.cross(X - c); }

Wrench moved(const Wrench& w, const Vec3& about) {
  return {w.force, w.moment + (w.about - about).cross(w.force), about};
}

bool prescribes_displacement(const Load& load) {
  return std::visit([](const auto& l) { return prescribes<std::decay_t<decltype(l)>>; }, load);
}

PrescribedValue prescribed_displacement(const Load& load, const Vec3& X, Kinematics kinematics, double factor) {
  return std::visit([&](const auto& l) { return value_at(l, X, kinematics, factor); }, load);
}

}  // namespace springproof
