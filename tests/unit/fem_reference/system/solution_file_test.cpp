// The file of a solution on its own mesh: where its nodes are, in VTK's order, and what stress they have.
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>

#include "fem_reference/solve_grid.h"
#include "problem/files/files.h"
#include "support/fem_block.h"
#include "support/solids.h"
#include "support/vtu_reader.h"

namespace springproof::solution_file_test {
namespace {

using test::read_array;

struct Elements {
  bool tetrahedra;
  int degree;
  double nu;
  const char* law;
};

void PrintTo(const Elements& e, std::ostream* out) {
  *out << (e.tetrahedra ? "P" : "Q") << e.degree << " nu " << e.nu << " " << e.law;
}

class SolutionFile : public testing::TestWithParam<Elements> {
 protected:
  SolutionFile()
      : file_(std::filesystem::temp_directory_path() / ("springproof_solution_" + std::to_string(getpid()) + ".vtu")) {}
  ~SolutionFile() override { std::filesystem::remove(file_); }

  using Vectors = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  Vectors array(const std::string& name, int components) const {
    const auto values = read_array<double>(document_, name);
    return Eigen::Map<const Vectors>(values.data(), static_cast<Eigen::Index>(values.size()) / components, components);
  }

  void solve(fem::GridProblem problem) {
    problem.vtu = file_.string();
    problem.vtu_notes = {{{"element", "any"}}, {{"poisson_ratio", GetParam().nu}}};
    const fem::Solution solution = fem::solve_grid(problem);
    ASSERT_TRUE(solution.ok) << solution.message;
    document_ = text_of_file(file_);
  }

  std::filesystem::path file_;
  std::string document_;
};

// A homogeneous strain, given on all of the surface: every element has it exactly, and its stress.
TEST_P(SolutionFile, HasTheNodesAndTheStressOfAHomogeneousStrain) {
  const auto [tetrahedra, degree, nu, law] = GetParam();
  const Vec3 size(2, 1, 1.5);
  fem::GridProblem problem = test::fem_block(size, {2, 2, 2}, 1, degree, nu);
  if (tetrahedra) {
    problem.coarse = test::ball_of_tetrahedra(4);
    problem.refinements = 0;
  } else {
    problem.place = test::shaken_inside(size, 0.03);
  }
  problem.law = law;
  Eigen::Matrix3d H;
  H << 2e-3, 1e-3, 0, -3e-3, 1e-3, 4e-3, 5e-3, 0, -4e-3;
  for (const Patch& p : problem.coarse.patches) problem.loads.push_back(PrescribedAffine{p.name, H, Vec3::Zero()});
  if (nu > 0.4) problem.tolerance = 1e-10;
  solve(problem);

  // Of the solver's residual, 1e-10 at most, relative: E/(1 - 2 nu) times the error of the strain is that of the
  // stress.
  const auto X = array("position", 3), u = array("displacement", 3), stress = array("stress", 6),
             mises = array("von_mises", 1);
  EXPECT_LT((u - X * H.transpose()).cwiseAbs().maxCoeff(), 1e-9);
  const double G = 1e4 / (2 * (1 + nu)), lambda = 2 * G * nu / (1 - 2 * nu);
  Eigen::Matrix3d s = G * (H + H.transpose()) + lambda * H.trace() * Eigen::Matrix3d::Identity();
  if (problem.law == "neo_hooke") {  // W = G/2 (I1 - 3) - G ln J + lambda/2 (ln J)^2
    const Eigen::Matrix3d F = Eigen::Matrix3d::Identity() + H;
    const double J = F.determinant();
    s = (G * (F * F.transpose() - Eigen::Matrix3d::Identity()) + lambda * std::log(J) * Eigen::Matrix3d::Identity()) /
        J;
  }
  Eigen::RowVectorXd expected(6);
  expected << s(0, 0), s(1, 1), s(2, 2), s(0, 1), s(1, 2), s(0, 2);
  const double scale = expected.cwiseAbs().maxCoeff();
  EXPECT_LT((stress.rowwise() - expected).cwiseAbs().maxCoeff(), 1e-6 * scale) << stress.row(0) << "; " << expected;
  const Eigen::Matrix3d deviator = s - s.trace() / 3 * Eigen::Matrix3d::Identity();
  EXPECT_LT((mises.array() - std::sqrt(1.5) * deviator.norm()).abs().maxCoeff(), 1e-6 * scale);
  EXPECT_EQ(read_array<double>(document_, "poisson_ratio"), std::vector<double>{nu});
}

// VTK's order: nodes between two, four and eight others lie in the middle of those.
TEST_P(SolutionFile, HasTheCellsInTheOrderOfVtk) {
  const auto [tetrahedra, degree, nu, law] = GetParam();
  fem::GridProblem problem = test::fem_block({2, 1, 1.5}, {2, 2, 2}, 1, degree, nu);
  if (tetrahedra) {
    problem.coarse = test::ball_of_tetrahedra(4);
    problem.refinements = 0;
  }
  problem.law = law;
  for (const Patch& p : problem.coarse.patches)
    problem.loads.push_back(PrescribedAffine{p.name, 1e-3 * Eigen::Matrix3d::Identity(), Vec3::Zero()});
  solve(problem);
  const auto X = array("position", 3);
  const auto connectivity = read_array<std::int32_t>(document_, "connectivity");
  const auto types = read_array<std::uint8_t>(document_, "types");
  const std::uint8_t type = tetrahedra ? (degree == 1 ? 10 : 24) : (degree == 1 ? 12 : 29);
  const std::size_t nodes = type == 10 ? 4 : type == 24 ? 10 : type == 12 ? 8 : 27;
  ASSERT_EQ(connectivity.size(), nodes * types.size());
  using Middle = std::vector<int>;
  const std::vector<Middle> of_hexahedron = {{0, 1},
                                             {1, 2},
                                             {2, 3},
                                             {3, 0},
                                             {4, 5},
                                             {5, 6},
                                             {6, 7},
                                             {7, 4},
                                             {0, 4},
                                             {1, 5},
                                             {2, 6},
                                             {3, 7},
                                             {0, 3, 4, 7},
                                             {1, 2, 5, 6},
                                             {0, 1, 4, 5},
                                             {2, 3, 6, 7},
                                             {0, 1, 2, 3},
                                             {4, 5, 6, 7},
                                             {0, 1, 2, 3, 4, 5, 6, 7}};
  const std::vector<Middle> of_tetrahedron = {{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}};
  for (std::size_t c = 0; c < types.size(); ++c) {
    ASSERT_EQ(types[c], type);
    const auto at = [&](std::size_t a) { return Vec3(X.row(connectivity[c * nodes + a]).transpose()); };
    const Vec3 e1 = at(1) - at(0), e2 = at(tetrahedra ? 2 : 3) - at(0), e3 = at(tetrahedra ? 3 : 4) - at(0);
    EXPECT_GT(e1.cross(e2).dot(e3), 0);
    if (!tetrahedra) {
      EXPECT_LT((at(2) - at(1) - e2).norm() + (at(6) - at(2) - e3).norm(), 1e-12);
    }
    if (degree == 1) continue;
    const std::vector<Middle>& middles = tetrahedra ? of_tetrahedron : of_hexahedron;
    for (std::size_t m = 0; m < middles.size(); ++m) {
      Vec3 mean = Vec3::Zero();
      for (const int a : middles[m]) mean += at(static_cast<std::size_t>(a)) / double(middles[m].size());
      EXPECT_LT((at((tetrahedra ? 4 : 8) + m) - mean).norm(), 1e-12) << "cell " << c << ", node " << m;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Files, SolutionFile,
                         testing::Values(Elements{false, 1, 0.3, "linear"}, Elements{false, 2, 0.3, "linear"},
                                         Elements{false, 2, 0.499, "linear"}, Elements{true, 1, 0.3, "linear"},
                                         Elements{true, 2, 0.3, "linear"}, Elements{true, 2, 0.499, "linear"},
                                         Elements{false, 2, 0.3, "neo_hooke"}));

}  // namespace
}  // namespace springproof::solution_file_test
