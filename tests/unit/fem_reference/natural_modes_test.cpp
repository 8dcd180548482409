// Natural modes by finite elements against closed forms.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "problem/system/input_error.h"
#include "support/bodies.h"
#include "support/fem_block.h"

namespace springproof::natural_modes_test {
namespace {

fem::GridProblem modes_of(const Vec3& size, const Cells& cells, int degree, double nu, int modes) {
  fem::GridProblem problem = test::fem_block(size, cells, 0, degree, nu);
  problem.modes = modes;
  problem.points = test::points_inside(size, 5);
  return problem;
}

/// Relative distance of the nearest frequency.
double nearest(const fem::Solution& s, double frequency) {
  double least = 1;
  for (const double f : s.frequencies) least = std::min(least, std::abs(f / frequency - 1));
  return least;
}

/// Of a free cube of n cells along each edge a: distance from Lame's modes, f = c_s / (sqrt(2) a) at every nu.
double error_of_lames_mode(int n, double nu, bool tetrahedra) {
  const double a = 0.5;
  fem::GridProblem problem = modes_of({a, a, a}, {n, n, n}, 2, nu, 14);
  if (tetrahedra) problem.coarse = test::tetrahedra_of(problem.coarse);
  const fem::Solution s = fem::solve_grid(problem);
  EXPECT_TRUE(s.ok) << s.message;
  EXPECT_EQ(s.rigid_motions, 6);
  EXPECT_GE(s.frequencies.size(), 14u);
  EXPECT_EQ(s.shapes.size(), s.frequencies.size());
  EXPECT_EQ(s.shapes.at(0).rows(), 5);
  EXPECT_LT(s.residual, 1e-8);
  return nearest(s, std::sqrt(shear_modulus(problem.material) / problem.material.density) / (std::sqrt(2.0) * a));
}

TEST(FemNaturalModes, OfAFreeCubeHoldLamesModes) {  // with order four, from the finest grid's error
  for (const bool tetrahedra : {false, true})
    for (const double nu : {0.0, 0.3, 0.45, 0.4999}) {
      const double coarse = error_of_lames_mode(3, nu, tetrahedra), fine = error_of_lames_mode(5, nu, tetrahedra);
      EXPECT_LT(coarse, 5e-3) << nu << tetrahedra;
      EXPECT_LT(fine, 1e-3) << nu << tetrahedra;
      EXPECT_GT(coarse / fine, std::pow(5. / 3, 3)) << nu << tetrahedra;
    }
}

TEST(FemNaturalModes, OfAColumnWithAMassOnItsEndAreExact) {
  // Sides on rollers: plane waves, b tan b = body's mass / attached mass = 1/5.
  const Vec3 size{0.4, 0.1, 0.1};
  for (const bool tetrahedra : {false, true}) {
    fem::GridProblem problem = modes_of(size, {8, 1, 1}, 2, 0.3, 2);
    if (tetrahedra) problem.coarse = test::tetrahedra_block(problem.coarse);
    problem.loads = {PrescribedDisplacement{"x_min", {0, std::nullopt, std::nullopt}}};
    for (const char* on : {"y_min", "y_max"})
      problem.loads.push_back(PrescribedDisplacement{on, {std::nullopt, 0, std::nullopt}});
    for (const char* on : {"z_min", "z_max"})
      problem.loads.push_back(PrescribedDisplacement{on, {std::nullopt, std::nullopt, 0}});
    problem.masses = {{"weight", "x_max", {}, 5 * size.prod() * problem.material.density}};
    const double exact =
        0.432841 / (2 * std::numbers::pi * size[0]) *
        std::sqrt((lame_lambda(problem.material) + 2 * shear_modulus(problem.material)) / problem.material.density);
    const fem::Solution s = fem::solve_grid(problem);
    ASSERT_TRUE(s.ok) << s.message;
    EXPECT_NEAR(s.frequencies[0], exact, 1e-4 * exact) << tetrahedra;
  }
}

TEST(FemNaturalModes, AMassOutsideOfTheBodyIsRefusedByItsName) {
  fem::GridProblem problem = modes_of({1, 1, 1}, {1, 1, 1}, 2, 0.3, 2);
  problem.masses = {{"far", "", {{9, 0, 0}}, 1}};
  try {
    fem::solve_grid(problem);
    FAIL();
  } catch (const InputError& e) {
    EXPECT_NE(std::string(e.what()).find("mass 'far': "), std::string::npos) << e.what();
  }
}

TEST(FemNaturalModes, WhereCopiesOfMultipleEigenvaluesAreMissedMoreAreAskedFor) {
  // With six beside those wanted, 32 eigenvalues lie below a gap where 30 are found.
  fem::GridProblem problem = modes_of({0.05, 0.05, 0.05}, {8, 8, 8}, 2, 0.3, 18);
  problem.material.youngs_modulus = 1e11;
  problem.material.density = 8500;
  const fem::Solution s = fem::solve_grid(problem);
  ASSERT_TRUE(s.ok) << s.message;
  EXPECT_EQ(s.rigid_motions, 6);
  EXPECT_GE(s.frequencies.size(), 18u);
}

TEST(FemNaturalModes, OfAClampedBarWithoutContractionHoldItsStandingWave) {
  // nu = 0: f = c / (4 L), plus the dispersion of consistent mass, (k h)^2/24 (linear) or (k h)^4/1440 (quadratic).
  const Vec3 size(2, 0.5, 0.6);
  for (const int degree : {1, 2}) {
    fem::GridProblem problem = modes_of(size, {8, 1, 1}, degree, 0, 8);
    problem.loads = {PrescribedDisplacement{"x_min", {0.0, 0.0, 0.0}}, Traction{"x_max", {1, 0, 0}}};
    const fem::Solution s = fem::solve_grid(problem);
    ASSERT_TRUE(s.ok) << s.message;
    EXPECT_EQ(s.rigid_motions, 0);
    const double c = std::sqrt(problem.material.youngs_modulus / problem.material.density);
    const double kh = std::numbers::pi / 2 / 8, expected = degree == 1 ? kh * kh / 24 : std::pow(kh, 4) / 1440;
    EXPECT_NEAR(nearest(s, c / (4 * size[0])), expected, 0.01 * expected) << degree;
  }
}

TEST(FemNaturalModes, OfThePressureFormAreThoseOfTheDisplacementForm) {
  // The form changes at nu = 0.4.  Modes that change the volume are among the first twelve.
  const Vec3 size(1, 1.1, 1.2);
  const fem::Solution a = fem::solve_grid(modes_of(size, {5, 5, 5}, 2, 0.4, 12)),
                      b = fem::solve_grid(modes_of(size, {5, 5, 5}, 2, 0.400001, 12));
  ASSERT_TRUE(a.ok && b.ok) << a.message << b.message;
  EXPECT_NE(a.form, b.form);
  for (int i = 0; i < 12; ++i) EXPECT_NEAR(b.frequencies[i] / a.frequencies[i], 1, 1e-3) << i;
}

TEST(FemNaturalModes, OfABodyOnAPlateAreLeftThreeRigidMotions) {
  fem::GridProblem problem = modes_of({1, 1, 1}, {2, 2, 2}, 2, 0.3, 4);
  problem.loads = {PrescribedDisplacement{"z_min", {std::nullopt, std::nullopt, 0.0}}};
  EXPECT_EQ(fem::solve_grid(problem).rigid_motions, 3);
}

TEST(FemNaturalModes, OfTetrahedraAreThoseOfHexahedraAtEveryPoissonsRatio) {
  const Vec3 size(1, 1, 1);
  for (const double nu : {0.3, 0.45, 0.4999}) {
    fem::GridProblem hexahedra = modes_of(size, {5, 5, 5}, 2, nu, 6), tetrahedra = hexahedra;
    tetrahedra.coarse = test::tetrahedra_of(hexahedra.coarse);
    const fem::Solution a = fem::solve_grid(hexahedra), b = fem::solve_grid(tetrahedra);
    ASSERT_TRUE(a.ok && b.ok) << a.message << b.message;
    for (int i = 0; i < 6; ++i) EXPECT_NEAR(b.frequencies[i] / a.frequencies[i], 1, 3e-3) << nu << ", mode " << i;
  }
}

}  // namespace
}  // namespace springproof::natural_modes_test
