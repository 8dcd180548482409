// The finite-strain laws: tangents, frame indifference, small strains, closed forms in tension.
#include "fem_reference/elements/laws.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>

#include "support/tolerances.h"
#include "support/uniaxial.h"

namespace springproof::laws_test {
namespace {

using fem::Law;
using fem::LawResponse;
using fem::tensor;
using Matrix = Eigen::Matrix3d;

constexpr double mu = 3.0, lambda = 5.0;
const std::vector<Law> all_laws = {Law::hencky, Law::log_cauchy, Law::neo_hooke, Law::neo_hooke_isochoric,
                                   Law::st_venant_kirchhoff};

fem::Voigt engineering(const Matrix& m) { return {m(0, 0), m(1, 1), m(2, 2), 2 * m(0, 1), 2 * m(1, 2), 2 * m(0, 2)}; }

LawResponse at(Law law, const Matrix& F) {
  return fem::respond(law, mu, fem::pressure(law, lambda, fem::dilatation(law, F)).value, F);
}

Matrix cauchy(Law law, const Matrix& F) { return F * tensor(at(law, F).S) * F.transpose() / F.determinant(); }

std::vector<Matrix> some_gradients() {
  Matrix general, squeezed, sheared = Matrix::Identity();
  general << 1.1, 0.2, -0.1, -0.15, 0.9, 0.05, 0.07, 0.12, 1.2;
  squeezed = Eigen::DiagonalMatrix<double, 3>(1.05, 1.05, 0.8);  // two equal principal stretches
  sheared(0, 2) = 0.3;
  return {Matrix::Identity(), general, squeezed, sheared, 1.1 * Matrix::Identity()};
}

class FemLaw : public testing::TestWithParam<Law> {};

TEST_P(FemLaw, StressIsTheDerivativeOfTheEnergy) {
  const Law law = GetParam();
  if (law == Law::log_cauchy) return;
  const auto energy = [&](const Matrix& F) {
    return fem::shear_energy(law, mu, F) + fem::dilatation_energy(law, lambda, fem::dilatation(law, F));
  };
  const double step = 1e-5;
  for (const Matrix& F : some_gradients()) {
    const Matrix P = F * tensor(at(law, F).S);
    for (int i = 0; i < 9; ++i) {
      Matrix up = F, down = F;
      up(i % 3, i / 3) += step;
      down(i % 3, i / 3) -= step;
      EXPECT_NEAR((energy(up) - energy(down)) / (2 * step), P(i % 3, i / 3), 1e-8 * (mu + P.norm()));
    }
  }
}

TEST_P(FemLaw, TangentIsTheDerivativeOfTheStress) {
  const Law law = GetParam();
  const double p = 0.7, step = 1e-5;
  Matrix direction;
  direction << 0.3, -0.8, 0.5, 0.9, 0.4, -0.2, -0.6, 0.1, 0.7;
  for (const Matrix& F : some_gradients()) {
    const LawResponse r = fem::respond(law, mu, p, F);
    const Matrix plus = F + step * direction, minus = F - step * direction;
    const Matrix numeric =
        (tensor(fem::respond(law, mu, p, plus).S) - tensor(fem::respond(law, mu, p, minus).S)) / (2 * step);
    const fem::Voigt dC = engineering(F.transpose() * direction + direction.transpose() * F);
    EXPECT_LE((tensor(r.D * dC) - numeric).norm(), test::finite_difference * mu);
    const double numeric_g = (fem::dilatation(law, plus) - fem::dilatation(law, minus)) / (2 * step);
    EXPECT_NEAR(r.G.dot(dC), numeric_g, test::finite_difference);
    const Matrix by_pressure =
        (tensor(fem::respond(law, mu, p + 1, F).S) - tensor(fem::respond(law, mu, p - 1, F).S)) / 2;
    EXPECT_LE((tensor(r.Q) - by_pressure).norm(), test::round_off * 10);
  }
}

TEST_P(FemLaw, PressureAndDilatationAreInverse) {
  const double step = 1e-6;
  for (double g : {-0.3, -0.01, 0.0, 1e-9, 0.2, 0.8}) {
    const fem::ValueAndSlope p = fem::pressure(GetParam(), lambda, g);
    const fem::ValueAndSlope back = fem::dilatation_at_pressure(GetParam(), lambda, p.value);
    EXPECT_NEAR(back.value, g, test::round_off);
    EXPECT_NEAR(back.slope * p.slope, 1, 1e-10);
    const double numeric =
        (fem::pressure(GetParam(), lambda, g + step).value - fem::pressure(GetParam(), lambda, g - step).value) /
        (2 * step);
    EXPECT_NEAR(p.slope, numeric, test::finite_difference * lambda);
  }
}

TEST_P(FemLaw, IsTheLinearOneAtSmallStrain) {
  const double size = 1e-6;
  Matrix h;
  h << 0.3, -0.8, 0.5, 0.9, 0.4, -0.2, -0.6, 0.1, 0.7;
  const Matrix strain = (h + h.transpose()) / 2;
  const Matrix linear = 2 * mu * strain + lambda * strain.trace() * Matrix::Identity();
  const Matrix stress = cauchy(GetParam(), Matrix::Identity() + size * h) / size;
  EXPECT_LE((stress - linear).norm(), 1e-5 * linear.norm());
}

TEST_P(FemLaw, TurnsWithTheBody) {
  const Matrix R = Eigen::AngleAxisd(1.2, Eigen::Vector3d(1, 2, -2).normalized()).toRotationMatrix();
  for (const Matrix& F : some_gradients())
    EXPECT_LE((cauchy(GetParam(), R * F) - R * cauchy(GetParam(), F) * R.transpose()).norm(), 1e-11);
}

TEST_P(FemLaw, HasNoStressAtRest) {
  const Matrix R = Eigen::AngleAxisd(0.8, Eigen::Vector3d::UnitY()).toRotationMatrix();
  EXPECT_LE(cauchy(GetParam(), R).norm(), test::round_off);
}

INSTANTIATE_TEST_SUITE_P(Laws, FemLaw, testing::ValuesIn(all_laws));

TEST(FemLaws, AgreeWithClosedFormsInTriaxialStretch) {
  const Eigen::Vector3d stretch(1.3, 0.9, 0.8);
  const Matrix F = stretch.asDiagonal();
  const double J = stretch.prod(), l = 1.3;
  EXPECT_NEAR(cauchy(Law::hencky, F)(0, 0), (2 * mu * std::log(l) + lambda * std::log(J)) / J, test::round_off);
  EXPECT_NEAR(cauchy(Law::log_cauchy, F)(0, 0), 2 * mu * std::log(l) + lambda * std::log(J), test::round_off);
  EXPECT_NEAR(cauchy(Law::neo_hooke, F)(0, 0), (mu * (l * l - 1) + lambda * std::log(J)) / J, test::round_off);
  const double K = lambda + 2 * mu / 3, third = stretch.squaredNorm() / 3;
  EXPECT_NEAR(cauchy(Law::neo_hooke_isochoric, F)(0, 0), mu * std::pow(J, -5. / 3) * (l * l - third) + K * (J - 1),
              test::round_off);
  const double trace_E = (stretch.squaredNorm() - 3) / 2;
  EXPECT_NEAR(cauchy(Law::st_venant_kirchhoff, F)(0, 0), l * l * (mu * (l * l - 1) + lambda * trace_E) / J,
              test::round_off);
}

TEST(FemLaws, LeaveTheSidesOfABarFree) {
  for (const char* name : {"hencky", "log_cauchy", "neo_hooke", "neo_hooke_isochoric", "st_venant_kirchhoff"})
    for (double nu : {-0.5, 0.0, 0.3, 0.499})
      for (double l : {0.8, 1.2}) {
        const IsotropicMaterial m{10, nu, 1};
        const auto [t, stress] = test::uniaxial(name, m, l);
        const Matrix F = Eigen::Vector3d(t, t, l).asDiagonal();
        const Law law = *fem::law_named(name);
        const double p = fem::pressure(law, lame_lambda(m), fem::dilatation(law, F)).value;
        const Matrix S = tensor(fem::respond(law, shear_modulus(m), p, F).S);
        EXPECT_NEAR(l * S(2, 2), stress, 1e-10 * m.youngs_modulus) << name << " nu " << nu;
        EXPECT_NEAR(S(0, 0), 0, 1e-10 * m.youngs_modulus) << name << " nu " << nu;
      }
}

TEST(FemLaws, NeoHookeIsochoricIsTheSlopeOfItsEnergy) {
  const double K = lambda + 2 * mu / 3, step = 1e-5;
  const auto energy = [&](const Matrix& F) {
    const double J = F.determinant();
    return mu / 2 * (std::pow(J, -2. / 3) * F.squaredNorm() - 3) + K / 2 * (J - 1) * (J - 1);
  };
  for (const Matrix& F : some_gradients()) {
    const Matrix P = F * tensor(at(Law::neo_hooke_isochoric, F).S);
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) {
        Matrix h = Matrix::Zero();
        h(i, j) = step;
        EXPECT_NEAR(P(i, j), (energy(F + h) - energy(F - h)) / (2 * step), test::finite_difference * mu);
      }
  }
}

TEST(FemLaws, AreFoundByName) {
  EXPECT_EQ(fem::law_named("neo_hooke"), Law::neo_hooke);
  EXPECT_FALSE(fem::law_named("linear"));
  EXPECT_EQ(fem::law_names(), "hencky, log_cauchy, neo_hooke, neo_hooke_isochoric, st_venant_kirchhoff");
}

}  // namespace
}  // namespace springproof::laws_test
