#include "msm/multigrid/macro_solver.h"

#include <Eigen/LU>

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

}  // namespace

bool MacroSolver::covers(const MassSpringModel& model) {
  return model.network.grid && model.laws.size() == 1 && macro_springs_of(model);
}

MacroSolver::MacroSolver(const MassSpringModel& model, const std::vector<char>& fixed)
    : network_(model.network),
      law_(*macro_springs_of(model)),
      fixed_(fixed),
      kappa_(law_.lame_lambda - law_.shear_modulus),
      mixed_(kappa_ > mixed_above_kappa * law_.shear_modulus),
      A_(model.network),
      volumes_(model.network.macro_cells.size()) {
  const double lambda = mixed_ ? law_.shear_modulus : law_.lame_lambda;
  lattice_ = std::make_unique<Multigrid>(lattice_levels(network_, fixed),
                                         cell_stiffness(companion(network_, law_.shear_modulus, lambda)).total);
}

void MacroSolver::take(const NodalVectors& x) {
  A_.set_zero();
  const double of_springs = law_.volume_modulus() - kappa_;
  const bool at_rest = x == network_.X;  // then all cells are alike
  MacroTangent cell;
  for (std::size_t c = 0; c < volumes_.size(); ++c) {
    if (c == 0 || !at_rest) {
      cell = law_.tangent(network_, network_.macro_cells[c], x);
      cell.springs += of_springs * cell.gradient.transpose() * cell.curvature * cell.gradient;
    }
    add_to(A_, network_.macro_cells[c], cell.springs);
    volumes_[c] = {cell.gradient, cell.curvature};
  }
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
    scatter(c, kappa_ * volumes_[c].curvature * (volumes_[c].gradient * gathered(c, x)), y);
}

Eigen::VectorXd MacroSolver::diagonal() const {
  Eigen::VectorXd d = A_.diagonal();
  for (std::size_t c = 0; c < volumes_.size(); ++c) {
    const auto& D = volumes_[c].gradient;
    for (int i = 0; i < 81; ++i)
      d[3 * network_.macro_cells[c][i / 3] + i % 3] += kappa_ * D.col(i).dot(volumes_[c].curvature * D.col(i));
  }
  return d;
}

void MacroSolver::precondition(const Eigen::VectorXd& r, Eigen::VectorXd& z) const { lattice_->apply(r, z); }

MacroSolver::State MacroSolver::take(const NodalVectors& x, const Eigen::VectorXd& pressures) {
  A_.set_zero();
  State state{Eigen::VectorXd::Zero(x.size()), Eigen::VectorXd(pressures.size())};
  for (std::size_t c = 0; c < volumes_.size(); ++c) {
    const MacroCell& cell = network_.macro_cells[c];
    const auto i = 4 * static_cast<Eigen::Index>(c);
    const MacroPressureForm form = pressure_form(law_, network_, cell, x, pressures.segment<4>(i));
    add_to(A_, cell, form.tangent.springs);
    volumes_[c] = {form.tangent.gradient, form.tangent.curvature};
    state.slope.segment<4>(i) = form.slope;
    for (int n = 0; n < 27; ++n) state.gradient.segment<3>(3 * cell[n]) += form.gradient.segment<3>(3 * n);
  }
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
  const double schur = 1 / (1 / kappa_ + 1 / (schur_of_volume * G));
  const Operator condition = [&](const Eigen::VectorXd& x, Eigen::VectorXd& z) {
    z.resize(n + m);
    part = x.head(n) * (G * l * l);
    for (Eigen::Index c = 0; c < cells; ++c) {
      const auto i = static_cast<std::size_t>(c);
      const Eigen::Vector4d of_cell = -schur * volumes_[i].curvature * x.segment<4>(n + 4 * c);
      scatter(i, -of_cell, part);
      z.segment<4>(n + 4 * c) = of_cell / (G * cube);
    }
    clear_fixed(part);
    lattice_->apply(part, product);
    z.head(n) = product / l;
  };
  Eigen::VectorXd right = Eigen::VectorXd::Zero(n + m), x = right;
  part = f / (G * l * l);
  clear_fixed(part);
  right << part, g;
  const KrylovResult result = gmres(apply, condition, right, tolerance, max_iterations, 60, x);
  u = x.head(n) * l;
  p = x.tail(m) * (G * cube);
  return result;
}

}  // namespace springproof
