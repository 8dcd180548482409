// Tolerances with names; every other tolerance in a test stands beside its reason.
#pragma once

namespace springproof::test {

inline constexpr double round_off = 1e-12;         ///< closed forms, relative
inline constexpr double finite_difference = 1e-6;  ///< central differences against exact derivatives, relative
inline constexpr double patch_test = 1e-10;        ///< affine fields reproduced, relative

}  // namespace springproof::test
