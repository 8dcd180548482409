// How many cells move in real time on one thread: a cube of 0.1 m, held below and let go from a sheared state, at 60
// frames a second.   real_time [E_Pa ...]
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "msm/dynamics/dynamics.h"
#include "msm/dynamics/time_step.h"
#include "msm/models.h"

using namespace springproof;

namespace {

constexpr double size = 0.1, density = 1000, frame = 1.0 / 60;  // [m], [kg/m^3], [s]

struct Frames {
  double seconds;  ///< of computing, per frame
  double ratio;    ///< of the frame to the safe step
};

/// A cube of n^3 cells over five frames, after a first one.
Frames measure(int n, const IsotropicMaterial& material, Integrator integrator) {
  const Mesh mesh = block_mesh({size, size, size}, {n, n, n});
  const MassSpringModel model = build_model(resolve({"hybmss_avg", {}, "", {}}), mesh, material);
  const std::vector<Load> loads = {PrescribedDisplacement{"z_min", {0.0, 0.0, 0.0}}};
  const double safe = 0.95 * safe_time_step(model, density);
  const bool large = integrator != Integrator::explicit_euler;
  const long steps = large ? 1 : std::lround(std::ceil(frame / safe));
  const auto motion =
      make_motion(model, density, {.integrator = integrator, .time_step = frame / static_cast<double>(steps)});
  motion->set_conditions(transfer(loads, mesh, density, Kinematics::finite));
  NodalVectors x = model.network.X;
  x.col(0) += 0.02 * x.col(2);
  motion->set_state(x, NodalVectors::Zero(x.rows(), 3));
  motion->advance(steps);
  const auto start = std::chrono::steady_clock::now();
  for (int f = 0; f < 5; ++f) motion->advance(steps);
  return {std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count() / 5, frame / safe};
}

}  // namespace

int main(int count, char** arguments) {
  std::vector<double> stiffness;
  for (int i = 1; i < count; ++i) stiffness.push_back(std::atof(arguments[i]));
  if (stiffness.empty()) stiffness = {1e4, 1e5, 1e6, 1e7};
  for (const double E : stiffness)
    if (!(E > 0)) return std::fprintf(stderr, "usage: real_time [E ...]   Young's moduli > 0 [Pa]\n"), 2;
  for (const double nu : {0.3, 0.49})
    for (const double E : stiffness)
      for (const Integrator integrator : {Integrator::explicit_euler, Integrator::energy_momentum}) {
        int cells = 0;
        Frames of = {};
        for (int n = 3; n <= 40; ++n) {
          const Frames now = measure(n, {E, nu, density}, integrator);
          if (now.seconds > frame) break;
          cells = n * n * n;
          of = now;
        }
        std::printf("E = %.0e Pa, nu = %.2f, %-19s %6d cells, %4.1f ms a frame of %.0f safe steps\n", E, nu,
                    name_of(integrator), cells, 1e3 * of.seconds, of.ratio);
        std::fflush(stdout);
      }
}
