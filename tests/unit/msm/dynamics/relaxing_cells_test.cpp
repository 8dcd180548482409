// Cells that relax: what their branches resist, keep and dissipate, in plain loops, kernels and large steps.
#include "msm/dynamics/terms/relaxing_cells.h"

#include <gtest/gtest.h>

#include <cmath>

#include "msm/dynamics/dynamics.h"
#include "msm/dynamics/list_motion.h"
#include "msm/dynamics/plain_motion.h"
#include "msm/dynamics/time_step.h"
#include "msm/laws/capabilities.h"
#include "support/zoo.h"

namespace springproof::relaxing_cells_test {
namespace {

constexpr double density = 1000;
const IsotropicMaterial rubber{1e4, 0.45, density};
const Relaxation two{{{0.116, 0.27}, {0.057, 2.6}}};

EmbeddedModel bar(const std::string& model, const Cells& cells = {4, 2, 2}) {
  return build_embedded(test::model(model), block_mesh({2, 1, 1}, cells), rubber);
}

MassSpringModel cut_model() {
  MassSpringModel model{test::cut_network(), {}};
  model.laws.emplace_back(AveragedSprings{shear_modulus(rubber), lame_lambda(rubber),
                                          HourglassStiffness::of_pattern(2, rubber.poisson_ratio, true, true)});
  return model;
}

NodalVectors bent(const NodalVectors& X) {
  NodalVectors x = X;
  for (Eigen::Index n = 0; n < X.rows(); ++n) {
    const Vec3 p = X.row(n).transpose();
    x.row(n) << 1.1 * p[0] + 0.05 * p[2] * p[0], 0.95 * p[1] + 0.02 * p[0] * p[0], p[2] - 0.03 * p[0] * p[1];
  }
  return x;
}

NodalVectors turned(const NodalVectors& x) {
  return x * Eigen::AngleAxisd(0.9, Vec3(1, 2, -1).normalized()).toRotationMatrix().transpose();
}

/// Nothing held, no load.
BoundaryConditions free_body(const Network& network) {
  BoundaryConditions bc;
  bc.fixed.assign(network.X.size(), 0);
  bc.owner.assign(network.X.size(), -1);
  bc.prescribed = bc.external = NodalVectors::Zero(network.X.rows(), 3);
  return bc;
}

NodalVectors forces_of(const Overstrains& branches, const NodalVectors& x, double dt) {
  NodalVectors f = NodalVectors::Zero(x.rows(), 3);
  branches.add_forces(x, dt, f);
  return f;
}

MassSpringModel measured(const Cells& cells = {4, 2, 2}) {
  return test::with_measured_cells(bar("hybmss_avg", cells).model);
}
MassSpringModel measured_cut() { return test::with_measured_cells(cut_model()); }

std::vector<MassSpringModel> models() {
  return {bar("hybmss_avg").model, bar("hybmss").model, cut_model(), measured(), measured_cut()};
}

TEST(RelaxingCells, ASuddenStrainMeetsTheSolidOfTheSuddenModuli) {
  for (const double nu : {0.0, 0.3, 0.45}) {
    const IsotropicMaterial solid{1e4, nu, density};
    const auto model_of = [](const IsotropicMaterial& m) {
      return build_embedded(test::model("hybmss_avg"), block_mesh({2, 1, 1}, {4, 2, 2}), m).model;
    };
    const MassSpringModel model = model_of(solid);
    const NodalVectors &X = model.network.X, x = X + 1e-6 * (bent(X) - X);
    const Overstrains branches(model.network, RelaxingCells::of(model, solid, two));
    const NodalVectors expected = forces(model_of(with_shear(solid, 1.173)), x) - forces(model, x),
                       f = forces_of(branches, x, 0);
    EXPECT_LT((f - expected).norm(), 1e-4 * expected.norm()) << nu;
    EXPECT_LT(forces_of(branches, x, 1e4).norm(), 1e-3 * expected.norm()) << nu;
  }
}

TEST(RelaxingCells, OfMeasuredCellsHaveTheirFormsButForVolume) {
  MassSpringModel model = measured();
  const MassSpringModel of_springs = bar("hybmss_avg").model;
  const NodalVectors &X = model.network.X, x = X + 1e-6 * (bent(X) - X);
  const NodalVectors f = forces_of({model.network, RelaxingCells::of(model, rubber, two)}, x, 0);
  MeasuredCells& law = *law_of<MeasuredCells>(model);
  for (std::size_t c = 0; c < model.network.cells.size(); ++c) {
    DeformationForm M = law.form_of_cell(c);
    Eigen::Matrix3d P = Eigen::Matrix3d::Identity() - Eigen::Matrix3d::Constant(1.0 / 3);
    M.topRows<3>() = P * M.topRows<3>().eval();
    M.leftCols<3>() = M.leftCols<3>().eval() * P;
    const std::size_t begin = numbers_of_form * c;
    std::vector<double> number;
    for (int i = 0; i < deformations_of_cell; ++i)
      for (int j = 0; j <= i; ++j) number.push_back(0.173 * M(i, j));
    std::copy(number.begin(), number.end(), law.form.begin() + static_cast<std::ptrdiff_t>(begin));
  }
  const NodalVectors expected = forces(model, x);
  EXPECT_LT((f - expected).norm(), 1e-12 * expected.norm());
  MeasuredCells same;  // of averaged springs: their branches, but for the bulk modulus in bending
  for (std::size_t c = 0; c < of_springs.network.cells.size(); ++c)
    same.add_form(form_of(*averaged_springs_of(of_springs), of_springs.network.cells.shape(c)));
  const MassSpringModel averaged_forms{of_springs.network, {same}};
  const NodalVectors of_forms = forces_of({model.network, RelaxingCells::of(averaged_forms, rubber, two)}, x, 0),
                     of_branches = forces_of({model.network, RelaxingCells::of(of_springs, rubber, two)}, x, 0);
  EXPECT_LT((of_forms - of_branches).norm(), 0.05 * of_branches.norm());
  EXPECT_GT((of_forms - of_branches).norm(), 1e-4 * of_branches.norm());
}

TEST(RelaxingCells, ForcesAreTheChangeOfTheirEnergy) {
  for (const MassSpringModel& model : models()) {
    const NodalVectors x = bent(model.network.X), d = test::noise(x.rows(), 1e-6);
    const auto energy = [&](const NodalVectors& at) {
      Overstrains branches(model.network, RelaxingCells::of(model, rubber, two));
      branches.advance(at, 1e-30);
      return branches.energy();
    };
    const Overstrains branches(model.network, RelaxingCells::of(model, rubber, two));
    const double work = forces_of(branches, x, 1e-30).cwiseProduct(d).sum();
    EXPECT_NEAR(-work, (energy(x + d) - energy(x - d)) / 2, 1e-6 * std::abs(work));
  }
}

TEST(RelaxingCells, TurnWithTheBodyAndKeepBothMomenta) {
  for (const MassSpringModel& model : models()) {
    Overstrains branches(model.network, RelaxingCells::of(model, rubber, two));
    const NodalVectors x0 = bent(model.network.X), x1 = x0 + test::noise(x0.rows(), 0.02);
    branches.advance(x0, 0.1);
    const NodalVectors f = forces_of(branches, x1, 0.3), of_turned = forces_of(branches, turned(x1), 0.3);
    EXPECT_LT((of_turned - turned(f)).norm(), 1e-12 * f.norm());
    NodalVectors mean = NodalVectors::Zero(f.rows(), 3);
    branches.add_mean_forces(x0, x1, 0.3, mean);
    const NodalVectors middle = (x0 + x1) / 2;
    Vec3 torque = Vec3::Zero(), of_mean = Vec3::Zero();
    for (Eigen::Index n = 0; n < f.rows(); ++n) {
      torque += Vec3(x1.row(n).transpose()).cross(Vec3(f.row(n).transpose()));
      of_mean += Vec3(middle.row(n).transpose()).cross(Vec3(mean.row(n).transpose()));
    }
    EXPECT_LT(f.colwise().sum().norm() + mean.colwise().sum().norm(), 1e-12 * f.norm());
    EXPECT_LT(torque.norm() + of_mean.norm(), 1e-12 * f.norm());
  }
}

TEST(RelaxingCells, TheWorkOfAStepIsStoredOrDissipated) {
  for (const MassSpringModel& model : models())
    for (const double dt : {1e-4, 0.05, 0.8, 40.0}) {
      Overstrains branches(model.network, RelaxingCells::of(model, rubber, two));
      NodalVectors x0 = model.network.X;
      for (int step = 0; step < 6; ++step) {
        const NodalVectors x1 = turned(x0) + test::noise(x0.rows(), 0.02, 3 + static_cast<unsigned>(step));
        NodalVectors f = NodalVectors::Zero(x0.rows(), 3);
        branches.add_mean_forces(x0, x1, dt, f);
        const double before = branches.energy() + branches.dissipated(), dissipated = branches.dissipated();
        branches.advance(x1, dt);
        const double now = branches.energy() + branches.dissipated();
        EXPECT_NEAR(now - before, -f.cwiseProduct(x1 - x0).sum(), 1e-12 * now);
        EXPECT_GT(branches.dissipated(), dissipated);
        x0 = x1;
      }
    }
}

/// A bar that is stretched and let go, in large steps: the largest change of kinetic, elastic and branches' energy and
/// what was dissipated, relative to the elastic energy at the start.
void expect_balance(const MassSpringModel& model) {
  const NodalVectors start = bent(model.network.X);
  MotionOptions options{.integrator = Integrator::energy_momentum, .time_step = 0.05};
  options.relaxation = RelaxingCells::of(model, rubber, two);
  const std::unique_ptr<Motion> motion = make_motion(model, density, options);
  motion->set_conditions(free_body(model.network));
  motion->set_state(start, NodalVectors::Zero(start.rows(), 3));
  motion->relax();
  Overstrains beside(model.network, options.relaxation);
  beside.relax(start);
  const Eigen::VectorXd mass = masses(model.network, density);
  const double scale = energy(model, start);
  for (int step = 0; step < 40; ++step) {
    motion->advance(1);
    ASSERT_EQ(motion->failure(), "");
    const NodalVectors x = motion->positions(), v = motion->velocities();
    beside.advance(x, 0.05);
    const double kinetic = 0.5 * (mass.asDiagonal() * v).cwiseProduct(v).sum();
    EXPECT_NEAR(kinetic + energy(model, x) + beside.energy() + beside.dissipated(), scale, 1e-10 * scale) << step;
  }
  EXPECT_GT(beside.dissipated(), 0.01 * scale);
}

TEST(RelaxingCells, LargeStepsKeepEnergyAndWhatIsDissipated) {
  expect_balance(bar("hybmss_avg", {2, 1, 1}).model);
  expect_balance(measured({2, 1, 1}));
}

/// Positions after some steps that are not at rest at the start.
NodalVectors after(Motion& motion, const MassSpringModel& model, long steps) {
  BoundaryConditions bc = free_body(model.network);
  for (int d = 0; d < 3; ++d) bc.fixed[d] = true;
  for (int d = 0; d < 3; ++d) bc.prescribed(0, d) = 0.01;
  motion.set_conditions(bc);
  NodalVectors v = test::noise(model.network.nodes(), 0.1);
  const Eigen::VectorXd mass = masses(model.network, density);
  for (Eigen::Index n = 0; n < v.rows(); ++n)
    if (n == 0 || mass[n] == 0) v.row(n).setZero();
  motion.set_state(bent(model.network.X), v);
  motion.relax();
  motion.advance(steps);
  return motion.positions();
}

TEST(RelaxingCells, KernelsMoveThemAsPlainLoopsDo) {
  for (const MassSpringModel& model :
       {bar("hybmss_avg", {9, 3, 2}).model, cut_model(), measured({8, 4, 4}), measured_cut()})
    for (const double viscosity : {0.0, 1e-3}) {
      MotionOptions options;
      options.relaxation = RelaxingCells::of(model, rubber, two);
      options.viscosity = Viscosity::of(model, rubber, viscosity);
      options.time_step = 0.5 * relaxing_time_step(model, density, options.relaxation, safe_time_step(model, density));
      PlainMotion plain(model, density, options);
      const std::unique_ptr<Motion> by_kernel = list_motion(model, density, options);
      ASSERT_TRUE(by_kernel);
      const NodalVectors expected = after(plain, model, 20), x = after(*by_kernel, model, 20);
      EXPECT_LT((x - expected).norm(), 1e-11 * (expected - bent(model.network.X)).norm()) << viscosity;
      const NodalVectors f = plain.relaxing_forces();
      EXPECT_LT((by_kernel->relaxing_forces() - f).norm(), 1e-9 * f.norm());
      options.relaxation = {};
      PlainMotion elastic(model, density, options);
      EXPECT_GT((after(elastic, model, 20) - expected).norm(), 1e-6 * expected.norm());
    }
}

TEST(RelaxingCells, KernelsKnowWhatTheyHaveStoredAndDissipated) {
  for (const MassSpringModel& model :
       {bar("hybmss_avg", {9, 3, 2}).model, bar("hybmss_avg", {4, 2, 2}).model, cut_model(), measured()}) {
    MotionOptions options{.branch_energies = true};
    options.relaxation = RelaxingCells::of(model, rubber, two);
    options.time_step = 0.25 * relaxing_time_step(model, density, options.relaxation, safe_time_step(model, density));
    PlainMotion plain(model, density, options);
    const std::unique_ptr<Motion> by_kernel = list_motion(model, density, options);
    ASSERT_TRUE(by_kernel);
    for (Motion* motion : {static_cast<Motion*>(&plain), by_kernel.get()}) {
      after(*motion, model, 1);
      for (int step = 0; step < 300; ++step) motion->advance(1);
    }
    const BranchEnergies exact = *plain.branch_energies(), energies = *by_kernel->branch_energies();
    EXPECT_GT(exact.stored, 0);
    EXPECT_NEAR(energies.stored, exact.stored, 1e-10 * exact.stored);
    EXPECT_NEAR(energies.dissipated, exact.dissipated, 1e-2 * exact.dissipated);
    by_kernel->relax();
    EXPECT_EQ(by_kernel->branch_energies()->dissipated, 0);
    options.branch_energies = false;
    EXPECT_FALSE(list_motion(model, density, options)->branch_energies());
  }
}

TEST(RelaxingCells, OfBoxesByThreadsAndInFloatsMoveAsPlainLoopsDo) {
  for (const MassSpringModel& model :
       {bar("hybmss_avg", {9, 3, 2}).model, bar("hybmss_avg", {8, 4, 4}).model, cut_model(), measured({8, 4, 4})}) {
    MotionOptions options;
    options.relaxation = RelaxingCells::of(model, rubber, two);
    options.time_step = 0.5 * relaxing_time_step(model, density, options.relaxation, safe_time_step(model, density));
    PlainMotion plain(model, density, options);
    const NodalVectors expected = after(plain, model, 20);
    const double size = (expected - bent(model.network.X)).norm();
    for (const Precision precision : {Precision::float64, Precision::float32})
      for (const int threads : {1, 2, 3}) {
        options.precision = precision;
        options.threads = threads;
        const std::unique_ptr<Motion> motion = make_motion(model, density, options);
        const double allowed = precision == Precision::float64 ? 1e-11 : 1e-4;
        EXPECT_LT((after(*motion, model, 20) - expected).norm(), allowed * size) << threads << " threads";
      }
  }
}

TEST(RelaxingCells, InFloatsBranchesOfYearsDoNotEndInRoundOff) {
  const MassSpringModel model = bar("hybmss_avg", {4, 2, 2}).model;
  MotionOptions options{.precision = Precision::float32};
  options.relaxation = RelaxingCells::of(model, rubber, {{{0.5, 1e8}}});
  options.time_step = 0.5 * relaxing_time_step(model, density, options.relaxation, safe_time_step(model, density));
  PlainMotion plain(model, density, options);
  const NodalVectors expected = after(plain, model, 20);
  const std::unique_ptr<Motion> motion = make_motion(model, density, options);
  EXPECT_LT((after(*motion, model, 20) - expected).norm(), 1e-4 * (expected - bent(model.network.X)).norm());
}

TEST(RelaxingCells, AStepOfImplicitEulerEndsWithTheForcesOfItsEnd) {
  const MassSpringModel model = bar("hybmss_avg", {2, 1, 1}).model;
  const double dt = 0.02;
  MotionOptions options{.integrator = Integrator::implicit_euler, .time_step = dt};
  options.relaxation = RelaxingCells::of(model, rubber, two);
  const std::unique_ptr<Motion> motion = make_motion(model, density, options);
  const NodalVectors start = bent(model.network.X);
  motion->set_conditions(free_body(model.network));
  motion->set_state(start, NodalVectors::Zero(start.rows(), 3));
  motion->relax();
  Overstrains beside(model.network, options.relaxation);
  beside.relax(start);
  const Eigen::VectorXd mass = masses(model.network, density);
  NodalVectors v = NodalVectors::Zero(start.rows(), 3);
  for (int step = 0; step < 10; ++step) {
    motion->advance(1);
    ASSERT_EQ(motion->failure(), "");
    const NodalVectors x = motion->positions(), branches = forces_of(beside, x, dt), f = forces(model, x) + branches;
    EXPECT_LT((mass.asDiagonal() * (motion->velocities() - v) / dt - f).norm(), 1e-6 * f.norm()) << step;
    if (step == 1) {
      EXPECT_GT(branches.norm(), 1e-3 * f.norm());
    }
    beside.advance(x, dt);
    v = motion->velocities();
  }
}

TEST(RelaxingCells, AShortTimeOfABranchNeedsNoSmallerStep) {
  for (const char* name : {"hybmss_avg", "hybmss"}) {
    const IsotropicMaterial foam{1e4, 0, density};
    const MassSpringModel model = build_model(test::model(name), block_mesh({2, 1, 1}, {4, 2, 2}), foam);
    const double elastic = safe_time_step(model, density);
    const auto step = [&](double time) {
      return relaxing_time_step(model, density, RelaxingCells::of(model, foam, {{{0.2, time}}}), elastic);
    };
    EXPECT_EQ(step(1e-9), step(1));
    EXPECT_GT(step(1e-9), 0.99 * elastic / std::sqrt(1.2));
    EXPECT_LT(step(1e-9), elastic);
    MotionOptions options;
    options.relaxation = RelaxingCells::of(model, foam, {{{0.2, 1e-9}}});
    options.time_step = 0.95 * step(1e-9);
    PlainMotion motion(model, density, options);
    const NodalVectors &X = model.network.X, start = 0.01 * (bent(X) - X);
    motion.set_conditions(free_body(model.network));
    motion.set_state(X + start, NodalVectors::Zero(X.rows(), 3));
    motion.relax();
    motion.advance(5000);
    EXPECT_LT((motion.positions() - X).norm(), 2 * start.norm());
  }
}

TEST(RelaxingCells, OfANetworkWithoutCellsAreRefused) {
  const EmbeddedModel body =
      build_embedded(test::model("msm_random"), block_mesh({4, 1, 1}, {8, 2, 2}), {1e4, 0.25, density});
  EXPECT_NE(lacks(body.model, Capability::relaxation), "");
  EXPECT_THROW(RelaxingCells::of(body.model, {1e4, 0.25, density}, two), InputError);
  EXPECT_FALSE(RelaxingCells::of(body.model, {1e4, 0.25, density}, {}).acts());
}

}  // namespace
}  // namespace springproof::relaxing_cells_test
