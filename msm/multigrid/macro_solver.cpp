#include "msm/multigrid/macro_solver.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "msm/laws/macro_points.h"
#include "msm/laws/macro_pressures.h"
#include "msm/multigrid/cell_stiffness.h"
#include "msm/multigrid/mixed_multigrid.h"

namespace springproof {
namespace {

/// Of the Schur complement D A^-1 D^T: that of a volume term of this many G.
constexpr double schur_of_volume = 3;

/// Averaged springs on the nodes of macro-cells; the springs' own hourglass constants take a tenth to a fifth less
/// iterations than those of exact bending.
MassSpringModel companion(const Network& network, double shear_modulus, double lame_lambda) {
  MassSpringModel model;
  model.network.cells = network.cells;
  model.network.cell_edge = network.cell_edge;
  model.laws = {
      AveragedSprings{shear_modulus, lame_lambda, HourglassStiffness::of_pattern(16.0 / 9, 0.25, false, false)}};
  return model;
}

/// Steps of GMRES between restarts; bodies one macro-cell across take more than a hundred.
constexpr int restart = 150;

/// Part of a cube that counts as filled at least.
constexpr double least_filled = 0.3;
/// Of the Schur complement of a cell that the body fills in part: times that with the other cells held.
constexpr double schur_of_patch = 3;
/// Largest eigenvalue of the lattice's correction beside the exact one of the patches.
constexpr double largest_correction = 1.5;

/// The same in a cut body.
MassSpringModel cut_companion(const Network& network, double shear_modulus, double lame_lambda) {
  MassSpringModel model = companion(network, shear_modulus, lame_lambda);
  model.network.X = network.X;
  for (const FilledPart& part : network.filled)
    model.network.filled.push_back(part.fraction < least_filled ? FilledPart{.fraction = least_filled} : part);
  for (const MacroAnchor& a : network.macro_anchors) {
    Anchor anchor{network.cells[8 * a.cell + a.cube], {}, a.node, a.stiffness};
    const Vec3 at = (network.X.row(a.node) - network.X.row(anchor.corners[0])).transpose() / network.cell_edge;
    for (int n = 0; n < 8; ++n) {
      anchor.weights[n] = 1;
      for (int d = 0; d < 3; ++d) anchor.weights[n] *= hexahedron_corners[n][d] ? at[d] : 1 - at[d];
    }
    model.network.anchors.push_back(anchor);
  }
  model.laws.emplace_back(Anchors{});
  return model;
}

}  // namespace

bool MacroSolver::covers(const MassSpringModel& model) {
  return macro_springs_of(model) && std::all_of(model.laws.begin(), model.laws.end(), [](const ForceLaw& law) {
           return std::holds_alternative<MacroSprings>(law) || std::holds_alternative<Anchors>(law);
         });
}

MacroSolver::MacroSolver(const MassSpringModel& model, const std::vector<char>& fixed)
    : network_(model.network),
      law_(*macro_springs_of(model)),
      fixed_(fixed),
      kappa_(law_.lame_lambda - law_.shear_modulus),
      mixed_(kappa_ > mixed_above_kappa * law_.shear_modulus),
      outside_(mixed_ || network_.filled.empty() ? kappa_ : 0),
      A_(model.network),
      volumes_(model.network.macro_cells.size()) {
  const double lambda = mixed_ ? law_.shear_modulus : law_.lame_lambda;
  if (network_.filled.empty())
    lattice_ = std::make_unique<Multigrid>(lattice_levels(network_, fixed),
                                           cell_stiffness(companion(network_, law_.shear_modulus, lambda)).total);
  else
    cut_ = std::make_unique<CutMultigrid>(cut_companion(network_, law_.shear_modulus, lambda), fixed);
}

void MacroSolver::add_constant_parts() {
  law_.add_bonds(network_, A_);
  Anchors{}.add_tangent(network_, network_.X, A_);
}

void MacroSolver::prepare_patches() {
  std::vector<std::vector<int>> anchored(network_.macro_cells.size());
  for (const MacroAnchor& a : network_.macro_anchors) anchored[a.cell].push_back(a.node);
  patches_.clear();
  for (std::size_t c = 0; c < network_.macro_cells.size(); ++c) {
    if (is_full(network_, c)) continue;
    std::vector<int> nodes(network_.macro_cells[c].begin(), network_.macro_cells[c].end());
    nodes.insert(nodes.end(), anchored[c].begin(), anchored[c].end());
    Patch& patch = patches_.emplace_back();
    patch.cell = static_cast<int>(c);
    for (const int n : nodes)
      for (int d = 0; d < 3; ++d)
        if (!fixed_[3 * n + d]) patch.unknowns.push_back(3 * n + d);
    patch.inverse = A_.dense(patch.unknowns).inverse().cast<float>();
  }
  // The lattice alone, against A: the largest eigenvalue by power iteration.
  Eigen::VectorXd v = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(fixed_.size())), Av, z;
  for (Eigen::Index i = 0; i < v.size(); ++i) v[i] = fixed_[i] ? 0 : std::sin(1.7 * static_cast<double>(i * i % 1009));
  double largest = 0;
  for (int k = 0; k < 15; ++k) {
    A_.multiply(v, Av);
    clear_fixed(Av);
    cut_->apply(Av, z);
    largest = z.norm() / v.norm();
    v = z.normalized();
  }
  step_ = std::min(1.0, largest_correction / largest);
}

void MacroSolver::assume_schur() {
  const double of_full = 1 / (1 / kappa_ + 1 / (schur_of_volume * law_.shear_modulus));
  schur_.resize(volumes_.size());
  for (std::size_t c = 0; c < volumes_.size(); ++c) schur_[c] = of_full * volumes_[c].curvature;
  for (const Patch& patch : patches_) {
    const auto& [gradient, curvature] = volumes_[patch.cell];
    const auto n = static_cast<Eigen::Index>(patch.unknowns.size());
    Eigen::MatrixXd D = Eigen::MatrixXd::Zero(4, n);
    for (Eigen::Index i = 0; i < n; ++i) {
      const MacroCell& cell = network_.macro_cells[patch.cell];
      for (int a = 0; a < 27; ++a)
        if (cell[a] == patch.unknowns[i] / 3) D.col(i) = gradient.col(3 * a + patch.unknowns[i] % 3);
    }
    const Eigen::Matrix4d S =
        schur_of_patch * D * patch.inverse.cast<double>() * D.transpose() + curvature.inverse() / kappa_;
    schur_[patch.cell] = S.inverse();
  }
}

void MacroSolver::relax(const Patch& patch, const Eigen::VectorXd& r, Eigen::VectorXd& z) const {
  Eigen::VectorXf own(static_cast<Eigen::Index>(patch.unknowns.size()));
  int node = -1;
  Vec3 product;
  for (Eigen::Index i = 0; i < own.size(); ++i) {
    const int u = patch.unknowns[i];
    if (u / 3 != node) product = A_.row_times(node = u / 3, z);
    own[i] = static_cast<float>(r[u] - product[u % 3]);
  }
  own = (patch.inverse * own).eval();
  for (Eigen::Index i = 0; i < own.size(); ++i) z[patch.unknowns[i]] += own[i];
}

void MacroSolver::apply_lattice(const Eigen::VectorXd& r, Eigen::VectorXd& z) const {
  if (!cut_) return lattice_->apply(r, z);
  z.setZero(r.size());
  Eigen::VectorXd product, correction;
  for (const Patch& patch : patches_) relax(patch, r, z);
  A_.multiply(z, product);
  cut_->apply(r - product, correction);
  z += step_ * correction;
  for (auto patch = patches_.rbegin(); patch != patches_.rend(); ++patch) relax(*patch, r, z);
}

void MacroSolver::take(const NodalVectors& x) {
  A_.set_zero();
  const double in_matrix = law_.volume_modulus() - outside_;
  const bool at_rest = x == network_.X;  // then all full cells are alike
  MacroTangent of_full;
  bool known = false;
  for (std::size_t c = 0; c < volumes_.size(); ++c) {
    const bool full = at_rest && is_full(network_, c);
    MacroTangent cell;
    if (!full || !known) {
      cell = law_.tangent(network_, c, x);
      cell.springs += in_matrix * cell.gradient.transpose() * cell.curvature * cell.gradient;
      if (full) of_full = cell, known = true;
    }
    const MacroTangent& K = full ? of_full : cell;
    add_to(A_, network_.macro_cells[c], K.springs);
    volumes_[c] = {K.gradient, K.curvature};
  }
  add_constant_parts();
  if (cut_) prepare_patches();
  if (mixed_) assume_schur();
}

Eigen::Matrix<double, 81, 1> MacroSolver::gathered(std::size_t c, const Eigen::VectorXd& u) const {
  Eigen::Matrix<double, 81, 1> of_cell;
  for (int n = 0; n < 27; ++n) of_cell.segment<3>(3 * n) = u.segment<3>(3 * network_.macro_cells[c][n]);
  return of_cell;
}

void MacroSolver::scatter(std::size_t c, const Eigen::Vector4d& p, Eigen::VectorXd& f) const {
  const Eigen::Matrix<double, 81, 1> of_cell = volumes_[c].gradient.transpose() * p;
  for (int n = 0; n < 27; ++n) f.segment<3>(3 * network_.macro_cells[c][n]) += of_cell.segment<3>(3 * n);
}

void MacroSolver::clear_fixed(Eigen::VectorXd& v) const {
  for (std::size_t i = 0; i < fixed_.size(); ++i)
    if (fixed_[i]) v[static_cast<Eigen::Index>(i)] = 0;
}

void MacroSolver::multiply(const Eigen::VectorXd& x, Eigen::VectorXd& y) const {
  A_.multiply(x, y);
  for (std::size_t c = 0; c < volumes_.size(); ++c)
    if (outside_ != 0) scatter(c, outside_ * volumes_[c].curvature * (volumes_[c].gradient * gathered(c, x)), y);
}

Eigen::VectorXd MacroSolver::diagonal() const {
  Eigen::VectorXd d = A_.diagonal();
  for (std::size_t c = 0; c < volumes_.size(); ++c) {
    const auto& D = volumes_[c].gradient;
    for (int i = 0; i < 81; ++i)
      d[3 * network_.macro_cells[c][i / 3] + i % 3] += outside_ * D.col(i).dot(volumes_[c].curvature * D.col(i));
  }
  return d;
}

void MacroSolver::precondition(const Eigen::VectorXd& r, Eigen::VectorXd& z) const { apply_lattice(r, z); }

MacroSolver::State MacroSolver::take(const NodalVectors& x, const Eigen::VectorXd& pressures) {
  A_.set_zero();
  State state{Eigen::VectorXd::Zero(x.size()), Eigen::VectorXd(pressures.size())};
  for (std::size_t c = 0; c < volumes_.size(); ++c) {
    const MacroCell& cell = network_.macro_cells[c];
    const auto i = 4 * static_cast<Eigen::Index>(c);
    const MacroPressureForm form = pressure_form(law_, network_, c, x, pressures.segment<4>(i));
    add_to(A_, cell, form.tangent.springs);
    volumes_[c] = {form.tangent.gradient, form.tangent.curvature};
    state.slope.segment<4>(i) = form.slope;
    for (int n = 0; n < 27; ++n) state.gradient.segment<3>(3 * cell[n]) += form.gradient.segment<3>(3 * n);
  }
  add_constant_parts();
  if (cut_) prepare_patches();
  if (mixed_) assume_schur();
  NodalVectors constant = NodalVectors::Zero(x.rows(), 3);
  law_.add_bond_forces(network_, x, constant);
  Anchors{}.add_forces(network_, x, constant);
  state.gradient -= flat(constant);
  return state;
}

Eigen::VectorXd MacroSolver::over_curvature(const Eigen::VectorXd& v) const {
  Eigen::VectorXd w(v.size());
  for (std::size_t c = 0; c < volumes_.size(); ++c) {
    const auto i = 4 * static_cast<Eigen::Index>(c);
    w.segment<4>(i) = volumes_[c].curvature.inverse() * v.segment<4>(i);
  }
  return w;
}

void MacroSolver::subtract(const Eigen::VectorXd& u, Eigen::VectorXd& f, Eigen::VectorXd& g) const {
  Eigen::VectorXd Au;
  A_.multiply(u, Au);
  f -= Au;
  for (std::size_t c = 0; c < volumes_.size(); ++c)
    g.segment<4>(4 * static_cast<Eigen::Index>(c)) -= volumes_[c].gradient * gathered(c, u);
}

KrylovResult MacroSolver::solve(const Eigen::VectorXd& b, double tolerance, int max_iterations,
                                Eigen::VectorXd& u) const {
  const Eigen::VectorXd none = Eigen::VectorXd::Zero(4 * static_cast<Eigen::Index>(volumes_.size()));
  Eigen::VectorXd p;
  return solve(b, none, tolerance, max_iterations, u, p);
}

KrylovResult MacroSolver::solve(const Eigen::VectorXd& f, const Eigen::VectorXd& g, double tolerance,
                                int max_iterations, Eigen::VectorXd& u, Eigen::VectorXd& p) const {
  // In units of G and l both equations have entries of order one.
  const double G = law_.shear_modulus, l = network_.cell_edge, cube = l * l * l;
  const Eigen::Index n = f.size(), cells = static_cast<Eigen::Index>(volumes_.size()), m = 4 * cells;
  Eigen::VectorXd part(n), product;
  const Operator apply = [&](const Eigen::VectorXd& x, Eigen::VectorXd& y) {
    y.resize(n + m);
    part = x.head(n) * l;
    A_.multiply(part, product);
    for (Eigen::Index c = 0; c < cells; ++c) {
      const auto i = static_cast<std::size_t>(c);
      const Eigen::Vector4d of_cell = x.segment<4>(n + 4 * c) * (G * cube);
      scatter(i, of_cell, product);
      y.segment<4>(n + 4 * c) =
          volumes_[i].gradient * gathered(i, part) - volumes_[i].curvature.inverse() * of_cell / kappa_;
    }
    clear_fixed(product);
    y.head(n) = product / (G * l * l);
  };
  const Operator condition = [&](const Eigen::VectorXd& x, Eigen::VectorXd& z) {
    z.resize(n + m);
    part = x.head(n) * (G * l * l);
    for (Eigen::Index c = 0; c < cells; ++c) {
      const auto i = static_cast<std::size_t>(c);
      const Eigen::Vector4d of_cell = -schur_[i] * x.segment<4>(n + 4 * c);
      scatter(i, -of_cell, part);
      z.segment<4>(n + 4 * c) = of_cell / (G * cube);
    }
    clear_fixed(part);
    apply_lattice(part, product);
    z.head(n) = product / l;
  };
  Eigen::VectorXd right = Eigen::VectorXd::Zero(n + m), x = right;
  part = f / (G * l * l);
  clear_fixed(part);
  right << part, g;
  const KrylovResult result = gmres(apply, condition, right, tolerance, max_iterations, restart, x);
  u = x.head(n) * l;
  p = x.tail(m) * (G * cube);
  return result;
}

}  // namespace springproof
