// Finite elements in time against closed forms, their own equilibrium, and smaller steps.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "support/bodies.h"
#include "support/fem_block.h"

namespace springproof::motion_test {
namespace {

fem::GridProblem block_in_motion(const Vec3& size, const Cells& cells, double nu, const fem::MotionRequest& motion,
                                 int steps) {
  fem::GridProblem problem = test::fem_block(size, cells, 0, 2, nu);
  problem.loads.clear();
  problem.motion = motion;
  problem.steps = steps;
  problem.points = test::points_inside(size, 4);
  return problem;
}

double largest(const NodalVectors& u) { return u.cwiseAbs().maxCoeff(); }

TEST(FemMotion, OfABodyThatFallsIsExact) {
  const Vec3 g(1, -2, -9.81);
  for (const char* law : {"linear", "hencky"})
    for (const double nu : {0.3, 0.499}) {
      fem::GridProblem problem = block_in_motion({1, 1, 1}, {2, 2, 2}, nu, {0.5, 0, {}, false}, 7);
      problem.law = law;
      problem.loads = {Gravity{g}};
      const fem::Solution s = fem::solve_grid(problem);
      ASSERT_TRUE(s.ok) << s.message;
      ASSERT_EQ(s.time.size(), 8u);
      for (std::size_t i = 0; i < s.time.size(); ++i) {
        const double t = s.time[i], mass = problem.material.density;
        EXPECT_NEAR(s.kinetic_energy[i], mass * g.squaredNorm() * t * t / 2, 1e-8 * mass);
        for (Eigen::Index p = 0; p < s.path[i].rows(); ++p)
          EXPECT_LT((Vec3(s.path[i].row(p)) - t * t / 2 * g).norm(), 1e-8) << law << nu;
      }
    }
}

TEST(FemMotion, OfABarLetGoIsATriangularWave) {
  // nu = 0: the end of a clamped bar under traction, let go, moves at constant speed between +-u in 2 L / c.
  const double length = 2;
  fem::GridProblem problem = block_in_motion({length, 0.5, 0.5}, {16, 1, 1}, 0, {}, 0);
  const double c = std::sqrt(problem.material.youngs_modulus / problem.material.density), period = 4 * length / c;
  problem.motion = fem::MotionRequest{period, 0, {}, true};
  problem.steps = 400;
  const double traction = 1e-3 * problem.material.youngs_modulus, amplitude = 1e-3 * length;
  problem.loads = {PrescribedDisplacement{"x_min", {0.0, 0.0, 0.0}}, Traction{"x_max", {traction, 0, 0}}};
  problem.points.resize(1, 3);
  problem.points << length, 0.25, 0.25;
  const fem::Solution s = fem::solve_grid(problem);
  ASSERT_TRUE(s.ok) << s.message;
  double squares = 0;
  for (std::size_t i = 0; i < s.time.size(); ++i) {
    const double phase = s.time[i] / period, wave = amplitude * (std::abs(4 * (phase - 0.5)) - 1);
    squares += std::pow(s.path[i](0, 0) - wave, 2) / s.time.size();
  }
  EXPECT_LT(std::sqrt(squares), 0.01 * amplitude / std::sqrt(3.0));
  EXPECT_NEAR(s.path[0](0, 0), amplitude, 1e-9 * amplitude);
}

TEST(FemMotion, ComesToRestAtTheEquilibrium) {
  for (const bool tetrahedra : {false, true})
    for (const double nu : {0.3, 0.49}) {
      fem::GridProblem problem = block_in_motion({1, 1, 1}, {2, 2, 2}, nu, {12, 4, {.ramp = 3}, false}, 480);
      if (tetrahedra) problem.coarse = test::tetrahedra_block(problem.coarse);
      problem.law = "hencky";
      problem.material.youngs_modulus = 1e4;
      problem.material.density = 1000;
      problem.loads = {PrescribedDisplacement{"z_min", {0.0, 0.0, 0.0}},
                       PrescribedRotation{"z_max", {0.5, 0.5, 1}, {0, 0, 1}, 0.5}};
      const fem::Solution moved = fem::solve_grid(problem);
      ASSERT_TRUE(moved.ok) << moved.message;
      problem.motion.reset();
      const fem::Solution still = fem::solve_grid(problem);
      ASSERT_TRUE(still.ok) << still.message;
      EXPECT_LT(largest(moved.displacement - still.displacement), 1e-5 * largest(still.displacement))
          << tetrahedra << nu;
    }
}

TEST(FemMotion, ABranchOfALongTimeIsStiffnessOneOfAShortTimeIsNothing) {
  for (const bool energy_momentum : {false, true})
    for (const char* law : {"linear", "hencky"})
      for (const double nu : {0.3, 0.499}) {
        const auto end = [&](const Relaxation& relaxation, double shear) {
          fem::GridProblem problem = block_in_motion({4, 1, 1}, {4, 1, 1}, nu, {0.5, 0.3, {}, false}, 40);
          problem.motion->energy_momentum = energy_momentum;
          problem.motion->relaxation = relaxation;
          problem.law = law;
          problem.material = with_shear({1e5, nu, 1000}, shear);
          const double load =
              std::string(law) == "linear" ? -500 : -0.5;  // strain and law of branches are linear there
          problem.loads = {PrescribedDisplacement{"x_min", {0.0, 0.0, 0.0}}, PatchForce{"x_max", {0, 0, load}}};
          const fem::Solution s = fem::solve_grid(problem);
          EXPECT_TRUE(s.ok) << s.message;
          return NodalVectors(s.displacement / load);
        };
        const NodalVectors elastic = end({}, 1), stiff = end({}, 1.2), size = end({{{0.2, 0.5}}}, 1);
        EXPECT_GT(largest(stiff - elastic), 0.05 * largest(elastic));
        const double same = nu < 0.4 ? 2e-4 : 0.03;  // pressures leave dilatation at points, which branches do not see
        EXPECT_LT(largest(end({{{0.2, 1e9}}}, 1) - stiff), same * largest(stiff)) << law << nu << energy_momentum;
        EXPECT_LT(largest(end({{{0.2, 1e-9}}}, 1) - elastic), 1e-6 * largest(elastic)) << law << nu;
        EXPECT_GT(largest(size - elastic), 0.01 * largest(elastic));
        EXPECT_GT(largest(size - stiff), 0.01 * largest(stiff));
      }
}

TEST(FemMotion, ReleasedStartsFromTheEquilibriumAndConvergesToSecondOrder) {
  for (const double nu : {0.3, 0.49}) {
    std::vector<fem::Solution> of_steps;
    for (const int steps : {80, 160, 320}) {
      fem::GridProblem problem = block_in_motion({4, 1, 1}, {4, 1, 1}, nu, {2, 0.3, {.ramp = 1}, true}, steps);
      problem.law = "hencky";
      problem.material.youngs_modulus = 1e5;
      problem.material.density = 1000;
      problem.loads = {PrescribedDisplacement{"x_min", {0.0, 0.0, 0.0}}, PatchForce{"x_max", {0, 0, -500}}};
      of_steps.push_back(fem::solve_grid(problem));
      ASSERT_TRUE(of_steps.back().ok) << of_steps.back().message;
      if (steps > 80) continue;
      problem.motion.reset();
      const fem::Solution still = fem::solve_grid(problem);
      EXPECT_LT(largest(of_steps[0].path[0] - still.displacement), 1e-7 * largest(still.displacement)) << nu;
    }
    const auto end = [&](int i) { return of_steps[i].displacement; };
    const double ratio = largest(end(1) - end(0)) / largest(end(2) - end(1));
    EXPECT_GT(ratio, nu < 0.4 ? 3.2 : 2.2);  // the steps do not resolve the volume waves of the stiffer one
    EXPECT_LT(ratio, 5) << nu;
  }
}

TEST(FemMotion, OfAStiffBodyThatSpinsIsRigid) {
  // Two turns about a principal axis, whose centre flies on: every point comes back, but for the flight.
  const Vec3 size(1, 0.6, 0.8), spin(0, 0, 5), velocity(0.5, 0, 0);
  const double turns = 2 * 2 * std::numbers::pi / spin.norm();
  fem::GridProblem problem = block_in_motion(size, {2, 1, 1}, 0.3, {turns, 0, {}, false, velocity, spin}, 800);
  problem.law = "hencky";
  problem.material.youngs_modulus = 1e8;
  const fem::Solution s = fem::solve_grid(problem);
  ASSERT_TRUE(s.ok) << s.message;
  const double mass = problem.material.density * size.prod();
  const Vec3 squares = size.cwiseProduct(size);
  const double inertia = mass / 12 * (squares.sum() - squares.dot(spin.cwiseProduct(spin)) / spin.squaredNorm());
  const double energy = mass * velocity.squaredNorm() / 2 + inertia * spin.squaredNorm() / 2;
  EXPECT_NEAR(s.kinetic_energy[0], energy, 1e-9 * energy);
  EXPECT_NEAR(s.kinetic_energy.back(), energy, 1e-3 * energy);
  for (Eigen::Index p = 0; p < 4; ++p)
    EXPECT_LT((Vec3(s.displacement.row(p)) - turns * velocity).norm(), 2e-3 * size.norm()) << p;
}

TEST(FemMotion, OfAStiffBodyThatIsShakenIsItsSupports) {
  const double amplitude = 0.01, frequency = 2;
  fem::GridProblem problem = block_in_motion({1, 1, 1}, {2, 2, 2}, 0.3, {1, 0, {.frequency = frequency}}, 200);
  problem.material.youngs_modulus = 1e9;
  problem.loads = {PrescribedDisplacement{"z_min", {amplitude, 0.0, 0.0}}};
  const fem::Solution s = fem::solve_grid(problem);
  ASSERT_TRUE(s.ok) << s.message;
  const double speed = 2 * std::numbers::pi * frequency * amplitude, energy = 1000 * speed * speed / 2;
  double mean = 0;  // the jump of the supports' speed at the start rings, without damping
  for (std::size_t i = 0; i < s.time.size(); ++i) {
    const double phase = 2 * std::numbers::pi * frequency * s.time[i];
    for (Eigen::Index p = 0; p < 4; ++p)
      EXPECT_NEAR(s.path[i](p, 0), amplitude * std::sin(phase), 0.03 * amplitude) << s.time[i];
    mean += s.kinetic_energy[i] / energy / static_cast<double>(s.time.size());
  }
  EXPECT_GT(mean, 0.45);
  EXPECT_LT(mean, 1.1);
}

TEST(FemMotion, OfAShortPulseHasItsImpulse) {
  // A pulse much shorter than a step leaves a free body with the speed of its impulse.
  const double pulse = 1e-3, force = 50;
  fem::GridProblem problem = block_in_motion({1, 1, 1}, {1, 1, 1}, 0.3, {1, 0, {.pulse = pulse}}, 8);
  problem.loads = {Gravity{{0, 0, force / 1000}}};
  const fem::Solution s = fem::solve_grid(problem);
  ASSERT_TRUE(s.ok) << s.message;
  const double impulse = force * pulse * 2 / std::numbers::pi;
  EXPECT_NEAR(s.kinetic_energy.back(), impulse * impulse / 2 / 1000, 1e-9 * impulse * impulse);
}

TEST(FemMotion, OfSupportsIsFollowed) {
  // All of the body's boundary moves: so does its inside, after a while.
  fem::GridProblem problem = block_in_motion({1, 1, 1}, {2, 2, 2}, 0.3, {3, 8, {.ramp = 1}, false}, 300);
  problem.material.youngs_modulus = 1e4;
  problem.material.density = 1000;
  const Vec3 shift(0.1, 0, 0.05);
  for (const char* patch : {"x_min", "x_max", "y_min", "y_max", "z_min", "z_max"})
    problem.loads.push_back(PrescribedDisplacement{patch, {shift[0], shift[1], shift[2]}});
  const fem::Solution s = fem::solve_grid(problem);
  ASSERT_TRUE(s.ok) << s.message;
  for (Eigen::Index p = 0; p < s.displacement.rows(); ++p)
    EXPECT_LT((Vec3(s.displacement.row(p)) - shift).norm(), 1e-5);
}

/// Damping ratio of a clamped bar let go, of which the end is recorded, from the largest deflections of half swings.
double lost_by_swings(const fem::Solution& s, double& period) {
  std::vector<double> crossings, extremes = {0};
  for (std::size_t i = 1; i < s.time.size(); ++i) {
    const double a = s.path[i - 1](0, 2), b = s.path[i](0, 2);
    if (a * b < 0) {
      crossings.push_back(s.time[i - 1] + a / (a - b) * (s.time[i] - s.time[i - 1]));
      extremes.push_back(0);
    }
    extremes.back() = std::max(extremes.back(), std::abs(b));
  }
  const std::size_t n = crossings.size() - 1;  // of whole half swings
  period = 2 * (crossings[n] - crossings[0]) / double(n);
  const double decrement = 2 * std::log(extremes[1] / extremes[n]) / double(n - 1);
  return decrement / std::hypot(2 * std::numbers::pi, decrement);
}

TEST(FemMotion, ViscosityDampsASwingByItsShare) {
  // Displacement form and mixed form, whose pressures are viscous too.
  for (const bool tetrahedra : {false, true})
    for (const double nu : {0.3, 0.49}) {
      fem::GridProblem problem = block_in_motion({4, 1, 1}, {4, 1, 1}, nu, {}, 0);
      if (tetrahedra) problem.coarse = test::tetrahedra_block(problem.coarse);
      problem.law = "hencky";
      problem.material.youngs_modulus = 1e7;
      problem.material.density = 1000;
      problem.loads = {PrescribedDisplacement{"x_min", {0.0, 0.0, 0.0}}, PatchForce{"x_max", {0, 0, -2000}}};
      problem.points.resize(1, 3);
      problem.points << 4, 0.5, 0.5;
      problem.motion = fem::MotionRequest{.duration = 3.5, .released = true, .viscosity = 0.02};
      problem.steps = 280;
      const fem::Solution s = fem::solve_grid(problem);
      ASSERT_TRUE(s.ok) << s.message;
      double period = 0;
      const double ratio = lost_by_swings(s, period);
      EXPECT_NEAR(ratio, std::numbers::pi / period * 0.02, 0.03 * ratio) << tetrahedra << nu << " " << period;
    }
}

TEST(FemMotion, ViscosityDoesNotBrakeASpin) {
  const double turn = 2 * std::numbers::pi / 5;
  fem::MotionRequest motion{.duration = turn, .spin = {0, 0, 5}, .viscosity = 0.05};
  fem::GridProblem problem = block_in_motion({1, 0.6, 0.8}, {2, 1, 1}, 0.3, motion, 400);
  problem.law = "hencky";
  problem.material.youngs_modulus = 1e6;
  const fem::Solution s = fem::solve_grid(problem);
  ASSERT_TRUE(s.ok) << s.message;
  // The body widens by the spin and its ripples die out.
  const double settled = s.kinetic_energy[s.kinetic_energy.size() / 2];
  EXPECT_NEAR(s.kinetic_energy.back(), settled, 1e-3 * settled);
  EXPECT_NEAR(settled, s.kinetic_energy[0], 0.02 * settled);
}

/// Largest change of the energy and of the angular momentum of a free bar that spins and rings for four turns.
std::pair<double, double> lost(bool energy_momentum, const char* law, double nu, int steps) {
  const double turn = 2 * std::numbers::pi / 20;
  fem::MotionRequest motion{.duration = 4 * turn, .spin = {0, 6, 19}};
  motion.energy_momentum = energy_momentum;
  fem::GridProblem problem = block_in_motion({0.3, 0.1, 0.1}, {3, 1, 1}, nu, motion, steps);
  problem.law = law;
  problem.material.youngs_modulus = 1e5;
  problem.material.density = 1000;
  const fem::Solution s = fem::solve_grid(problem);
  EXPECT_TRUE(s.ok) << s.message;
  double energy = 0, spin = 0;
  const double E = s.kinetic_energy[0] + s.elastic_energy[0], L = s.angular_momentum[0].norm();
  for (std::size_t i = 0; i < s.time.size(); ++i) {
    energy = std::max(energy, std::abs((s.kinetic_energy[i] + s.elastic_energy[i]) / E - 1));
    spin = std::max(spin, (s.angular_momentum[i] - s.angular_momentum[0]).norm() / L);
  }
  return {energy, spin};
}

TEST(FemMotion, EnergyMomentumStepsKeepBoth) {
  for (const char* law : {"hencky", "neo_hooke", "neo_hooke_isochoric", "st_venant_kirchhoff"})
    for (const double nu : {0.25, 0.49}) {
      const auto [energy, spin] = lost(true, law, nu, 160);
      EXPECT_LT(energy, 1e-8) << law << nu;
      EXPECT_LT(spin, 1e-8) << law << nu;
      EXPECT_GT(lost(false, law, nu, 160).first, 5e-3) << law << nu;
    }
}

}  // namespace
}  // namespace springproof::motion_test
