// Matrices of cut cells against the laws' tangent, and their kernels against plain loops.
#include "msm/multigrid/cut/cut_matrix.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "msm/models.h"
#include "msm/multigrid/cut/cut_levels.h"
#include "support/refined_cells.h"
#include "support/solids.h"
#include "support/zoo.h"

namespace springproof::cut_matrix_test {
namespace {

MassSpringModel bar(bool refined, double nu, double shift) {
  const double l = 0.2;
  const Mesh body = test::mapped(test::cylinder(2, 8, 12), test::random_placement(3, l));
  VoxelGrid grid = test::grid_about(body, l);
  if (refined) grid = test::halved_at_random(grid, 2, 7);
  ModelParameters parameters = test::model("hybmss_bt");
  parameters.shift = shift;
  return build_cut(parameters, cut_body(grid, body), {"z_min"}, Mesh{}, {1e4, nu, 1}).model;
}

/// Noise that is zero in carried unknowns.
Eigen::VectorXd field(const Network& network, unsigned seed) {
  Eigen::VectorXd x = flat(test::noise(network.nodes(), 1, seed));
  for (const CarriedPoint& c : network.cells.carried) x.segment<3>(3 * c.point).setZero();
  return x;
}

TEST(CutMatrix, IsTheTangentAtRest) {
  for (const bool refined : {false, true})
    for (const double nu : {-0.5, 0.25, 0.499})
      for (const double shift : {0.0, 0.4}) {
        const MassSpringModel model = bar(refined, nu, shift);
        const Network& network = model.network;
        const AnchoredNodes nodes(network, std::vector<char>(network.X.size(), 0));
        const CutLevel level = cut_levels(network, nodes).front();
        const CutMatrix<double> cells(averaged_cells(*averaged_springs_of(model), level), 1, level, {});
        const Eigen::VectorXd x = field(network, 1);
        Eigen::VectorXd y, expected;
        nodes.multiply(cells, 1, x, y);
        tangent(model, network.X).multiply(x, expected);
        EXPECT_LE((y - expected).norm(), 1e-13 * expected.norm()) << refined << ' ' << nu << ' ' << shift;
      }
}

// A cube of ten cells along each edge: nine points along it lie inside, with 27 blocks in common.
TEST(CutMatrix, StoresEqualRowsOnce) {
  const MassSpringModel model = [] {
    const Mesh body = test::solid_of(block_mesh({1, 1, 1}, {2, 2, 2}));
    return build_cut(test::model("hybmss_avg"), cut_body(test::grid_about(body, 0.1), body), {}, Mesh{}, {1, 0.25, 1})
        .model;
  }();
  const AnchoredNodes nodes(model.network, std::vector<char>(model.network.X.size(), 0));
  const CutLevel level = cut_levels(model.network, nodes).front();
  const CutMatrix<double> cells(averaged_cells(*averaged_springs_of(model), level), 1, level, {});
  EXPECT_EQ(cells.rows(), 11 * 11 * 11);
  long entries = 0;
  for (int i = 0; i < cells.rows(); ++i)
    for (int j = 0; j < cells.rows(); ++j) entries += cells.block(i, j) != nullptr;
  EXPECT_EQ(entries, 31 * 31 * 31);
  EXPECT_EQ(cells.stored_blocks(), 31 * 31 * 31 - 27 * (9 * 9 * 9 - 1));
}

TEST(CutMatrix, SweepsFromZeroWithHalfOfTheRows) {
  const MassSpringModel model = bar(true, 0.25, 0);
  const AnchoredNodes nodes(model.network, std::vector<char>(model.network.X.size(), 0));
  const CutLevel level = cut_levels(model.network, nodes).front();
  const CutMatrix<double> A(averaged_cells(*averaged_springs_of(model), level), 1, level, {});
  const std::vector<double> D = A.inverse_diagonal({});
  const Eigen::VectorXd b = field(model.network, 1).head(3 * A.rows());
  Eigen::VectorXd x = Eigen::VectorXd::Zero(b.size()), expected = x;
  A.relax_from_zero(D, b.data(), x.data());
  A.relax(D, true, b.data(), expected.data());
  EXPECT_LE((x - expected).norm(), 1e-14 * expected.norm());
}

/// Rows of a few blocks, the last two alike, in no order.
template <class Real>
struct Sample {
  std::vector<int> point{2, 0, 3, 1}, begin{0, 2, 5, 6, 7}, column{2, 0, 2, 0, 3, 3, 1}, first{0, 2, 5, 5};
  std::vector<Real> block, D;

  Sample() {
    for (int i = 0; i < 9 * 6 + 1; ++i) block.push_back(Real(0.01) * Real((i * 7919) % 13 - 6));
    for (const int diagonal : {0, 3, 5})
      for (int a = 0; a < 3; ++a) block[9 * diagonal + 4 * a] += 1;
    for (int i = 0; i < 36; ++i) D.push_back(Real(i % 9 % 4 == 0 ? 0.9 : 0.05) + Real(0.01) * Real(i));
  }
  BlockRows<Real> rows() const {
    return {4, point.data(), begin.data(), begin.data() + 1, column.data(), first.data(), block.data()};
  }
  Eigen::Matrix<Real, 3, 1> times(int row, const std::vector<Real>& x) const {
    Eigen::Matrix<Real, 3, 1> sum = Eigen::Matrix<Real, 3, 1>::Zero();
    for (int e = begin[row]; e < begin[row + 1]; ++e)
      for (int a = 0; a < 3; ++a)
        for (int b = 0; b < 3; ++b)
          sum[a] += block[9 * (first[row] + e - begin[row]) + 3 * a + b] * x[3 * column[e] + b];
    return sum;
  }
};

template <class Real>
void expect_plain_loops(double tolerance) {
  const Sample<Real> s;
  std::vector<Real> b, x0;
  for (int i = 0; i < 12; ++i) {
    b.push_back(Real(i - 5));
    x0.push_back(Real(0.1) * Real((i * 5) % 7));
  }
  for (const InstructionSet set : usable_instruction_sets()) {
    const BlockRowKernels<Real>& kernels = kernels_of<Real>(set).rows;
    std::vector<Real> y(12), r(12), work(16);
    kernels.multiply(s.rows(), x0.data(), y.data(), work.data());
    kernels.residual(s.rows(), b.data(), x0.data(), r.data(), work.data());
    for (int n = 0; n < 4; ++n)
      for (int a = 0; a < 3; ++a) {
        const int i = 3 * s.point[n] + a;
        EXPECT_NEAR(y[i], s.times(n, x0)[a], tolerance);
        EXPECT_NEAR(r[i], b[i] - s.times(n, x0)[a], tolerance);
      }
    for (const bool ascending : {true, false}) {
      std::vector<Real> x = x0, expected = x0;
      kernels.relax(s.rows(), s.D.data(), ascending, b.data(), x.data(), work.data());
      for (int m = 0; m < 4; ++m) {
        const int n = ascending ? m : 3 - m, i = s.point[n];
        const Eigen::Matrix<Real, 3, 1> Ax = s.times(n, expected);
        for (int a = 0; a < 3; ++a)
          for (int c = 0; c < 3; ++c) expected[3 * i + a] += s.D[9 * i + 3 * a + c] * (b[3 * i + c] - Ax[c]);
      }
      for (int i = 0; i < 12; ++i) EXPECT_NEAR(x[i], expected[i], tolerance) << ascending;
    }
  }
}

TEST(CutMatrix, KernelsDoWhatPlainLoopsDo) {
  expect_plain_loops<double>(1e-14);
  expect_plain_loops<float>(1e-5);
}

}  // namespace
}  // namespace springproof::cut_matrix_test
