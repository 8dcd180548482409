// The kernels for lists of cells against the plain loops of the laws.
#include "msm/kernels/cell_forces.h"

#include <gtest/gtest.h>

#include <cmath>

#include "msm/dynamics/dynamics.h"
#include "msm/dynamics/inertia.h"
#include "msm/dynamics/list_motion.h"
#include "msm/dynamics/plain_motion.h"
#include "msm/dynamics/time_step.h"
#include "msm/laws/capabilities.h"
#include "support/refined_cells.h"
#include "support/two_materials.h"
#include "support/zoo.h"

namespace springproof::cell_forces_test {
namespace {

constexpr double edge = 0.5, retardation = 1e-3;

/// A round bar of two cells and more across, lying anyhow in its lattice, with slivers; held at one end.
/// @param halved so many cells, and as many of their parts once more
MassSpringModel bar(const ModelParameters& parameters, double poisson_ratio = 0.3, double length = 5, int halved = 0) {
  const Mesh body =
      test::mapped(test::cylinder(length, 8, static_cast<int>(4 * length)), test::random_placement(2, edge));
  VoxelGrid grid = test::grid_about(body, edge);
  if (halved > 0) grid = test::halved_at_random(grid, 2, halved);
  return build_cut(parameters, cut_body(grid, body), {"z_min"}, Mesh{}, {1e4, poisson_ratio, 1000}).model;
}

/// The same of three materials along its axis.
MassSpringModel bar_of_three_materials(int halved) {
  const Mesh straight = test::with_materials(test::cylinder(5, 8, 20), [](const Vec3& x) {
    return x[2] < 1.75 ? 0 : x[2] < 3 ? 2 : 1;
  });
  const Mesh body = test::mapped(straight, test::random_placement(2, edge));
  VoxelGrid grid = test::grid_about(body, edge);
  if (halved > 0) grid = test::halved_at_random(grid, 2, halved);
  MassSpringModel model = build_cut(test::model("hybmss_avg"), cut_body(grid, body), {"z_min"}, Mesh{},
                                    {1e4, 0.3, 1000}, {{3e5, 0.2, 1000}, {2e3, 0.49, 1000}})
                              .model;
  EXPECT_EQ(lacks(model, Capability::cell_kernels), "its bonds turn with their cells");
  soften_bonds(model, 1000);
  return model;
}

std::vector<MassSpringModel> models() {
  std::vector<MassSpringModel> all;
  for (const double nu : {-0.5, 0.3, 0.499})
    for (const StrainCurve curve : {StrainCurve::hencky, StrainCurve::neo_hooke, StrainCurve::neo_hooke_isochoric}) {
      ModelParameters parameters = test::model("hybmss_avg");
      parameters.curve = curve;
      parameters.slender = curve == StrainCurve::neo_hooke;
      all.push_back(bar(parameters, nu));
      all.push_back(bar(parameters, nu, 5, 12));
      all.push_back({test::cut_network(), all.back().laws});  // less than a vector of cells
    }
  all.push_back({all.back().network, {*averaged_springs_of(all.back())}});  // without its anchors
  all.push_back(bar_of_three_materials(0));
  all.push_back(bar_of_three_materials(12));
  all.push_back(test::with_measured_cells(bar(test::model("hybmss_avg"))));
  all.push_back(test::with_measured_cells(bar(test::model("hybmss_avg"), 0.499)));
  const Mesh boxes = block_mesh({1.2, 1.6, 0.7}, {4, 3, 5});
  all.push_back(build_model(test::model("hybmss_avg"), boxes, {1e4, 0.3, 1000}));
  return all;
}

NodalVectors disturbed(const Network& network, double size = 0.1) {
  return network.X + test::noise(network.nodes(), size * network.cells.edge);
}

double worst(const NodalVectors& a, const NodalVectors& b) {
  return (a - b).cwiseAbs().maxCoeff() / b.cwiseAbs().maxCoeff();
}

template <class Real>
void expect_plain_forces(double tolerance) {
  for (const MassSpringModel& model : models()) {
    NodalVectors x = disturbed(model.network), v = test::noise(model.network.nodes(), 10, 2);
    carry(model.network.cells.carried, x);
    carry(model.network.cells.carried, v);
    const NodalVectors expected = forces(model, x);
    NodalVectors f, damped = expected;
    ASSERT_TRUE(expected.allFinite());
    const Viscosity viscosity = Viscosity::of(model, {1e4, 0.3, 1000}, retardation);
    const AveragedSprings& law = viscosity.cells();
    viscosity.add_forces(model.network, x, v, damped);
    ASSERT_GT(worst(damped, expected), 0.01);
    for (const InstructionSet set : usable_instruction_sets()) {
      CellForces<Real>(model, set).at(x, v, f);
      EXPECT_LE(worst(f, expected), tolerance) << name_of(set) << ", curve " << static_cast<int>(law.curve);
      CellForces<Real>(model, set, law, retardation).at(x, v, f);
      EXPECT_LE(worst(f, damped), tolerance) << name_of(set) << ", with dashpots";
    }
  }
}

}  // namespace

TEST(CellForces, DoubleIsThePlainLoop) {
  double least = 1;
  for (const FilledPart& part : bar(test::model("hybmss_avg")).network.cells.filled)
    least = std::min(least, part.fraction);
  EXPECT_LT(least, 0.02);  // slivers
  expect_plain_forces<double>(1e-12);
}

TEST(CellForces, FloatIsThePlainLoopToSinglePrecision) { expect_plain_forces<float>(1e-5); }

TEST(CellForces, OfAnInvertedCellAreNoNumbers) {
  for (const MassSpringModel& model : models()) {
    NodalVectors x = model.network.X, f;
    x.col(0) *= -1;
    CellForces<double>(model).at(x, x, f);
    EXPECT_FALSE(f.allFinite());
  }
}

TEST(CellForces, CoverAveragedSpringsWithoutShift) {
  const MassSpringModel model = bar(test::model("hybmss_avg"));
  const auto covers = [&](auto change) {
    MassSpringModel changed = model;
    change(changed, std::get<AveragedSprings>(changed.laws[0]));
    return can(changed, Capability::cell_kernels);
  };
  EXPECT_TRUE(covers([](MassSpringModel&, AveragedSprings&) {}));
  EXPECT_FALSE(covers([](MassSpringModel&, AveragedSprings& law) { law.shift = 0.4; }));
  EXPECT_FALSE(covers([](MassSpringModel&, AveragedSprings& law) { law.curve = StrainCurve::springs_hencky; }));
  EXPECT_FALSE(covers([](MassSpringModel& m, AveragedSprings& law) { m.laws.emplace_back(law); }));
  EXPECT_FALSE(covers([](MassSpringModel& m, AveragedSprings&) { m.laws.emplace_back(Springs{}); }));
  EXPECT_TRUE(covers([](MassSpringModel& m, AveragedSprings&) { m.network = test::refined_network(); }));
  const MassSpringModel springs{model.network, {Springs{}}};
  EXPECT_THROW(CellForces<double>{springs}, std::invalid_argument);
}

TEST(CellOrder, CompletesNodesALayerLater) {
  const Network network = bar(test::model("hybmss_avg"), 0.3, 60).network;
  const CellOrder order(network, 8);
  std::vector<int> seen(network.cells.size(), 0);
  for (const int cell : order.cells) ++seen[cell];
  EXPECT_TRUE(std::all_of(seen.begin(), seen.end(), [](int n) { return n == 1; }));
  const Wavefront w(order.plan);
  EXPECT_EQ(w.complete.back(), network.nodes());
  EXPECT_LE(w.lag, std::max(2L, w.pieces() / 8));
  const auto expect_between = [&](int node, long block) {
    const long piece = block / order.plan.blocks_of_piece;
    EXPECT_GE(order.place[node], w.complete[piece]);                                // not moved before its last cell
    EXPECT_LT(order.place[node], w.complete[std::min(piece + w.lag, w.pieces())]);  // moved before its next one
  };
  for (std::size_t c = 0; c < order.cells.size(); ++c)
    for (const int node : network.cells.corners[order.cells[c]]) expect_between(node, static_cast<long>(c) / 8);
  ASSERT_GT(network.anchors.size(), 3u);
  ASSERT_EQ(order.first_anchor.back(), static_cast<int>(network.anchors.size()));
  for (long block = 0; block < order.plan.blocks; ++block)
    for (int a = order.first_anchor[block]; a < order.first_anchor[block + 1]; ++a) {
      const Anchor& anchor = network.anchors[order.anchors[a]];
      expect_between(anchor.node, block);
      for (const int node : anchor.corners) expect_between(node, block);
    }
}

namespace {

/// The anchored end moves to where it is held; a load on every node, and one unknown held apart from them.
BoundaryConditions pulled(const Network& network) {
  BoundaryConditions bc;
  bc.fixed.assign(3 * network.nodes(), 0);
  bc.prescribed = NodalVectors::Zero(network.nodes(), 3);
  bc.external = test::noise(network.nodes(), 0.5, 4);
  hand_back(network.cells.carried, bc.external);
  for (const Anchor& a : network.anchors) {
    for (int d = 0; d < 3; ++d) bc.fixed[3 * a.node + d] = 1;
    bc.prescribed.row(a.node) << 0.1, 0, -0.05;
  }
  std::vector<char> own(network.nodes(), 1);
  for (const CarriedPoint& c : network.cells.carried) own[c.point] = 0;
  const Hexahedron& last = network.cells.corners.back();
  const int apart = *std::find_if(last.begin(), last.end(), [&](int n) { return own[n]; });
  bc.fixed[3 * apart + 1] = 1;
  bc.prescribed(apart, 1) = 0.02;
  return bc;
}

struct State {
  NodalVectors x, v, of_supports;
  ForceNorms norms;
};

/// The steps of run_dynamics(), written out; supports move at the end of the first.
State plain_steps(const MassSpringModel& model, const BoundaryConditions& bc, double dt, double damping, double time,
                  int steps) {
  const NodalVectors per_mass = inverse_inertia(model.network, 1000, {.time_step = dt}), zero = 0 * per_mass;
  State s{model.network.X, zero, zero, {}};
  for (; steps > 0; --steps) {
    NodalVectors f = forces(model, s.x);
    averaged_springs_of(model)->add_viscous_forces(model.network, s.x, s.v + s.of_supports, time, f);
    hand_back(model.network.cells.carried, f);
    f += bc.external;
    ForceNorms squares;
    for (Eigen::Index i = 0; i < f.size(); ++i) {
      const double force = f.data()[i];
      (bc.fixed[i] ? squares.support : squares.unbalanced) += force * force;
      if (bc.fixed[i]) {
        const double to = model.network.X.data()[i] + bc.prescribed.data()[i];
        s.of_supports.data()[i] = (to - s.x.data()[i]) / dt;
        s.x.data()[i] = to;
      } else {
        s.v.data()[i] = (s.v.data()[i] + dt * force * per_mass.data()[i]) / (1 + dt * damping);
        s.x.data()[i] += dt * s.v.data()[i];
      }
    }
    carry(model.network.cells.carried, s.x);
    carry(model.network.cells.carried, s.v);
    carry(model.network.cells.carried, s.of_supports);
    s.norms = {std::sqrt(squares.unbalanced), std::sqrt(squares.support)};
  }
  return s;
}

template <class Real>
void expect_plain_steps(double tolerance, int halved = 0) {
  const MassSpringModel model = bar(test::model("hybmss_avg"), 0.3, halved > 0 ? 10 : 60, halved);
  const Network& network = model.network;
  const BoundaryConditions bc = pulled(network);
  const double dt = 0.2 * safe_time_step(model, 1000), damping = 0.3;
  for (const double time : {0.0, 0.1 * dt}) {
    const State expected = plain_steps(model, bc, dt, damping, time, 41);
    for (const InstructionSet set : usable_instruction_sets()) {
      NodalVectors first_x, first_v;
      for (const int threads : {1, 2, 3}) {
        ListMotion<Real> motion(std::make_unique<CellForces<Real>>(model, set, *averaged_springs_of(model), time),
                                model, 1000, {.time_step = dt, .damping = damping, .threads = threads});
        motion.set_conditions(bc);
        for (const long steps : {7, 1, 2}) motion.advance(steps);
        motion.set_state(motion.positions(), motion.velocities());
        const ForceNorms norms = motion.advance(31);
        EXPECT_EQ(motion.threads(), halved > 0 ? 1 : threads);
        const NodalVectors x = motion.positions(), v = motion.velocities();
        EXPECT_LE(worst(x - network.X, expected.x - network.X), tolerance) << name_of(set) << ", " << time << " s";
        EXPECT_LE(worst(v, expected.v), tolerance) << name_of(set) << ", " << time << " s";
        EXPECT_NEAR(norms.unbalanced, expected.norms.unbalanced, 10 * tolerance * expected.norms.unbalanced);
        EXPECT_NEAR(norms.support, expected.norms.support, 10 * tolerance * expected.norms.support);
        if (threads == 1) {
          first_x = x;
          first_v = v;
        } else if (sizeof(Real) == 8) {
          EXPECT_TRUE(x == first_x && v == first_v) << threads << " threads, " << name_of(set);
        }
      }
    }
  }
}

}  // namespace

TEST(CellMotion, IsThePlainMotionOnAnyNumberOfThreads) { expect_plain_steps<double>(1e-11); }

TEST(CellMotion, OfCellsOfSeveralSizesIsThePlainMotion) { expect_plain_steps<double>(1e-11, 30); }

TEST(CellMotion, OfSinglePrecisionIsNearIt) { expect_plain_steps<float>(1e-4); }

/// Supports that move twice, a share of consistent mass, damping.
template <class Real>
void expect_plain_averages(double tolerance) {
  const MassSpringModel model = bar(test::model("hybmss_avg"), 0.3, 60);
  const Network& network = model.network;
  const MotionOptions options = {.time_step = 0.2 * safe_time_step(model, 1000, false, 0.6),
                                 .damping = 0.3,
                                 .mass_consistency = 0.6,
                                 .threads = 2};
  const BoundaryConditions bc = pulled(network);
  BoundaryConditions further = bc;
  further.prescribed *= 1.3;
  PlainMotion plain(model, 1000, options);
  plain.set_conditions(bc);
  plain.advance(9);
  plain.set_conditions(further);
  plain.advance(20);
  for (const InstructionSet set : usable_instruction_sets()) {
    ListMotion<Real> motion(std::make_unique<CellForces<Real>>(model, set), model, 1000, options);
    motion.set_conditions(bc);
    for (const long steps : {7, 2}) motion.advance(steps);
    motion.set_conditions(further);
    motion.set_state(motion.positions(), motion.velocities());
    motion.advance(20);
    EXPECT_EQ(motion.threads(), 1);
    EXPECT_LE(worst(motion.positions() - network.X, plain.positions() - network.X), tolerance) << name_of(set);
    EXPECT_LE(worst(motion.velocities(), plain.velocities()), tolerance) << name_of(set);
  }
}

TEST(CellMotion, OfAveragedMassIsThePlainMotion) {
  expect_plain_averages<double>(1e-11);
  expect_plain_averages<float>(1e-4);
}

TEST(CellMotion, IsChosenWhereTheKernelsHaveTheModel) {
  const auto how = [](const MassSpringModel& model, MotionOptions options) {
    options.time_step = 1e-6;
    return make_motion(model, 1000, options)->description();
  };
  const ModelParameters averaged = test::model("hybmss_avg");
  MassSpringModel model = bar(averaged);
  const std::string kernel = "cell kernel, FP64, " + name_of(instruction_set()) + ", 1 thread";
  EXPECT_EQ(how(model, {}), kernel);
  MotionOptions options;
  options.viscosity = Viscosity::of(model, {1e4, 0.3, 1000}, retardation);
  EXPECT_EQ(how(model, options), kernel);
  options.precision = Precision::float32;
  EXPECT_NE(how(model, options).find("cell kernel, FP32"), std::string::npos);
  options.mass_consistency = 0.5;
  EXPECT_EQ(how(model, options), "plain loops") << "dashpots take averaged velocities";
  options.viscosity = {};
  EXPECT_NE(how(model, options).find("cell kernel, FP32"), std::string::npos);
  EXPECT_NE(how(build_model(averaged, test::notched_block(), {1e4, 0.3, 1000}), {}).find("lattice kernel"),
            std::string::npos);
  std::get<AveragedSprings>(model.laws[0]).shift = 0.4;
  EXPECT_EQ(how(model, {}), "plain loops");
}

}  // namespace springproof::cell_forces_test
