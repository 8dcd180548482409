// Cells measured in a finer lattice: the local problems, the fit, and how the body then moves.
#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "msm/algebra/dense.h"
#include "msm/coarsening/cell_patches.h"
#include "msm/coarsening/layered_solver.h"
#include "msm/coarsening/measure_cells.h"
#include "msm/coarsening/states.h"
#include "msm/embedding/cut_lattice.h"
#include "msm/exchange/springs_file.h"
#include "msm/periodic/laws_of_model.h"
#include "msm/topology/cubic_lattice.h"
#include "problem/relaxation.h"
#include "support/solids.h"
#include "support/two_materials.h"
#include "support/zoo.h"

namespace springproof::measure_cells_test {
namespace {

AveragedSprings averaged(double nu) { return averaged_law(test::model("hybmss_avg"), {1, nu, 1}); }

Eigen::MatrixXd noise(Eigen::Index rows, Eigen::Index columns, unsigned seed) {
  const NodalVectors v = test::noise((rows * columns + 2) / 3, 1, seed);
  return Eigen::Map<const Eigen::MatrixXd>(v.data(), rows, columns);
}

/// An angle of plates 1.2 cells of edge 1 thick, askew in the lattice.
Mesh thin_bracket() {
  const Mesh all =
      test::voxels_of(block_mesh({6, 4.8, 6}, {5, 2, 5}), [](int i, int, int k) { return i == 0 || k == 0; });
  const Eigen::Matrix3d turn = test::rotation();
  return test::mapped(test::solid_of(all), [&](const Vec3& x) -> Vec3 { return turn * x; });
}

struct Lattices {
  Mesh body;
  CutBody coarse = cut_body(voxel_grid(body, 1), body);
  FineCells fine = fine_cells(coarse, body, 3);
};
const Lattices& bracket() {
  static const Lattices lattices{thin_bracket()};
  return lattices;
}

/// 18 x 18, symmetric, with eigenvalues in [low, high] in the metric of `of_springs`.
DeformationForm random_form(const DeformationForm& of_springs, double low, double high) {
  const Eigen::MatrixXd A = noise(18, 18, 3);
  const Eigenpairs pairs = symmetric_eigenpairs(A + A.transpose());
  const Eigen::MatrixXd root = Eigen::MatrixXd(of_springs.llt().matrixL()) * pairs.vectors;
  return root * Eigen::VectorXd::LinSpaced(18, low, high).asDiagonal() * root.transpose();
}

TEST(LayeredMatrix, SolvesWhatLayersCouple) {
  LayeredMatrix K({37, 26, 41});
  Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(104, 104);
  const int first[] = {0, 37, 63, 104};
  for (int l = 0; l < 3; ++l) {
    const int n = first[l + 1] - first[l];
    const Eigen::MatrixXd A = noise(n, n, l + 1);
    K.of(l) = A * A.transpose() + 60 * Eigen::MatrixXd::Identity(n, n);
    dense.block(first[l], first[l], n, n) = K.of(l);
    if (l == 2) continue;
    K.below(l) = noise(first[l + 2] - first[l + 1], n, l + 7);
    dense.block(first[l + 1], first[l], K.below(l).rows(), n) = K.below(l);
    dense.block(first[l], first[l + 1], n, K.below(l).rows()) = K.below(l).transpose();
  }
  const Eigen::MatrixXd x = noise(104, 11, 11);
  Eigen::MatrixXd b = dense * x;
  ASSERT_TRUE(K.factor());
  K.solve(b);
  EXPECT_LE((b - x).norm(), 1e-12 * x.norm());
  LayeredMatrix indefinite({2});
  indefinite.of(0) << 1, 2, 2, 1;
  EXPECT_FALSE(indefinite.factor());
}

TEST(ForceFit, FindsTheFormThatStatesHave) {
  const DeformationForm of_springs = form_of(averaged(0.3), {0.5}), true_form = random_form(of_springs, 0.1, 2.5);
  const Eigen::MatrixXd y = noise(18, 40, 5), s = true_form * y;
  const auto misfit = [&](const DeformationForm& M) { return (M * y - s).norm() / s.norm(); };
  EXPECT_LE(misfit(fit_form(of_springs, y, s, {1e-12, 0.02, 3, false})), 1e-8);
  EXPECT_LE(misfit(fit_form(of_springs, y, s)), 0.5 * misfit(of_springs));
}

TEST(ForceFit, KeepsTheFormSymmetricAndItsEigenvaluesInTheirRange) {
  const DeformationForm of_springs = form_of(averaged(0.3), {0.5});
  const Eigen::MatrixXd y = noise(18, 10, 6), s = noise(18, 10, 7);  // no form has these forces
  for (const FitSettings& settings : {FitSettings{}, FitSettings{0.3, 0.3, 4, true}}) {
    const DeformationForm M = fit_form(of_springs, y, s, settings);
    EXPECT_LE((M - M.transpose()).norm(), 1e-12 * M.norm());
    const Eigen::VectorXd values = symmetric_eigenvalues(M, of_springs);
    const double scalars_least = settings.of_scalars ? 0.05 : 1, scalars_largest = settings.of_scalars ? 5 : 1;
    EXPECT_GE(values.minCoeff(), settings.least * scalars_least * (1 - 1e-9));
    EXPECT_LE(values.maxCoeff(), settings.largest * scalars_largest * (1 + 1e-9));
  }
}

TEST(CellPatches, UniformStrainHasTheStressOfAveragedSprings) {
  const Mesh body = test::solid_of(block_mesh({5, 5, 5}, {1, 1, 1}));
  const CutBody coarse = cut_body({Vec3::Zero(), 1, {5, 5, 5}}, body);
  const FineCells fine = fine_cells(coarse, body, 2);
  const AveragedSprings law = averaged(0.3);
  const int middle = coarse.place({2.5, 2.5, 2.5}).cell;
  const PatchAnswer answer = CellPatches(coarse, fine, law).answer(middle);
  ASSERT_EQ(answer.nodes.size(), 64u);
  const Eigen::Matrix3d gradient = noise(3, 3, 2);
  Eigen::VectorXd U(3 * 64), corners(24);
  for (int n = 0; n < 64; ++n) U.segment<3>(3 * n) = gradient * coarse.points.row(answer.nodes[n]).transpose();
  for (int n = 0; n < 8; ++n)
    corners.segment<3>(3 * n) = gradient * coarse.points.row(coarse.cells[middle].corners[n]).transpose();
  const CellShape shape{1, coarse.cells[middle].filled};
  const Eigen::VectorXd y = deformation_of(shape) * corners, s = form_of(law, shape) * y;
  EXPECT_LE((answer.deformation * U - y).norm(), 1e-9 * y.norm());
  EXPECT_LE((answer.stress * U - s).norm(), 1e-9 * s.norm());
}

TEST(CellPatches, RigidMotionsHaveNoDeformationAndNoStress) {
  const Lattices& of = bracket();
  const AveragedSprings law = averaged(0.3);
  const CellPatches patches(of.coarse, of.fine, law);
  int measured = 0;
  for (int cell = 0; cell < static_cast<int>(of.coarse.cells.size()); cell += 7) {
    const PatchAnswer answer = patches.answer(cell);
    if (answer.nodes.empty()) continue;
    ++measured;
    Eigen::VectorXd U(3 * static_cast<Eigen::Index>(answer.nodes.size()));
    for (std::size_t n = 0; n < answer.nodes.size(); ++n)
      U.segment<3>(3 * static_cast<Eigen::Index>(n)) =
          Vec3(1, -2, 3) + Vec3(2, 1, -1).cross(of.coarse.points.row(answer.nodes[n]).transpose());
    EXPECT_LE((answer.deformation * U).norm(), 1e-8 * answer.deformation.norm() * U.norm());
    EXPECT_LE((answer.stress * U).norm(), 1e-8 * answer.stress.norm() * U.norm());
  }
  EXPECT_GE(measured, 10);
}

TEST(LoadsAllOver, HaveNoResultantOnAFreeBody) {
  const Network network = cut_lattice(bracket().coarse, {}, {{1, 0.3, 1}});
  const Eigen::MatrixXd loads = loads_all_over(network, 0), others = loads_all_over(network, 1);
  EXPECT_GE((loads - others).norm(), 0.5 * loads.norm());
  for (Eigen::Index i = 0; i < loads.cols(); ++i) {
    Vec3 force = Vec3::Zero(), torque = Vec3::Zero();
    for (int n = 0; n < network.nodes(); ++n) {
      const Vec3 f = loads.col(i).segment<3>(3 * n);
      force += f;
      torque += network.X.row(n).transpose().cross(f);
    }
    EXPECT_LE(force.norm() + torque.norm(), 1e-9 * loads.col(i).lpNorm<1>());
  }
}

TEST(MeasuredCells, MoveAThinBodyAsTheFineLatticeDoes) {
  const Lattices& of = bracket();
  const MeasuredBody measured = measure_cells({of.coarse, of.fine, averaged(0.3)}, {.threads = 2});
  EXPECT_LE(measured.as_averaged, static_cast<int>(of.coarse.cells.size()) / 10);
  EXPECT_GE(measured.error_of_averaged, 0.15);
  EXPECT_LE(measured.error, 0.4 * measured.error_of_averaged);
}

// Cells of the long-time moduli with branches of half their shear modulus, beside those of the sudden moduli.
TEST(MeasuredCells, RelaxAsTheFineLatticeDoes) {
  const Lattices& of = bracket();
  const auto law = [](const IsotropicMaterial& m) { return averaged_law(test::model("hybmss_avg"), m); };
  const IsotropicMaterial relaxed{1, 0.45, 1}, sudden = with_shear(relaxed, 1.5);
  const MeasuredCells cells = measure_cells({of.coarse, of.fine, averaged(0.3)}, {.threads = 2}).cells;
  const CellSet in = cut_lattice(of.coarse, {}, {{1, 0.3, 1}}).cells;
  const MeasuredCells at_long_times = in_material(cells, in, averaged(0.3), law(relaxed)),
                      at_once = in_material(cells, in, averaged(0.3), law(sudden));
  MeasuredCells with_branches;
  for (std::size_t c = 0; c < in.size(); ++c) {
    const DeformationForm M = at_long_times.form_of_cell(c);
    with_branches.add_form(M + 0.5 * without_volume(M));
  }
  const MeasuredIn truth{of.coarse, of.fine, law(sudden)};
  const FineTruth fine(truth);
  const double error = fine.error(with_branches), error_at_once = fine.error(at_once);
  EXPECT_LE(error, 1.15 * error_at_once);
  EXPECT_GE(fine.error(at_long_times), 1.2 * error);
}

// Measured as if free, cells at a clamped end are far too soft.
TEST(MeasuredCells, OfAClampedBarAreMeasuredOnTheHeldBody) {
  const double edge = 0.5;  // two cells across
  const auto place = test::random_placement(1, edge);
  const Mesh body = test::mapped(test::cylinder(5, 6, 30), [&](const Vec3& x) -> Vec3 { return place(x); });
  const CutBody coarse = cut_body(test::grid_about(body, edge), body);
  const FineCells fine = fine_cells(coarse, body, 3);
  const MeasuredIn held{coarse, fine, averaged(0.3), {"z_min"}};
  const MeasuredBody on_its_support = measure_cells(held), free = measure_cells({coarse, fine, averaged(0.3)});
  const double as_if_free = FineTruth(held).error(free.cells);
  EXPECT_GE(as_if_free, 0.1);
  EXPECT_LE(on_its_support.error, 0.4 * as_if_free);
}

/// A block with balls two cells across that are of another material, in cells of edge 1.
struct BlockWithBalls {
  Mesh body;
  CutBody coarse;
  FineCells fine;

  BlockWithBalls() {
    body = test::with_materials(test::solid_of(block_mesh({7, 5, 5}, {28, 20, 20})), [](const Vec3& x) {
      return std::min((x - Vec3(1.9, 2.3, 2.6)).norm(), (x - Vec3(5.2, 2.7, 2.2)).norm()) < 1;
    });
    Mesh as_one = body;
    as_one.materials.clear();
    coarse = cut_body(voxel_grid(body, 1), as_one);
    fine = fine_cells(coarse, body, 3);
  }
};
const BlockWithBalls& block_with_balls() {
  static const BlockWithBalls block;
  return block;
}

AveragedSprings with_region(double relative_modulus) {
  return averaged_law(test::model("hybmss_avg"), {1, 0.3, 1}, {{relative_modulus, 0.3, 1}});
}

TEST(CellPatches, RigidMotionsOfSeveralMaterialsHaveNoStress) {
  const BlockWithBalls& of = block_with_balls();
  const CellPatches patches(of.coarse, of.fine, with_region(100));
  const PatchAnswer answer = patches.answer(of.coarse.place({1.9, 2.3, 2.6}).cell);
  ASSERT_FALSE(answer.nodes.empty());
  Eigen::VectorXd U(3 * static_cast<Eigen::Index>(answer.nodes.size()));
  for (std::size_t n = 0; n < answer.nodes.size(); ++n)
    U.segment<3>(3 * static_cast<Eigen::Index>(n)) =
        Vec3(1, -2, 3) + Vec3(2, 1, -1).cross(of.coarse.points.row(answer.nodes[n]).transpose());
  EXPECT_LE((answer.deformation * U).norm(), 1e-8 * answer.deformation.norm() * U.norm());
  EXPECT_LE((answer.stress * U).norm(), 1e-8 * answer.stress.norm() * U.norm());
}

TEST(MeasuredCells, OfABodyWithStiffBallsMoveAsTheirBondedFineLattice) {
  const BlockWithBalls& of = block_with_balls();
  const MeasuredBody measured = measure_cells({of.coarse, of.fine, with_region(100)}, {.threads = 2});
  EXPECT_GE(measured.error_of_averaged, 0.2);
  EXPECT_LE(measured.error, 0.4 * measured.error_of_averaged);
}

TEST(MeasuredCells, HaveTheHarmonicMeanOfBulkModuliOfSeveralMaterials) {
  const BlockWithBalls& of = block_with_balls();
  const AveragedSprings soft = with_region(2),
                        stiff = averaged_law(test::model("hybmss_avg"), {3, 0.3, 1}, {{6, 0.3, 1}});
  const CellSet cells = cut_lattice(of.coarse, {}, {{1, 0.3, 1}}).cells;
  MeasuredCells measured;
  for (std::size_t c = 0; c < cells.size(); ++c)
    measured.add_form(form_of(springs_in_cell(of.fine, static_cast<int>(c), soft), cells.shape(c)));
  const MeasuredCells scaled = in_material(measured, cells, soft, stiff, &of.fine);
  for (std::size_t c = 0; c < cells.size(); ++c)
    EXPECT_LE((scaled.form_of_cell(c) - 3 * measured.form_of_cell(c)).norm(), 1e-9 * scaled.form_of_cell(c).norm());
}

TEST(MeasuredCells, StopWhereTheyAreInterrupted) {
  const Lattices& of = bracket();
  EXPECT_THROW(measure_cells({of.coarse, of.fine, averaged(0.3)}, {1, [] { return true; }}), std::runtime_error);
}

TEST(MeasuredCells, OfAFileHaveAnEnergy) {
  SpringsFile file;
  file.model.network = lattice_without_springs(test::notched_block());
  MeasuredCells cells;
  for (std::size_t c = 0; c < file.model.network.cells.size(); ++c)
    cells.add_form((c == 3 ? -1 : 1) * DeformationForm::Identity());
  file.model.laws = {cells};
  EXPECT_THROW(
      try { parse_springs(springs_as_json(file), "cells.json"); } catch (const InputError& e) {
        EXPECT_NE(std::string(e.what()).find("the form of cell 3 has the eigenvalue -1 N/m"), std::string::npos)
            << e.what();
        throw;
      },
      InputError);
}

TEST(MeasuredCells, KeepTheBulkModulusOfAnotherMaterial) {
  const Network network = test::cut_network();
  const AveragedSprings of = averaged(0.3), at = averaged(0.499);
  MeasuredCells measured;
  for (std::size_t c = 0; c < network.cells.size(); ++c) measured.add_form(form_of(of, network.cells.shape(c)));
  const MeasuredCells same = in_material(measured, network.cells, of, of),
                      other = in_material(measured, network.cells, of, at);
  for (std::size_t c = 0; c < network.cells.size(); ++c) {
    EXPECT_LE((same.form_of_cell(c) - measured.form_of_cell(c)).norm(), 1e-12 * measured.form_of_cell(c).norm());
    const Eigen::Matrix<double, 6, 6> strain = other.form_of_cell(c).topLeftCorner<6, 6>(),
                                      exact = form_of(at, network.cells.shape(c)).topLeftCorner<6, 6>();
    EXPECT_LE((strain - exact).norm(), 1e-12 * exact.norm());
  }
}

}  // namespace
}  // namespace springproof::measure_cells_test
