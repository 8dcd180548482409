// The inverse root of the kernels, as the inverse lengths that the list kernels store.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "msm/kernels/kernels.h"

namespace springproof::inverse_root_test {
namespace {

/// 1 / length of springs along x, by the kernel of an instruction set.
template <class Real>
std::vector<Real> inverse_lengths(InstructionSet set, std::vector<Real> lengths) {
  while (lengths.size() % (block_springs * blocks_together) != 0) lengths.push_back(1);
  const std::size_t entries = lengths.size();
  std::vector<Padded<Real>> x = {{}};  // the first node of all springs
  std::vector<int> i(entries / block_springs, 0), j;
  for (const Real length : lengths) {
    j.push_back(static_cast<int>(x.size()));
    x.push_back({{length, 0, 0, 0}});
  }
  const std::vector<Real> zeros(entries, 0);
  std::vector<Real> J(x.size(), 0), inverse(entries);
  kernels_of<Real>(set).list.inflow(
      {static_cast<long>(i.size()), i.data(), j.data()}, {zeros.data(), zeros.data(), zeros.data()},
      {zeros.data(), zeros.data(), zeros.data(), zeros.data()}, x.data(), J.data(), inverse.data());
  return inverse;
}

/// Lengths whose squares are exact, from the smallest normal square to the largest, or of subnormal squares.
template <class Real>
std::vector<Real> lengths_of_every_exponent(bool subnormal) {
  using Limits = std::numeric_limits<Real>;
  const int digits = Limits::digits / 2, half = (1 - Limits::min_exponent) / 2, smallest = (Limits::digits - 1) / 2;
  std::vector<Real> all;
  for (int exponent = subnormal ? -half - smallest : -half; exponent < (subnormal ? -half : half); ++exponent)
    for (int m = 0; m < 199; ++m) {
      const Real mantissa =
          subnormal ? Real(1) : Real(1) + std::ldexp(std::floor(std::ldexp(Real(m) / 199, digits - 1)), 1 - digits);
      all.push_back(std::ldexp(mantissa, exponent));
    }
  return all;
}

template <class Real>
void expect_two_units(InstructionSet set) {
  for (const bool subnormal : {false, true}) {
    const std::vector<Real> lengths = lengths_of_every_exponent<Real>(subnormal);
    const std::vector<Real> inverse = inverse_lengths(set, lengths);
    Real worst = 0;
    for (std::size_t n = 0; n < lengths.size(); ++n) worst = std::fmax(worst, std::abs(inverse[n] * lengths[n] - 1));
    EXPECT_LE(worst, 2 * std::numeric_limits<Real>::epsilon()) << name_of(set) << ", subnormal: " << subnormal;
  }
}

}  // namespace

TEST(InverseRoot, IsExactToTwoUnitsForSquaresOfEveryExponent) {
  for (const InstructionSet set : usable_instruction_sets()) {
    expect_two_units<double>(set);
    expect_two_units<float>(set);
  }
}

TEST(InverseRoot, IsNotFiniteAtZeroAndOfOverflowingSquaresNotPositive) {
  for (const InstructionSet set : usable_instruction_sets()) {
    const std::vector<double> inverse = inverse_lengths<double>(set, {0, 1e200});
    EXPECT_FALSE(std::isfinite(inverse[0])) << name_of(set);
    EXPECT_FALSE(inverse[1] > 0) << name_of(set);
  }
}

}  // namespace springproof::inverse_root_test
