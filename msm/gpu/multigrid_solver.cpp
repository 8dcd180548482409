#include <algorithm>
#include <chrono>
#include <cmath>

#include "msm/gpu/gpu.h"
#include "msm/gpu/multigrid_level.h"
#include "msm/multigrid/chebyshev.h"

namespace springproof::gpu {
namespace {

/// A level's arrays, and one step of its smoother after the other.
struct LevelOnGpu {
  explicit LevelOnGpu(const MultigridLevel& l)
      : box(l.box),
        fill(l.fill),
        inverse_diagonal(l.inverse_diagonal),
        r(3L * l.box.size),
        x(r.size()),
        z{Array<float>(r.size()), Array<float>(r.size())},
        cells{l.K, fill.data()},
        largest_eigenvalue(l.largest_eigenvalue) {}

  template <class Finish>
  void sweep(const Finish& finish) {
    const float* from = z[now].data();
    const Sweep<float, LinearCells<float>, Finish> sweep{
        box, {from, from + box.size, from + 2 * box.size}, cells, finish, nullptr};
    launch(sweep, box.blocks);
  }

  /// Chebyshev steps `first` ... `last`, each after the residual update of the step before.
  void smooth(int first, int last) {
    for (int k = first; k <= last; ++k) {
      const ChebyshevStep step(k, largest_eigenvalue);
      sweep(Smooth{inverse_diagonal.data(), z[now].data(), z[1 - now].data(), r.data(), x.data(), box.size,
                   static_cast<float>(step.previous), static_cast<float>(step.step)});
      now = 1 - now;
    }
  }

  void before_coarse(int degree) {
    launch_each(FirstStep{inverse_diagonal.data(), r.data(), z[now].data(), x.data(),
                          static_cast<float>(ChebyshevStep(1, largest_eigenvalue).step)},
                r.size());
    smooth(2, degree);
    sweep(TakeResidual{inverse_diagonal.data(), r.data(), box.size});
  }

  Box box;
  Array<float> fill, inverse_diagonal, r, x, z[2];
  LinearCells<float> cells;
  double largest_eigenvalue;
  int now = 0;  ///< which of z
};

}  // namespace

struct MultigridSolver::Data {
  explicit Data(const MultigridForGpu& m)
      : degree(m.smoothing_degree),
        unit(m.unit),
        K(m.K),
        fill(std::vector<double>(m.levels[0].fill.begin(), m.levels[0].fill.end())),
        inverse(m.coarsest_inverse),
        places(m.coarsest_places),
        coarsest_r(places.size()),
        b(3L * m.levels[0].box.size),
        u(b.size()),
        r(b.size()),
        p(b.size()),
        y(b.size()),
        partial(long(sums_of_launch) * std::max(blocks_for(b.size()), m.levels[0].box.number_of_blocks())),
        sums(partial.size()) {
    for (const MultigridLevel& level : m.levels) levels.emplace_back(level);
    for (std::size_t l = 0; l + 1 < m.levels.size(); ++l) transfers.push_back({m.levels[l].box, m.levels[l + 1].box});
  }

  double sum(long blocks) {
    download(sums.data(), partial.data(), sizeof(double) * sums_of_launch * blocks);
    double total = 0;
    for (long block = 0; block < blocks; ++block) total += sums[block * sums_of_launch];
    return total;
  }

  template <class Each>
  double sum_of_each(const Each& each) {
    launch_each(each, b.size(), partial.data());
    return sum(blocks_for(b.size()));
  }

  /// y = K x on the unknowns that are `free`; returns x . y.
  double multiply(const Array<double>& x, const float* free) {
    const Box& box = levels[0].box;
    const double* from = x.data();
    const Sweep<double, LinearCells<double>, StoreProduct<double>> sweep{box,
                                                                         {from, from + box.size, from + 2 * box.size},
                                                                         {K, fill.data()},
                                                                         {free, from, y.data(), box.size},
                                                                         partial.data()};
    launch(sweep, box.blocks);
    return sum(box.number_of_blocks());
  }

  void cycle(std::size_t l) {
    LevelOnGpu& level = levels[l];
    if (l + 1 == levels.size()) {
      launch_each(Gather{places.data(), level.r.data(), coarsest_r.data()}, places.size());
      launch_each(SolveCoarsest{inverse.data(), coarsest_r.data(), places.data(), static_cast<int>(places.size()),
                                level.x.data()},
                  places.size());
      return;
    }
    LevelOnGpu& below = levels[l + 1];
    level.before_coarse(degree);
    launch_each(Restrict{transfers[l], level.r.data(), below.r.data()}, nodes(below.box));
    cycle(l + 1);
    launch_each(Prolongate{transfers[l], below.x.data(), level.inverse_diagonal.data(), level.z[level.now].data(),
                           level.x.data()},
                nodes(level.box));
    level.smooth(1, degree);
  }

  static long nodes(const Box& box) { return long(box.nodes[0]) * box.nodes[1] * box.nodes[2]; }

  int degree;
  double unit;
  CellBlocks<double> K;
  Array<double> fill;
  std::vector<LevelOnGpu> levels;
  std::vector<Transfer> transfers;
  Array<float> inverse;
  Array<int> places;
  Array<float> coarsest_r;
  Array<double> b, u, r, p, y, partial;
  std::vector<double> sums;
};

MultigridSolver::MultigridSolver(const MultigridForGpu& multigrid) : data_(std::make_unique<Data>(multigrid)) {}
MultigridSolver::~MultigridSolver() = default;

MultigridSolver::Result MultigridSolver::solve(const std::vector<double>& b, double tolerance, int max_iterations,
                                               std::vector<double>& u) {
  Data& d = *data_;
  Result result;
  d.b.write(b.data());
  d.r.write(b.data());
  for (Array<double>* zero : {&d.u, &d.p, &d.y}) zero->clear();
  wait();
  const auto start = std::chrono::steady_clock::now();
  LevelOnGpu& finest = d.levels[0];
  const double scale = std::sqrt(d.sum_of_each(Residual{d.b.data(), d.y.data()}));  // y = K 0
  double norm = scale, rz = 0;
  while (norm > tolerance * scale && result.iterations < max_iterations) {
    // The cycle sees r / |r|: single precision has digits enough, not range.
    launch_each(Rounded{d.r.data(), finest.r.data(), 1 / norm}, d.r.size());
    d.cycle(0);
    const double factor = norm / d.unit, before = rz;
    rz = factor * d.sum_of_each(Product{d.r.data(), finest.x.data()});
    launch_each(NextDirection{finest.x.data(), d.p.data(), factor, result.iterations == 0 ? 0 : rz / before},
                d.p.size());
    const double curvature = d.multiply(d.p, finest.inverse_diagonal.data());
    if (!(curvature > 0)) {
      result.negative_curvature = true;
      break;
    }
    norm = std::sqrt(d.sum_of_each(StepAlong{d.p.data(), d.y.data(), d.u.data(), d.r.data(), rz / curvature}));
    ++result.iterations;
  }
  d.multiply(d.u, finest.inverse_diagonal.data());
  if (scale > 0) result.residual = std::sqrt(d.sum_of_each(Residual{d.b.data(), d.y.data()})) / scale;
  result.converged = result.residual <= 10 * tolerance;
  wait();
  result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  u.resize(b.size());
  d.u.read(u.data());
  return result;
}

void MultigridSolver::multiply(const std::vector<double>& x, std::vector<double>& y) {
  data_->p.write(x.data());
  data_->multiply(data_->p, nullptr);
  y.resize(x.size());
  data_->y.read(y.data());
}

double MultigridSolver::bytes() const {
  const Data& d = *data_;
  std::size_t bytes = d.fill.bytes() + d.inverse.bytes() + 5 * d.b.bytes() + d.partial.bytes();
  for (const LevelOnGpu& l : d.levels) bytes += l.fill.bytes() + 5 * l.r.bytes();
  return double(bytes);
}

}  // namespace springproof::gpu
