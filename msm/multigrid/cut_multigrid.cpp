#include "msm/multigrid/cut_multigrid.h"

#include <algorithm>

namespace springproof {
namespace {

constexpr int relaxations = 2;  // before and after the coarser lattice

}  // namespace

bool CutMultigrid::covers(const MassSpringModel& model) {
  if (model.network.filled.empty() || !averaged_springs_of(model)) return false;
  return std::all_of(model.laws.begin(), model.laws.end(), [](const ForceLaw& law) {
    return std::holds_alternative<AveragedSprings>(law) || std::holds_alternative<Anchors>(law);
  });
}

CutMultigrid::CutMultigrid(const MassSpringModel& model, const std::vector<char>& fixed)
    : nodes_(model.network, fixed),
      unit_(averaged_springs_of(model)->shear_modulus * model.network.cell_edge),
      levels_(cut_levels(model.network, nodes_)) {
  for (CutLevel& level : levels_) {
    const bool finest = &level == &levels_.front();
    const std::vector<char> fixed_here = finest ? nodes_.fixed_corners() : std::vector<char>{};
    CutMatrix<double> of_cells(*averaged_springs_of(model), unit_, level, fixed_here);
    take_matrix(of_cells, unit_, fixed_here, level);
    if (finest) K_ = std::move(of_cells);
    level.invert_anchored();
    const Eigen::VectorXf zero = Eigen::VectorXf::Zero(level.unknowns());
    at_level_.push_back({zero, zero, zero});
  }
  coarsest_.factor(levels_.back().A.sparse());
}

Eigen::VectorXd CutMultigrid::diagonal() const {
  Eigen::VectorXd d = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(nodes_.fixed.size()));
  for (int i = 0; i < K_.rows(); ++i)
    if (const double* block = K_.block(i, i))
      for (int a = 0; a < 3; ++a) d[3 * i + a] = unit_ * block[4 * a];
  for (const Anchor& a : nodes_.anchors) d.segment<3>(3 * a.node).array() += a.stiffness;
  return d;
}

void CutMultigrid::cycle(std::size_t l) const {
  auto& [b, x, r] = at_level_[l];
  if (l + 1 == levels_.size()) {
    x = coarsest_.solve(b);
    return;
  }
  const CutLevel& level = levels_[l];
  for (int s = 0; s < relaxations; ++s) {
    if (s == 0)
      level.A.relax_from_zero(level.D, b.data(), x.data());
    else
      level.A.relax(level.D, true, b.data(), x.data());
    for (std::size_t c = 0; c < level.anchored.size(); ++c) level.relax_anchored(c, b.data(), x.data());
  }
  level.A.residual(b.data(), x.data(), r.data());
  Vectors& below = at_level_[l + 1];
  below.b.setZero();
  level.restrict_to(r, levels_[l + 1], below.b);
  cycle(l + 1);
  level.prolongate(below.x, levels_[l + 1], x);
  if (l == 0)
    for (Eigen::Index i = 0; i < x.size(); ++i)
      if (nodes_.fixed[i]) x[i] = 0;
  for (int s = 0; s < relaxations; ++s) {
    for (std::size_t c = level.anchored.size(); c-- > 0;) level.relax_anchored(c, b.data(), x.data());
    level.A.relax(level.D, false, b.data(), x.data());
  }
}

void CutMultigrid::apply(const Eigen::VectorXd& r, Eigen::VectorXd& z) const {
  const Eigen::VectorXd b = nodes_.eliminated(r);
  const double largest = b.lpNorm<Eigen::Infinity>(), scale = largest > 0 ? largest : 1;
  at_level_[0].b = (b / scale).cast<float>();
  cycle(0);
  nodes_.complete(r, at_level_[0].x.cast<double>() * (scale / unit_), z);
}

}  // namespace springproof
