// Observed orders of the springs on manufactured motions: large strain at rest, and in time.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "meshes/mesher/mesher.h"
#include "msm/dynamics/dynamics.h"
#include "msm/embedding/cut_lattice.h"
#include "msm/statics/equilibrium.h"
#include "support/manufactured.h"
#include "support/solids.h"
#include "support/zoo.h"

namespace springproof::msm_manufactured_test {
namespace {

using test::ClosedMotion;
using test::PiolaStress;

enum class Cells { cubes, boxes, cut };
const char* name_of(Cells cells) {
  return cells == Cells::cubes ? "cubes" : cells == Cells::boxes ? "boxes" : "cut cells";
}

/// The law that a curve of the springs stands for.
PiolaStress law_of(StrainCurve curve, const IsotropicMaterial& m) {
  return curve == StrainCurve::neo_hooke ? test::neo_hookean(m) : test::hencky(m);
}

/// A unit cube of averaged springs, n cells along it; in cut cells it lies askew in the lattice.
struct SpringCube {
  EmbeddedModel built;
  CutBody cut;
  Eigen::VectorXd volumes;                             ///< that a body force acts on
  Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();  ///< of the cube in the lattice
  std::vector<char> held;                              ///< nodes on the surface

  SpringCube(Cells cells, int n, const IsotropicMaterial& material, StrainCurve curve = StrainCurve::neo_hooke) {
    ModelParameters p = test::model("hybmss_avg");
    p.curve = curve;
    const int up = cells == Cells::boxes ? n / 2 : n;
    const Mesh block = block_mesh({1, 1, 1}, {n, n, up});
    if (cells == Cells::cut) {
      turn = test::random_placement(3, 0.1).turn;
      const Mesh body = test::mapped(test::solid_of(block_mesh({1, 1, 1}, {2, 2, 2})),
                                     [&](const Vec3& X) -> Vec3 { return turn * X; });
      cut = cut_body(test::grid_about(body, 1. / n), body);
      built = build_cut(p, cut, {"surface"}, Mesh{}, material);
      volumes = built.embedding.volumes;
    } else {
      built.model = build_model(p, block, material);
      volumes = built.model.network.volume;
    }
    held.assign(network().nodes(), 0);
    for (int i = 0; i < network().nodes(); ++i)
      held[i] = cells == Cells::cut ? i >= cut.points.rows() : on_surface(rest(i));
  }

  const Network& network() const { return built.model.network; }
  /// In the cube's own axes.
  Vec3 rest(int node) const { return turn.transpose() * network().X.row(node).transpose(); }
  static bool on_surface(const Vec3& X) { return X.minCoeff() < 1e-9 || X.maxCoeff() > 1 - 1e-9; }
  Vec3 displacement(const ClosedMotion& x, const Vec3& X, double t) const { return turn * (x(X, t) - X); }

  BoundaryConditions conditions(const ClosedMotion& x, const PiolaStress& P, double density, double t) const {
    const int n = network().nodes();
    BoundaryConditions bc{std::vector<char>(3 * n, 0), std::vector<int>(3 * n, -1), NodalVectors::Zero(n, 3),
                          NodalVectors::Zero(n, 3)};
    for (int i = 0; i < n; ++i) {
      if (held[i]) {
        std::fill_n(bc.fixed.begin() + 3 * i, 3, 1);
        std::fill_n(bc.owner.begin() + 3 * i, 3, 0);
        bc.prescribed.row(i) = displacement(x, rest(i), t).transpose();
      }
      if (volumes[i] != 0)
        bc.external.row(i) = volumes[i] * (turn * test::body_force(x, P, density, rest(i), t)).transpose();
    }
    return bc;
  }

  /// Root mean square of the error over the nodes, or over points inside of a cut body.
  double error(const ClosedMotion& x, const NodalVectors& u, double t) const {
    std::vector<Vec3> points;
    NodalVectors found = u;
    if (cut.cells.empty()) {
      for (int i = 0; i < network().nodes(); ++i) points.push_back(rest(i));
    } else {
      NodalVectors at(1000, 3);
      for (int i = 0; i < 1000; ++i) {
        points.push_back(0.05 * Vec3::Ones() + 0.1 * Vec3(i % 10, i / 10 % 10, i / 100));
        at.row(i) = (turn * points.back()).transpose();
      }
      found = displacement_at(cut, u, at);
    }
    double off = 0, all = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Vec3 exact = displacement(x, points[i], t);
      off += (found.row(static_cast<Eigen::Index>(i)).transpose() - exact).squaredNorm();
      all += exact.squaredNorm();
    }
    return std::sqrt(off / all);
  }
};

double error_at_rest(Cells cells, int n, const IsotropicMaterial& m, StrainCurve curve, const ClosedMotion& x) {
  const SpringCube cube(cells, n, m, curve);
  const BoundaryConditions whole = cube.conditions(x, law_of(curve, m), 0, 0);
  const Equilibrium e = solve_finite(cube.built.model, [&](double factor) {
    BoundaryConditions part = whole;
    part.prescribed *= factor;
    part.external *= factor;
    return part;
  });
  EXPECT_TRUE(e.ok) << e.message;
  return cube.error(x, e.displacement, 0);
}

struct AtRest {
  const char* motion;
  ClosedMotion x;
  Cells cells;
  double poisson_ratio, order;
  StrainCurve curve = StrainCurve::neo_hooke;
};
const char* law_name(StrainCurve curve) { return curve == StrainCurve::neo_hooke ? "neo-Hooke" : "Hencky"; }
void PrintTo(const AtRest& row, std::ostream* out) {
  *out << fmt::format("{}, {}, {}, nu = {}", row.motion, law_name(row.curve), name_of(row.cells), row.poisson_ratio);
}
class ManufacturedAtRest : public testing::TestWithParam<AtRest> {};

TEST_P(ManufacturedAtRest, HasItsOrder) {
  const AtRest& row = GetParam();
  const IsotropicMaterial m{1, row.poisson_ratio, 1};
  const double coarse = error_at_rest(row.cells, 6, m, row.curve, row.x),
               fine = error_at_rest(row.cells, 12, m, row.curve, row.x);
  const double order = test::recorded_order(
      fmt::format("`hybmss_avg`, {}, {}", law_name(row.curve), name_of(row.cells)),
      fmt::format("{}, ν = {:g}", row.motion, row.poisson_ratio), row.cells == Cells::cut ? 1 : 2, coarse, fine);
  EXPECT_GE(order, row.order) << coarse << " -> " << fine;
  EXPECT_LE(fine, 0.08);
}

// Anchors give way by a thirtieth of a cell, which is of order 1.  Beyond half of these strains slivers of cut cells
// are unstable under such body forces.
std::vector<AtRest> rows_at_rest() {
  std::vector<AtRest> rows;
  for (const Cells cells : {Cells::cubes, Cells::boxes, Cells::cut}) {
    const double part = cells == Cells::cut ? 0.4 : 1, order = cells == Cells::cut ? 1.3 : 1.8;
    const ClosedMotion bulge = test::bulge([part](double) { return part; }), twist = test::twist(0.8 * part);
    rows.push_back({"bulge", bulge, cells, 0.3, order});
    rows.push_back({"twist", twist, cells, 0.3, order});
    rows.push_back({"twist", twist, cells, cells == Cells::cut ? 0.45 : 0.499, order});
    rows.push_back({"bent", test::bent(0.6 * part), cells, 0, order});
    rows.push_back({"bulge", bulge, cells, 0.3, order, StrainCurve::hencky});
  }
  return rows;
}
INSTANTIATE_TEST_SUITE_P(Springs, ManufacturedAtRest, testing::ValuesIn(rows_at_rest()));

double error_in_motion(int n, int steps, Integrator integrator, const ClosedMotion& x) {
  const IsotropicMaterial m{1, 0.3, 1};
  const SpringCube cube(Cells::cubes, n, m);
  const PiolaStress P = test::neo_hookean(m);
  constexpr double duration = 1;
  DynamicsOptions options;
  options.integrator = integrator;
  options.duration = duration;
  options.course.ramp = duration;  // so that the factor is the time
  options.time_step = duration / steps;
  options.velocity = NodalVectors::Zero(cube.network().nodes(), 3);
  for (int i = 0; i < cube.network().nodes(); ++i)
    options.velocity.row(i) =
        test::derivative([&](double s) { return Vec3(cube.displacement(x, cube.rest(i), s)); }).transpose();
  const DynamicsResult r = run_dynamics(
      cube.built.model, m.density, [&](double factor) { return cube.conditions(x, P, m.density, factor * duration); },
      options);
  EXPECT_TRUE(r.state.ok) << r.state.message;
  return cube.error(x, r.state.displacement, r.time);
}

struct InMotion {
  const char* motion;
  ClosedMotion x;
  Integrator integrator;
  int steps;       ///< of the coarser run, of four cells
  int fine_cells;  ///< of the finer one, of twice the steps: where F is uniform cells have no error
  double order;
};
void PrintTo(const InMotion& row, std::ostream* out) {
  *out << fmt::format("{}, {}", row.motion, name_of(row.integrator));
}
class ManufacturedInMotion : public testing::TestWithParam<InMotion> {};

TEST_P(ManufacturedInMotion, HasTheOrderOfItsSteps) {
  const InMotion& row = GetParam();
  const double coarse = error_in_motion(4, row.steps, row.integrator, row.x),
               fine = error_in_motion(row.fine_cells, 2 * row.steps, row.integrator, row.x),
               order = test::recorded_order(fmt::format("`hybmss_avg`, {}", name_of(row.integrator)), row.motion,
                                            row.integrator == Integrator::implicit_euler ? 1 : 2, coarse, fine);
  EXPECT_GE(order, row.order) << coarse << " -> " << fine;
  EXPECT_LE(fine, 0.12);
}

std::vector<InMotion> rows_in_motion() {
  const ClosedMotion pulse = test::bulge([](double t) { return (1 - std::cos(3 * t)) / 2; }), spin = test::spin(0.25);
  return {{"bulge", pulse, Integrator::explicit_euler, 20, 8, 1.8},
          {"bulge", pulse, Integrator::energy_momentum, 8, 8, 1.8},
          {"bulge", pulse, Integrator::implicit_euler, 8, 8, 0.8},
          {"spin", spin, Integrator::explicit_euler, 20, 4, 1.9},
          {"spin", spin, Integrator::energy_momentum, 8, 4, 1.9},
          {"spin", spin, Integrator::implicit_euler, 40, 4, 0.9}};
}
INSTANTIATE_TEST_SUITE_P(Springs, ManufacturedInMotion, testing::ValuesIn(rows_in_motion()));

/// Springs of small strains: lattices, and networks of about n^3 nodes.
double linear_error(const std::string& name, int n, const IsotropicMaterial& m, const ClosedMotion& x, unsigned seed) {
  ModelParameters p = test::model(name);
  p.random.seed = seed;
  const Mesh mesh =
      passes_patch_test(p.row)
          ? mesh_body({.file = find_geo({"bar.geo", {}, {}, {}}, "case.toml"), .size = {1, 1, 1}, .edge = 1. / n}).mesh
          : block_mesh({1, 1, 1}, {n, n, n});
  const MassSpringModel model = build_model(p, mesh, m);
  const NodalVectors& X = model.network.X;
  BoundaryConditions bc{std::vector<char>(X.size(), 0), std::vector<int>(X.size(), -1), 0 * X, 0 * X};
  NodalVectors exact = X;
  for (int i = 0; i < model.network.nodes(); ++i) {
    const Vec3 at = X.row(i);
    exact.row(i) = (x(at, 0) - at).transpose();
    bc.external.row(i) = model.network.volume[i] * test::body_force(x, test::linear_elastic(m), 0, at, 0).transpose();
    if (!SpringCube::on_surface(at)) continue;
    std::fill_n(bc.fixed.begin() + 3 * i, 3, 1);
    std::fill_n(bc.owner.begin() + 3 * i, 3, 0);
    bc.prescribed.row(i) = exact.row(i);
  }
  const Equilibrium e = solve_linear(model, bc);
  EXPECT_TRUE(e.ok) << e.message;
  return (e.displacement - exact).norm() / exact.norm();
}

struct SmallStrain {
  const char* model;
  double poisson_ratio;
  double expected, order;  ///< of theory (0: none), and at least
};
void PrintTo(const SmallStrain& row, std::ostream* out) {
  *out << fmt::format("{}, nu = {}", row.model, row.poisson_ratio);
}
class ManufacturedAtSmallStrain : public testing::TestWithParam<SmallStrain> {};

TEST_P(ManufacturedAtSmallStrain, HasItsOrder) {
  const SmallStrain& row = GetParam();
  const IsotropicMaterial m{1, row.poisson_ratio, 1};
  const ClosedMotion bulge = test::bulge([](double) { return 1; });
  double coarse = 0, fine = 0;
  const int networks = row.expected > 0 ? 1 : 3;
  for (int seed = 1; seed <= networks; ++seed) {
    coarse += linear_error(row.model, 6, m, bulge, seed) / networks;
    fine += linear_error(row.model, 12, m, bulge, seed) / networks;
  }
  const double order =
      test::recorded_order(fmt::format("`{}`", row.model),
                           fmt::format("bulge, small strain, ν = {:g}", row.poisson_ratio), row.expected, coarse, fine);
  EXPECT_GE(order, row.order) << coarse << " -> " << fine;
}

INSTANTIATE_TEST_SUITE_P(Springs, ManufacturedAtSmallStrain,
                         testing::Values(SmallStrain{"msm_18", 0.25, 2, 1.8}, SmallStrain{"hybmss", 0.3, 2, 1.8},
                                         SmallStrain{"hybmss_bt", 0.3, 2, 1.8}, SmallStrain{"hybmss_bt", 0.499, 2, 1.5},
                                         SmallStrain{"emsm", 0.3, 2, 1.8}, SmallStrain{"msm_random", 0.25, 0, 0.5},
                                         SmallStrain{"emsm_random", 0.3, 0, 0.5},
                                         SmallStrain{"emsm_patch", 0.3, 2, 1.5}));

TEST(ManufacturedMotions, NeedNoForceWhereTheirStressIsUniform) {
  const IsotropicMaterial m{1, 0.3, 1};
  for (const PiolaStress& P : {test::neo_hookean(m), test::hencky(m)}) {
    EXPECT_LE(test::body_force(test::spin(0.25), P, 0, {0.3, 0.2, 0.7}, 0.4).norm(), 1e-9);
    EXPECT_GE(test::body_force(test::spin(0.25), P, 1, {0.3, 0.2, 0.7}, 0.4).norm(), 0.1);
  }
}

}  // namespace
}  // namespace springproof::msm_manufactured_test
