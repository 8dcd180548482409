#include "msm/statics/macro_newton.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "msm/multigrid/mixed_multigrid.h"
#include "problem/system/progress.h"

namespace springproof {
namespace {

constexpr double macro_pressure_tolerance = 1e-8;
constexpr int most_macro_krylov_steps = 400;

}  // namespace

bool MacroNewton::suits(const MassSpringModel& model) {
  if (!MacroSolver::covers(model)) return false;
  const MacroSprings& law = *macro_springs_of(model);
  return law.lame_lambda - law.shear_modulus > mixed_above_kappa * law.shear_modulus;
}

MacroNewton::MacroNewton(const MassSpringModel& model, const std::vector<char>& fixed)
    : network_(model.network), fixed_(fixed), solver_(model, fixed) {
  p_ = accepted_p_ = Eigen::VectorXd::Zero(4 * static_cast<Eigen::Index>(network_.macro_cells.size()));
}

bool MacroNewton::step(const BoundaryConditions& bc, double tolerance, int max_iterations, NodalVectors& x) {
  p_ = accepted_p_;
  Eigen::VectorXd du = Eigen::VectorXd::Zero(x.size()), dp;
  for (Eigen::Index i = 0; i < x.size(); ++i)
    if (fixed_[i]) du[i] = network_.X.data()[i] + bc.prescribed.data()[i] - x.data()[i];
  for (int k = 0; k <= max_iterations; ++k) {
    const MacroSolver::State at = solver_.take(x, p_);
    Eigen::VectorXd r = flat(bc.external) - at.gradient;
    double on_fixed = 0, on_free = 0;
    for (Eigen::Index i = 0; i < r.size(); ++i) (fixed_[i] ? on_fixed : on_free) += r[i] * r[i];
    const double scale = std::sqrt(std::max(on_fixed, bc.external.squaredNorm())),
                 relative = scale > 0 ? std::sqrt(on_free) / scale : 0;
    if (!std::isfinite(relative)) return false;
    const Eigen::VectorXd mismatch = p_ / solver_.kappa() - at.slope;
    if (k > 0 && relative <= tolerance && solver_.kappa() * mismatch.norm() <= macro_pressure_tolerance * p_.norm())
      return true;
    if (k == max_iterations) return false;
    ++iterations_;
    progress::detail([&] {
      return fmt::format("{} unknowns, Newton step {} at this load, residual {:.1e}", x.size(), k + 1, relative);
    });
    Eigen::VectorXd h = solver_.over_curvature(mismatch), correction;
    if (k == 0) solver_.subtract(du, r, h);  // the displacements of the supports are known
    solver_.solve(r, h, std::clamp(1e-2 * relative, 1e-8, 1e-3), most_macro_krylov_steps, correction, dp);
    if (k == 0) correction += du;
    x += Eigen::Map<const NodalVectors>(correction.data(), x.rows(), 3);
    p_ += dp;
  }
  return false;
}

}  // namespace springproof
