#include "msm/laws/laws.h"

namespace springproof {
namespace {

/// Positions with carried nodes where they are carried to.
const NodalVectors& carried_along(const Network& network, const NodalVectors& x, NodalVectors& copy) {
  if (network.cells.carried.empty()) return x;
  copy = x;
  carry(network.cells.carried, copy);
  return copy;
}

}  // namespace

double energy(const MassSpringModel& model, const NodalVectors& x) {
  double sum = 0;
  NodalVectors copy;
  const NodalVectors& at = carried_along(model.network, x, copy);
  for (const ForceLaw& law : model.laws)
    sum += std::visit([&](const auto& l) { return l.energy(model.network, at); }, law);
  return sum;
}

NodalVectors forces(const MassSpringModel& model, const NodalVectors& x) {
  NodalVectors f = NodalVectors::Zero(x.rows(), 3);
  NodalVectors copy;
  const NodalVectors& at = carried_along(model.network, x, copy);
  for (const ForceLaw& law : model.laws) std::visit([&](const auto& l) { l.add_forces(model.network, at, f); }, law);
  hand_back(model.network.cells.carried, f);
  return f;
}

Tangent tangent(const MassSpringModel& model, const NodalVectors& x) {
  Tangent K;
  K.local = BlockMatrix(model.network);
  update_tangent(model, x, K);
  return K;
}

void update_tangent(const MassSpringModel& model, const NodalVectors& x, Tangent& K) {
  K.local.set_zero();
  NodalVectors copy;
  const NodalVectors& at = carried_along(model.network, x, copy);
  for (const ForceLaw& law : model.laws)
    std::visit([&](const auto& l) { l.add_tangent(model.network, at, K.local); }, law);
  if (const MomentumDispersion* dispersion = dispersion_of(model)) dispersion->add_flow(model.network, x, K);
}

const MomentumDispersion* dispersion_of(const MassSpringModel& model) { return law_of<MomentumDispersion>(model); }

const AveragedSprings* averaged_springs_of(const MassSpringModel& model) { return law_of<AveragedSprings>(model); }

}  // namespace springproof
