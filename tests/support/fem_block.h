// Blocks to solve on, and points to look at.
#pragma once

#include <Eigen/Dense>
#include <cmath>
#include <random>

#include "fem_reference/solve_grid.h"
#include "support/bodies.h"

namespace springproof::test {

inline const std::vector<std::string> block_faces = {"x_min", "x_max", "y_min", "y_max", "z_min", "z_max"};

/// A block of `cells`, refined on top, held nowhere.
inline fem::GridProblem fem_block(const Vec3& size, const Cells& cells, int refinements, int degree,
                                  double poisson_ratio) {
  fem::GridProblem problem;
  problem.coarse = block_mesh(size, cells);
  problem.refinements = refinements;
  problem.degree = degree;
  problem.material = {1e4, poisson_ratio, 1000};
  problem.tolerance = 1e-12;
  return problem;
}

/// A block with every box cut into six tetrahedra, and its patches.
inline Mesh tetrahedra_block(const Mesh& boxes) {
  Mesh mesh = tetrahedra_of(boxes);
  mesh.patches = boxes.patches;
  for (Patch& patch : mesh.patches) patch.facets.clear();
  const Vec3 size = boxes.nodes.colwise().maxCoeff();
  for (const auto& [a, b, c, d] : mesh.tetrahedra)
    for (const std::array<int, 4>& f : {std::array{a, c, b, -1}, {a, b, d, -1}, {b, c, d, -1}, {a, d, c, -1}})
      for (int axis = 0; axis < 3; ++axis)
        for (int high = 0; high < 2; ++high) {
          bool on = true;
          for (int k = 0; k < 3; ++k) on &= std::abs(boxes.nodes(f[k], axis) - high * size[axis]) < 1e-12;
          if (on) mesh.patches[2 * axis + high].facets.push_back(f);
        }
  return mesh;
}

/// Random points inside [0, size].
inline NodalVectors points_inside(const Vec3& size, int n) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> part(0.01, 0.99);
  NodalVectors points(n, 3);
  for (int i = 0; i < n; ++i)
    for (int c = 0; c < 3; ++c) points(i, c) = part(random) * size[c];
  return points;
}

/// Moves every vertex that is not on the surface of the block by up to `amount` [m] in each direction,
/// differently from one vertex to the next.
inline std::function<Vec3(const Vec3&)> shaken_inside(const Vec3& size, double amount) {
  return [=](const Vec3& X) {
    if ((X.array() < 1e-9).any() || ((size - X).array() < 1e-9).any()) return X;
    const double seed = 12.9898 * X[0] + 78.233 * X[1] + 37.719 * X[2];
    const Vec3 waves(std::sin(43.7585 * seed), std::sin(95.1234 * seed + 1), std::sin(71.5432 * seed + 2));
    return Vec3(X + amount * waves);
  };
}

/// Force and torque about the origin of all reactions together.
struct Wrench {
  Vec3 force = Vec3::Zero();
  Vec3 torque = Vec3::Zero();
};

inline Wrench total(const fem::Solution& solution, const Mesh& mesh) {
  Wrench wrench;
  for (const PatchReaction& r : solution.reactions) {
    wrench.force += r.force;
    wrench.torque += r.torque + centroid(mesh, patch(mesh, r.patch)).cross(r.force);
  }
  return wrench;
}

}  // namespace springproof::test
