#include "msm/multigrid/cut/cut_mixed_multigrid.h"

#include <Eigen/LU>
#include <algorithm>
#include <set>

#include "msm/algebra/fixed.h"
#include "msm/multigrid/v_cycle.h"
#include "msm/parameters/calibrate.h"

namespace springproof {
namespace {

/// A cell in units of a length.
CellShape in_units(CellShape cell, double length) {
  cell.edge /= length;
  return cell;
}

constexpr int sweeps_of_cut_cells = 2;  // before and after the coarser lattice
constexpr float damped = 2;             // of the inverse diagonal blocks in the Schur complement; 1 diverges

/// Row of B and entry of C of a cell; without a pressure p = 0 on its own.
struct VolumeRow {
  Eigen::Matrix<double, 24, 1> gradient = Eigen::Matrix<double, 24, 1>::Zero();
  double compliance = 1;

  /// Of a cell in units; `kappa` of the materials.
  VolumeRow(const CellShape& cell, const std::vector<double>& kappa) {
    if (!(kappa[cell.material] > 0)) return;
    gradient = volume_gradient(cell);
    compliance = cell.volume() / kappa[cell.material];
  }
};

}  // namespace

/// One level of the cycle, in single precision.
class CutMixedMultigrid::Level {
 public:
  /// Of a lattice with the matrix of its springs alone; `fixed_unknowns` of the finest level, else empty.
  Level(CutLevel lattice_of_level, std::vector<char> fixed_unknowns);
  /// Sets the rows of B and C, for cells in units of `finest_edge`.
  void set_volumes(double finest_edge, const std::vector<double>& kappa, int schur_sweeps);

  void smooth(Smoothing when);
  void residual();  ///< d = f - K u - B^T p, Bu = B u
  void restrict_to(Level& below) const;
  void prolongate(Level& below);
  void solve_coarsest(const CoarsestFactors& factors);

  CutLevel lattice;
  Eigen::VectorXf f, g, u, p;

 private:
  /// Points of CutLevel::anchored, relaxed together with the pressures of the cells that have no others.  These are
  /// left out of S: bonds and anchors are stiff, so D knows nothing of how both sides move together.
  struct Patch {
    std::vector<int> points, cells;
    Eigen::MatrixXf gradient;  ///< rows of B of the cells
    Eigen::MatrixXf inverse;   ///< of their rows and columns of the saddle point
  };
  void set_up_patches();
  Patch patch_of(std::vector<int> points, std::vector<int> cells, const Carriers& carriers) const;
  void relax_patch(const Patch& patch, Eigen::VectorXf& b);  ///< b = load(), and stays so
  void set_up_schur();
  void relax_schur(bool ascending);  ///< Gauss-Seidel for S q = r
  void sweep(bool ascending);
  Eigen::VectorXf load() const;  ///< f - B^T p
  void divergence(const Eigen::VectorXf& displacements, Eigen::VectorXf& out) const;
  void add_gradient(const Eigen::VectorXf& pressures, Eigen::VectorXf& out) const;
  void scale_by_diagonal(Eigen::VectorXf& v) const;

  std::vector<char> fixed_;      ///< unknowns; empty: none
  std::vector<float> gradient_;  ///< 24 per cell: row of B
  Eigen::VectorXf compliance_;   ///< diagonal of C
  int schur_sweeps_ = 0;
  std::vector<Patch> patches_;
  std::vector<int> begin_, column_;  ///< of the rows of S = C + B D B^T, a cell each
  std::vector<float> schur_;         ///< its entries
  Eigen::VectorXf inverse_schur_;    ///< of its diagonal
  Eigen::VectorXf d_, Bu_, r_, q_;
};

CutMixedMultigrid::Level::Level(CutLevel lattice_of_level, std::vector<char> fixed_unknowns)
    : lattice(std::move(lattice_of_level)), fixed_(std::move(fixed_unknowns)) {
  const std::size_t cells = lattice.cubes.size();
  f = u = d_ = Eigen::VectorXf::Zero(lattice.unknowns());
  compliance_ = inverse_schur_ = g = p = Bu_ = r_ = q_ = Eigen::VectorXf::Zero(static_cast<Eigen::Index>(cells));
}

void CutMixedMultigrid::Level::set_volumes(double finest_edge, const std::vector<double>& kappa, int schur_sweeps) {
  schur_sweeps_ = schur_sweeps;
  gradient_.resize(24 * lattice.cubes.size());
  for (std::size_t c = 0; c < lattice.cubes.size(); ++c) {
    const VolumeRow row(in_units(lattice.shape(c), finest_edge), kappa);
    for (int i = 0; i < 24; ++i) gradient_[24 * c + i] = static_cast<float>(row.gradient[i]);
    compliance_[static_cast<Eigen::Index>(c)] = static_cast<float>(row.compliance);
  }
  set_up_schur();
  set_up_patches();
}

void CutMixedMultigrid::Level::set_up_schur() {
  struct Entry {
    int cell;
    Eigen::Vector3f b, Db;
  };
  std::vector<std::vector<Entry>> at(lattice.point.size());  // columns of B, with what carried corners hand back
  const Carriers carriers = carriers_of(static_cast<int>(lattice.point.size()), lattice.carried);
  const int cells = static_cast<int>(lattice.corners.size());
  const auto hand = [&](int i, int c, const Eigen::Vector3f& b) {
    const Eigen::Map<const Eigen::Matrix<float, 3, 3, Eigen::RowMajor>> D(&lattice.D[9 * static_cast<std::size_t>(i)]);
    at[i].push_back({c, b, damped * (D * b)});
  };
  for (int c = 0; c < cells; ++c)
    for (int n = 0; n < 8; ++n) {
      const Eigen::Vector3f b = Eigen::Map<const Eigen::Vector3f>(&gradient_[24 * static_cast<std::size_t>(c) + 3 * n]);
      for_each_carrier(carriers, lattice.corners[c][n],
                       [&](int i, double w) { hand(i, c, static_cast<float>(w) * b); });
    }
  begin_ = {0};
  std::vector<int> place(cells, -1);  // of each column in the row
  std::set<int> points;
  for (int c = 0; c < cells; ++c) {
    const int start = begin_.back();
    const auto add = [&](int column, float value) {
      if (place[column] < start) {
        place[column] = static_cast<int>(column_.size());
        column_.push_back(column);
        schur_.push_back(0);
      }
      schur_[place[column]] += value;
    };
    add(c, compliance_[c]);
    points.clear();
    for (const int q : lattice.corners[c]) for_each_carrier(carriers, q, [&](int i, double) { points.insert(i); });
    for (const int i : points)
      for (const Entry& own : at[i])
        if (own.cell == c)
          for (const Entry& other : at[i]) add(other.cell, own.b.dot(other.Db));
    inverse_schur_[c] = 1 / schur_[start];
    begin_.push_back(static_cast<int>(column_.size()));
  }
}

void CutMixedMultigrid::Level::set_up_patches() {
  if (lattice.anchors.empty() && lattice.bonds.empty()) return;
  const Carriers carriers = carriers_of(static_cast<int>(lattice.point.size()), lattice.carried);
  std::vector<std::vector<int>> cells_at(lattice.point.size()), points_of(lattice.corners.size());
  for (std::size_t c = 0; c < lattice.corners.size(); ++c)
    for (const int n : lattice.corners[c])
      for_each_carrier(carriers, n, [&](int i, double) {
        cells_at[i].push_back(static_cast<int>(c));
        points_of[c].push_back(i);
      });
  for (std::vector<int>& points : lattice.anchored_points()) {
    const auto is_inside = [&](int i) { return std::binary_search(points.begin(), points.end(), i); };
    std::set<int> cells;
    for (const int point : points)
      for (const int c : cells_at[point])
        if (std::all_of(points_of[c].begin(), points_of[c].end(), is_inside)) cells.insert(c);
    for (const int c : cells) inverse_schur_[c] = 0;
    patches_.push_back(patch_of(std::move(points), {cells.begin(), cells.end()}, carriers));
  }
}

CutMixedMultigrid::Level::Patch CutMixedMultigrid::Level::patch_of(std::vector<int> points, std::vector<int> cells,
                                                                   const Carriers& carriers) const {
  const Eigen::Index n = 3 * static_cast<Eigen::Index>(points.size()), m = static_cast<Eigen::Index>(cells.size());
  Eigen::MatrixXf B = Eigen::MatrixXf::Zero(m, n);
  for (Eigen::Index k = 0; k < m; ++k)
    for (int corner = 0; corner < 8; ++corner)
      for_each_carrier(carriers, lattice.corners[cells[k]][corner], [&](int i, double w) {
        const auto at = 3 * (std::lower_bound(points.begin(), points.end(), i) - points.begin());
        const float* b = &gradient_[24 * static_cast<std::size_t>(cells[k]) + 3 * corner];
        for (int a = 0; a < 3; ++a)
          if (fixed_.empty() || !fixed_[3 * i + a]) B(k, at + a) += static_cast<float>(w) * b[a];
      });
  Eigen::MatrixXd whole = Eigen::MatrixXd::Zero(n + m, n + m);
  whole.topLeftCorner(n, n) = lattice.dense(points);
  whole.bottomLeftCorner(m, n) = B.cast<double>();
  whole.topRightCorner(n, m) = B.cast<double>().transpose();
  for (Eigen::Index k = 0; k < m; ++k) whole(n + k, n + k) = -compliance_[cells[k]];
  return {std::move(points), std::move(cells), std::move(B), whole.inverse().cast<float>()};
}

void CutMixedMultigrid::Level::relax_patch(const Patch& patch, Eigen::VectorXf& b) {
  const Eigen::Index n = patch.gradient.cols(), m = patch.gradient.rows();
  Eigen::VectorXf r(n + m), own(n);
  for (Eigen::Index i = 0; i < n / 3; ++i) {
    lattice.A.residual(b.data(), u.data(), patch.points[i], r.data() + 3 * i);
    own.segment<3>(3 * i) = u.segment<3>(3 * patch.points[i]);
  }
  r.tail(m).noalias() = -patch.gradient * own;
  for (Eigen::Index k = 0; k < m; ++k) r[n + k] += g[patch.cells[k]] + compliance_[patch.cells[k]] * p[patch.cells[k]];
  const Eigen::VectorXf d = patch.inverse * r, force = patch.gradient.transpose() * d.tail(m);
  for (Eigen::Index i = 0; i < n / 3; ++i) {
    u.segment<3>(3 * patch.points[i]) += d.segment<3>(3 * i);
    b.segment<3>(3 * patch.points[i]) -= force.segment<3>(3 * i);
  }
  for (Eigen::Index k = 0; k < m; ++k) p[patch.cells[k]] += d[n + k];
}

void CutMixedMultigrid::Level::relax_schur(bool ascending) {
  const int rows = static_cast<int>(r_.size());
  for (int n = 0; n < rows; ++n) {
    const int i = ascending ? n : rows - 1 - n;
    float even = 0, odd = 0;  // two sums, since each addition waits for the one before
    int e = begin_[i];
    for (; e + 1 < begin_[i + 1]; e += 2) {
      even += schur_[e] * q_[column_[e]];
      odd += schur_[e + 1] * q_[column_[e + 1]];
    }
    if (e < begin_[i + 1]) even += schur_[e] * q_[column_[e]];
    const float sum = r_[i] - even - odd;
    q_[i] += inverse_schur_[i] * sum;
  }
}

void CutMixedMultigrid::Level::divergence(const Eigen::VectorXf& displacements, Eigen::VectorXf& out) const {
  const float* b = gradient_.data();
  Eigen::VectorXf copy;
  if (!lattice.carried.empty()) {
    copy = displacements;
    carry(lattice.carried, copy);
  }
  const float* at = lattice.carried.empty() ? displacements.data() : copy.data();
  for (std::size_t c = 0; c < lattice.corners.size(); ++c, b += 24) {
    float sum = 0;
    for (int n = 0; n < 8; ++n) {
      const float* v = at + 3 * lattice.corners[c][n];
      sum += b[3 * n] * v[0] + b[3 * n + 1] * v[1] + b[3 * n + 2] * v[2];
    }
    out[static_cast<Eigen::Index>(c)] = sum;
  }
}

void CutMixedMultigrid::Level::add_gradient(const Eigen::VectorXf& pressures, Eigen::VectorXf& out) const {
  const float* b = gradient_.data();
  for (std::size_t c = 0; c < lattice.corners.size(); ++c, b += 24) {
    const float value = pressures[static_cast<Eigen::Index>(c)];
    for (int n = 0; n < 8; ++n) {
      float* v = out.data() + 3 * lattice.corners[c][n];
      for (int a = 0; a < 3; ++a) v[a] += value * b[3 * n + a];
    }
  }
  hand_back(lattice.carried, out);
}

void CutMixedMultigrid::Level::scale_by_diagonal(Eigen::VectorXf& v) const {
  const float* D = lattice.D.data();
  for (Eigen::Index i = 0; i < v.size(); i += 3, D += 9) {
    const float x = v[i], y = v[i + 1], z = v[i + 2];
    for (int a = 0; a < 3; ++a) v[i + a] = damped * (D[3 * a] * x + D[3 * a + 1] * y + D[3 * a + 2] * z);
  }
}

Eigen::VectorXf CutMixedMultigrid::Level::load() const {
  Eigen::VectorXf all = f;
  const Eigen::VectorXf minus_p = -p;
  add_gradient(minus_p, all);
  clear_fixed(fixed_, all);
  return all;
}

void CutMixedMultigrid::Level::residual() {
  lattice.A.residual(load().data(), u.data(), d_.data());
  divergence(u, Bu_);
}

/// Gauss-Seidel for the displacements, then pressures q and displacements -D B^T q that restore the volumes.
void CutMixedMultigrid::Level::sweep(bool ascending) {
  Eigen::VectorXf b = load();
  const auto relax_patches = [&] {
    const std::size_t count = patches_.size();
    for (std::size_t c = 0; c < count; ++c) relax_patch(patches_[ascending ? c : count - 1 - c], b);
  };
  if (!ascending) relax_patches();
  lattice.A.relax(lattice.D, ascending, b.data(), u.data());
  if (ascending) relax_patches();
  divergence(u, Bu_);
  r_ = Bu_ - g - compliance_.cwiseProduct(p);
  q_.setZero();
  for (int s = 0; s < schur_sweeps_; ++s) relax_schur((s % 2 == 0) == ascending);
  Eigen::VectorXf t = Eigen::VectorXf::Zero(u.size());
  add_gradient(q_, t);
  scale_by_diagonal(t);
  u -= t;
  p += q_;
  b = load();
  relax_patches();
}

void CutMixedMultigrid::Level::smooth(Smoothing when) {
  const bool before = when == Smoothing::before_coarse;
  if (before) {
    u.setZero();
    p.setZero();
  }
  for (int s = 0; s < sweeps_of_cut_cells; ++s) sweep(before);
}

void CutMixedMultigrid::Level::restrict_to(Level& below) const {
  below.f.setZero();
  lattice.restrict_to(d_, below.lattice, below.f);
  below.g.setZero();
  const Eigen::VectorXf volumes = g - Bu_ + compliance_.cwiseProduct(p);
  for (Eigen::Index c = 0; c < volumes.size(); ++c) below.g[lattice.parent[c]] += volumes[c];
}

void CutMixedMultigrid::Level::prolongate(Level& below) {
  lattice.prolongate(below.u, below.lattice, u);
  clear_fixed(fixed_, u);
  for (Eigen::Index c = 0; c < p.size(); ++c) p[c] += below.p[lattice.parent[c]];
}

/// Eliminates p: (K_s + B^T C^-1 B) u = f + B^T C^-1 g, p = C^-1 (B u - g).
void CutMixedMultigrid::Level::solve_coarsest(const CoarsestFactors& factors) {
  p = g.cwiseQuotient(compliance_);
  Eigen::VectorXf b = f;
  add_gradient(p, b);
  u = factors.solve(b);
  divergence(u, Bu_);
  p = (Bu_ - g).cwiseQuotient(compliance_);
}

CutMixedMultigrid::CutMixedMultigrid(const MassSpringModel& model, const std::vector<char>& fixed)
    : nodes_(model.network, fixed), network_(model.network) {
  const AveragedSprings& law = *averaged_springs_of(model);
  MixedParts parts = mixed_parts(law);
  const bool free = network_.bonds.empty() && network_.anchors.empty();
  const int schur_sweeps = volume_stiffness_ratio(model) > 1000 && free ? 12 : 6;
  const double l = network_.cells.edge, unit = law.shear_modulus * l;
  for (double& kappa : parts.kappa) kappa /= law.shear_modulus;
  gradient_.resize(24, static_cast<Eigen::Index>(network_.cells.size()));
  compliance_.resize(gradient_.cols());
  for (std::size_t c = 0; c < network_.cells.size(); ++c) {
    const VolumeRow row(in_units(network_.cells.shape(c), l), parts.kappa);
    gradient_.col(static_cast<Eigen::Index>(c)) = row.gradient;
    compliance_[static_cast<Eigen::Index>(c)] = row.compliance;
  }
  std::vector<CutLevel> lattices = cut_levels(network_, nodes_, &law);
  const double finest_edge = lattices[0].edge;
  for (CutLevel& lattice : lattices) {
    const bool finest = levels_.empty();
    const std::vector<char> fixed_here = finest ? nodes_.fixed_corners() : std::vector<char>{};
    if (&lattice == &lattices.back()) {  // the pressure is eliminated there
      take_matrix(CutMatrix<double>(averaged_cells(law, lattice), unit, lattice, fixed_here), unit, fixed_here,
                  lattice);
      coarsest_.factor(lattice.A.sparse());
    }
    CutMatrix<double> of_cells(averaged_cells(parts.springs, lattice), unit, lattice, fixed_here);
    take_matrix(of_cells, unit, fixed_here, lattice);
    if (finest) K_ = std::move(of_cells);
    levels_.push_back(
        std::make_unique<Level>(std::move(lattice), finest ? nodes_.unknowns_of_corners() : std::vector<char>{}));
    levels_.back()->set_volumes(finest_edge, parts.kappa, schur_sweeps);
  }
  for (Anchor& a : nodes_.anchors) a.stiffness /= unit;
}

CutMixedMultigrid::~CutMixedMultigrid() = default;

Eigen::VectorXd CutMixedMultigrid::force(const MixedVector& x) {
  Eigen::VectorXd y;
  nodes_.multiply(K_, 1, x.u, y);
  for (Eigen::Index c = 0; c < x.p.size(); ++c)
    for (int n = 0; n < 8; ++n)
      y.segment<3>(3 * network_.cells.corners[c][n]) += x.p[c] * gradient_.col(c).segment<3>(3 * n);
  hand_back(network_.cells.carried, y);
  return y;
}

Eigen::VectorXd CutMixedMultigrid::volume_change(const Eigen::VectorXd& displacement) {
  Eigen::VectorXd u = displacement;
  carry(network_.cells.carried, u);
  Eigen::VectorXd J = Eigen::VectorXd::Zero(gradient_.cols());
  for (Eigen::Index c = 0; c < J.size(); ++c)
    for (int n = 0; n < 8; ++n)
      J[c] += gradient_.col(c).segment<3>(3 * n).dot(u.segment<3>(3 * network_.cells.corners[c][n]));
  return J;
}

MixedVector CutMixedMultigrid::cycle(const MixedVector& b) {
  Level& finest = *levels_[0];
  finest.f = nodes_.eliminated(b.u).cast<float>();
  finest.g = b.p.cast<float>();
  v_cycle(levels_, [&](Level& coarsest) { coarsest.solve_coarsest(coarsest_); });
  MixedVector x{{}, finest.p.cast<double>()};
  nodes_.complete(b.u, finest.u.cast<double>(), x.u);
  return x;
}

}  // namespace springproof
