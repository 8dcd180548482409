// Relaxation: branches over time steps beside their closed forms.
#include "problem/relaxation.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

namespace springproof::relaxation_test {
namespace {

const Relaxation two{{{0.116, 0.27}, {0.057, 2.6}}};

TEST(BranchStep, ARampAndAHoldAreExactAtAnyStep) {
  for (const double time : {1.4e-3, 0.27, 2.6})
    for (const double dt : {0.5, 0.1, 1e-2, 1e-6}) {
      const BranchStep step = BranchStep::of(dt / time);
      double Q = 0, E = 0;
      const double rate = 3;
      for (int n = 1; n <= 10; ++n) {
        const double before = Q;
        Q = step.end(before, rate * dt);
        E += rate * dt;
        const double exact = -rate * time * std::expm1(-n * dt / time);
        EXPECT_NEAR(Q, exact, 1e-14 * rate * time) << time << " " << dt;
        const auto integral = [&](double t) { return rate * time * (t + time * std::expm1(-t / time)); };
        const double mean = (integral(n * dt) - integral((n - 1) * dt)) / dt;
        EXPECT_NEAR(step.mean(before, rate * dt), mean, 1e-9 * rate * time) << time << " " << dt;  // cancels
      }
      const double held = Q;
      for (int n = 1; n <= 10; ++n) {
        Q = step.end(Q, 0.0);
        EXPECT_NEAR(Q, held * std::exp(-n * dt / time), 1e-14 * rate * time);
      }
    }
}

TEST(BranchStep, TheSeriesMeetsTheFormulaAndTheLimitsAreMidpointAndDashpot) {
  const BranchStep below = BranchStep::of(0.999999e-3), above = BranchStep::of(1.000001e-3);
  EXPECT_NEAR(above.psi, below.psi, 1e-9);
  EXPECT_EQ(BranchStep::of(0).psi, 0.5);
  EXPECT_EQ(BranchStep::of(0).phi, 1);
  const BranchStep dashpot = BranchStep::of(1e8);
  EXPECT_NEAR(dashpot.mean(0.0, 2.0), 2e-8, 1e-14);
  EXPECT_EQ(dashpot.decay, 0);
}

TEST(BranchStep, DissipatesAtAnyStepWhateverTheStrainDoes) {
  for (const double x : {1e-6, 1e-3, 0.1, 1.0, 30.0})
    for (const double Q : {-1.0, 0.0, 0.4})
      for (const double change : {-0.7, 0.0, 1e-3, 2.0}) {
        const BranchStep step = BranchStep::of(x);
        const double end = step.end(Q, change), work = step.mean(Q, change) * change;
        EXPECT_GE(work - (end * end - Q * Q) / 2, -1e-15) << x << " " << Q << " " << change;
      }
}

/// The strain under a constant stress, solved for in each step; the largest error of the stress at its ends.
double creep_error(double dt) {
  std::vector<double> Q(two.branches.size(), 0.0);
  double E = 0, worst = 0;
  // Held until the branches carry their share: E is the strain of a sudden stress 1.
  E = 1 / two.instantaneous();
  for (double& q : Q) q = E;
  for (int n = 0; n < std::lround(4 / dt); ++n) {
    double known = 0, slope = 1;  // mean stress of the step = (E0 + E1) / 2 + sum of shares of the means = 1
    for (std::size_t i = 0; i < Q.size(); ++i) {
      const BranchStep step = BranchStep::of(dt / two.branches[i].time);
      known += two.branches[i].share * step.phi * Q[i];
      slope += 2 * two.branches[i].share * step.psi;
    }
    const double change = 2 * (1 - E - known) / slope;
    double stress = E += change;
    for (std::size_t i = 0; i < Q.size(); ++i) {
      Q[i] = BranchStep::of(dt / two.branches[i].time).end(Q[i], change);
      stress += two.branches[i].share * Q[i];
    }
    worst = std::max(worst, std::abs(stress - 1));
  }
  return worst;
}

TEST(BranchStep, CreepUnderAConstantMeanStressIsOfSecondOrder) {
  const double coarse = creep_error(0.1), fine = creep_error(0.05);
  EXPECT_NEAR(std::log2(coarse / fine), 2, 0.15);
  EXPECT_LT(fine, 1e-2);
}

TEST(Relaxation, CreepsByTheRetardationsOfItsBranches) {
  const Relaxation one{{{0.25, 2}}};  // a standard linear solid: retardation 2 * 1.25
  for (const double t : {0.0, 0.3, 4.0}) EXPECT_NEAR(one.creep_after(t), 1 - 0.2 * std::exp(-t / 2.5), 1e-14) << t;
  EXPECT_NEAR(two.creep_after(0), 1 / 1.173, 1e-14);
  EXPECT_EQ(two.creep_after(std::numeric_limits<double>::infinity()), 1);
  std::vector<double> Q(2, 1 / 1.173);
  double E = 1 / 1.173;
  const double dt = 1e-3;
  for (int n = 0; n < 4000; ++n) {  // of second order
    double known = 1 - E, slope = 1;
    for (std::size_t i = 0; i < 2; ++i) {
      const BranchStep step = BranchStep::of(dt / two.branches[i].time);
      known -= two.branches[i].share * step.decay * Q[i];
      slope += two.branches[i].share * step.phi;
    }
    const double change = known / slope;
    E += change;
    for (std::size_t i = 0; i < 2; ++i) Q[i] = BranchStep::of(dt / two.branches[i].time).end(Q[i], change);
  }
  EXPECT_NEAR(two.creep_after(4), E, 1e-7);
}

TEST(Relaxation, ModuliAreThoseOfItsBranches) {
  EXPECT_DOUBLE_EQ(two.instantaneous(), 1.173);
  EXPECT_NEAR(two.modulus_after(0.27), 1 + 0.116 / std::exp(1) + 0.057 * std::exp(-0.27 / 2.6), 1e-15);
  EXPECT_NEAR(two.storage(1e9), 1.173, 1e-12);
  EXPECT_EQ(two.storage(0), 1);
  const double w = 1 / 0.27;
  EXPECT_NEAR(two.loss(w), 0.116 / 2 + 0.057 * w * 2.6 / (1 + w * w * 2.6 * 2.6), 1e-15);
  const IsotropicMaterial material{1e5, 0.3, 1000}, sudden = with_shear(material, 1.173);
  EXPECT_NEAR(shear_modulus(sudden), 1.173 * shear_modulus(material), 1e-9);
  EXPECT_NEAR(bulk_modulus(sudden), bulk_modulus(material), 1e-9);
}

}  // namespace
}  // namespace springproof::relaxation_test
