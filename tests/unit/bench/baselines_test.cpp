// A baseline that computes something else would be no baseline.
#include <gtest/gtest.h>

#include "comparisons/bench/baselines.h"
#include "comparisons/bench/bodies.h"
#include "comparisons/bench/interrupt.h"
#include "comparisons/bench/machine.h"
#include "msm/statics/equilibrium.h"

#include <nlohmann/json.hpp>

namespace springproof::bench::baselines_test {
namespace {

TEST(PlainLoop, MovesAsTheForcesSay) {
  const MassSpringModel model = lattice("hybmss_cf", {4, 3, 5}, 0.25);
  const NodalVectors x = moved(model.network), f = forces(model, x);
  const Eigen::VectorXd mass = masses(model.network, density);
  const double dt = 1e-4;
  for (const InstructionSet set : usable_instruction_sets()) {
    std::vector<PlainNode> nodes;
    std::vector<PlainSpring> springs;
    std::vector<double> dt_over_mass;
    for (Eigen::Index i = 0; i < x.rows(); ++i) {
      nodes.push_back({{x(i, 0), x(i, 1), x(i, 2)}, {}, {}});
      dt_over_mass.push_back(dt / mass[i]);
    }
    for (const Spring& s : model.network.springs) springs.push_back({s.i, s.j, s.stiffness, s.rest_length});
    kernels_of(set).plain_step(nodes.data(), long(nodes.size()), springs.data(), long(springs.size()),
                               dt_over_mass.data(), dt);
    double off = 0, largest = 0;
    for (Eigen::Index i = 0; i < x.rows(); ++i)
      for (int c = 0; c < 3; ++c) {
        const double v = dt / mass[i] * f(i, c);
        off = std::max({off, std::abs(nodes[i].v[c] - v), std::abs(nodes[i].x[c] - (x(i, c) + dt * v)) / dt});
        largest = std::max(largest, std::abs(v));
        EXPECT_EQ(nodes[i].f[c], 0);
      }
    EXPECT_LT(off, 1e-10 * largest) << name_of(set);
  }
}

TEST(Lammps, HasOurForces) {
  if (!Lammps::available()) GTEST_SKIP() << "lmp is not installed (apt-get install lammps)";
  for (const MassSpringModel& model : {lattice("hybmss_cf", {4, 3, 5}, 0.25), random_springs(300)}) {
    const NodalVectors ours = forces({model.network, {Springs{}}, false}, moved(model.network));
    EXPECT_LT((Lammps(model.network).forces() - ours).cwiseAbs().maxCoeff(), 1e-10 * ours.cwiseAbs().maxCoeff());
  }
}

TEST(Lammps, TakesLongerForMoreSprings) {
  if (!Lammps::available()) GTEST_SKIP() << "lmp is not installed (apt-get install lammps)";
  const auto seconds = [](int n) {
    return Lammps(lattice("hybmss_cf", {n, n, n}, 0.25).network).seconds_per_step(0.2, 3);
  };
  const double ratio = seconds(16) / seconds(8);  // of springs: 7.6
  EXPECT_GT(ratio, 4);
  EXPECT_LT(ratio, 16);
}

TEST(Gamg, FindsOurEquilibrium) {
  if (!has_gamg()) GTEST_SKIP() << "no PETSc";
  const MassSpringModel model = lattice("hybmss", {6, 5, 4}, 0.3);
  const BoundaryConditions conditions = clamped_bottom(model.network);
  const auto answer = in_child([&] {
    const Equilibrium ours = solve_linear(model, conditions);
    const GamgResult gamg = solve_gamg(model, conditions, 1e-10, ours.displacement);
    return nlohmann::json{
        {"converged", gamg.converged}, {"iterations", gamg.iterations}, {"difference", gamg.difference}};
  });
  EXPECT_TRUE(answer.at("converged"));
  EXPECT_GT(answer.at("iterations"), 1);
  EXPECT_LT(answer.at("difference"), 1e-7);
}

TEST(Relaxation, RestsAndNoOtherDampingIsFaster) {
  const MassSpringModel model = lattice("hybmss_cf", {4, 4, 4}, 0.25);
  const BoundaryConditions conditions = clamped_bottom(model.network);
  const DynamicsResult best = relax(model, conditions, 1e-8);
  ASSERT_TRUE(best.state.ok) << best.state.message;
  for (const double factor : {0.6, 1.6}) {
    EXPECT_GT(relax(model, conditions, 1e-8, factor).steps, best.steps) << factor;
  }
}

}  // namespace
}  // namespace springproof::bench::baselines_test
