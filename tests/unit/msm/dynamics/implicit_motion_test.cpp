// Implicit integrators: what they conserve, what they lose, their order, and their limits.
#include "msm/dynamics/implicit_motion.h"
#include "msm/laws/capabilities.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "msm/algebra/dense.h"
#include "msm/dynamics/dynamics.h"
#include "msm/dynamics/lattice_motion.h"
#include "msm/dynamics/time_step.h"
#include "msm/topology/cubic_lattice.h"
#include "support/zoo.h"

namespace springproof::implicit_motion_test {
namespace {

constexpr double density = 1000;

/// Change of the energy and of the angular momentum of a spinning and vibrating bar, the largest of all steps.
struct Errors {
  double energy = 0, spin = 0, momentum = 0;
  double final_energy = 0, final_spin = 0;
};

struct Bar {
  MassSpringModel model;
  Eigen::VectorXd mass;
  NodalVectors x, v;  ///< stretched by 3 %, bent, spinning at 20 rad/s about z and moving along x
  double safe_step;

  Bar(const std::string& name, double nu, std::array<int, 3> cells = {3, 1, 1})
      : model(build_model(test::model(name), block_mesh(0.1 * Vec3(3, 1, 1), cells), {2.5e5, nu, density})),
        mass(masses(model.network, density)),
        safe_step(safe_time_step(model, density)) {
    const NodalVectors& X = model.network.X;
    x = X;
    x.col(0) *= 1.03;
    x += test::noise(X.rows(), 0.003 * 3 / cells[0], 3);
    v.resize(X.rows(), 3);
    const Eigen::RowVector3d middle = mass.transpose() * x / mass.sum();
    for (Eigen::Index n = 0; n < X.rows(); ++n)
      v.row(n) = Vec3(0, 0, 20).cross(Vec3((x.row(n) - middle).transpose())).transpose();
  }

  BoundaryConditions free() const {
    BoundaryConditions bc;
    bc.fixed.assign(3 * x.rows(), 0);
    bc.owner.assign(3 * x.rows(), -1);
    bc.prescribed = bc.external = NodalVectors::Zero(x.rows(), 3);
    return bc;
  }

  double energy_of(const NodalVectors& at, const NodalVectors& speed) const {
    return energy(model, at) + 0.5 * (speed.rowwise().squaredNorm().array() * mass.array()).sum();
  }
  Vec3 spin_of(const NodalVectors& at, const NodalVectors& speed) const {
    Vec3 L = Vec3::Zero();
    for (Eigen::Index n = 0; n < at.rows(); ++n)
      L += mass[n] * Vec3(at.row(n).transpose()).cross(Vec3(speed.row(n).transpose()));
    return L;
  }

  /// Four turns in steps of `ratio` times the safe one; an infinite error if a step has no solution.
  Errors turn(Integrator integrator, double ratio) const {
    const double dt = ratio * safe_step;
    const long steps = std::lround(4 * 2 * std::numbers::pi / 20 / dt);
    ImplicitMotion motion(model, density, {.integrator = integrator, .time_step = dt});
    motion.set_conditions(free());
    motion.set_state(x, v);
    const double E = energy_of(x, v);
    const Vec3 L = spin_of(x, v), p = v.transpose() * mass;
    Errors most;
    for (long s = 0; s < steps; ++s) {
      motion.advance(1);
      if (!motion.failure().empty()) return {INFINITY, INFINITY, INFINITY, 0, 0};
      const NodalVectors at = motion.positions(), speed = motion.velocities();
      most.final_energy = energy_of(at, speed) / E - 1;
      most.final_spin = spin_of(at, speed)[2] / L[2] - 1;
      most.energy = std::max(most.energy, std::abs(most.final_energy));
      most.spin = std::max(most.spin, (spin_of(at, speed) - L).norm() / L.norm());
      most.momentum = std::max(most.momentum, (speed.transpose() * mass - p).norm() / (20 * 0.1 * mass.sum()));
    }
    return most;
  }
};

/// Work and torque of the forces between two states, relative to what the forces could do.
void expect_exact(const MassSpringModel& model, const std::string& name, double size) {
  const NodalVectors& X = model.network.X;
  const double edge = model.network.cells.edge;
  const NodalVectors x0 = X * test::rotation().transpose() + test::noise(X.rows(), 0.05 * edge, 1),
                     x1 = x0 * Eigen::AngleAxisd(size, Vec3(1, 0, 2).normalized()).toRotationMatrix() +
                          test::noise(X.rows(), size * 0.1 * edge, 2);
  const NodalVectors f = EnergyMomentum(model).forces(x0, x1), middle = (x0 + x1) / 2;
  const double scale = f.norm() * (x1 - x0).norm();
  EXPECT_NEAR(f.cwiseProduct(x1 - x0).sum(), energy(model, x0) - energy(model, x1), 1e-11 * scale) << name;
  EXPECT_LT(f.colwise().sum().norm(), 1e-12 * f.norm()) << name;
  Vec3 torque = Vec3::Zero();
  for (Eigen::Index n = 0; n < f.rows(); ++n)
    torque += Vec3(middle.row(n).transpose()).cross(Vec3(f.row(n).transpose()));
  EXPECT_LT(torque.norm(), 1e-12 * f.norm() * middle.norm()) << name;
  EXPECT_LT((EnergyMomentum(model).forces(x0, x0) - forces(model, x0)).norm(), 1e-11 * f.norm()) << name;
}

TEST(EnergyMomentum, ForcesDoTheWorkOfTheEnergyAndHaveNoTorque) {
  for (double size : {1e-3, 0.02, 0.7})
    for (double nu : {0.0, 0.25, 0.49})
      for (const char* name : {"msm_18", "emsm", "hybmss", "hybmss_avg"}) {
        ModelParameters p = test::model(name);
        expect_exact(build_model(p, test::notched_block(), {1e4, nu, density}), name, size);
        p.volume_energy = VolumeEnergy::paper;
        p.dispersion = Dispersion::finite_strain;
        expect_exact(build_model(p, test::notched_block(), {1e4, nu, density}), name, size);
      }
}

TEST(EnergyMomentum, HoldsForBoxesCutCellsTheirAnchorsAndEveryCurve) {
  for (StrainCurve curve : {StrainCurve::hencky, StrainCurve::neo_hooke, StrainCurve::neo_hooke_isochoric,
                            StrainCurve::springs_hencky, StrainCurve::springs_neo_hooke})
    for (double size : {1e-3, 0.02, 0.7}) {
      AveragedSprings law{1e4, 3e4};
      law.hourglass = HourglassStiffness::of_pattern(2, 0.3, true, true);
      law.curve = curve;
      expect_exact({test::cut_network(), {law, Anchors{}}}, std::to_string(static_cast<int>(curve)), size);
      const Network boxes = lattice_without_springs(test::notched_block(Vec3(0.5, 0.9, 0.35)));
      expect_exact({boxes, {law}}, "boxes " + std::to_string(static_cast<int>(curve)), size);
    }
}

TEST(ImplicitMotion, DashpotsTakeTheEnergyThatIsLostAndKeepBothMomenta) {
  for (const auto& [name, nu] :
       {std::pair("hybmss_avg", 0.25), {"hybmss_avg", 0.45}, {"hybmss", 0.25}, {"emsm", 0.3}, {"msm_18", 0.25}})
    for (const double ratio : {2.0, 8.0}) {
      const Bar bar(name, nu);
      const Viscosity viscosity = Viscosity::of(bar.model, {2.5e5, nu, density}, 2 * bar.safe_step);
      const double dt = ratio * bar.safe_step;
      ImplicitMotion motion(bar.model, density,
                            {.integrator = Integrator::energy_momentum, .time_step = dt, .viscosity = viscosity});
      motion.set_conditions(bar.free());
      motion.set_state(bar.x, bar.v);
      const double E = bar.energy_of(bar.x, bar.v);
      const Vec3 L = bar.spin_of(bar.x, bar.v);
      double before = E;
      for (int s = 0; s < 40; ++s) {
        const NodalVectors x0 = motion.positions();
        motion.advance(1);
        ASSERT_EQ(motion.failure(), "") << name << nu << " " << ratio;
        const NodalVectors x1 = motion.positions(), v1 = motion.velocities();
        NodalVectors f = NodalVectors::Zero(x0.rows(), 3);
        viscosity.add_forces(bar.model.network, (x0 + x1) / 2, (x1 - x0) / dt, f);
        const double work = f.cwiseProduct(x1 - x0).sum(), now = bar.energy_of(x1, v1);
        EXPECT_LT(work, 0) << name << nu << " " << ratio;
        EXPECT_NEAR(now - before, work, 1e-9 * E) << name << nu << " " << ratio << " " << s;
        before = now;
      }
      EXPECT_LT(before, 0.99 * E) << name << nu << " " << ratio;
      EXPECT_LT((bar.spin_of(motion.positions(), motion.velocities()) - L).norm(), 1e-9 * L.norm())
          << name << nu << " " << ratio;
    }
}

TEST(EnergyMomentum, ModelsWithoutItAreRefusedWithTheReason) {
  const auto why = [](const std::string& name, Dispersion form = Dispersion::symmetric) {
    ModelParameters p = test::model(name);
    p.dispersion = form;
    return lacks(build_model(p, test::notched_block(), {1e4, 0.3, density}), Capability::energy_momentum);
  };
  EXPECT_NE(why("hybmss_bt").find("hourglass correction is linear"), std::string::npos) << why("hybmss_bt");
  EXPECT_NE(why("emsm", Dispersion::published).find("has no energy"), std::string::npos);
  EXPECT_EQ(why("emsm"), "");
  EXPECT_EQ(why("hybmss_avg"), "");
  ModelParameters p = test::model("hybmss_bt");
  const MassSpringModel model = build_model(p, test::notched_block(), {1e4, 0.3, density});
  EXPECT_THROW((ImplicitMotion(model, density, {.integrator = Integrator::energy_momentum, .time_step = 1e-3})),
               std::invalid_argument);
}

TEST(ImplicitMotion, EnergyMomentumKeepsSpinAndEnergyAtLargeSteps) {
  for (const char* name : {"hybmss_avg", "hybmss", "emsm"})
    for (double nu : {0.25, 0.49}) {
      const Bar bar(name, nu);
      for (double ratio : {2, 5, 15}) {
        const Errors e = bar.turn(Integrator::energy_momentum, ratio);
        EXPECT_LT(e.energy, 1e-9) << name << " " << nu << " " << ratio;
        EXPECT_LT(e.spin, 1e-9) << name << " " << nu << " " << ratio;
        EXPECT_LT(e.momentum, 1e-11) << name << " " << nu << " " << ratio;
      }
    }
}

TEST(ImplicitMotion, ImplicitEulerLosesSpin) {
  for (const char* name : {"hybmss_avg", "hybmss"}) {
    const Bar bar(name, 0.25);
    EXPECT_NEAR(bar.turn(Integrator::implicit_euler, 2).final_spin, -0.68, 0.02);
    EXPECT_NEAR(bar.turn(Integrator::implicit_euler, 5).final_spin, -0.79, 0.02);
  }
}

TEST(ImplicitMotion, ExplicitStepsKeepSpinToRoundOffAndEnergyToSecondOrder) {
  const Bar bar("hybmss", 0.25);
  const auto energy_error = [&](double ratio) {
    const double dt = ratio * bar.safe_step;
    const auto motion = lattice_motion(bar.model, density, {.time_step = dt});
    motion->set_conditions(bar.free());
    NodalVectors x = bar.x;
    // Velocities half a step before, from those of now.
    NodalVectors v = bar.v - dt / 2 * bar.mass.cwiseInverse().asDiagonal() * forces(bar.model, x);
    motion->set_state(x, v);
    const double E = bar.energy_of(bar.x, bar.v);
    const Vec3 L = bar.spin_of(x, v);
    double most = 0;
    for (long s = std::lround(0.4 * std::numbers::pi / dt); s > 0; --s) {
      motion->advance(1);
      const NodalVectors after = motion->velocities();
      most = std::max(most, std::abs(bar.energy_of(x, (v + after) / 2) / E - 1));
      x = motion->positions();
      v = after;
    }
    EXPECT_LT((bar.spin_of(x, v) - L).norm(), 1e-12 * L.norm());
    return most;
  };
  const double coarse = energy_error(0.05);
  EXPECT_LT(coarse, 1e-4);
  EXPECT_NEAR(coarse / energy_error(0.025), 4, 0.4);
}

TEST(ImplicitMotion, ManyUnknownsAreSolvedByMultigridWhileTheBodyTurns) {
  Bar bar("hybmss_avg", 0.3, {24, 8, 8});
  ImplicitMotion motion(bar.model, density,
                        {.integrator = Integrator::energy_momentum, .time_step = 10 * bar.safe_step});
  motion.set_conditions(bar.free());
  motion.set_state(bar.x, bar.v);
  motion.advance(24);  // 114 degrees
  ASSERT_EQ(motion.failure(), "");
  EXPECT_NE(motion.description().find("multigrid"), std::string::npos);
  const double E = bar.energy_of(bar.x, bar.v);
  EXPECT_NEAR(bar.energy_of(motion.positions(), motion.velocities()) / E, 1, 1e-9);
  const Vec3 L = bar.spin_of(bar.x, bar.v);
  EXPECT_LT((bar.spin_of(motion.positions(), motion.velocities()) - L).norm(), 1e-9 * L.norm());
}

/// A cantilever of 4 x 1 x 1 cells along x, its lowest frequency [rad/s] and mode about rest.
struct Cantilever {
  MassSpringModel model;
  BoundaryConditions bc;
  double frequency;
  NodalVectors mode;  ///< largest displacement 1

  explicit Cantilever(const std::string& name)
      : model(build_model(test::model(name), block_mesh(0.1 * Vec3(4, 1, 1), {4, 1, 1}), {2.5e5, 0.3, density})) {
    const Eigen::Index n = model.network.nodes();
    bc.fixed.assign(3 * n, 0);
    bc.owner.assign(3 * n, -1);
    bc.prescribed = bc.external = NodalVectors::Zero(n, 3);
    std::vector<int> free;
    for (int i = 0; i < 3 * n; ++i) model.network.X(i / 3, 0) < 1e-9 ? void(bc.fixed[i] = 1) : free.push_back(i);
    const Tangent K = tangent(model, model.network.X);
    const Eigen::VectorXd m = masses(model.network, density);
    Eigen::MatrixXd A(free.size(), free.size());
    for (std::size_t i = 0; i < free.size(); ++i) {
      Eigen::VectorXd column;
      K.multiply(Eigen::VectorXd::Unit(3 * n, free[i]), column);
      for (std::size_t j = 0; j < free.size(); ++j)
        A(j, i) = column[free[j]] / std::sqrt(m[free[i] / 3] * m[free[j] / 3]);
    }
    const Eigenpairs all = symmetric_eigenpairs(A);
    frequency = std::sqrt(all.values[0]);
    mode = NodalVectors::Zero(n, 3);
    for (std::size_t i = 0; i < free.size(); ++i) mode.data()[free[i]] = all.vectors(i, 0) / std::sqrt(m[free[i] / 3]);
    mode /= mode.cwiseAbs().maxCoeff();
  }

  /// Displacement along the mode after each step, released from `amplitude` [m].
  std::vector<double> release(Integrator integrator, double dt, double duration, double amplitude) const {
    std::vector<double> along;
    DynamicsOptions options;
    options.integrator = integrator;
    options.time_step = dt;
    options.duration = duration;
    options.start = model.network.X + amplitude * mode;
    options.after_step = [&](const MotionSample& at) {
      const NodalVectors& x = at.x;
      along.push_back((x - model.network.X).cwiseProduct(mode).sum() / mode.squaredNorm());
    };
    const DynamicsResult result = run_dynamics(
        model, density, [&](double) { return bc; }, options);
    EXPECT_TRUE(result.state.ok) << result.state.message;
    return along;
  }
};

/// Mean period between the first and the last downward crossing of zero, in steps.
double period_of(const std::vector<double>& u) {
  std::vector<double> at;
  for (std::size_t i = 1; i < u.size(); ++i)
    if (u[i - 1] > 0 && u[i] <= 0) at.push_back(i - 1 + u[i - 1] / (u[i - 1] - u[i]));
  return (at.back() - at.front()) / (at.size() - 1);
}

// Midpoint kinematics: a period longer by (w dt)^2 / 12; semi-implicit: shorter by (w dt)^2 / 24.
TEST(ImplicitMotion, PeriodIsThatOfTheSmallestFrequencyAndOfTheMethod) {
  for (const char* name : {"hybmss_avg", "hybmss", "emsm"}) {
    const Cantilever beam(name);
    const double T = 2 * std::numbers::pi / beam.frequency;
    for (int steps : {20, 40}) {
      const double wdt = 2 * std::numbers::pi / steps;
      const auto longer = [&](Integrator i) {
        return period_of(beam.release(i, T / steps, 10.5 * T, 1e-5)) / steps - 1;
      };
      EXPECT_NEAR(longer(Integrator::energy_momentum), wdt * wdt / 12, 0.02 * wdt * wdt) << name;
    }
  }
}

TEST(ImplicitMotion, OrdersAreTwoAndOne) {
  const Cantilever beam("hybmss_avg");
  const double T = 2 * std::numbers::pi / beam.frequency;
  struct Row {
    Integrator integrator;
    int order, steps;  ///< of a period
  };
  for (const Row& row : {Row{Integrator::energy_momentum, 2, 100}, Row{Integrator::implicit_euler, 1, 800}}) {
    const auto end = [&](int steps) {
      return beam.release(row.integrator, T / steps, (0.7 - 1e-6) * T, 0.0005).back();
    };
    const double a = end(row.steps), b = end(2 * row.steps), c = end(4 * row.steps);
    EXPECT_NEAR(std::log2((a - b) / (b - c)), row.order, 0.12) << static_cast<int>(row.integrator);
  }
}

TEST(ImplicitMotion, SlowRampEndsInTheStaticState) {
  Cantilever beam("hybmss_avg");
  const LoadPath path = [&](double factor) {
    BoundaryConditions bc = beam.bc;
    for (Eigen::Index n = 0; n < beam.mode.rows(); ++n)
      if (beam.model.network.X(n, 0) > 0.399) bc.external(n, 2) = -5 * factor;
    return bc;
  };
  const Equilibrium still = solve_finite(beam.model, path);
  ASSERT_TRUE(still.ok);
  ASSERT_GT(still.displacement.cwiseAbs().maxCoeff(), 0.05);  // an eighth of the length
  for (Integrator i : {Integrator::energy_momentum, Integrator::implicit_euler}) {
    DynamicsOptions options;
    options.integrator = i;
    options.duration = 12;
    options.course.ramp = 3;
    options.damping = 8;
    const DynamicsResult result = run_dynamics(beam.model, density, path, options);
    ASSERT_TRUE(result.state.ok) << result.state.message;
    EXPECT_LT((result.state.displacement - still.displacement).cwiseAbs().maxCoeff(),
              1e-6 * still.displacement.cwiseAbs().maxCoeff());
    EXPECT_LT((result.state.support - still.support).norm(), 1e-5 * still.support.norm());
  }
}

}  // namespace
}  // namespace springproof::implicit_motion_test
