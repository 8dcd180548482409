#include "problem/attached_mass.h"

namespace springproof {

std::vector<Vec3> points_of(const AttachedMass& mass) {
  if (mass.at.size() < 2) return mass.at;
  constexpr int points_of_a_segment = 16;  // each in the middle of its part
  std::vector<Vec3> points;
  for (int i = 0; i < points_of_a_segment; ++i)
    points.push_back(mass.at[0] + (i + 0.5) / points_of_a_segment * (mass.at[1] - mass.at[0]));
  return points;
}

std::vector<Load> loads_of(const AttachedMass& mass, const Vec3& acceleration) {
  const Vec3 force = mass.mass * acceleration;
  if (!mass.on.empty()) return {PatchForce{mass.on, force}};
  const std::vector<Vec3> points = points_of(mass);
  std::vector<Load> loads;
  for (const Vec3& X : points) loads.push_back(PointForce{X, force / static_cast<double>(points.size())});
  return loads;
}

std::vector<Load> weight_of(const AttachedMass& mass, const std::vector<Load>& loads) {
  Vec3 gravity = Vec3::Zero();
  for (const Load& load : loads)
    if (const auto* g = std::get_if<Gravity>(&load)) gravity += g->acceleration;
  return mass.weighs && gravity != Vec3::Zero() ? loads_of(mass, gravity) : std::vector<Load>();
}

}  // namespace springproof
