#include "msm/multigrid/cut/cut_multigrid.h"

#include "msm/algebra/fixed.h"

namespace springproof {
namespace {

constexpr int relaxations = 2;  // before and after the coarser lattice

}  // namespace

CutMultigrid::CutMultigrid(const MassSpringModel& model, const std::vector<char>& fixed)
    : nodes_(model.network, fixed) {
  const auto* measured = law_of<MeasuredCells>(model);
  const CellSet& cells = model.network.cells;
  const AveragedSprings law = measured ? mean_springs(*measured, cells) : *averaged_springs_of(model);
  unit_ = law.shear_modulus * cells.edge;
  for (CutLevel& lattice : cut_levels(model.network, nodes_, &law)) {
    const bool finest = levels_.empty();
    const std::vector<char> fixed_here = finest ? nodes_.fixed_corners() : std::vector<char>{};
    CutMatrix<double> of_cells(finest && measured
                                   ? StiffnessOfCells{[&](std::size_t c) { return measured->cell_matrix(cells, c); }}
                                   : averaged_cells(law, lattice),
                               unit_, lattice, fixed_here);
    take_matrix(of_cells, unit_, fixed_here, lattice);
    if (finest) K_ = std::move(of_cells);
    lattice.invert_anchored();
    const Eigen::VectorXf zero = Eigen::VectorXf::Zero(lattice.unknowns());
    std::vector<char> held = finest ? nodes_.unknowns_of_corners() : std::vector<char>{};
    levels_.push_back(std::make_unique<Level>(Level{std::move(lattice), std::move(held), zero, zero, zero}));
  }
  coarsest_.factor(levels_.back()->lattice.A.sparse());
}

Eigen::VectorXd CutMultigrid::diagonal() const {
  Eigen::VectorXd d = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(nodes_.fixed.size()));
  for (int i = 0; i < K_.rows(); ++i)
    if (const double* block = K_.block(i, i))
      for (int a = 0; a < 3; ++a) d[3 * i + a] = unit_ * block[4 * a];
  for (const Anchor& a : nodes_.anchors) d.segment<3>(3 * a.node) += a.stiffness.diagonal();
  return d;
}

void CutMultigrid::Level::smooth(Smoothing when) {
  const CutMatrix<float>& A = lattice.A;
  const std::size_t anchored = lattice.anchored.size();
  for (int s = 0; s < relaxations; ++s) {
    if (when == Smoothing::after_coarse) {
      for (std::size_t c = anchored; c-- > 0;) lattice.relax_anchored(c, b.data(), x.data());
      A.relax(lattice.D, false, b.data(), x.data());
      continue;
    }
    if (s == 0)
      A.relax_from_zero(lattice.D, b.data(), x.data());
    else
      A.relax(lattice.D, true, b.data(), x.data());
    for (std::size_t c = 0; c < anchored; ++c) lattice.relax_anchored(c, b.data(), x.data());
  }
}

void CutMultigrid::Level::restrict_to(Level& below) const {
  below.b.setZero();
  lattice.restrict_to(r, below.lattice, below.b);
}

void CutMultigrid::Level::prolongate(Level& below) {
  lattice.prolongate(below.x, below.lattice, x);
  clear_fixed(fixed, x);
}

void CutMultigrid::apply(const Eigen::VectorXd& r, Eigen::VectorXd& z) const {
  const Eigen::VectorXd b = nodes_.eliminated(r);
  const double largest = b.lpNorm<Eigen::Infinity>(), scale = largest > 0 ? largest : 1;
  Level& finest = *levels_[0];
  finest.b = (b / scale).cast<float>();
  v_cycle(levels_, [&](Level& coarsest) { coarsest.x = coarsest_.solve(coarsest.b); });
  nodes_.complete(r, finest.x.cast<double>() * (scale / unit_), z);
}

}  // namespace springproof
