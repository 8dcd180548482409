// One range of sizes for every body, in cases, commands and libraries.
#pragma once

namespace springproof {

/// The longest side [m].  Products of a few lengths, moduli and densities then stay finite, and springs files can be
/// read again; 1e9 is also the largest coordinate.
inline constexpr double smallest_body = 1e-6, largest_body = 1e9;

}  // namespace springproof
