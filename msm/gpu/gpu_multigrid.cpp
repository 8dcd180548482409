#include "msm/gpu/gpu_multigrid.h"

#include <stdexcept>

#include "msm/multigrid/multigrid.h"

namespace springproof {
namespace {

gpu::Box box_of(const LatticeLevel& level) {
  return {level.cells_per_side[0] + 1, level.cells_per_side[1] + 1, level.cells_per_side[2] + 1};
}

int place_of(const gpu::Box& box, const std::array<int, 3>& index) {
  return box.at(1 + index[0], 1 + index[1], 1 + index[2]);
}

gpu::MultigridLevel level_for_gpu(const LatticeLevel& level, const SmoothingLevel& smoothing, const CellMatrix& cell) {
  gpu::MultigridLevel l;
  l.box = box_of(level);
  l.K = cell_blocks<float>(level.edge_ratio * cell, 0);
  l.fill.assign(l.box.size, 0);
  for (std::size_t c = 0; c < level.cell_index.size(); ++c)
    l.fill[place_of(l.box, level.cell_index[c])] = level.fill.empty() ? 1 : static_cast<float>(level.fill[c]);
  l.inverse_diagonal.assign(3 * std::size_t(l.box.size), 0);
  for (long n = 0; n < level.points(); ++n)
    for (int a = 0; a < 3; ++a)
      l.inverse_diagonal[a * l.box.size + place_of(l.box, level.point_index[n])] =
          smoothing.inverse_diagonal[a * level.stride() + n];
  l.largest_eigenvalue = smoothing.largest_eigenvalue;
  return l;
}

}  // namespace

gpu::MultigridForGpu GpuMultigrid::prepared(const LatticeLevels& all, const CellMatrix& cell_of_network, int degree) {
  if (!all.levels[0].fill.empty()) throw std::invalid_argument("a GPU's multigrid is for whole cells");
  const CellMatrix cell = reorder(cell_of_network, all.axes);
  gpu::MultigridForGpu m;
  m.smoothing_degree = degree;
  m.unit = cell.diagonal().mean();
  m.K = cell_blocks<double>(cell, 0);
  const CellMatrix scaled = cell / m.unit;
  for (const LatticeLevel& level : all.levels) {
    SmoothingLevel smoothing(level, scaled);
    if (m.levels.size() + 1 < all.levels.size()) smoothing.bound_eigenvalues(largest_scaled_eigenvalue(scaled));
    m.levels.push_back(level_for_gpu(level, smoothing, scaled));
  }
  const LatticeLevel& coarsest = all.levels.back();
  const gpu::Box& box = m.levels.back().box;
  DirectSolver factors;
  factor_coarsest(assemble(coarsest, scaled), all, false, factors);
  const std::vector<char> fixed = fixed_by_point(coarsest);
  std::vector<long> unknowns;
  for (std::size_t i = 0; i < fixed.size(); ++i) {
    if (fixed[i]) continue;
    unknowns.push_back(static_cast<long>(i));
    m.coarsest_places.push_back(static_cast<int>(i % 3) * box.size + place_of(box, coarsest.point_index[i / 3]));
  }
  for (const long unknown : unknowns) {
    Eigen::VectorXd x;
    factors.solve(Eigen::VectorXd::Unit(static_cast<Eigen::Index>(fixed.size()), unknown), x);
    for (const long row : unknowns) m.coarsest_inverse.push_back(static_cast<float>(x[row]));
  }
  return m;
}

GpuMultigrid::GpuMultigrid(LatticeLevels levels, const CellMatrix& cell, int smoothing_degree)
    : lattice_(std::move(levels)), solver_(prepared(lattice_, cell, smoothing_degree)) {
  const LatticeLevel& finest = lattice_.levels[0];
  const gpu::Box box = box_of(finest);
  size_ = 3 * std::size_t(box.size);
  for (const int point : lattice_.point_of_node) {
    auto& places = places_.emplace_back();
    for (std::size_t a = 0; a < 3; ++a)
      places[lattice_.axes[a]] = a * box.size + place_of(box, finest.point_index[point]);
  }
}

std::vector<double> GpuMultigrid::to_box(const Eigen::VectorXd& nodal) const {
  std::vector<double> box(size_, 0.0);
  for (std::size_t n = 0; n < places_.size(); ++n)
    for (int a = 0; a < 3; ++a) box[places_[n][a]] = nodal[3 * static_cast<long>(n) + a];
  return box;
}

void GpuMultigrid::from_box(const std::vector<double>& box, Eigen::VectorXd& nodal) const {
  nodal.resize(3 * static_cast<long>(places_.size()));
  for (std::size_t n = 0; n < places_.size(); ++n)
    for (int a = 0; a < 3; ++a) nodal[3 * static_cast<long>(n) + a] = box[places_[n][a]];
}

KrylovResult GpuMultigrid::solve(const Eigen::VectorXd& b, double tolerance, int max_iterations, Eigen::VectorXd& u) {
  std::vector<double> right = to_box(b), found;
  const LatticeLevel& finest = lattice_.levels[0];
  const gpu::Box box = box_of(finest);
  for (const int place : finest.fixed)
    right[place / finest.stride() * std::size_t(box.size) +
          place_of(box, finest.point_index[place % finest.stride()])] = 0;
  const gpu::MultigridSolver::Result result = solver_.solve(right, tolerance, max_iterations, found);
  from_box(found, u);
  seconds_ = result.seconds;
  return {result.converged, result.iterations, result.residual, result.negative_curvature};
}

void GpuMultigrid::multiply(const Eigen::VectorXd& x, Eigen::VectorXd& y) {
  std::vector<double> product;
  solver_.multiply(to_box(x), product);
  from_box(product, y);
}

}  // namespace springproof
