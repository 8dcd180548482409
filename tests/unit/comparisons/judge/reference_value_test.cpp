#include "comparisons/judge/reference_value.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

namespace springproof::reference_value_test {
namespace {

std::vector<double> sequence(double limit, double error, double order) {
  return {limit + error, limit + error / std::pow(2, order), limit + error / std::pow(4, order)};
}

TEST(ReferenceValue, RecoversLimitAndOrder) {
  for (double order : {0.7, 1.4, 2.0}) {
    const ReferenceValue v = extrapolate(sequence(7.5, -0.3, order), 1e-12);
    ASSERT_TRUE(v.observed_order);
    EXPECT_NEAR(*v.observed_order, order, 1e-9);
    EXPECT_NEAR(v.value, 7.5, 1e-9);
    // GCI: Fs times the finest grid's own error
    EXPECT_NEAR(v.uncertainty, 1.25 * 0.3 / std::pow(4, order), 1e-9);
  }
}

TEST(ReferenceValue, RecoversLimitAndOrderOnGridsOfAnyRatios) {
  for (const GridRatios r : {GridRatios{1.5, 1.5}, GridRatios{1.3, 1.7}, GridRatios{2, 1.2}}) {
    const double p = 1.6, h3 = 0.1, h2 = r.fine * h3, h1 = r.coarse * h2;
    const auto f = [&](double h) { return 7.5 - 3 * std::pow(h, p); };
    const ReferenceValue v = extrapolate({f(h1), f(h2), f(h3)}, 1e-12, {}, r);
    ASSERT_TRUE(v.observed_order);
    EXPECT_NEAR(*v.observed_order, p, 1e-9);
    EXPECT_NEAR(v.value, 7.5, 1e-9);
    EXPECT_NEAR(v.uncertainty, 1.25 * 3 * std::pow(h3, p), 1e-9);
  }
}

TEST(ReferenceValue, TwoGridsAreOfFirstOrder) {
  const ReferenceValue v = extrapolate_two(1 + 0.4, 1 + 0.2);
  EXPECT_NEAR(v.value, 1, 1e-15);
  EXPECT_NEAR(v.uncertainty, 3 * 0.2, 1e-15);
  EXPECT_FALSE(v.observed_order);
}

TEST(ReferenceValue, DoesNotTrustHighOrders) {
  // Two grids that happen to agree look like a high order: torsion at nu = 0.499 showed 5.4 on grids up to 8^3, and was
  // off by 27 times an uncertainty that believed it.  Then the first difference counts, at the order that is believed.
  for (const double order : {2.3, 3.0, 5.0}) {
    const ReferenceValue v = extrapolate(sequence(1, 0.1, order), 0);
    EXPECT_NEAR(*v.observed_order, order, 1e-6);
    const double first = 0.1 * (1 - std::pow(2, -order)), last = 0.1 * (std::pow(2, -order) - std::pow(4, -order));
    EXPECT_NEAR(v.value, 1 + 0.1 / std::pow(4, order) - last / 3, 1e-12);
    EXPECT_NEAR(v.uncertainty, 1.25 * first / (3 * 4), 1e-12);
    EXPECT_NE(v.note.find("order too high"), std::string::npos);
  }
}

TEST(ReferenceValue, TrustsTheElementsOrderInASmoothSolution) {
  const auto first = [](double order) { return 0.1 * (1 - std::pow(2, -order)); };
  const auto uncertainty = [](double order, const std::string& measure, const std::string& element) {
    return extrapolate(sequence(1, 0.1, order), 0, trusted_orders(measure, element, true)).uncertainty;
  };
  const std::string u = "displacement.tip.x", stress = "stress.tip.xx";
  EXPECT_NEAR(uncertainty(3, u, "q2"), 1.25 * 0.1 / 64, 1e-12);
  EXPECT_NEAR(uncertainty(4, u, "q2"), 1.25 * first(4) / (7 * 8), 1e-12);  // at nodes: not believed
  EXPECT_NEAR(uncertainty(3, stress, "p2"), 1.25 * first(3) / (3 * 4), 1e-12);
  EXPECT_NEAR(uncertainty(2, u, "p1"), 1.25 * 0.1 / 16, 1e-12);
  EXPECT_NEAR(uncertainty(2, stress, "q1"), 1.25 * first(2) / (1 * 2), 1e-12);
  EXPECT_NEAR(uncertainty(3, "volume_change", "q2"), 1.25 * first(3) / (3 * 4), 1e-12);
}

TEST(ReferenceValue, SmoothnessMustBeStated) {
  for (const char* measure : {"displacement.tip.x", "stress.tip.xx", "volume_change"})
    EXPECT_EQ(trusted_orders(measure, "q2", false).highest, 2);
}

TEST(ReferenceValue, TheFirstDifferenceOfDisplacementsFallsWithTheElementsOrder) {
  // An organ held on a smooth surface: its coarsest mesh is 3 % off, the observed order 4.
  const auto of = [](double order) {
    return extrapolate(sequence(1, 0.1, order), 0, trusted_orders("displacement.tip.x", "p2", false));
  };
  const auto last = [](double order) { return 0.1 * (std::pow(2, -order) - std::pow(4, -order)); };
  EXPECT_NEAR(of(2.5).uncertainty, 1.25 * std::max(last(2.5) / 3, 0.1 / std::pow(4, 2.5)), 1e-12);
  EXPECT_NEAR(of(5).uncertainty, 1.25 * 0.1 * (1 - std::pow(2, -5)) / (7 * 8), 1e-12);
  EXPECT_NEAR(of(5).value, 1 + 0.1 / std::pow(4, 5) + last(5) * -1 / 3, 1e-12) << "the limit is still of second order";
}

TEST(ReferenceValue, ElementsThatMayLockCanBeSlowerThanFirstOrder) {
  for (const char* element : {"p1", "q1"})
    EXPECT_EQ(trusted_orders("displacement.tip.x", element, false).lowest, TrustedOrders{}.lowest);
  for (const char* element : {"p2", "q2"}) EXPECT_EQ(trusted_orders("displacement.tip.x", element, false).lowest, 1);
}

TEST(ReferenceValue, DisplacementsAreOfFirstOrderAtLeast) {
  // A scanned bunny: three meshes differ by 0.5 and 0.5 %, the finest is 0.3 % off.
  const auto of = [](const std::string& measure, double order) {
    return extrapolate(sequence(1, 0.1, order), 0, trusted_orders(measure, "p2", false));
  };
  const double first = 0.1 * (1 - std::pow(2, -0.7)), last = first * std::pow(2, -0.7);
  const ReferenceValue slow = of("mean_displacement.load.z", 0.7);
  EXPECT_FALSE(slow.observed_order);
  EXPECT_NEAR(slow.uncertainty, 1.25 * (first + last), 1e-12);
  EXPECT_NEAR(of("force.hold.z", 0.7).value, 1, 1e-9);
  EXPECT_NEAR(of("displacement.tip.x", 1.1).value, 1, 1e-9);
}

TEST(ReferenceValue, SlowConvergenceIsNotExtrapolated) {
  const ReferenceValue v = extrapolate(sequence(1, 0.1, 0.2), 0);
  EXPECT_FALSE(v.observed_order);
  EXPECT_GE(v.uncertainty, 0.25 * 0.1 / std::pow(4, 0.2));
}

TEST(ReferenceValue, SaysWhenItIsNotMonotone) {
  const auto of = [](std::vector<double> values) {
    const ReferenceValue v = extrapolate(values, 0);
    EXPECT_FALSE(v.observed_order);
    EXPECT_EQ(v.value, values.back());
    EXPECT_EQ(v.sequence, Sequence::not_converging);
    EXPECT_TRUE(v.note.starts_with("not converging")) << v.note;
    return v.uncertainty;
  };
  EXPECT_NEAR(of({1, 2, 1.5}), 1.25 * 0.5, 1e-12);   // the last difference
  EXPECT_NEAR(of({1, 2, 1.9}), 1.25 * 0.25, 1e-12);  // what two halvings leave of the first, at first order
  EXPECT_GE(of({1, 1.1, 1.3}), 1.25 * 0.3);          // growing differences: the spread
}

TEST(ReferenceValue, GridsThatAreNotRefinedAreNotExtrapolated) {
  // Three meshes of a sphere of facets, held and under gravity, came out with 4132, 3719 and 3837 tetrahedra.
  for (const GridRatios r : {GridRatios{0.97, 1.01}, GridRatios{1.19, 1.5}, GridRatios{1.5, 1.19}, GridRatios{1, 1}}) {
    const ReferenceValue v = extrapolate({1.00, 1.02, 1.03}, 0, {}, r);
    EXPECT_EQ(v.value, 1.03);
    EXPECT_NEAR(v.uncertainty, 3 * 0.03, 1e-12);
    EXPECT_FALSE(v.observed_order);
    EXPECT_EQ(v.sequence, Sequence::not_converging);
    EXPECT_TRUE(v.note.starts_with("not refined: ratio " + fmt::format("{:.2f}", std::min(r.coarse, r.fine))))
        << v.note;
  }
  EXPECT_EQ(extrapolate({1.00, 1.02, 1.03}, 0, {}, {1.5, 1.5}).sequence, Sequence::converging);
}

TEST(ReferenceValue, UncertaintyCoversTheStep) {
  for (const double ratio : {1.2, 1.3, 1.5, 2.0, 3.0})
    for (double quotient = 0.05; quotient < 100; quotient *= 1.3) {
      const std::vector<double> values = {0, quotient, quotient + 1};
      const ReferenceValue v = extrapolate(values, 0, {}, {ratio, ratio});
      EXPECT_GE(v.uncertainty, std::abs(v.value - values.back())) << ratio << ' ' << quotient;
    }
}

TEST(ReferenceValue, StepsNoFurtherThanTheGridsAreApart) {
  for (const double ratio : {1.2, 1.5, 2.0})
    for (double quotient = 0.05; quotient < 100; quotient *= 1.3) {
      const std::vector<double> values = {0, quotient, quotient + 1};
      EXPECT_LE(std::abs(extrapolate(values, 0, {}, {ratio, ratio}).value - values.back()), quotient + 1 + 1e-12);
    }
  // Slower than that: not a limit, and its uncertainty is what the order says, not only the spread.
  const double p = 0.6, r = 1.5, h = std::pow(r, -p);
  const ReferenceValue slow = extrapolate({1, h, h * h}, 0, {}, {r, r});
  EXPECT_EQ(slow.sequence, Sequence::not_converging);
  EXPECT_EQ(slow.value, h * h);
  EXPECT_GE(slow.uncertainty, h * h);
}

TEST(ReferenceValue, RoundOffIsNotAnOrder) {
  const ReferenceValue v = extrapolate({5.0, 5.0 + 1e-10, 5.0 - 1e-10}, 1e-9);
  EXPECT_FALSE(v.observed_order);
  EXPECT_EQ(v.uncertainty, 1e-9);
}

TEST(ReferenceValue, NeedsThreeGrids) { EXPECT_THROW(extrapolate({1, 2}, 0), std::invalid_argument); }

TEST(ReferenceValue, NoneIsSurerThanUsualOfItsKind) {
  // One probe's three grids agree by accident; beside it two that are known to 1 % of their displacement.
  std::map<std::string, ReferenceValue> limits = {
      {"displacement.A.x", {1, 0.01, 2, ""}},           {"displacement.A.y", {0, 0.01, 2, ""}},
      {"displacement.B.x", {3, 0.04, 2, ""}},           {"displacement.B.y", {4, 0.05, 2, ""}},
      {"displacement.C.x", {0.2, 1e-6, 2, ""}},         {"displacement.C.y", {0, 1e-9, {}, "", Sequence::equal}},
      {"displacement.C.magnitude", {0.2, 1e-6, 2, ""}}, {"force.top.x", {7, 1e-5, 2, ""}},
      {"force.base.magnitude", {-0.109, 0.465, 2, ""}}, {"mean_displacement.held.x", {1e-19, 4e-5, 2, ""}},
      {"mean_displacement.held.y", {0, 4e-5, 2, ""}},   {"mean_displacement.free.x", {2, 0.01, 2, ""}}};
  raise_to_usual(limits);
  EXPECT_NEAR(limits.at("mean_displacement.free.x").uncertainty, 0.01, 1e-15) << "held: smaller than its uncertainty";
  EXPECT_NEAR(limits.at("displacement.C.x").uncertainty, 0.01 * 0.2, 1e-15);
  EXPECT_NEAR(limits.at("displacement.C.magnitude").uncertainty, 0.01 * 0.2, 1e-15);
  EXPECT_EQ(limits.at("displacement.C.y").uncertainty, 1e-9);  // equal on all grids: known, not lucky
  EXPECT_NEAR(limits.at("displacement.B.x").uncertainty, 0.05, 1e-15);
  EXPECT_EQ(limits.at("force.top.x").uncertainty, 1e-5);  // forces are of another kind
  EXPECT_EQ(limits.at("force.base.magnitude").value, 0) << "extrapolated below 0";
}

TEST(ReferenceField, RecoversTheLimitField) {
  const NodalVectors limit = NodalVectors::Random(50, 3), error = 0.1 * NodalVectors::Random(50, 3);
  const Eigen::VectorXd weights = Eigen::VectorXd::Random(50).cwiseAbs() + Eigen::VectorXd::Ones(50);
  const ReferenceField f =
      extrapolate(std::vector<NodalVectors>{limit + error, limit + error / 4, limit + error / 16}, weights);
  EXPECT_NEAR(*f.observed_order, 2, 1e-9);
  EXPECT_LE((f.displacement - limit).norm(), 1e-12);
  const double step = 1.25 * weighted_norm(error, weights) / 16 / weighted_norm(limit + error / 16, weights);
  EXPECT_GE(f.uncertainty, step);
  EXPECT_LE(f.uncertainty, step + solver_noise);
}

/// Differences of `first` and 1/4 m, of this correlation.
std::vector<NodalVectors> fields_of(double correlation, NodalVectors& limit, double first = 1) {
  limit = NodalVectors::Constant(40, 3, 5);
  NodalVectors along = NodalVectors::Zero(40, 3), across = NodalVectors::Zero(40, 3);
  along.col(0).setOnes();
  across.col(1).setOnes();
  const NodalVectors u3 = limit - along / 12, u2 = u3 - along / 4;
  return {u2 - first * (correlation * along + std::sqrt(1 - correlation * correlation) * across), u2, u3};
}

TEST(ReferenceField, IsExtrapolatedOnlyWhereItsDifferencesPointTheSameWay) {
  const Eigen::VectorXd weights = Eigen::VectorXd::Ones(40);
  NodalVectors limit;
  for (const double correlation : {-1.0, -0.5, 0.0, 0.4}) {
    const auto fields = fields_of(correlation, limit);
    const ReferenceField f = extrapolate(fields, weights);
    EXPECT_EQ(f.displacement, fields[2]);
    EXPECT_EQ(f.sequence, Sequence::converging);  // but its limit is not where they point
    EXPECT_TRUE(f.note.starts_with("the grids' differences point apart")) << f.note;
    EXPECT_NEAR(f.correlation.value(), correlation, 1e-12);
    EXPECT_NEAR(f.nodal_uncertainty.minCoeff(), 1.25 * 0.25, 1e-6);  // Fs times the last difference: first order
    const ReferenceField slow =
        extrapolate(fields_of(correlation, limit, 0.4), weights);  // falls more slowly than that
    EXPECT_EQ(slow.sequence, Sequence::not_converging);
    EXPECT_TRUE(slow.note.starts_with("not converging")) << slow.note;
    EXPECT_GE(slow.nodal_uncertainty.minCoeff(), 1.25 * 0.4);  // Fs times the largest difference
  }
  const ReferenceField f = extrapolate(fields_of(1, limit), weights);
  EXPECT_EQ(f.sequence, Sequence::converging);
  EXPECT_LE((f.displacement - limit).norm(), 1e-12);
  // Only what points along counts as convergence: a lower order, a larger uncertainty.
  const ReferenceField askew = extrapolate(fields_of(0.8, limit), weights);
  EXPECT_EQ(askew.sequence, Sequence::converging);
  EXPECT_NEAR(askew.observed_order.value(), std::log2(0.8 * 4), 1e-9);
  EXPECT_GT(askew.uncertainty, f.uncertainty);
}

TEST(ReferenceField, OfQuadraticElementsMayFallWithTheirOwnOrderAndNotSlowerThanTheFirst) {
  NodalVectors limit;
  const Eigen::VectorXd weights = Eigen::VectorXd::Ones(40);
  const TrustedOrders quadratic = trusted_orders("displacement", "p2", false);
  const auto fast = fields_of(1, limit, 2), slow = fields_of(1, limit, 0.4);  // orders 3 and 0.7
  EXPECT_NEAR(extrapolate(fast, weights).nodal_uncertainty.minCoeff(), 1.25 * 2 / 12, 1e-6);
  EXPECT_NEAR(extrapolate(fast, weights, {}, 0, quadratic).nodal_uncertainty.minCoeff(), 1.25 * 0.25 / 3, 1e-6);
  EXPECT_EQ(extrapolate(slow, weights).sequence, Sequence::converging);
  const ReferenceField own = extrapolate(slow, weights, {}, 0, quadratic);
  EXPECT_EQ(own.sequence, Sequence::not_converging);
  EXPECT_NEAR(own.nodal_uncertainty.minCoeff(), 1.25 * 0.65, 1e-6);
}

TEST(ReferenceField, DoesNotConvergeWhereTheScalarsDoNot) {
  NodalVectors limit;
  const auto fields = fields_of(1, limit);
  const ReferenceField sure = extrapolate(fields, Eigen::VectorXd::Ones(40));
  const ReferenceField same = extrapolate(fields, Eigen::VectorXd::Ones(40), {}, 0.9 * sure.uncertainty);
  EXPECT_EQ(same.sequence, Sequence::converging) << "doubt of less than the field itself states";
  EXPECT_EQ(same.uncertainty, sure.uncertainty);
  const ReferenceField f = extrapolate(fields, Eigen::VectorXd::Ones(40), {}, 1.1 * sure.uncertainty);
  EXPECT_EQ(f.displacement, fields[2]);
  EXPECT_FALSE(f.observed_order);
  EXPECT_EQ(f.sequence, Sequence::not_converging);
  EXPECT_NEAR(f.nodal_uncertainty.minCoeff(), 1.25 * 0.25, 1e-6);  // falls at first order
  const ReferenceField slow = extrapolate(fields_of(1, limit, 0.4), Eigen::VectorXd::Ones(40), {}, 1);
  EXPECT_GE(slow.nodal_uncertainty.minCoeff(), 1.25 * 0.4);
  const ReferenceField dubious = extrapolate(fields, Eigen::VectorXd::Ones(40), {}, 10);
  EXPECT_NEAR(dubious.uncertainty, 10, 1e-6);
  EXPECT_GE(extrapolate({fields[0], fields[2], fields[2]}, Eigen::VectorXd::Ones(40), {}, 10).uncertainty,
            10);  // no last difference
}

TEST(ReferenceField, IsInDoubtWhereMostValuesThatMatterDoNotConverge) {
  const ReferenceValue good{1, 0.1, 2, ""}, bad{2, 0.1, {}, "", Sequence::not_converging},
      small{1, 0.1, {}, "", Sequence::not_converging, false};
  EXPECT_EQ(doubt_of({{"force.a.x", good}, {"force.a.y", small}, {"force.b.y", small}}), 0);
  EXPECT_EQ(doubt_of({{"force.a.x", good}, {"force.a.y", bad}, {"force.b.y", bad}}), 0.05);
  EXPECT_EQ(doubt_of({}), 0);
}

TEST(ReferenceField, StressesHaveNoVoteOnDisplacements) {
  const ReferenceValue good{1, 0.1, 2, ""}, bad{2, 3, {}, "", Sequence::not_converging};
  EXPECT_EQ(doubt_of({{"displacement.a.x", good}, {"stress.a.xx", bad}, {"stress.a.yy", bad}}), 0);
  EXPECT_EQ(doubt_of({{"displacement.a.x", bad}, {"stress.a.xx", good}, {"stress.a.yy", good}}), 1.5);
}

TEST(ReferenceField, GridsThatAreNotRefinedAreNotExtrapolated) {
  NodalVectors limit;
  const auto fields = fields_of(1, limit);
  const ReferenceField f = extrapolate(fields, Eigen::VectorXd::Ones(40), {0.97, 1.01});
  EXPECT_EQ(f.displacement, fields[2]);
  EXPECT_EQ(f.sequence, Sequence::not_converging);
  EXPECT_TRUE(f.note.starts_with("not refined: ratio 0.97")) << f.note;
  EXPECT_GE(f.nodal_uncertainty.minCoeff(), 3 * 1.25);
}

}  // namespace
}  // namespace springproof::reference_value_test
