// Three grids of one element: limits, errors against an exact field, observed orders.
#include "comparisons/reference/reference_grids.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>

#include "comparisons/run/prepare.h"
#include "fem_reference/exchange/reference.h"
#include "problem/exact_field.h"
#include "problem/processes/child.h"

namespace springproof::reference_grids_test {
namespace {

PreparedCase prepared_block(const std::string& exact) {
  PreparedCase prepared;
  Experiment& e = prepared.experiment;
  e.name = "plate";
  e.materials = {{1e4, 0.25, 1000}};
  e.exact = exact;
  e.measures = {"displacement_error", "displacement_error_order", "probe", "stress"};
  e.probes = {{"D", {1, 1, 1}}};
  prepared.body.size = Vec3::Ones();
  add_lattice({{3, 3, 3}, std::make_shared<Mesh>(block_mesh({1, 1, 1}, {3, 3, 3}))}, prepared);
  prepared.reference_cells = {16, 16, 16};
  return prepared;
}

/// The trigonometric field with an error of h^order, and a stress that tends to -1 Pa.
ElementGrids grids_of_order(const PreparedCase& prepared, double order) {
  ElementGrids e{"p1", {}};
  const NodalVectors& nodes = prepared.lattices.front().mesh->nodes;
  for (int n : {4, 8, 16}) {
    fem::Solution s;
    s.ok = true;
    s.grid.cells = {n, n, n};
    s.grid.element = "p1";
    s.displacement = NodalVectors(nodes.rows() + 1, 3);
    const double h = std::pow(1.0 / n, order);
    for (Eigen::Index i = 0; i <= nodes.rows(); ++i) {
      const Vec3 X = i < nodes.rows() ? Vec3(nodes.row(i)) : Vec3(1, 1, 1);
      s.displacement.row(i) = (exact_displacement("trigonometric", X) + h * Vec3(1, 2, 3)).transpose();
    }
    s.stress = fem::Stresses::Zero(1, 6);
    s.stress(0, 1) = -1 + h;
    e.grids.push_back(s);
  }
  return e;
}

const ReferenceRecord& find(const std::vector<ReferenceRecord>& records, const std::string& measure) {
  for (const ReferenceRecord& r : records)
    if (r.measure == measure) return r;
  throw std::out_of_range(measure);
}

TEST(ReferenceGrids, OrderAgainstTheExactField) {
  const PreparedCase prepared = prepared_block("trigonometric");
  for (const double order : {1.0, 2.0, 3.0}) {
    const auto records = records_of(prepared, prepared.experiment.materials[0], grids_of_order(prepared, order));
    const ReferenceRecord& error = find(records, "displacement_error");
    EXPECT_EQ(error.element, "p1");
    ASSERT_EQ(error.values.size(), 3u);
    ASSERT_EQ(error.cells.size(), 3u);
    EXPECT_NEAR(error.observed_order.value(), order, 1e-9);
    EXPECT_EQ(error.value, error.values[2]);
    EXPECT_NEAR(find(records, "displacement_error_order").value, order, 1e-9);
  }
}

TEST(ReferenceGrids, StressesOfTheProbesHaveLimits) {
  const PreparedCase prepared = prepared_block("");
  const auto records = records_of(prepared, prepared.experiment.materials[0], grids_of_order(prepared, 2));
  const ReferenceRecord& stress = find(records, "stress.D.yy");
  EXPECT_EQ(stress.unit, "Pa");
  EXPECT_NEAR(stress.value, -1, 1e-12);
  EXPECT_THROW(find(records, "displacement_error_order"), std::out_of_range);
}

/// The only probe lies where there is no stress, as on the middle of a bent bar.
TEST(ReferenceGrids, StressesThatVanishAreRoundOffOfTheStrainsStress) {
  const PreparedCase prepared = prepared_block("");
  ElementGrids grids = grids_of_order(prepared, 2);
  double noise = 1e-6;
  for (fem::Solution& s : grids.grids) s.stress << fem::Stresses::Constant(1, 6, noise *= -1.5);
  const auto limits = limits_of(prepared, grids);
  for (const char* component : {"xx", "yy", "xy"}) {
    const ReferenceValue& stress = limits.at(std::string("stress.D.") + component);
    EXPECT_EQ(stress.sequence, Sequence::equal) << component << ' ' << stress.note;
    EXPECT_FALSE(stress.matters) << component;
  }
}

TEST(ReferenceGrids, SmoothnessIsTheCasesWord) {
  PreparedCase prepared = prepared_block("");
  const auto uncertainty = [&](const std::string& measure) {
    return find(records_of(prepared, prepared.experiment.materials[0], grids_of_order(prepared, 2)), measure)
        .uncertainty;
  };
  const double u = uncertainty("displacement.D.x"), stress = uncertainty("stress.D.yy");
  prepared.experiment.reference.smooth = true;
  EXPECT_NEAR(uncertainty("displacement.D.x"), u, 1e-9 * u);  // P1: order 2 either way
  // But order 1 for stresses: half the first difference, four times the last.  Round-off of the strain's stress, of
  // largest displacement over the cube's diagonal, stands beside both.
  const double largest = grids_of_order(prepared, 2).grids[2].displacement.rowwise().norm().maxCoeff();
  const double noise = solver_noise * 1e4 * largest / std::sqrt(3);
  EXPECT_NEAR(uncertainty("stress.D.yy"), 6 * (stress - noise) + noise, 1e-6 * stress);
}

TEST(ReferenceGrids, RowsStandBesideWhatIsExpectedOfTheElement) {
  PreparedCase prepared = prepared_block("trigonometric");
  prepared.experiment.models.clear();
  prepared.experiment.reference.elements = {"p1"};
  prepared.experiment.expectations = {{"fem", 0.25, {}, "stress.D.yy", Source::analytic, -1.0, 0.1, false, {}, "", {}}};
  const auto rows =
      rows_of(prepared, records_of(prepared, prepared.experiment.materials[0], grids_of_order(prepared, 2)));
  int stresses = 0;
  for (const Row& row : rows) {
    EXPECT_EQ(row.model, "fem_p1");
    EXPECT_TRUE(std::isfinite(row.value)) << row.measure;
    if (row.measure == "stress.D.xx") {
      EXPECT_FALSE(row.reference);
    }
    if (row.measure == "displacement_error") {
      EXPECT_EQ(row.error, row.value);
    }
    if (row.measure != "stress.D.yy") continue;
    ++stresses;
    EXPECT_EQ(row.reference, -1.0);
    EXPECT_NEAR(row.error.value(), std::pow(1.0 / row.cells[0], 2), 1e-12);
  }
  EXPECT_EQ(stresses, 3);
}

/// A bar of silicone under its own weight, nu = 0.499: three grids whose coarsest has one cell across had no order.
TEST(ReferenceGrids, NearOneHalfTheCoarsestGridHasTwoCellsAcross) {
  const auto cells = [](const std::string& nu) {
    return reference_cells(parse_experiment(fmt::format(R"(kinematics = "hencky"
[body]
geo = "block.geo"
size_m = [0.2, 0.03, 0.03]
cells = [10, 2, 2]
[material]
youngs_modulus_Pa = 1e5
poisson_ratio = {}
[[load]]
on = "x_min"
displacement_m = [0, 0, 0]
[compare]
models = ["hybmss"]
)",
                                                        nu),
                                            "bar.toml"));
  };
  EXPECT_EQ(cells("[0.3, 0.499]"), (Cells{36, 8, 8}));
  EXPECT_EQ(cells("0.3"), (Cells{36, 4, 4}));
  EXPECT_EQ(divisible_cells({1, 1, 1}, 4096, 8), (Cells{16, 16, 16}));
}

ElementGrids grids_with(const std::vector<Cells>& cells) {
  ElementGrids e{"q2", {}};
  for (const Cells& c : cells) e.grids.emplace_back().grid.cells = c;
  return e;
}

TEST(ReferenceGrids, RatiosAreThoseOfTheNumbersOfCells) {
  const auto near = [](const GridRatios& r, double coarse, double fine) {
    EXPECT_NEAR(r.coarse, coarse, 1e-12);
    EXPECT_NEAR(r.fine, fine, 1e-12);
  };
  near(ratios_of(grids_with({{4, 4, 4}, {8, 8, 8}, {16, 16, 16}})), 2, 2);
  near(ratios_of(grids_with({{12, 6, 1}, {24, 12, 1}, {48, 24, 1}})), 2, 2);  // plane strain
  near(ratios_of(grids_with({{3, 1, 1}, {6, 1, 1}, {12, 1, 1}})), 2, 2);
  near(ratios_of(grids_with({{1, 1, 1}, {1, 1, 1}, {1, 1, 1}})), 1, 1);
  near(ratios_of(grids_with({{1000, 0, 0}, {8000, 0, 0}, {27000, 0, 0}})), 2, 1.5);
  near(ratios_of(grids_with({{4132, 0, 0}, {3719, 0, 0}, {3837, 0, 0}})), std::cbrt(3719 / 4132.0),
       std::cbrt(3837 / 3719.0));
}

/// A cube between rough plates, St. Venant-Kirchhoff's law, which softens in compression.
PreparedCase squeezed_cube(const std::string& elements, double shortening) {
  return prepare(parse_experiment(fmt::format(R"(
kinematics = "st_venant_kirchhoff"
[body]
geo = "block.geo"
size_m = [1, 1, 1]
cells = [2, 2, 2]
[material]
youngs_modulus_Pa = 1e4
poisson_ratio = 0.3
[[load]]
on = "z_min"
displacement_m = [0, 0, 0]
[[load]]
on = "z_max"
displacement_m = [0, 0, -{}]
[compare]
models = []
measures = ["volume_change"]
[reference]
cells = [8, 8, 8]
elements = [{}]
)",
                                              shortening, elements),
                                  "cube.toml"));
}

bool on_grids_of(const ElementGrids& e, double grading) {
  return std::all_of(e.grids.begin(), e.grids.end(), [&](const fem::Solution& s) { return s.grid.grading == grading; });
}

TEST(ReferenceGrids, WhatFailsOnGradedGridsIsSolvedOnUniformOnes) {
  if (!fem::available()) GTEST_SKIP() << "no springproof-fem";
  const PreparedCase prepared = squeezed_cube("\"q2\"", 0.2);
  const ReferenceGrids grids = solve_grids(prepared, prepared.experiment.materials[0]);
  ASSERT_EQ(grids.elements.size(), 1u) << grids.failure;
  const ElementGrids& q2 = grids.elements[0];
  ASSERT_TRUE(complete(q2)) << q2.grids[2].message;
  EXPECT_TRUE(on_grids_of(q2, 1));
  EXPECT_TRUE(q2.note.starts_with("uniform grids: the graded grid of ")) << q2.note;
  for (const ReferenceRecord& r : records_of(prepared, prepared.experiment.materials[0], q2))
    EXPECT_NE(r.note.find(q2.note), std::string::npos) << r.note;
}

/// A torque that vanishes is the largest of its kind, and says nothing about the body.
TEST(ReferenceGrids, RoundOffOfATorqueDoesNotMatter) {
  if (!fem::available()) GTEST_SKIP() << "no springproof-fem";
  const PreparedCase prepared = squeezed_cube("\"q2\"", 0.01);
  const ReferenceGrids grids = solve_grids(prepared, prepared.experiment.materials[0]);
  ASSERT_EQ(grids.elements.size(), 1u) << grids.failure;
  const auto limits = limits_of(prepared, grids.elements[0]);
  EXPECT_TRUE(limits.at("force.z_max.z").matters);
  EXPECT_FALSE(limits.at("force.z_max.x").matters);
  EXPECT_FALSE(limits.at("torque.z_max.z").matters);
}

/// Beside the load they are nothing, and they alone would say that nothing converges.
TEST(ReferenceGrids, ReactionsThatVanishByEquilibriumAreRoundOffOfTheLoad) {
  if (!fem::available()) GTEST_SKIP() << "no springproof-fem";
  const PreparedCase prepared = prepare(parse_experiment(R"(
[body]
geo = "block.geo"
size_m = [1, 1, 1]
cells = [2, 2, 2]
[material]
youngs_modulus_Pa = 1e4
poisson_ratio = 0.3
[[load]]
on = "z_min"
displacement_m = [0, 0, 0]
[[load]]
on = ["x_min", "x_max", "y_min", "y_max", "z_min", "z_max"]
pressure_Pa = 10
[compare]
models = []
measures = ["reaction"]
[reference]
cells = [8, 8, 8]
elements = ["q2"]
)",
                                                         "pressed.toml"));
  const ReferenceGrids grids = solve_grids(prepared, prepared.experiment.materials[0]);
  ASSERT_EQ(grids.elements.size(), 1u) << grids.failure;
  const auto limits = limits_of(prepared, grids.elements[0]);
  for (const char* measure : {"force.z_min.x", "force.z_min.z", "force.z_min.magnitude", "torque.z_min.z"}) {
    const ReferenceValue& limit = limits.at(measure);
    EXPECT_LT(std::abs(limit.value), 1e-6) << measure;
    EXPECT_FALSE(limit.matters) << measure << " " << limit.value << " " << limit.note;
    EXPECT_EQ(limit.sequence, Sequence::equal) << measure << " " << limit.value << " " << limit.note;
  }
  EXPECT_EQ(doubt_of(limits), 0);
}

TEST(ReferenceGrids, WhatFailsOnUniformGridsTooSaysBoth) {
  if (!fem::available()) GTEST_SKIP() << "no springproof-fem";
  const PreparedCase prepared = squeezed_cube("\"q2\"", 0.6);
  const ReferenceGrids grids = solve_grids(prepared, prepared.experiment.materials[0]);
  ASSERT_EQ(grids.elements.size(), 1u) << grids.failure;
  EXPECT_FALSE(complete(grids.elements[0]));
  const auto& all = grids.elements[0].grids;
  const auto failed = std::find_if(all.begin(), all.end(), [](const fem::Solution& s) { return !s.ok; });
  ASSERT_NE(failed, all.end());
  EXPECT_TRUE(failed->message.starts_with("on a uniform grid ")) << failed->message;
  EXPECT_NE(failed->message.find("; the graded grid of "), std::string::npos) << failed->message;
}

/// The elements' program, ended by a signal if it is asked for one of these.
class DyingProgram {
 public:
  explicit DyingProgram(const std::string& element) {
    std::ofstream(script_) << "#!/bin/sh\ngrep -aq gelementb" << element << " \"$2\" && kill -9 $$\nexec "
                           << SPRINGPROOF_BINARY_DIR << "/springproof-fem \"$@\"\n";
    std::filesystem::permissions(script_, std::filesystem::perms::owner_all);
    setenv("SPRINGPROOF_FEM_PROGRAM", script_.c_str(), 1);
  }
  ~DyingProgram() { unsetenv("SPRINGPROOF_FEM_PROGRAM"); }

 private:
  TemporaryFolder folder_;
  std::filesystem::path script_ = folder_.path / "springproof-fem";
};

TEST(ReferenceGrids, AnElementThatTheProgramDiesOfDiesAlone) {
  if (!fem::available()) GTEST_SKIP() << "no springproof-fem";
  const DyingProgram program("p1");
  const PreparedCase prepared = squeezed_cube("\"q1\", \"p1\"", 0.02);
  const ReferenceGrids grids = solve_grids(prepared, prepared.experiment.materials[0]);
  ASSERT_EQ(grids.elements.size(), 2u) << grids.failure;
  EXPECT_TRUE(complete(grids.elements[0]));
  EXPECT_FALSE(complete(grids.elements[1]));
  EXPECT_NE(grids.elements[1].grids[0].message.find("signal 9"), std::string::npos)
      << grids.elements[1].grids[0].message;
}

TEST(ReferenceGrids, WithoutTheProgramThereIsAReasonAndNoElement) {
  const DyingProgram program("q2");
  const PreparedCase prepared = squeezed_cube("\"q2\"", 0.02);
  const ReferenceGrids grids = solve_grids(prepared, prepared.experiment.materials[0]);
  EXPECT_TRUE(grids.elements.empty());
  EXPECT_NE(grids.failure.find("signal 9"), std::string::npos) << grids.failure;
}

TEST(ReferenceGrids, OneFailedGridLeavesNoReference) {
  const PreparedCase prepared = prepared_block("");
  ElementGrids e = grids_of_order(prepared, 2);
  EXPECT_TRUE(complete(e));
  e.grids[1].ok = false;
  EXPECT_FALSE(complete(e));
}

}  // namespace
}  // namespace springproof::reference_grids_test
