// The lattice kernels against the plain loops.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "msm/dynamics/lattice_motion.h"
#include "msm/dynamics/time_step.h"
#include "support/zoo.h"

namespace springproof::lattice_motion_test {
namespace {

constexpr double density = 1000, edge = 0.25;

Mesh cubes(const std::array<int, 3>& cells) { return block_mesh(edge * Vec3(cells[0], cells[1], cells[2]), cells); }

struct Body {
  std::string name;
  Mesh mesh;
};

std::vector<Body> bodies() {
  std::vector<Body> all;
  for (const std::array<int, 3>& n : std::vector<std::array<int, 3>>{
           {1, 1, 1}, {2, 3, 5}, {10, 10, 10}, {16, 5, 7}, {7, 7, 7}, {15, 3, 3}, {1, 1, 31}, {4, 9, 1}, {3, 16, 4}})
    all.push_back({fmt::format("{}x{}x{}", n[0], n[1], n[2]), cubes(n)});
  const auto ball = [](double i, double j, double k) { return i * i + j * j + k * k; };
  all.push_back({"hollow ball", test::voxels_of(cubes({12, 12, 12}), [&](int i, int j, int k) {
                   const double r = ball(i - 5.5, j - 5.5, k - 5.5);
                   return r < 36 && r > 9;
                 })});
  all.push_back({"bridge of single cells", test::voxels_of(cubes({17, 5, 4}), [](int i, int j, int k) {
                   return i < 4 || i > 12 || (j == 2 && k == 1);
                 })});
  all.push_back({"sparse", test::voxels_of(cubes({13, 6, 7}), [](int i, int j, int k) {
                   return (7 * i + 5 * j + 11 * k + i * j * k) % 3 == 0;
                 })});
  all.push_back({"cells that touch at corners", test::voxels_of(cubes({9, 8, 8}), [](int i, int j, int k) {
                   return (i + j) % 2 == 0 && (j + k) % 2 == 0;
                 })});
  return all;
}

std::vector<ModelParameters> models() {
  std::vector<ModelParameters> all;
  for (const char* name : {"hybmss_cf", "hybmss", "hybmss_fd", "msm_18", "msm_14", "hybmss_bt"})
    all.push_back(test::model(name));
  all.push_back(test::model("hybmss"));
  all.back().volume_energy = VolumeEnergy::paper;
  for (Dispersion form :
       {Dispersion::symmetric, Dispersion::share_weighted, Dispersion::published, Dispersion::published_transposed}) {
    all.push_back(test::model("emsm"));
    all.back().dispersion = form;
  }
  for (StrainCurve curve : {StrainCurve::hencky, StrainCurve::neo_hooke, StrainCurve::neo_hooke_isochoric}) {
    all.push_back(test::model("hybmss_avg"));
    all.back().curve = curve;
    all.back().slender = curve == StrainCurve::neo_hooke;
  }
  all.push_back(test::model("emsm"));
  all.back().exact_volumes = false;
  all.push_back(test::model("emsm"));
  all.back().face_to_cube = 2;
  return all;
}

std::string label(const ModelParameters& p, const Body& body, const MotionOptions& options) {
  return fmt::format("{}{} form {} {} {} float{} {} threads", p.row.name,
                     p.volume_energy == VolumeEnergy::paper ? " (paper)" : "", static_cast<int>(p.dispersion),
                     body.name, options.device == Device::gpu ? "gpu" : name_of(options.instructions),
                     options.precision == Precision::float32 ? 32 : 64, options.threads);
}

std::vector<MotionOptions> every_kernel(const std::vector<int>& thread_counts = {1, 2, 3}) {
  std::vector<MotionOptions> all;
  for (InstructionSet set : usable_instruction_sets())
    for (Precision precision : {Precision::float64, Precision::float32})
      for (int threads : thread_counts)
        all.push_back({.time_step = 1, .precision = precision, .threads = threads, .instructions = set});
  for (Precision precision : {Precision::float64, Precision::float32})
    all.push_back({.time_step = 1, .precision = precision, .device = Device::gpu});
  return all;
}

bool lacks(const MotionOptions& options, const MassSpringModel& model) {
  return options.device == Device::gpu && !LatticeMotion::suits_gpu(model, options);
}

double worst(const NodalVectors& a, const NodalVectors& b) {
  return (a - b).rowwise().norm().maxCoeff() / b.rowwise().norm().maxCoeff();
}

TEST(LatticeMotion, ForcesAreThoseOfThePlainLoops) {
  for (const Body& body : bodies())
    for (const ModelParameters& p : models()) {
      const MassSpringModel model = build_model(p, body.mesh, {1e5, 0.3, density});
      const NodalVectors& X = model.network.X;
      const NodalVectors x = X + test::noise(X.rows(), 0.15 * edge), v = test::noise(X.rows(), 1, 2),
                         f = forces(model, x);
      ASSERT_TRUE(LatticeMotion::suits(model)) << body.name;
      for (const MotionOptions& options : every_kernel()) {
        if (lacks(options, model)) continue;
        const auto motion = lattice_motion(model, density, options);
        motion->set_state(x, v);
        const double allowed = options.precision == Precision::float64 ? 1e-12 : 1e-5;
        EXPECT_LE(worst(motion->forces(), f), allowed) << label(p, body, options);
        EXPECT_LE(worst(motion->forces(), f), allowed) << label(p, body, options) << ", asked again";
      }
    }
}

/// Everything that can be prescribed: supports that move, loads, free unknowns beside fixed ones.
BoundaryConditions conditions_of(const Network& network) {
  BoundaryConditions bc;
  bc.fixed.assign(3 * network.nodes(), 0);
  bc.prescribed = NodalVectors::Zero(network.nodes(), 3);
  bc.external = test::noise(network.nodes(), 40, 5);
  const double low = network.X.col(0).minCoeff(), high = network.X.col(0).maxCoeff();
  for (int n = 0; n < network.nodes(); ++n) {
    if (network.X(n, 0) < low + 0.1 * edge) bc.fixed[3 * n] = bc.fixed[3 * n + 1] = bc.fixed[3 * n + 2] = 1;
    if (network.X(n, 0) > high - 0.1 * edge) {
      bc.fixed[3 * n + 1] = 1;
      bc.prescribed(n, 1) = 0.1 * edge;
    }
  }
  return bc;
}

struct State {
  NodalVectors x, v;
  ForceNorms norms;                               ///< of the last step
  double peak_speed = 0;                          ///< of any node so far
  NodalVectors of_supports = NodalVectors(0, 3);  ///< velocity of fixed unknowns that moved in the last step
};

/// Steps of run_dynamics(), spelt out.
State plain_steps(const MassSpringModel& model, State s, const BoundaryConditions& bc, int steps, double dt,
                  double damping, const Viscosity& viscosity = {}) {
  const Eigen::VectorXd mass = masses(model.network, density);
  if (s.of_supports.rows() == 0) s.of_supports = NodalVectors::Zero(s.x.rows(), 3);
  for (int n = 0; n < steps; ++n) {
    NodalVectors f = forces(model, s.x) + bc.external;
    if (viscosity.acts()) viscosity.add_forces(model.network, s.x, s.v + s.of_supports, f);
    s.norms = {};
    for (Eigen::Index i = 0; i < f.size(); ++i) {
      double& sum = bc.fixed[i] ? s.norms.support : s.norms.unbalanced;
      sum += f.data()[i] * f.data()[i];
      if (bc.fixed[i]) {
        s.of_supports.data()[i] = (model.network.X.data()[i] + bc.prescribed.data()[i] - s.x.data()[i]) / dt;
        s.x.data()[i] = model.network.X.data()[i] + bc.prescribed.data()[i];
        continue;
      }
      s.v.data()[i] = (s.v.data()[i] + dt * f.data()[i] / mass[i / 3]) / (1 + dt * damping);
      s.x.data()[i] += dt * s.v.data()[i];
    }
    s.peak_speed = std::max(s.peak_speed, s.v.rowwise().norm().maxCoeff());
  }
  s.norms = {std::sqrt(s.norms.unbalanced), std::sqrt(s.norms.support)};
  return s;
}

TEST(LatticeMotion, StepsAreThoseOfThePlainLoops) {
  for (const Body& body : bodies())
    for (const ModelParameters& p : models()) {
      if (p.row.name == "hybmss_fd" || p.row.name == "msm_14") continue;  // fold over under noise
      if (p.row.bending_correction && body.name == "cells that touch at corners")
        continue;  // its kinematics amplify large rotations
      const MassSpringModel model = build_model(p, body.mesh, {1e5, 0.3, density});
      const NodalVectors& X = model.network.X;
      const double dt = 0.8 * safe_time_step(model, density), damping = 5;
      const BoundaryConditions bc = conditions_of(model.network);
      const State rest = {X, NodalVectors::Zero(X.rows(), 3), {}, 0};
      const int steps = body.mesh.hexahedra.size() > 500 ? 8 : 24;
      const double scale = bc.external.norm();
      const State plain = plain_steps(model, rest, bc, steps, dt, damping);
      // Other numbers of threads: ForcesAreThoseOfThePlainLoops and ThreadsDoNotChangeTheMotionAndRepeatIt.
      for (MotionOptions options : every_kernel({2})) {
        options.time_step = dt;
        options.damping = damping;
        if (lacks(options, model)) continue;
        const bool exact = options.precision == Precision::float64;
        const auto motion = lattice_motion(model, density, options);
        motion->set_conditions(bc);
        motion->advance(steps / 2);
        const ForceNorms norms = motion->advance(steps - steps / 2);
        const std::string what = label(p, body, options);
        EXPECT_LE(worst(motion->positions() - X, plain.x - X), exact ? 1e-12 : 1e-5) << what;
        EXPECT_LE((motion->velocities() - plain.v).rowwise().norm().maxCoeff(),
                  (exact ? 1e-12 : 1e-4) * plain.peak_speed)
            << what;
        EXPECT_NEAR(norms.unbalanced, plain.norms.unbalanced, (exact ? 1e-11 : 1e-4) * scale) << what;
        EXPECT_NEAR(norms.support, plain.norms.support, (exact ? 1e-11 : 1e-4) * (scale + plain.norms.support)) << what;
      }
    }
}

TEST(LatticeMotion, ViscousStepsAreThoseOfThePlainLoops) {
  const IsotropicMaterial material{1e5, 0.3, density};
  for (const Body& body : bodies())
    for (const ModelParameters& p : models()) {
      if (p.has(Extension::none) || p.row.name == "hybmss_fd") continue;  // dashpots along springs; folds over
      if (p.row.bending_correction && body.name == "cells that touch at corners") continue;
      const MassSpringModel model = build_model(p, body.mesh, material);
      const NodalVectors& X = model.network.X;
      const double elastic = safe_time_step(model, density);
      const Viscosity viscosity = Viscosity::of(model, material, 0.3 * elastic);
      ASSERT_TRUE(LatticeMotion::suits(model, {.viscosity = viscosity})) << p.row.name;
      const double dt = 0.8 * viscous_time_step(model, density, viscosity, elastic), damping = 5;
      const BoundaryConditions bc = conditions_of(model.network);
      BoundaryConditions moved = bc;
      moved.prescribed *= 1.2;
      const State rest = {X, NodalVectors::Zero(X.rows(), 3), {}, 0};
      const int steps = body.mesh.hexahedra.size() > 500 ? 3 : 6;
      const State first = plain_steps(model, rest, bc, steps, dt, damping, viscosity);
      const State plain = plain_steps(model, first, moved, steps, dt, damping, viscosity);
      for (MotionOptions options : every_kernel({2})) {
        options.time_step = dt;
        options.damping = damping;
        options.viscosity = viscosity;
        if (lacks(options, model)) continue;
        const bool exact = options.precision == Precision::float64;
        const auto motion = lattice_motion(model, density, options);
        motion->set_conditions(bc);
        motion->advance(steps);
        motion->set_conditions(moved);
        const ForceNorms norms = motion->advance(steps);
        const std::string what = label(p, body, options);
        EXPECT_LE(worst(motion->positions() - X, plain.x - X), exact ? 1e-12 : 1e-5) << what;
        EXPECT_LE((motion->velocities() - plain.v).rowwise().norm().maxCoeff(),
                  (exact ? 1e-12 : 1e-4) * plain.peak_speed)
            << what;
        const double scale = bc.external.norm() + plain.norms.support;
        EXPECT_NEAR(norms.unbalanced, plain.norms.unbalanced, (exact ? 1e-11 : 1e-4) * scale) << what;
        EXPECT_NEAR(norms.support, plain.norms.support, (exact ? 1e-11 : 1e-4) * scale) << what;
        EXPECT_LE(worst(motion->forces(), forces(model, motion->positions())), exact ? 1e-11 : 1e-3) << what;
      }
    }
}

TEST(LatticeMotion, ThreadsDoNotChangeTheMotionAndRepeatIt) {
  const Mesh mesh = block_mesh(edge * Vec3(6, 6, 9), {6, 6, 9});
  const MassSpringModel model = build_model(test::model("hybmss"), mesh, {1e5, 0.3, density});
  const double dt = 0.8 * safe_time_step(model, density);
  const auto positions = [&](int threads) {
    const auto motion = lattice_motion(model, density, {.time_step = dt, .damping = 5, .threads = threads});
    motion->set_conditions(conditions_of(model.network));
    motion->advance(100);
    return NodalVectors(motion->positions() - model.network.X);
  };
  const NodalVectors one = positions(1);
  for (int threads : {2, 3, 5, 50}) {
    const NodalVectors many = positions(threads);
    EXPECT_LE(worst(many, one), 1e-11) << threads;
    EXPECT_EQ((many - positions(threads)).cwiseAbs().maxCoeff(), 0) << threads;
  }
}

TEST(LatticeMotion, StretchByWholeCellsIsNoTrap) {
  // The last node of a row then lies where the first of the next seems to be.
  const Mesh mesh = block_mesh(edge * Vec3(7, 2, 2), {7, 2, 2});
  const MassSpringModel model = build_model(test::model("hybmss"), mesh, {1e5, 0.3, density});
  const NodalVectors& X = model.network.X;
  for (int axis = 0; axis < 3; ++axis) {
    NodalVectors x = X;
    for (int n = 0; n < x.rows(); ++n)
      if (X(n, axis) > X.col(axis).maxCoeff() - 0.1 * edge) x(n, axis) += edge;
    const auto motion = lattice_motion(model, density, {.time_step = 1});
    motion->set_state(x, 0 * X);
    EXPECT_LE(worst(motion->forces(), forces(model, x)), 1e-12);
  }
}

TEST(LatticeMotion, DispersionMayBeNegative) {
  for (const Body& body : bodies()) {
    const MassSpringModel model = build_model(test::model("emsm"), body.mesh, {1e5, 0.1, density});
    const NodalVectors x = model.network.X + test::noise(model.network.nodes(), 0.15 * edge);
    const auto motion = lattice_motion(model, density, {.time_step = 1});
    motion->set_state(x, NodalVectors::Zero(x.rows(), 3));
    EXPECT_LT(dispersion_of(model)->q, 0);
    EXPECT_LE(worst(motion->forces(), forces(model, x)), 1e-12) << body.name;
  }
}

TEST(LatticeMotion, SuitsLatticesOnly) {
  const Mesh mesh = block_mesh({1, 1, 1}, {3, 3, 3});
  const IsotropicMaterial material{1e5, 0.3, density};
  for (const char* name : {"msm_random", "msm_hexagonal", "kirkwood"})
    EXPECT_FALSE(LatticeMotion::suits(build_model(test::model(name), mesh, material))) << name;
  MassSpringModel model = build_model(test::model("hybmss"), mesh, material);
  EXPECT_TRUE(LatticeMotion::suits(model));
  model.network.springs[7].rest_length *= 1.01;
  EXPECT_FALSE(LatticeMotion::suits(model));
  EXPECT_THROW(lattice_motion(model, density, {.time_step = 1}), std::invalid_argument);
  const MassSpringModel springs = build_model(test::model("msm_18"), mesh, {1e5, 0.25, density});
  EXPECT_TRUE(LatticeMotion::suits(springs));
  EXPECT_FALSE(LatticeMotion::suits(springs, {.viscosity = Viscosity::of(springs, {1e5, 0.25, density}, 1e-3)}));
}

TEST(LatticeMotion, KeepsFewBytesPerNode) {
  const Mesh mesh = block_mesh(edge * Vec3(31, 31, 31), {31, 31, 31});
  const MassSpringModel model = build_model(test::model("hybmss"), mesh, {1e5, 0.3, density});
  const auto bytes = [&](Precision precision) {
    return lattice_motion(model, density, {.time_step = 1, .precision = precision})->bytes_per_node();
  };
  EXPECT_LE(bytes(Precision::float64), 80);
  EXPECT_LE(bytes(Precision::float32), 50);
}

}  // namespace
}  // namespace springproof::lattice_motion_test
