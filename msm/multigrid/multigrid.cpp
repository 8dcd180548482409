#include "msm/multigrid/multigrid.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <stdexcept>

#include "msm/algebra/dense.h"
#include "msm/algebra/noise.h"

namespace springproof {
namespace {

constexpr int smoothing_degree = 3;
constexpr int lanczos_steps = 10;

void solve_coarsest(const DirectSolver& factors, SmoothingLevel& level) {
  const long points = level.K.level().points(), stride = level.K.stride();
  Eigen::VectorXd b(3 * points), x;
  for (long n = 0; n < points; ++n)
    for (int a = 0; a < 3; ++a) b[3 * n + a] = level.r[a * stride + n];
  factors.solve(b, x);
  for (long n = 0; n < points; ++n)
    for (int a = 0; a < 3; ++a) level.x[a * stride + n] = static_cast<float>(x[3 * n + a]);
}

/// Whether the fixed unknowns of a level constrain all six rigid motions.
bool holds_rigid_motions(const LatticeLevel& level) {
  Eigen::Matrix<double, 6, 6> sum = Eigen::Matrix<double, 6, 6>::Zero();
  const double size = *std::max_element(level.cells_per_side.begin(), level.cells_per_side.end());
  for (int place : level.fixed) {
    const int a = static_cast<int>(place / level.stride());
    const auto& at = level.point_index[place % level.stride()];
    const Vec3 x = Vec3(at[0], at[1], at[2]) / size;
    Eigen::Matrix<double, 6, 1> motion;  // a-component of three translations and three rotations at x
    motion << Vec3::Unit(a), x.cross(Vec3::Unit(a));
    sum += motion * motion.transpose();
  }
  const Eigen::VectorXd found = symmetric_eigenvalues(sum);
  return found[0] > 1e-12 * found[5];
}

/// Largest eigenvalue of diag(K)^-1 K of one cell: a bound for every lattice of such cells.
double largest_scaled_eigenvalue(const CellMatrix& cell) {
  const CellVector root = cell.diagonal().cwiseSqrt().cwiseInverse();
  const CellMatrix scaled = root.asDiagonal() * cell * root.asDiagonal();
  return symmetric_eigenvalues(scaled)[23];
}

}  // namespace

void factor_coarsest(BlockMatrix K, const LatticeLevels& lattice, bool may_float, DirectSolver& coarsest) {
  const LatticeLevel& level = lattice.levels.back();
  std::vector<char> fixed(3 * level.points(), 0);
  for (int place : level.fixed) fixed[3 * (place % level.stride()) + place / level.stride()] = 1;
  const bool held = holds_rigid_motions(level);
  if (!may_float && !holds_rigid_motions(lattice.levels[0])) throw std::runtime_error("the body is not held");
  // Without supports, pivots at the level of single precision are those of rigid motions.
  if (coarsest.factor(K, fixed, held ? 1e-14 : 1e-7)) return;
  if (!may_float && held) throw std::runtime_error("the coarsest lattice is singular: the model has zero-energy modes");
  const double anchor = 1e-3 * K.diagonal().mean();
  for (int n = 0; n < K.nodes(); ++n) K.add(n, n, anchor * Eigen::Matrix3d::Identity());
  if (!coarsest.factor(K, fixed)) throw std::runtime_error("the coarsest lattice is not positive definite");
}

void restrict_field(const LatticeLevel& coarse, const CellKernels<float>& kernels, long fine_stride, const float* fine,
                    float* field) {
  for (const TransferRow& row : coarse.transfer)
    for (int a = 0; a < 3; ++a)
      for (int k = 0; k < row.count; ++k)
        kernels.restrict_row(row.length, row.odd, 1.0f / static_cast<float>(row.count),
                             fine + a * fine_stride + row.fine, field + a * coarse.stride() + row.coarse[k]);
}

void prolongate_field(const LatticeLevel& coarse, const CellKernels<float>& kernels, const float* field,
                      long fine_stride, float* fine) {
  for (const TransferRow& row : coarse.transfer)
    for (int a = 0; a < 3; ++a) {
      const float* from[4] = {};
      for (int k = 0; k < row.count; ++k) from[k] = field + a * coarse.stride() + row.coarse[k];
      kernels.prolongate_row(row.length, row.odd, 1.0f / static_cast<float>(row.count), from, row.count,
                             fine + a * fine_stride + row.fine);
    }
}

Multigrid::Multigrid(LatticeLevels levels, const CellMatrix& cell_of_network, bool may_float, double mass)
    : lattice_(std::move(levels)),
      K_(lattice_.levels[0], cell_of_levels(cell_of_network + CellMatrix(mass * CellMatrix::Identity()), lattice_)) {
  // The stiffness of a cell grows with its edge, its mass with the cube.
  const auto of_level = [&](const LatticeLevel& level) {
    const double masses = level.edge_ratio * level.edge_ratio * mass;
    return cell_of_levels(cell_of_network + CellMatrix(masses * CellMatrix::Identity()), lattice_);
  };
  const CellMatrix finest = of_level(lattice_.levels[0]);
  const double unit = finest.diagonal().mean();
  unit_ = 1 / unit;
  cell_ = reorder(cell_of_network + CellMatrix(mass * CellMatrix::Identity()), lattice_.axes);
  for (const LatticeLevel& level : lattice_.levels) {
    const CellMatrix here = of_level(level) / unit;
    SmoothingLevel& l = *levels_.emplace_back(std::make_unique<SmoothingLevel>(level, here));
    if (levels_.size() == lattice_.levels.size()) break;
    l.bound_eigenvalues(largest_scaled_eigenvalue(here));
    l.thin = ThinParts::of(level, here);
  }
  factor_coarsest(assemble(lattice_.levels.back(), of_level(lattice_.levels.back()) / unit), lattice_, may_float,
                  coarsest_);
}

SmoothingLevel::SmoothingLevel(const LatticeLevel& level, const CellMatrix& cell) : K(level, cell) {
  const Eigen::VectorXd d = diagonal(level, cell);
  inverse_diagonal = (d.array() > 0).select(1 / d.array(), 0).cast<float>().matrix();
  level.clear_fixed(inverse_diagonal);
  r = z = x = Eigen::VectorXf::Zero(3 * level.stride());
}

/// Lanczos in the inner product of diag(K), from a pseudo-random vector.  The sum of the largest Ritz value and its
/// residual is observed to bound the spectrum from above (Zhou and Saad's bound for Chebyshev filters).
void SmoothingLevel::bound_eigenvalues(double at_most) {
  const long stride = K.stride();
  const Eigen::ArrayXf D = (inverse_diagonal.array() > 0).select(inverse_diagonal.array().inverse(), 0);
  Eigen::VectorXf &v = z, &w = r, &before = x;
  fill_with_noise(v);
  v.array() *= (D > 0).cast<float>();
  v /= std::sqrt((v.array().square() * D).sum());
  before.setZero();
  Eigen::VectorXd alpha(lanczos_steps), beta(lanczos_steps);
  for (int k = 0; k < lanczos_steps; ++k) {
    if (k > 0)
      w = static_cast<float>(-beta[k - 1]) * before;
    else
      w.setZero();
    double curvature = 0;
    K.pass(v.data(), nullptr, nullptr, [&](int a, long begin, long n, const float* y) {
      const long at = a * stride + begin;
      const Eigen::Map<const Eigen::VectorXf> Kv(y, n);
      curvature += Kv.dot(v.segment(at, n));
      w.segment(at, n) += inverse_diagonal.segment(at, n).cwiseProduct(Kv);
      before.segment(at, n) = v.segment(at, n);
    });
    alpha[k] = curvature;
    w -= static_cast<float>(curvature) * before;
    beta[k] = std::sqrt(double((w.array().square() * D).sum()));
    if (!(beta[k] > 1e-6)) return void(largest_eigenvalue = at_most);
    v = w / static_cast<float>(beta[k]);
  }
  const Eigenpairs ritz = tridiagonal_eigenpairs(alpha, beta.head(lanczos_steps - 1));
  const double residual = beta[lanczos_steps - 1] * std::abs(ritz.vectors(lanczos_steps - 1, lanczos_steps - 1));
  largest_eigenvalue = std::min(at_most, ritz.values[lanczos_steps - 1] + residual);
  r.setZero();
  z.setZero();
}

/// Chebyshev steps `first` ... `last`, each after the residual update of the step before.
void SmoothingLevel::chebyshev(int first, int last) {
  const long stride = K.stride();
  for (int k = first; k <= last; ++k) {
    const ChebyshevStep step(k, largest_eigenvalue);
    K.pass(z.data(), nullptr, nullptr, [&](int a, long begin, long n, const float* y) {
      const long at = a * stride + begin;
      K.kernels().chebyshev(n, y, inverse_diagonal.data() + at, static_cast<float>(step.previous),
                            static_cast<float>(step.step), r.data() + at, z.data() + at, x.data() + at);
    });
  }
}

/// r -= K z.
void SmoothingLevel::residual() {
  K.pass(z.data(), nullptr, nullptr, [&](int a, long begin, long n, const float* y) {
    r.segment(a * K.stride() + begin, n) -= Eigen::Map<const Eigen::VectorXf>(y, n);
  });
  K.level().clear_fixed(r);
}

void SmoothingLevel::smooth(Smoothing when) {
  if (when == Smoothing::after_coarse) {
    if (thin) thin->correct(r.data(), z.data());
    x += z;
    chebyshev(1, smoothing_degree);
    return;
  }
  z = static_cast<float>(ChebyshevStep(1, largest_eigenvalue).step) * inverse_diagonal.cwiseProduct(r);
  x = z;
  chebyshev(2, smoothing_degree);
  if (!thin) return;
  residual();
  z.setZero();
  thin->correct(r.data(), z.data());
  x += z;
}

void SmoothingLevel::restrict_to(SmoothingLevel& below) {
  below.r.setZero();
  restrict_field(below.K.level(), K.kernels(), K.stride(), r.data(), below.r.data());
}

void SmoothingLevel::prolongate(const SmoothingLevel& below) {
  prolongate_field(below.K.level(), K.kernels(), below.x.data(), K.stride(), z.data());
  K.level().clear_fixed(z);
}

void Multigrid::cycle() {
  v_cycle(levels_, [&](SmoothingLevel& level) { solve_coarsest(coarsest_, level); });
}

void Multigrid::apply_rows(const Eigen::VectorXd& r, Eigen::VectorXd& z) {
  const double scale = r.cwiseAbs().maxCoeff();  // single precision has digits enough, not range
  if (!(scale > 0)) {
    z.setZero(r.size());
    return;
  }
  finest().r = (r / scale).cast<float>();
  cycle();
  z = (scale * unit_) * finest().x.cast<double>();
}

void Multigrid::multiply_rows(const Eigen::VectorXd& x, Eigen::VectorXd& y) {
  const long stride = K_.stride();
  y.resize(x.size());
  K_.pass(x.data(), nullptr, nullptr, [&](int a, long begin, long n, const double* values) {
    std::memcpy(y.data() + a * stride + begin, values, n * sizeof(double));
  });
  for (int a = 0; a < 3; ++a) y.segment((a + 1) * stride - array_slack, array_slack).setZero();
}

void Multigrid::multiply(const Eigen::VectorXd& x, Eigen::VectorXd& y) {
  Eigen::VectorXd x_rows, y_rows;
  lattice_.to_rows(Nodal::displacements, x, x_rows);
  multiply_rows(x_rows, y_rows);
  lattice_.from_rows(Nodal::forces, y_rows, y);
}

Eigen::VectorXd Multigrid::diagonal() const {
  const LatticeLevel& finest = lattice_.levels[0];
  const Eigen::VectorXd rows = springproof::diagonal(finest, cell_);
  Eigen::VectorXd d(static_cast<Eigen::Index>(3 * lattice_.point_of_node.size()));
  for (std::size_t n = 0; n < lattice_.point_of_node.size(); ++n)
    for (int a = 0; a < 3; ++a)
      d[static_cast<Eigen::Index>(3 * n) + lattice_.axes[a]] = rows[a * finest.stride() + lattice_.point_of_node[n]];
  return d;
}

void Multigrid::apply(const Eigen::VectorXd& r, Eigen::VectorXd& z) {
  Eigen::VectorXd r_rows, z_rows;
  lattice_.to_rows(Nodal::forces, r, r_rows);
  apply_rows(r_rows, z_rows);
  lattice_.from_rows(Nodal::displacements, z_rows, z);
}

KrylovResult Multigrid::solve(const Eigen::VectorXd& b, double tolerance, int max_iterations, Eigen::VectorXd& u) {
  const LatticeLevel& finest = lattice_.levels[0];
  Eigen::VectorXd b_rows, u_rows;
  lattice_.to_rows(Nodal::forces, b, b_rows);
  finest.clear_fixed(b_rows);
  u_rows.setZero(b_rows.size());
  const Operator K = [&](const Eigen::VectorXd& x, Eigen::VectorXd& y) {
    multiply_rows(x, y);
    finest.clear_fixed(y);
  };
  const Operator condition = [&](const Eigen::VectorXd& r, Eigen::VectorXd& z) { apply_rows(r, z); };
  const KrylovResult result = conjugate_gradients(K, condition, b_rows, tolerance, max_iterations, u_rows);
  lattice_.from_rows(Nodal::displacements, u_rows, u);
  return result;
}

}  // namespace springproof
