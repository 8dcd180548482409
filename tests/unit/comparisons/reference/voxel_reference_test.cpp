// The finite elements of a body of voxels: supports balance the loads, the parts of the error add up.
#include "comparisons/reference/voxel_reference.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "fem_reference/exchange/reference.h"
#include "problem/system/run_cost.h"
#include "support/voxel_case.h"

namespace springproof::voxel_reference_test {
namespace {

using namespace test;

constexpr const char* some_models = R"("hybmss", "emsm", "emsm_random", "msm_18")";

class VoxelReference : public testing::Test {
 protected:
  void SetUp() override {
    if (!fem::available()) GTEST_SKIP() << "no springproof-fem";
  }
};

const PreparedCase& ball() {
  static const PreparedCase prepared = prepared_ball(150, every_load, some_models, "edge_m = 0.035");
  return prepared;
}

/// Of all loads about the true patch that is held.
Wrench total_load() {
  const Mesh& body = *ball().body.tetrahedra.back();
  Wrench total{Vec3::Zero(), Vec3::Zero(), centroid(body, patch(body, "low"))};
  for (const Load& load : ball().loads) {
    Wrench w;
    if (const auto* carried = wrench_of(load))
      w = moved(carried->value(), total.about);
    else if (const auto* p = std::get_if<PointForce>(&load))
      w = {p->force, (p->at - total.about).cross(p->force), total.about};
    total.force += w.force;
    total.moment += w.moment;
  }
  return total;
}

void expect_balance(const fem::Solution& s) {
  ASSERT_TRUE(s.ok) << s.message;
  ASSERT_EQ(s.reactions.size(), 1u);
  const Wrench load = total_load();
  EXPECT_LE((s.reactions[0].force + load.force).norm(), 1e-8 * load.force.norm());
  EXPECT_LE((s.reactions[0].torque + load.moment).norm(), 1e-8 * 0.2 * load.force.norm());
}

TEST_F(VoxelReference, SupportsBalanceTheBodysLoadOnEveryGrid) {
  const ReferenceGrids grids = solve_body_grids(ball(), ball().experiment.materials[0]);
  ASSERT_EQ(grids.failure, "");
  ASSERT_EQ(grids.elements.size(), 1u);
  ASSERT_EQ(grids.peers.size(), 1u);
  ASSERT_EQ(grids.refined.at(0).size(), 2u);
  for (const fem::Solution& s : grids.elements[0].grids) {
    SCOPED_TRACE("tetrahedra " + std::to_string(s.grid.cells[0]));
    expect_balance(s);
  }
  SCOPED_TRACE("cubes");
  ASSERT_EQ(grids.peers[0].size(), 1u);
  expect_balance(grids.peers[0][0]);
  for (const fem::Solution& s : grids.refined[0]) expect_balance(s);
}

TEST_F(VoxelReference, RowsBalanceAndPartsOfTheErrorAddUp) {
  const Part part = run_part(ball(), 0, {});
  for (const springproof::Run& run : part.runs) EXPECT_TRUE(run.ok) << run.model << ": " << run.message;
  const Wrench load = total_load();
  std::map<std::string, int> seen;
  for (const Row& row : part.rows)
    for (int d = 0; d < 3; ++d) {
      const std::string axis(1, "xyz"[d]);
      const bool force = row.measure == "force.low." + axis, torque = row.measure == "torque.low." + axis;
      if (!force && !torque) continue;
      ++seen[row.model];
      EXPECT_NEAR(row.value, force ? -load.force[d] : -load.moment[d], 1e-8 * load.force.norm() * (force ? 1 : 0.2))
          << row.model << " " << row.measure;
    }
  for (const char* model : {"hybmss", "emsm", "emsm_random", "msm_18", "fem_q1"}) EXPECT_EQ(seen[model], 6) << model;
  ASSERT_EQ(part.deformations.size(), 1u);
  EXPECT_LE((part.deformations[0].applied_N - load.force).norm(), 1e-8 * load.force.norm());
  EXPECT_LE((part.deformations[0].reacted_N + load.force).norm(), 1e-8 * load.force.norm());
  const auto coloured = std::count_if(part.pictures.begin(), part.pictures.end(), [](const Picture& p) {
    return p.von_mises.size() == p.rest.size() / 3 && *std::max_element(p.von_mises.begin(), p.von_mises.end()) > 0;
  });
  EXPECT_EQ(coloured, 1) << "the reference on the true surface";
  ASSERT_FALSE(part.splits.empty()) << "the case asks for them";
  std::map<std::string, int> scalars;
  EXPECT_GT(ball().body.chords, 1e-3) << "chords of a sphere";
  for (const ErrorSplit& s : part.splits) {
    EXPECT_TRUE(std::isfinite(s.total)) << s.measure;
    if (s.measure == "displacement_error") {
      EXPECT_EQ(s.facets, ball().body.chords > 0.1 * s.total ? ball().body.chords : 0) << s.model;
      EXPECT_GT(s.uncertainty, s.facets);
      EXPECT_LE(s.total, (s.model_error + s.discretisation_error + s.geometry_error) * (1 + 1e-12))
          << s.model << ": triangle inequality";
      continue;
    }
    ++scalars[s.model];
    EXPECT_NEAR(s.total, s.model_error + s.discretisation_error + s.geometry_error,
                1e-12 * (std::abs(s.total) + std::abs(s.model_error) + std::abs(s.geometry_error)))
        << s.model << " " << s.measure;
  }
  for (const char* model : {"hybmss", "emsm", "emsm_random", "msm_18"}) EXPECT_GE(scalars[model], 5) << model;
  for (const ErrorSplit& s : part.splits)
    EXPECT_EQ(s.geometry_error == 0, s.model == "hybmss" || s.model == "msm_18")
        << s.model << ": cut cells fit the body";
}

TEST_F(VoxelReference, ElementsBesideTheModelsRunAtTheirResolutions) {
  std::string text = ball_case(100, every_load, "\"hybmss\"", "edge_m = 0.035");
  text.replace(text.find("voxels = 100"), 12, "voxels = [100, 200]");
  text.replace(text.find("[compare]\nparts = true\n"), 23,
               "[compare]\ncost = true\nelements = [\"p1\", \"q1\", \"p2\"]\n");
  const PreparedCase prepared = prepare(parse_experiment(text, "ball.toml"));
  ASSERT_EQ(prepared.lattices.size(), 2u);
  EXPECT_GT(prepared.lattices[1].tetrahedra->tetrahedra.size(), prepared.lattices[0].tetrahedra->tetrahedra.size());
  const Part part = run_part(prepared, 0, {});
  EXPECT_TRUE(part.splits.empty()) << "parts of the errors are computed on request";
  for (const springproof::Run& run : part.runs) EXPECT_NE(run.model, "fem_q2") << cells_text(run.cells);
  for (const char* model : {"hybmss", "fem_p1", "fem_q1", "fem_p2"})
    for (const Lattice& lattice : prepared.lattices) {
      const Cells& c = lattice.cells;
      SCOPED_TRACE(std::string(model) + " " + cells_text(c));
      const auto row = std::find_if(part.rows.begin(), part.rows.end(), [&](const Row& r) {
        return r.model == model && r.cells == c && r.measure == "displacement_error";
      });
      const auto run = std::find_if(part.runs.begin(), part.runs.end(),
                                    [&](const springproof::Run& r) { return r.model == model && r.cells == c; });
      ASSERT_TRUE(row != part.rows.end() && run != part.runs.end());
      EXPECT_TRUE(row->value > 0 && row->value < 0.7) << row->value;
      EXPECT_GT(run->seconds, 0);
      EXPECT_GT(run->set_up_seconds, 0);
      EXPECT_LE(run->residual, compared_residual);
    }
}

TEST_F(VoxelReference, RecordsHaveTheTetrahedraThatWereSolved) {
  const PreparedCase prepared = prepared_ball(100, every_load, "\"hybmss\"", "edge_m = 0.05\nrefine = 2");
  const Part part = run_part(prepared, 0, {});
  ASSERT_FALSE(part.references.empty());
  for (const ReferenceRecord& r : part.references) {
    EXPECT_GE(r.cells.back()[0], 2 * prepared.body.uncut.back()) << r.measure;
    EXPECT_TRUE(
        std::ranges::any_of(part.runs, [&](const springproof::Run& run) { return run.cells == r.cells.back(); }));
  }
}

TEST_F(VoxelReference, AStiffMotionIsTheSameInTetrahedraAndCubes) {
  // A body turned and moved as a whole (first order): every mesh, and what is taken from it outside the body, is exact.
  std::string text = ball_case(100, "", "\"hybmss\"", "edge_m = 0.025");
  const std::string held = "displacement_m = [0, 0, 0]";
  text.replace(
      text.find(held), held.size(),
      "displacement_gradient = [[0, -0.2, 0.1], [0.2, 0, 0.3], [-0.1, -0.3, 0]]\ndisplacement_m = [0.01, 0.02, 0.03]");
  const PreparedCase prepared = prepare(parse_experiment(text, "ball.toml"));
  const ReferenceGrids grids = solve_body_grids(prepared, prepared.experiment.materials[0]);
  Eigen::Matrix3d G;
  G << 0, -0.2, 0.1, 0.2, 0, 0.3, -0.1, -0.3, 0;
  const NodalVectors exact =
      (prepared.lattices[0].mesh->nodes * G.transpose()).rowwise() + Eigen::RowVector3d(0.01, 0.02, 0.03);
  const auto error = [&](const fem::Solution& s) {
    return (at_nodes(prepared.lattices[0], s.displacement) - exact).cwiseAbs().maxCoeff();
  };
  for (const fem::Solution& s : grids.elements.at(0).grids) EXPECT_LE(error(s), 1e-7 * 0.1) << s.grid.cells[0];
  EXPECT_LE(error(grids.peers.at(0).at(0)), 1e-7 * 0.1);
  for (const fem::Solution& s : grids.refined.at(0)) EXPECT_LE(error(s), 1e-7 * 0.1);
}

}  // namespace
}  // namespace springproof::voxel_reference_test
