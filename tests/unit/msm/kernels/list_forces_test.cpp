// The list kernels against the plain loops of the laws.
#include "msm/dynamics/list_motion.h"

#include <gtest/gtest.h>

#include <random>

#include "msm/dynamics/dynamics.h"
#include "msm/dynamics/time_step.h"
#include "msm/kernels/list_forces.h"
#include "msm/kernels/list_stiffness.h"
#include "msm/laws/capabilities.h"
#include "msm/topology/random/random_network.h"
#include "support/zoo.h"

namespace springproof::list_forces_test {

using namespace test;

namespace {

double uniform(std::mt19937& generator) { return generator() / 4294967295.0; }

RandomParameters spacing_one() {
  RandomParameters p{};
  p.spacing = 1;
  return p;
}

/// `springs` springs between distinct random pairs of nodes, all constants different.
Network tangle(int nodes, int springs, unsigned seed) {
  std::mt19937 generator(seed);
  Network network;
  network.X = noise(nodes, 1, seed + 1);
  std::set<std::pair<int, int>> pairs;
  while (static_cast<int>(pairs.size()) < springs) {
    const int i = static_cast<int>(generator() % nodes), j = static_cast<int>(generator() % nodes);
    if (i < j) pairs.insert({i, j});
  }
  for (const auto& [i, j] : pairs)
    network.springs.push_back({i, j, 0.5 + uniform(generator),
                               (network.X.row(j) - network.X.row(i)).norm() * (0.8 + 0.4 * uniform(generator))});
  network.volume = Eigen::VectorXd::Constant(nodes, 0.1);
  return network;
}

std::vector<MassSpringModel> models_of(const Network& network) {
  std::vector<MassSpringModel> models = {{network, {Springs{}}}};
  for (Dispersion form :
       {Dispersion::symmetric, Dispersion::share_weighted, Dispersion::published, Dispersion::published_transposed})
    if (network.image_of.empty() || form == Dispersion::symmetric)
      models.push_back({network, {Springs{}, MomentumDispersion{0.6, form}}});
  MomentumDispersion weighted{0.6, Dispersion::symmetric};
  for (std::size_t e = 0; e < 2 * network.springs.size(); ++e) weighted.weight.push_back(0.1 + 0.01 * double(e % 97));
  if (network.image_of.empty())
    for (int n = 0; n < network.nodes(); ++n) weighted.group.push_back(n - n % 3);
  models.push_back({network, {Springs{}, weighted}});
  return models;
}

std::vector<MassSpringModel> all_models() {
  std::vector<Network> networks = {tangle(2, 1, 1), tangle(7, 7, 2), tangle(143, 1003, 3)};
  networks.push_back(random_network(region_of(block_mesh({7, 6, 5}, {7, 6, 5})), spacing_one()));
  networks.push_back(periodic_random_network({6, 6, 6}, spacing_one()));
  std::vector<MassSpringModel> models;
  for (const Network& network : networks)
    for (MassSpringModel& m : models_of(network)) models.push_back(std::move(m));
  return models;
}

template <class Real>
void expect_plain_forces(double tolerance) {
  for (InstructionSet set : usable_instruction_sets())
    for (const MassSpringModel& model : all_models()) {
      const NodalVectors x = model.network.X + noise(model.network.nodes(), 0.05, 9), expected = forces(model, x);
      NodalVectors f;
      ListForces<Real> fast(model, set);
      for (int repeat = 0; repeat < 2; ++repeat) {
        fast.at(x, f);
        EXPECT_LE((f - expected).cwiseAbs().maxCoeff(), tolerance * expected.cwiseAbs().maxCoeff())
            << name_of(set) << ", " << model.network.springs.size() << " springs, " << model.laws.size() << " laws";
      }
    }
}

/// The steps of run_dynamics(), written out.
void plain_steps(const MassSpringModel& model, const Eigen::VectorXd& mass, const LoadPath& path,
                 const DynamicsOptions& o, int steps, NodalVectors& x, NodalVectors& v) {
  const double dt = *o.time_step;
  x = model.network.X;
  v = NodalVectors::Zero(x.rows(), 3);
  Eigen::VectorXd J;
  for (int step = 0; step < steps; ++step) {
    const auto at = [&](int steps_made) {
      return path(o.course.ramp > 0 ? std::min(1.0, steps_made * dt / o.course.ramp) : 1.0);
    };
    const BoundaryConditions bc = at(step), next = at(step + 1);
    if (step == 0)
      for (Eigen::Index i = 0; i < x.size(); ++i)
        if (bc.fixed[i]) x.data()[i] += bc.prescribed.data()[i];
    NodalVectors f = forces(model, x);
    if (const MomentumDispersion* law = o.lagged ? dispersion_of(model) : nullptr) {
      f.setZero();
      Springs{}.add_forces(model.network, x, f);
      const Eigen::VectorXd now = law->inflow(model.network, x);
      law->add_forces(model.network, x, step == 0 ? now : J, f);
      J = now;
    }
    for (Eigen::Index i = 0; i < x.size(); ++i)
      if (bc.fixed[i]) {
        x.data()[i] = model.network.X.data()[i] + next.prescribed.data()[i];
      } else {
        v.data()[i] = (v.data()[i] + dt * (f.data()[i] + bc.external.data()[i]) / mass[i / 3]) / (1 + dt * o.damping);
        x.data()[i] += dt * v.data()[i];
      }
  }
}

}  // namespace

TEST(ListForces, DoubleIsThePlainLoop) { expect_plain_forces<double>(1e-12); }

TEST(ListForces, FloatIsThePlainLoopToSinglePrecision) { expect_plain_forces<float>(1e-5); }

TEST(ListForces, CoverSpringsAndDispersionOnly) {
  const Network network = tangle(7, 7, 2);
  EXPECT_TRUE(can({network, {Springs{}}}, Capability::list_kernels));
  EXPECT_TRUE(can({network, {Springs{}, MomentumDispersion{0.1}}}, Capability::list_kernels));
  EXPECT_FALSE(can({network, {MomentumDispersion{0.1}}}, Capability::list_kernels));
  const MassSpringModel corrected{network, {Springs{}, VolumeCorrection{1.0}}};
  EXPECT_FALSE(can(corrected, Capability::list_kernels));
  EXPECT_THROW(ListForces<double>{corrected}, std::invalid_argument);
}

TEST(ListStiffness, IsTheTangentAtRest) {
  for (InstructionSet set : usable_instruction_sets())
    for (MassSpringModel& model : all_models()) {
      for (Spring& s : model.network.springs)
        s.rest_length = (model.network.X.row(s.j) - model.network.X.row(s.i)).norm();
      const ListStiffness<double> list(model, std::make_shared<SpringBlocks>(model.network), set);
      const Tangent K = tangent(model, model.network.X);
      const NodalVectors u = noise(model.network.nodes(), 1, 5);
      const Eigen::VectorXd flat = Eigen::Map<const Eigen::VectorXd>(u.data(), u.size());
      Eigen::VectorXd expected, y, single;
      K.multiply(flat, expected);
      list.multiply(flat, y);
      EXPECT_LE((y - expected).lpNorm<Eigen::Infinity>(), 1e-13 * expected.lpNorm<Eigen::Infinity>());
      const double unit = 7e4;
      ListStiffness<float>(list, unit).multiply(flat, single);
      EXPECT_LE((unit * single - expected).lpNorm<Eigen::Infinity>(), 1e-5 * expected.lpNorm<Eigen::Infinity>());
      const std::vector<Eigen::Matrix3d> blocks = list.node_blocks(), node_blocks = K.node_blocks();
      for (std::size_t p = 0; p < blocks.size(); ++p)
        EXPECT_LE((blocks[p] - node_blocks[list.blocks()->order[p]]).norm(),
                  1e-13 * (1 + node_blocks[list.blocks()->order[p]].norm()));
    }
}

TEST(SpringBlocks, HoldEverySpringOnceInNearlyFullBlocks) {
  const Network network = random_network(region_of(block_mesh({12, 12, 12}, {12, 12, 12})), spacing_one());
  const SpringBlocks blocks(network);
  std::vector<int> seen(network.springs.size(), 0);
  for (std::size_t e = 0; e < blocks.entries(); ++e) {
    ASSERT_NE(blocks.i[e / 4], blocks.j[e]);
    if (blocks.spring[e] < 0) continue;
    ++seen[blocks.spring[e]];
    const Spring& s = network.springs[blocks.spring[e]];
    EXPECT_EQ(std::minmax(blocks.order[blocks.i[e / 4]], blocks.order[blocks.j[e]]), std::minmax(s.i, s.j));
  }
  EXPECT_TRUE(std::all_of(seen.begin(), seen.end(), [](int n) { return n == 1; }));
  EXPECT_EQ(blocks.i.size() % blocks_together, 0u);
  EXPECT_LE(double(blocks.entries()), 1.02 * double(seen.size()));
}

namespace {

/// Held at x < 0.5 in two components, one of them displaced; a load on every node.
BoundaryConditions pulled(const Network& network) {
  BoundaryConditions full;
  full.fixed.assign(3 * network.nodes(), 0);
  full.prescribed = NodalVectors::Zero(network.nodes(), 3);
  full.external = noise(network.nodes(), 0.01, 4);
  for (int n = 0; n < network.nodes(); ++n)
    if (network.X(n, 0) < 0.5) {
      full.fixed[3 * n] = full.fixed[3 * n + 2] = 1;
      full.prescribed(n, 2) = 0.1;
    }
  return full;
}

/// Unbalanced forces on free and on held unknowns.
ForceNorms plain_norms(const MassSpringModel& model, const NodalVectors& x, const BoundaryConditions& bc) {
  const NodalVectors f = forces(model, x) + bc.external;
  ForceNorms squares;
  for (Eigen::Index i = 0; i < f.size(); ++i)
    (bc.fixed[i] ? squares.support : squares.unbalanced) += f.data()[i] * f.data()[i];
  return {std::sqrt(squares.unbalanced), std::sqrt(squares.support)};
}

}  // namespace

TEST(ListMotion, IsThePlainMotion) {
  const Network network = random_network(region_of(block_mesh({6, 5, 5}, {6, 5, 5})), spacing_one());
  const BoundaryConditions full = pulled(network);
  const LoadPath path = [&](double factor) {
    BoundaryConditions bc = full;
    bc.prescribed *= factor;
    bc.external *= factor;
    return bc;
  };
  for (const MassSpringModel& model : models_of(network))
    for (double ramp : {0.0, 0.8})
      for (bool lagged : {false, true}) {
        DynamicsOptions options;
        options.course.ramp = ramp;
        options.lagged = lagged;
        options.damping = 5;
        options.time_step = 0.2 * safe_time_step(model, 1, lagged);
        options.duration = 59.5 * *options.time_step;
        NodalVectors x, v;
        plain_steps(model, masses(network, 1), path, options, 60, x, v);
        NodalVectors last_v;
        options.after_step = [&](const MotionSample& at) {
          const NodalVectors& now = at.v;
          last_v = now;
        };
        const DynamicsResult result = run_dynamics(model, 1, path, options);
        ASSERT_EQ(result.steps, 60);
        const NodalVectors u = x - network.X;
        EXPECT_LE((result.state.displacement - u).cwiseAbs().maxCoeff(), 1e-11 * u.cwiseAbs().maxCoeff());
        EXPECT_LE((last_v - v).cwiseAbs().maxCoeff(), 1e-11 * v.cwiseAbs().maxCoeff());
      }
}

TEST(ListMotion, StepsThatFollowEachOtherAreThePlainStepsOnAnyNumberOfThreads) {
  const Network network = random_network(region_of(block_mesh({26, 8, 9}, {26, 8, 9})), spacing_one());
  const MassSpringModel model{network, {Springs{}}};
  const BoundaryConditions bc = pulled(network);
  const LoadPath path = [&](double) { return bc; };
  DynamicsOptions o;
  o.damping = 0.3;
  o.time_step = 0.2 * safe_time_step(model, 1);
  NodalVectors x, v, before, unused, first_x, first_v;
  plain_steps(model, masses(network, 1), path, o, 41, x, v);
  plain_steps(model, masses(network, 1), path, o, 40, before, unused);
  const ForceNorms expected = plain_norms(model, before, bc);
  for (const InstructionSet set : usable_instruction_sets())
    for (const int threads : {1, 2, 3}) {
      ListMotion<double> motion(std::make_unique<ListForces<double>>(model, set), model, 1,
                                {.time_step = *o.time_step, .damping = o.damping, .threads = threads});
      motion.set_conditions(bc);
      motion.move_supports();
      for (const long steps : {7, 1, 2}) motion.advance(steps);
      const ForceNorms norms = motion.advance(31);
      EXPECT_EQ(motion.threads(), threads);
      const NodalVectors at = motion.positions(), speed = motion.velocities();
      const NodalVectors u = x - network.X;
      EXPECT_LE((at - x).cwiseAbs().maxCoeff(), 1e-12 * u.cwiseAbs().maxCoeff());
      EXPECT_LE((speed - v).cwiseAbs().maxCoeff(), 1e-12 * v.cwiseAbs().maxCoeff());
      EXPECT_NEAR(norms.unbalanced, expected.unbalanced, 1e-11 * expected.unbalanced);
      EXPECT_NEAR(norms.support, expected.support, 1e-11 * expected.support);
      if (threads == 1) {
        first_x = at;
        first_v = speed;
      }
      EXPECT_TRUE(at == first_x && speed == first_v) << threads << " threads, " << name_of(set);
    }
}

TEST(Wavefront, FollowsAFewLayersBehind) {
  const Network network = random_network(region_of(block_mesh({10, 50, 10}, {10, 50, 10})), spacing_one());
  const SpringBlocks blocks(network);
  const Wavefront w(blocks.plan());
  ASSERT_EQ(w.complete.size(), w.begin.size());
  EXPECT_EQ(w.complete.front(), 0);
  EXPECT_EQ(w.complete.back(), network.nodes());
  EXPECT_LE(w.lag, std::max(3L, w.pieces() / 8));
  for (long piece = 0; piece < w.pieces(); ++piece)
    for (long b = w.begin[piece]; b < w.begin[piece + 1]; ++b)
      for (int lane = 0; lane < block_springs; ++lane)
        for (const int node : {blocks.i[b], blocks.j[block_springs * b + lane]}) {
          EXPECT_GE(node, w.complete[piece]);                                // not moved before its last spring
          EXPECT_LT(node, w.complete[std::min(piece + w.lag, w.pieces())]);  // moved before its next one
        }
}

TEST(Dynamics, OfANetworkDoesNotDependOnThreads) {
  const Network network = random_network(region_of(block_mesh({14, 7, 7}, {14, 7, 7})), spacing_one());
  const MassSpringModel model{network, {Springs{}}};
  const LoadPath path = [&](double) { return pulled(network); };
  DynamicsOptions options;
  options.damping = 0.2;
  options.duration = 3;
  const DynamicsResult one = run_dynamics(model, 1, path, options);
  options.threads = 2;
  const DynamicsResult two = run_dynamics(model, 1, path, options);
  EXPECT_TRUE(one.state.displacement == two.state.displacement);
  EXPECT_EQ(one.kinetic_energy, two.kinetic_energy);
  EXPECT_NE(two.state.solver.find("2 threads"), std::string::npos) << two.state.solver;
}

}  // namespace springproof::list_forces_test
