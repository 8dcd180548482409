// Least squares on functions whose parameters, uncertainties and directions are known.
#include "comparisons/identify/least_squares.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace springproof::least_squares_test {
namespace {

using Eigen::Index, Eigen::VectorXd;

/// A bar's sags under three loads, twice, and its frequencies: in ln E (p0), ln density (p1) and ratio (p2).
VectorXd bar(const VectorXd& p) {
  const double E = std::exp(p[0]), density = p.size() > 1 ? std::exp(p[1]) : 1;
  const double softer = p.size() > 2 ? 1 - 0.3 * p[2] : 1;
  VectorXd values(6);
  for (Index i = 0; i < 3; ++i) {
    const double load = 1 + static_cast<double>(i), sag = load * softer / E;
    values[i] = sag / (1 + 0.1 * sag);
    values[3 + i] = std::sqrt(E / (density + load));
  }
  return values;
}

struct Data {
  VectorXd values, u;
};

BoundedFit problem(const Data& data, const VectorXd& start) {
  const Index n = start.size();
  const BoundedFit::Residuals residuals = [data](const VectorXd& p) {
    return std::optional<VectorXd>((bar(p) - data.values).cwiseQuotient(data.u));
  };
  return {residuals, start, VectorXd::Constant(n, -7), VectorXd::Constant(n, 7), VectorXd::Constant(n, 0.03)};
}

VectorXd vector(std::initializer_list<double> numbers) {
  VectorXd out(static_cast<Index>(numbers.size()));
  std::copy(numbers.begin(), numbers.end(), out.data());
  return out;
}

Data exact(const VectorXd& truth) {
  const VectorXd values = bar(truth);
  return {values, 0.03 * values};
}

TEST(LeastSquares, FindsTheTruthFromFarAway) {
  const VectorXd truth = vector({0.4, -0.3});
  for (const double from : {-3.0, -1.0, 0.5, 3.0}) {
    const LeastSquaresFit found = fit(problem(exact(truth), vector({from, from / 2})));
    EXPECT_TRUE(found.converged) << from << ' ' << found.message;
    EXPECT_NEAR(found.parameters[0], truth[0], 1e-3) << from;
    EXPECT_NEAR(found.parameters[1], truth[1], 3e-3) << from;
    EXPECT_LT(found.iterations, 12) << from;
  }
}

TEST(LeastSquares, StaysBetweenTheBounds) {
  BoundedFit p = problem(exact(vector({0.4, -0.3})), vector({0, 0}));
  p.upper[0] = 0.2;
  const LeastSquaresFit found = fit(p);
  EXPECT_TRUE(found.converged) << found.message;
  EXPECT_EQ(found.parameters[0], 0.2);
  const Eigen::MatrixXd J = *jacobian_of(p, found.parameters, found.residuals);
  EXPECT_NEAR(J.col(1).dot(found.residuals), 0, 0.02 * J.col(1).norm());  // the other is the best beside it
  EXPECT_LT(J.col(0).dot(found.residuals), -0.02 * J.col(0).norm());
}

TEST(LeastSquares, EndsWhereEveryParameterIsAtABound) {
  BoundedFit one = problem(exact(vector({3})), vector({0}));
  one.upper[0] = 1;
  const LeastSquaresFit fitted = fit(one);
  EXPECT_TRUE(fitted.converged) << fitted.message;
  EXPECT_DOUBLE_EQ(fitted.parameters[0], 1);
}

TEST(LeastSquares, GoesAroundParametersThatHaveNoResult) {
  BoundedFit p = problem(exact(vector({0.4, -0.3})), vector({-1, 0}));
  const BoundedFit::Residuals all = p.residuals;
  p.residuals = [all](const VectorXd& at) { return at[0] > 0.6 ? std::nullopt : all(at); };
  const LeastSquaresFit found = fit(p);
  EXPECT_TRUE(found.converged) << found.message;
  EXPECT_NEAR(found.parameters[0], 0.4, 1e-3);
  p.residuals = [all](const VectorXd& at) { return at[0] > 0.2 ? std::nullopt : all(at); };
  EXPECT_FALSE(fit(p).converged);  // short steps are no rest
  p.residuals = [](const VectorXd&) { return std::optional<VectorXd>(); };
  EXPECT_EQ(fit(p).message, "the model has no result at the start");
}

TEST(LeastSquares, LimitsOf95PercentHoldTheTruthIn95PercentOfSets) {
  constexpr int sets = 1000;
  const VectorXd truth = vector({0.4, -0.3});
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  int inside[2] = {0, 0};
  double chi2 = 0;
  for (int s = 0; s < sets; ++s) {
    Data data = exact(truth);
    for (Index i = 0; i < data.values.size(); ++i) data.values[i] += normal(random) * data.u[i];
    const BoundedFit p = problem(data, vector({0, 0}));
    const LeastSquaresFit found = fit(p);
    ASSERT_TRUE(found.converged) << found.message;
    const Certainty c = certainty_of(*jacobian_of(p, found.parameters, found.residuals));
    for (Index i = 0; i < 2; ++i) inside[i] += std::abs(found.parameters[i] - truth[i]) < 1.96 * c.u[i];
    chi2 += found.residuals.squaredNorm() / sets;
  }
  const double spread = std::sqrt(0.95 * 0.05 / sets);  // of a share of 95 %
  for (const int count : inside) EXPECT_NEAR(static_cast<double>(count) / sets, 0.95, 3 * spread);
  EXPECT_NEAR(chi2, 4, 3 * std::sqrt(8.0 / sets));  // six values, two parameters
}

TEST(Certainty, NamesTheDirectionThatNoResidualSees) {
  Eigen::MatrixXd J(3, 2);
  J << 3, 4, 6, 8, 9, 12;  // along (4, -3) / 5 nothing changes
  const Certainty c = certainty_of(J);
  EXPECT_GT(c.along[0], 1e6);
  EXPECT_NEAR(c.along[1], 1 / (5 * std::sqrt(14.0)), 1e-9);
  EXPECT_NEAR(std::abs(c.directions(0, 0)), 0.8, 1e-9);
  EXPECT_NEAR(c.directions(0, 0) * c.directions(1, 0), -0.48, 1e-9);
  EXPECT_NEAR(c.correlation(0, 1), -1, 1e-6);
}

TEST(HeldFit, HoldsWhatTheDataDoNotTellAndFitsTheRest) {
  // Without frequencies' help: sags alone see E and the ratio as one number.
  Data sags = exact(vector({0.4, -0.3, 0.5}));
  sags.u.tail(3).setConstant(1e9);
  BoundedFit p = problem(sags, vector({0, -0.3, 0.45}));
  p.lower[2] = 0;
  p.upper[2] = 0.5;
  const HeldFit found = fit_what_is_told(p);
  EXPECT_TRUE(found.fit.converged) << found.fit.message;
  EXPECT_EQ(found.held, (std::vector<bool>{false, true, true}));
  EXPECT_EQ(found.fit.parameters[2], 0.45);
  EXPECT_NEAR(found.fit.parameters[0], 0.4 + std::log((1 - 0.3 * 0.45) / (1 - 0.3 * 0.5)), 1e-3);
  EXPECT_EQ(found.jacobian.cols(), 3);
}

TEST(HeldFit, HoldsNothingThatTheDataTell) {
  BoundedFit p = problem(exact(vector({0.4, -0.3})), vector({-2, 1}));
  const HeldFit found = fit_what_is_told(p);
  EXPECT_EQ(found.held, (std::vector<bool>{false, false}));
  EXPECT_NEAR(found.fit.parameters[1], -0.3, 3e-3);
}

}  // namespace
}  // namespace springproof::least_squares_test
