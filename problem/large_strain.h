// Names of the laws of large strain: the reference's, and in case files `kinematics`.
#pragma once

#include <array>

namespace springproof {

/// In the order of fem::Law (fem_reference/elements/laws.h), which says what each is.
inline constexpr std::array<const char*, 5> laws_of_large_strain = {"hencky", "log_cauchy", "neo_hooke",
                                                                    "neo_hooke_isochoric", "st_venant_kirchhoff"};

}  // namespace springproof
