// Solvers for the tangent: each has the tangent of its model, and solves with it.
#include "msm/statics/stiffness_solver.h"

#include <gtest/gtest.h>

#include "msm/embedding/boundary.h"
#include "msm/models.h"
#include "msm/periodic/laws_of_model.h"
#include "support/zoo.h"

namespace springproof::stiffness_solver_test {
namespace {

constexpr long all = 1000000;  // unknowns: always factored

struct Kind {
  std::string solver;  ///< its name
  MassSpringModel model;
  long direct_limit = 0;
};

void PrintTo(const Kind& kind, std::ostream* out) { *out << kind.solver; }

MassSpringModel emsm(const std::string& name, Dispersion form) {
  ModelParameters p = test::model(name);
  p.dispersion = form;
  p.homogenised = false;
  return build_embedded(p, block_mesh({5, 5, 5}, {5, 5, 5}), {1e4, 0.3, 1}).model;
}

MassSpringModel lattice(const std::string& name, const Vec3& edges) {
  return build_model(test::model(name), test::notched_block(edges), {1e4, 0.3, 1});
}

MassSpringModel cut_cells() {
  MassSpringModel model = lattice("hybmss_avg", {1, 1, 1});
  model.network = test::refined_network();
  for (Anchor& a : model.network.anchors) a.stiffness += 50 * Vec3(1, 2, 3) * Vec3(1, 2, 3).transpose();
  model.laws.push_back(Anchors{});
  return model;
}

/// The same cells with forms of their own: those of averaged springs, some softer and some stiffer.
MassSpringModel measured_cells(double nu) {
  MassSpringModel model = cut_cells();
  const AveragedSprings law = averaged_law(test::model("hybmss_avg"), {1e4, nu, 1});
  MeasuredCells measured;
  for (std::size_t c = 0; c < model.network.cells.size(); ++c)
    measured.add_form((0.5 + 0.25 * double(c % 4)) * form_of(law, model.network.cells.shape(c)));
  model.laws = {measured, Anchors{}};
  return model;
}

std::vector<Kind> kinds() {
  return {{"Cholesky", lattice("hybmss", {1, 1, 1}), all},
          {"CG + multigrid", lattice("hybmss", {1, 1, 1})},
          {"CG + multigrid", lattice("hybmss_avg", {1, 0.5, 2})},
          {"CG + multigrid", cut_cells()},
          {"CG + multigrid", measured_cells(0.3)},
          {"CG + network multigrid", emsm("emsm_random", Dispersion::symmetric)},
          {"CG + network multigrid", emsm("emsm", Dispersion::symmetric)},
          {"GMRES + CG + network multigrid of the symmetric form", emsm("emsm_random", Dispersion::published)},
          {"GMRES + Cholesky of the symmetric form", emsm("emsm", Dispersion::published), all}};
}

std::vector<char> held_at_the_left(const Network& network) {
  std::vector<char> fixed(static_cast<std::size_t>(network.X.size()), 0);
  const double left = network.X.col(0).minCoeff();
  for (int n = 0; n < network.nodes(); ++n)
    if (network.X(n, 0) < left + 1e-9) std::fill_n(fixed.begin() + 3 * n, 3, 1);
  for (const Anchor& a : network.anchors) std::fill_n(fixed.begin() + 3 * a.node, 3, 1);
  return fixed_or_carried(network, fixed);
}

Eigen::VectorXd field(const Network& network) {
  Eigen::VectorXd u = flat(test::noise(network.nodes(), 1, 3));
  for (const CarriedPoint& c : network.cells.carried) u.segment<3>(3 * c.point).setZero();
  return u;
}

class Solvers : public testing::TestWithParam<Kind> {};

TEST_P(Solvers, HaveTheTangentOfTheState) {
  const auto& [name, model, direct_limit] = GetParam();
  const Network& network = model.network;
  const auto solver = solver_for(model, held_at_the_left(network), direct_limit);
  EXPECT_EQ(solver->name(), name);
  NodalVectors strained = network.X;
  strained.col(0) *= 1.02;
  for (const NodalVectors& x : {network.X, strained}) {
    ASSERT_TRUE(solver->take(x));
    const Tangent K = tangent(model, x);
    const Eigen::VectorXd u = field(network);
    Eigen::VectorXd Ku, expected;
    solver->multiply(u, Ku);
    K.multiply(u, expected);
    EXPECT_LE((Ku - expected).norm(), 1e-12 * expected.norm());
    if (!network.anchors.empty()) continue;  // of which CutMultigrid::diagonal() has the nodes alone
    EXPECT_LE((solver->diagonal() - K.diagonal()).norm(), 1e-12 * K.diagonal().norm());
  }
}

TEST_P(Solvers, SolveOnTheFreeUnknowns) {
  const auto& [name, model, direct_limit] = GetParam();
  const std::vector<char> fixed = held_at_the_left(model.network);
  const auto solver = solver_for(model, fixed, direct_limit);
  NodalVectors strained = model.network.X;
  strained.col(0) *= 1.02;
  for (const NodalVectors& x : {model.network.X, strained}) {
    ASSERT_TRUE(solver->take(x));
    EXPECT_TRUE(solver->stable());
    Eigen::VectorXd expected = field(model.network), b, u;
    for (std::size_t i = 0; i < fixed.size(); ++i)
      if (fixed[i]) expected[static_cast<Eigen::Index>(i)] = 0;
    solver->multiply(expected, b);
    EXPECT_TRUE(solver->solve(b, 1e-11, 500, u).converged);
    EXPECT_LE((u - expected).norm(), 1e-7 * expected.norm());
  }
}

TEST(SolverFor, EliminatesTheFreeDirectionsOfAnchoredNodes) {
  const MassSpringModel model = cut_cells();
  std::vector<char> fixed = held_at_the_left(model.network);
  for (const Anchor& a : model.network.anchors) fixed[3 * a.node + 1] = 0;
  const auto solver = solver_for(model, fixed, 0);
  ASSERT_TRUE(solver->take(model.network.X));
  Eigen::VectorXd expected = field(model.network), b, u;
  for (std::size_t i = 0; i < fixed.size(); ++i)
    if (fixed[i]) expected[static_cast<Eigen::Index>(i)] = 0;
  solver->multiply(expected, b);
  const KrylovResult solve = solver->solve(b, 1e-11, 500, u);
  EXPECT_TRUE(solve.converged);
  EXPECT_LE(solve.iterations, 20);
  EXPECT_LE((u - expected).norm(), 1e-7 * expected.norm());
}

TEST(SolverFor, FactorsMeasuredCellsWhoseVolumeIsStiff) {
  for (const auto& [nu, name] : {std::pair{0.45, "CG + multigrid"}, std::pair{0.499, "Cholesky"}}) {
    const MassSpringModel model = measured_cells(nu);
    EXPECT_EQ(solver_for(model, held_at_the_left(model.network), 0)->name(), name) << nu;
  }
}

INSTANTIATE_TEST_SUITE_P(Kinds, Solvers, testing::ValuesIn(kinds()));

}  // namespace
}  // namespace springproof::stiffness_solver_test
