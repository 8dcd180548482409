// A share of consistent mass in explicit motion: what moves, what is kept, which frequencies, which step.
#include "msm/dynamics/terms/mass_average.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <numbers>

#include "msm/dynamics/dynamics.h"
#include "msm/dynamics/lattice_motion.h"
#include "msm/dynamics/natural_modes.h"
#include "msm/dynamics/time_step.h"
#include "support/zoo.h"

namespace springproof::mass_average_test {
namespace {

constexpr double density = 900;

/// W [1/kg] between nodes.
Eigen::MatrixXd inverse_mass(const Network& network, double theta) {
  const Eigen::VectorXd L = masses(network, density);
  Eigen::MatrixXd W(network.nodes(), network.nodes());
  const MassAverage average(network, theta);
  for (int n = 0; n < network.nodes(); ++n) {
    NodalVectors s = NodalVectors::Zero(network.nodes(), 3);
    s(n, 1) = 1 / L[n];
    W.col(n) = average.velocities(s).col(1);
  }
  return W;
}

MassSpringModel cut_ball(const std::string& name, double nu) {
  const Mesh body = test::mapped(test::ball_of_tetrahedra(6), test::random_placement(1, 0.3));
  return build_cut(test::model(name), cut_body(test::grid_about(body, 0.3), body), {}, Mesh{}, {1e4, nu, density})
      .model;
}

BoundaryConditions nothing(const Network& network) {
  return {std::vector<char>(network.X.size(), 0), std::vector<int>(network.X.size(), -1),
          NodalVectors::Zero(network.nodes(), 3), NodalVectors::Zero(network.nodes(), 3)};
}

TEST(MassAverage, IsTheFirstTwoTermsOfNeumannsSeries) {
  const Network network = build_model(test::model("hybmss"), test::notched_block(), {1e4, 0.3, density}).network;
  const Eigen::MatrixXd L = masses(network, density).asDiagonal();
  for (const double theta : {0.0, 0.4, 1.0}) {
    const Eigen::MatrixXd M = mass_matrix(network, density, theta), W = inverse_mass(network, theta);
    EXPECT_LT((W - L.inverse() * (2 * L - M) * L.inverse()).norm(), 1e-14 * W.norm()) << theta;
  }
  EXPECT_THROW(MassAverage(network, 1.01), std::invalid_argument);
  EXPECT_THROW(MassAverage(network, -0.01), std::invalid_argument);
}

TEST(MassAverage, IsSymmetricMovesRigidlyAndHasAnInverse) {
  for (const Network& network : {build_model(test::model("hybmss"), test::notched_block(), {1e4, 0.3, density}).network,
                                 cut_ball("hybmss_avg", 0.3).network}) {
    const Eigen::MatrixXd W = inverse_mass(network, 0.6);
    EXPECT_LT((W - W.transpose()).norm(), 1e-13 * W.norm());
    const MassAverage average(network, 0.6);
    const NodalVectors all = NodalVectors::Ones(network.nodes(), 3), v = test::noise(network.nodes(), 1);
    EXPECT_LT((average.velocities(all) - all).norm(), 1e-13 * all.norm());
    std::vector<char> fixed(network.X.size(), 0);
    for (int i = 0; i < 20; ++i) fixed[3 * i] = 1;
    const NodalVectors s = average.momenta(v, fixed), again = average.velocities(s);
    for (Eigen::Index i = 0; i < v.size(); ++i) EXPECT_NEAR((fixed[i] ? s : again).data()[i], v.data()[i], 1e-14);
    EXPECT_GT((s - v).norm(), 0.1 * v.norm());
  }
}

/// Thrown, turning and ringing: momenta to round-off, the energy as with lumped mass.
TEST(MassAverage, KeepsMomentaAndEnergy) {
  std::vector<MassSpringModel> models;
  for (const char* name : {"msm_18", "hybmss", "hybmss_avg", "emsm"})
    models.push_back(build_model(test::model(name), block_mesh({1.5, 1, 0.5}, {6, 4, 2}), {1e4, 0.25, density}));
  models.push_back(cut_ball("hybmss_avg", 0.3));
  for (const MassSpringModel& model : models) {
    const Network& network = model.network;
    const Eigen::VectorXd mass = masses(network, density);
    double of_lumped = 0;
    for (const double theta : {0.0, 0.6}) {
      const MassAverage average(network, theta);
      DynamicsOptions options;
      options.mass_consistency = theta;
      options.start = network.X;
      for (auto x : options.start.rowwise()) x[1] += 0.05 * x[0] * x[0] + 0.05 * x[0] * x[2];
      options.velocity = test::noise(network.nodes(), 0.02);
      for (Eigen::Index n = 0; n < network.X.rows(); ++n)
        options.velocity.row(n) += Vec3(0.3, -1, 2).cross(Vec3(network.X.row(n).transpose())).transpose();
      const double dt = 0.4 * safe_time_step(model, density, false, theta);
      options.time_step = dt;
      options.duration = 300 * dt;
      std::vector<double> energies;
      std::vector<Vec3> momenta, spins;
      double size = 0;
      options.after_step = [&](const MotionSample& at) {
        const NodalVectors& x = at.x;
        NodalVectors s = at.v;
        const NodalVectors f = forces(model, x);
        for (Eigen::Index n = 0; n < s.rows(); ++n) s.row(n) += dt / 2 / mass[n] * f.row(n);
        const NodalVectors v = average.velocities(s);
        double kinetic = 0;
        Vec3 p = Vec3::Zero(), spin = Vec3::Zero();
        size = 0;
        for (Eigen::Index n = 0; n < s.rows(); ++n) {
          const Vec3 ps = mass[n] * s.row(n).transpose();
          kinetic += ps.dot(Vec3(v.row(n).transpose())) / 2;
          p += ps;
          spin += Vec3(x.row(n).transpose()).cross(ps);
          size += ps.norm();
        }
        energies.push_back(kinetic + energy(model, x));
        momenta.push_back(p);
        spins.push_back(spin);
      };
      const DynamicsResult result = run_dynamics(
          model, density, [&](double) { return nothing(network); }, options);
      ASSERT_TRUE(result.state.ok) << result.state.message;
      double drift = 0, lowest = energies[0], highest = energies[0];
      for (std::size_t i = 0; i < energies.size(); ++i) {
        drift = std::max({drift, (momenta[i] - momenta[0]).norm(), (spins[i] - spins[0]).norm()});
        lowest = std::min(lowest, energies[i]);
        highest = std::max(highest, energies[i]);
      }
      EXPECT_LT(drift, 1e-12 * size) << theta;
      const double off = (highest - lowest) / highest;
      EXPECT_LT(off, 0.02) << theta;
      if (theta == 0) of_lumped = off;
      EXPECT_LT(off, 2 * of_lumped) << theta;
    }
  }
}

/// A clamped bar in its lowest modes of K W follows them step by step; they are those of M to second order in the
/// share.
TEST(MassAverage, VibratesWithTheFrequenciesOfItsMass) {
  const MassSpringModel model =
      build_model(test::model("hybmss_avg"), block_mesh({4, 1, 1}, {8, 2, 2}), {1e4, 0.3, density});
  const Network& network = model.network;
  BoundaryConditions bc = nothing(network);
  std::vector<int> free;
  for (int n = 0; n < network.nodes(); ++n)
    for (int d = 0; d < 3; ++d) {
      bc.fixed[3 * n + d] = network.X(n, 0) < 1e-9;
      if (!bc.fixed[3 * n + d]) free.push_back(3 * n + d);
    }
  const Tangent K = tangent(model, network.X);
  const auto unknowns = static_cast<Eigen::Index>(free.size());
  for (const double theta : {0.0, 0.5, 1.0}) {
    const Eigen::MatrixXd W = inverse_mass(network, theta);
    Eigen::MatrixXd of_free(unknowns, unknowns), k(unknowns, unknowns);
    for (Eigen::Index j = 0; j < unknowns; ++j) {
      Eigen::VectorXd unit = Eigen::VectorXd::Zero(network.X.size()), column;
      unit[free[j]] = 1;
      K.multiply(unit, column);
      for (Eigen::Index i = 0; i < unknowns; ++i) {
        k(i, j) = column[free[i]];
        of_free(i, j) = free[i] % 3 == free[j] % 3 ? W(free[i] / 3, free[j] / 3) : 0;
      }
    }
    const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> modes(k, of_free.inverse());
    const NaturalModes of_mass = natural_modes(model, bc.fixed, density, theta, 4);
    ASSERT_TRUE(of_mass.ok) << of_mass.message;
    const double dt = 0.9 * safe_time_step(model, density, false, theta);
    for (int mode : {0, 2, 3}) {
      const double w = std::sqrt(modes.eigenvalues()[mode]);
      // W^-1 is never below M, and of a mode with L^-1 C = z above by 1 / (1 - a^2), a = theta (1 - z).  Most in
      // torsion: z = 2/3 for the spin of a section of 2 x 2 cells, times the average of a quarter of a wave over eight
      // cells.
      const double ratio = w / (2 * std::numbers::pi * of_mass.frequencies[mode]);
      const double z = 2.0 / 3 * (2 + std::cos(std::numbers::pi / 16)) / 3, a = theta * (1 - z);
      EXPECT_LT(ratio, 1 + 1e-6) << theta << ' ' << mode;
      EXPECT_GT(ratio, std::sqrt(1 - a * a) - 1e-3) << theta << ' ' << mode;
      DynamicsOptions options;
      options.mass_consistency = theta;
      options.time_step = dt;
      options.duration = 250 * dt;
      options.start = network.X;
      options.velocity = NodalVectors::Zero(network.nodes(), 3);
      Eigen::VectorXd shape = modes.eigenvectors().col(mode);
      shape *= 1e-7 / shape.lpNorm<Eigen::Infinity>();
      for (Eigen::Index i = 0; i < unknowns; ++i) options.start.data()[free[i]] += shape[i];
      const double of_steps = 2 / dt * std::asin(w * dt / 2);
      double off = 0;
      options.after_step = [&](const MotionSample& at) {
        const double time = at.time;
        const NodalVectors& x = at.x;
        for (Eigen::Index i = 0; i < unknowns; ++i)
          off = std::max(
              off, std::abs(x.data()[free[i]] - network.X.data()[free[i]] - shape[i] * std::cos(of_steps * time)));
      };
      ASSERT_TRUE(run_dynamics(
                      model, density, [&](double) { return bc; }, options)
                      .state.ok);
      EXPECT_LT(off, 1e-5 * shape.lpNorm<Eigen::Infinity>()) << theta << ' ' << mode;
    }
  }
}

/// Largest squared frequency of K W, by power iteration: below it, not above.
double spectral_radius(const MassSpringModel& model, double theta) {
  const Tangent K = tangent(model, model.network.X);
  const MassAverage average(model.network, theta);
  const Eigen::VectorXd mass = masses(model.network, density);
  NodalVectors x = test::noise(model.network.nodes(), 1);
  Eigen::VectorXd y;
  double radius = 0;
  for (int i = 0; i < 1500; ++i) {
    x /= x.norm();
    K.multiply(Eigen::Map<const Eigen::VectorXd>(x.data(), x.size()), y);
    NodalVectors s = Eigen::Map<const NodalVectors>(y.data(), x.rows(), 3);
    for (Eigen::Index n = 0; n < s.rows(); ++n) s.row(n) /= mass[n];
    x = average.velocities(s);
    radius = x.norm();
  }
  return radius;
}

TEST(MassAverage, TheSafeStepIsSafeAndNotWasteful) {
  for (const std::string& name : test::model_names())
    for (const double nu : {-0.5, 0.25, 0.45}) {
      if (test::model(name).has(Extension::none) && nu != 0.25) continue;
      for (const Mesh& mesh : {block_mesh({2.5, 2, 1.5}, {5, 4, 3}), test::notched_block()}) {
        ModelParameters p = test::model(name);
        p.homogenised = false;
        const MassSpringModel model = build_model(p, mesh, {1e4, nu, density});
        for (const double theta : {0.4, 0.6, 1.0}) {
          const double used =
              safe_time_step(model, density, false, theta) * std::sqrt(spectral_radius(model, theta)) / 2;
          EXPECT_LE(used, 1 + 1e-9) << name << " nu = " << nu << ", " << theta;
          EXPECT_GE(used, 0.4) << name << " nu = " << nu << ", " << theta;
        }
      }
    }
  for (const double nu : {0.0, 0.45}) {
    const MassSpringModel cut = cut_ball("hybmss_avg", nu);
    const double used = safe_time_step(cut, density, false, 0.6) * std::sqrt(spectral_radius(cut, 0.6)) / 2;
    EXPECT_LE(used, 1 + 1e-9) << nu;
    EXPECT_GE(used, 0.5) << nu;
  }
}

TEST(MassAverage, TheSafeStepOfBoxesIsSafeAndNotWasteful) {
  for (const double nu : {-0.5, 0.25, 0.45})
    for (const Vec3& size : {Vec3(2.5, 4, 1.5), Vec3(10, 2, 1.5), Vec3(2.5, 0.5, 1.5)}) {
      const MassSpringModel model =
          build_model(test::model("hybmss_avg"), block_mesh(size, {5, 4, 3}), {1e4, nu, density});
      for (const double theta : {0.0, 0.6, 1.0}) {
        const double used = safe_time_step(model, density, false, theta) * std::sqrt(spectral_radius(model, theta)) / 2;
        EXPECT_LE(used, 1 + 1e-9) << size.transpose() << ", nu = " << nu << ", " << theta;
        EXPECT_GE(used, 0.7) << size.transpose() << ", nu = " << nu << ", " << theta;
      }
    }
}

TEST(MassAverage, CostsTheStepOfAnInfiniteLatticeNoMore) {
  for (const char* name : {"hybmss", "hybmss_avg"}) {
    const MassSpringModel model =
        build_model(test::model(name), block_mesh({2.5, 2, 1.5}, {5, 4, 3}), {1e4, 0.25, density});
    for (const double theta : {0.4, 0.6})
      EXPECT_NEAR(safe_time_step(model, density, false, theta) / safe_time_step(model, density),
                  1 / std::sqrt(1 + 2 * theta / 3), 1e-3)
          << name << theta;
  }
}

/// A body that moves with its supports has no strain: their velocity has part in the average.
TEST(MassAverage, TakesTheVelocityOfSupportsAlong) {
  for (const Mesh& mesh : {block_mesh({1, 1, 1}, {3, 3, 3}), test::notched_block()}) {  // with a kernel and without
    const MassSpringModel model = build_model(test::model("hybmss"), mesh, {1e4, 0.3, density});
    const Network& network = model.network;
    BoundaryConditions bc = nothing(network);
    NodalVectors v = Eigen::VectorXd::Ones(network.nodes()) * Eigen::RowVector3d(0.1, 0.2, -0.3);
    NodalVectors s = v;
    for (int n = 0; n < network.nodes(); ++n)
      if (network.X(n, 2) < 1e-9) {
        for (int d = 0; d < 3; ++d) bc.fixed[3 * n + d] = 1;
        s.row(n).setZero();
      }
    DynamicsOptions options;
    options.mass_consistency = 0.6;
    const double dt = checked_time_step(model, density, options);
    options.time_step = dt;
    const auto motion = make_motion(model, density, options);
    motion->set_conditions(bc);
    motion->set_state(network.X, s);
    motion->move_supports();
    for (int step = 1; step <= 20; ++step) {
      bc.prescribed = step * dt * v;
      motion->set_conditions(bc);
      motion->advance(1);
    }
    EXPECT_LT((motion->positions() - network.X - 20 * dt * v).norm(), 1e-12 * network.X.norm());
  }
}

/// Supports that move and stay, a load, damping; every instruction set, both precisions, one thread and two.
TEST(MassAverage, KernelsMoveAsThePlainLoops) {
  const double theta = 0.6, damping = 2;
  for (const char* name : {"msm_18", "hybmss", "hybmss_bt", "hybmss_avg", "emsm"})
    for (const Cells& cells : {Cells{5, 4, 3}, Cells{1, 2, 9}}) {
      const MassSpringModel model = build_model(
          test::model(name), block_mesh(0.5 * Vec3(cells[0], cells[1], cells[2]), cells), {1e4, 0.3, density});
      const Network& network = model.network;
      const Eigen::VectorXd mass = masses(network, density);
      const MassAverage average(network, theta);
      BoundaryConditions bc = nothing(network);
      NodalVectors speed = NodalVectors::Zero(network.nodes(), 3);
      for (int n = 0; n < network.nodes(); ++n) {
        const bool bottom = network.X(n, 2)<1e-9, top = network.X(n, 2)> network.X.col(2).maxCoeff() - 1e-9;
        for (int d = 0; d < 3; ++d) bc.fixed[3 * n + d] = bottom || (top && d == 2);
        if (top) speed(n, 2) = 0.2;
        bc.external.row(n) << 0.3, 0, -0.1 * n;
      }
      const double dt = 0.8 * safe_time_step(model, density, false, theta);
      NodalVectors x = network.X, s = 0 * x;
      const int steps = 30;
      const auto at = [&](int step) {
        BoundaryConditions now = bc;
        if (step <= 10) now.prescribed = (step + 1) * dt * speed;  // later steps: as it was left
        if (step > 10) now.prescribed = 11 * dt * speed;
        return now;
      };
      for (int step = 0; step < steps; ++step) {
        const BoundaryConditions now = at(step);
        const NodalVectors f = forces(model, x) + now.external;
        for (Eigen::Index i = 0; i < s.size(); ++i)
          s.data()[i] = now.fixed[i] ? (network.X.data()[i] + now.prescribed.data()[i] - x.data()[i]) / dt
                                     : (s.data()[i] + dt * f.data()[i] / mass[i / 3]) / (1 + damping * dt);
        const NodalVectors v = average.velocities(s);
        for (Eigen::Index i = 0; i < s.size(); ++i) x.data()[i] += dt * (now.fixed[i] ? s : v).data()[i];
      }
      for (const InstructionSet set : usable_instruction_sets())
        for (const Precision precision : {Precision::float64, Precision::float32})
          for (const int threads : {1, 2}) {
            const auto motion = lattice_motion(model, density,
                                               {.time_step = dt,
                                                .damping = damping,
                                                .mass_consistency = theta,
                                                .precision = precision,
                                                .threads = threads,
                                                .instructions = set});
            for (int step = 0; step < 12; ++step) {
              motion->set_conditions(at(step));
              motion->advance(1);
            }
            motion->advance(steps - 12);
            const double moved = (x - network.X).norm(), limit = precision == Precision::float64 ? 1e-12 : 1e-5;
            EXPECT_LT((motion->positions() - x).norm(), limit * moved) << name << name_of(set) << threads;
            EXPECT_LT((motion->velocities() - s).norm(), 10 * limit * s.norm()) << name << name_of(set) << threads;
          }
    }
}

TEST(MassAverage, HasAKernelOnBoxesAlone) {
  const auto suits = [](const std::string& name, const Mesh& mesh, double viscosity) {
    const MassSpringModel model = build_model(test::model(name), mesh, {1e4, 0.25, density});
    return LatticeMotion::suits(
        model, {.viscosity = Viscosity::of(model, {1e4, 0.25, density}, viscosity), .mass_consistency = 0.5});
  };
  EXPECT_TRUE(suits("hybmss", block_mesh({1, 1, 1}, {3, 3, 3}), 0));
  EXPECT_FALSE(suits("hybmss", test::notched_block(), 0));
  EXPECT_FALSE(suits("hybmss_avg", block_mesh({1, 1, 1}, {3, 3, 3}), 1e-4));
}

TEST(MassAverage, IsRefusedWhereItCanNotBeHad) {
  const Mesh mesh = block_mesh({1, 1, 1}, {3, 3, 3});
  const MassSpringModel model = build_model(test::model("hybmss_avg"), mesh, {1e4, 0.25, density}),
                        random = build_model(test::model("msm_random"), mesh, {1e4, 0.25, density});
  DynamicsOptions options;
  options.mass_consistency = 0.5;
  EXPECT_NO_THROW(checked_time_step(model, density, options));
  EXPECT_THROW(checked_time_step(random, density, options), InputError);
  options.time_step = 1.001 * safe_time_step(model, density, false, 0.5);
  EXPECT_THROW(checked_time_step(model, density, options), InputError);
  options.time_step.reset();
  options.integrator = Integrator::energy_momentum;
  EXPECT_THROW(checked_time_step(model, density, options), InputError);
  options.integrator = Integrator::explicit_euler;
  options.mass_consistency = 1.5;
  EXPECT_THROW(checked_time_step(model, density, options), InputError);
}

}  // namespace
}  // namespace springproof::mass_average_test
