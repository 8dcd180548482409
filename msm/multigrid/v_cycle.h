// The V-cycle of multigrid, whatever its levels are.
#pragma once

#include <cstddef>

namespace springproof {

/// On the way down to the coarser level, from zero, or on the way up.
enum class Smoothing { before_coarse, after_coarse };

/// Of a level above another, `below`, whose equation `solve_below` solves, nearly or exactly.
template <class Level, class Below, class Solve>
void two_level_cycle(Level& level, Below& below, const Solve& solve_below) {
  level.smooth(Smoothing::before_coarse);
  level.residual();
  level.restrict_to(below);  // the right-hand side below
  solve_below();
  level.prolongate(below);  // its solution as a correction
  level.smooth(Smoothing::after_coarse);
}

/// V-cycle from level `l` of `levels`, pointers to them, finest first: the solution of a level from its right-hand
/// side.
template <class Levels, class Solve>
void v_cycle(const Levels& levels, const Solve& solve_coarsest, std::size_t l = 0) {
  if (l + 1 == levels.size())
    solve_coarsest(*levels[l]);
  else
    two_level_cycle(*levels[l], *levels[l + 1], [&] { v_cycle(levels, solve_coarsest, l + 1); });
}

/// Coefficients of step k = 1, 2, ... of Chebyshev iteration of the fourth kind, z = previous z + step D r.
struct ChebyshevStep {
  double previous, step;
  ChebyshevStep(int k, double largest_eigenvalue)
      : ChebyshevStep{k > 1 ? (2.0 * k - 3) / (2.0 * k + 1) : 0, (8.0 * k - 4) / ((2.0 * k + 1) * largest_eigenvalue)} {
  }
  ChebyshevStep(double of_previous, double of_residual) : previous(of_previous), step(of_residual) {}
};

}  // namespace springproof
