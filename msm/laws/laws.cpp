#include "msm/laws/laws.h"

namespace springproof {

double energy(const MassSpringModel& model, const NodalVectors& x) {
  double sum = 0;
  for (const ForceLaw& law : model.laws)
    sum += std::visit([&](const auto& l) { return l.energy(model.network, x); }, law);
  return sum;
}

NodalVectors forces(const MassSpringModel& model, const NodalVectors& x) {
  NodalVectors f = NodalVectors::Zero(x.rows(), 3);
  for (const ForceLaw& law : model.laws)
    std::visit([&](const auto& l) { l.add_forces(model.network, x, f); }, law);
  return f;
}

BlockMatrix tangent(const MassSpringModel& model, const NodalVectors& x) {
  BlockMatrix K(coupled_nodes(model.network));
  update_tangent(model, x, K);
  return K;
}

void update_tangent(const MassSpringModel& model, const NodalVectors& x, BlockMatrix& K) {
  K.set_zero();
  for (const ForceLaw& law : model.laws)
    std::visit([&](const auto& l) { l.add_tangent(model.network, x, K); }, law);
}

}  // namespace springproof
