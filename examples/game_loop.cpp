// A loop of frames: a springs file whose support is shaken, and the vertices that a game draws.
//   springproof export body.obj --scale 0.01 -E 2e4 --nu 0.45 --voxels 400 --hold bottom --carry body.obj --to springs
//   --out body.json game_loop body.json bottom 300
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <numbers>

#include "msm/dynamics/time_step.h"
#include "msm/exchange/springs_file.h"

using namespace springproof;

namespace {

constexpr double frame = 1.0 / 60, damping = 2, amplitude = 0.1, frequency = 1.5;  // [s], [1/s], of the size, [Hz]

/// Where the support is and what it accelerates by, along x.
struct Shaken {
  double u = 0, a = 0;
};

/// Begins at rest.
Shaken shaken(double time, double size) {
  const double w = 2 * std::numbers::pi * frequency, A = amplitude * size;
  return {A * (1 - std::cos(w * time)), A * w * w * std::cos(w * time)};
}

/// By what the nodes at a support are heavier in explicit steps, so that the safe step stays (docs/springs_file.md).
Eigen::VectorXd support_mass(const std::vector<Anchor>& anchors, Eigen::Index nodes, double dt) {
  Eigen::VectorXd mass = Eigen::VectorXd::Zero(nodes);
  for (const Anchor& anchor : anchors) {
    const double k = anchor.stiffness.cwiseAbs().rowwise().sum().maxCoeff();
    double sum = 0;
    for (const double w : anchor.weights) sum += std::abs(w);
    for (int c = 0; c < 8; ++c) mass[anchor.corners[c]] += dt * dt / 4 * k * std::abs(anchor.weights[c]) * sum;
  }
  return mass;
}

void add_support(const std::vector<Anchor>& anchors, const NodalVectors& X, const NodalVectors& x, const Vec3& moved,
                 NodalVectors& f) {
  for (const Anchor& anchor : anchors) {
    Vec3 d = -moved;
    for (int c = 0; c < 8; ++c)
      d += anchor.weights[c] * (x.row(anchor.corners[c]) - X.row(anchor.corners[c])).transpose();
    const Vec3 force = anchor.stiffness * d;
    for (int c = 0; c < 8; ++c) f.row(anchor.corners[c]) -= anchor.weights[c] * force.transpose();
  }
}

}  // namespace

int main(int count, char** arguments) try {
  if (count != 4) return std::fprintf(stderr, "usage: game_loop FILE.json PATCH FRAMES\n"), 2;
  const SpringsFile file = read_springs(arguments[1]);
  const auto held = file.anchors.find(arguments[2]);
  if (held == file.anchors.end())
    return std::fprintf(stderr, "%s holds no patch '%s' of cut cells\n", arguments[1], arguments[2]), 2;
  const NodalVectors& X = file.model.network.X;
  const double size = (X.colwise().maxCoeff() - X.colwise().minCoeff()).maxCoeff();
  const int steps = static_cast<int>(std::ceil(frame / (0.95 * safe_time_step(file.model, file.density))));
  const double dt = frame / steps;
  const Eigen::VectorXd mass = masses(file.model.network, file.density),
                        extra = support_mass(held->second, X.rows(), dt);
  const Eigen::RowVector3d gravity(0, 0, -9.81);

  NodalVectors x = X, v = NodalVectors::Zero(X.rows(), 3), drawn;
  double worst = 0, sway = 0;
  for (int n = 0; n < std::atoi(arguments[3]); ++n) {
    const auto begin = std::chrono::steady_clock::now();
    for (int s = 0; s < steps; ++s) {
      const Shaken support = shaken((n * steps + s) * dt, size);
      NodalVectors f = forces(file.model, x);
      add_support(held->second, X, x, support.u * Vec3::UnitX(), f);
      for (Eigen::Index i = 0; i < x.rows(); ++i) {  // semi-implicit Euler
        const Eigen::RowVector3d own =
            mass[i] * (gravity - damping * v.row(i)) + extra[i] * support.a * Eigen::RowVector3d::UnitX();
        v.row(i) += dt / (mass[i] + extra[i]) * (f.row(i) + own);
        x.row(i) += dt * v.row(i);
      }
    }
    drawn =
        file.surface.weights * (x - X) + file.surface.vertices;  // what is drawn: the vertices of --carry, in its order
    worst = std::max(worst, std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
    sway = std::max(sway, (drawn - file.surface.vertices).col(0).cwiseAbs().maxCoeff() / size);
  }
  std::printf("%ld vertices by %zu cells, %d steps a frame, at most %.1f ms of its 16.7; sways by %.2f of its size\n",
              long(drawn.rows()), file.model.network.cells.size(), steps, 1e3 * worst, sway);
  return std::isfinite(sway) && sway > amplitude ? 0 : 1;
} catch (const std::exception& e) {
  std::fprintf(stderr, "%s\n", e.what());
  return 2;
}
