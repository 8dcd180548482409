// One discretisation solved in this process: what `springproof-fem` does per grid, and what the tests of the
// elements call.  No deal.II in this header.
#pragma once

#include <functional>

#include "fem_reference/reference.h"

namespace springproof::fem {

enum class Method {
  automatic,      ///< without a matrix where the cells have a hierarchy, else assembled
  assembled,      ///< matrices; for quadratic elements a level of linear ones above algebraic multigrid
  assembled_gamg  ///< matrices, algebraic multigrid alone: the usual way, and the baseline of the benchmarks
};

struct GridProblem {
  Mesh coarse;                             ///< cells of one kind, with named patches
  int refinements = 0;                     ///< each cell is cut into 8 this many times
  std::function<Vec3(const Vec3&)> place;  ///< moves the vertices of the finest mesh; empty: they stay
  int degree = 2;                          ///< 1 or 2
  std::string law = "linear";
  IsotropicMaterial material;
  std::vector<Load> loads;
  std::function<Vec3(const Vec3&)> body_force;      ///< [N/m^3], besides gravity; empty: none
  NodalVectors points;                              ///< rest positions at which the displacement is wanted, n x 3 [m]
  NodalVectors stress_points = NodalVectors(0, 3);  ///< and the stress
  double tolerance = 1e-9;                          ///< relative residual
  Method method = Method::automatic;
  bool wide_vectors = true;  ///< use the wide vectors of the processor, where it has them
  bool own_memory = false;   ///< Solution::memory_MiB is what this grid adds
};

/// Solution::grid is left to the caller.  A solver that fails gives ok = false.
/// @throws InputError if the problem cannot be used: unknown patch or law, unconstrained body, point outside
/// it.
Solution solve_grid(const GridProblem& problem);

/// Draws coordinates within the box [low, high] towards its faces, over half the shortest side r on every
/// axis: the distance d < r to a face becomes r (d/r)^exponent.  Faces stay, and the rest of a slender body
/// stays uniform.
std::function<Vec3(const Vec3&)> graded(const Vec3& low, const Vec3& high, double exponent);

/// "deal.II 9.4.1, AVX2" or "..., one lane": what answers on this machine.
std::string library_versions();

}  // namespace springproof::fem
