// Pseudo-random vectors, the same on every machine.
#pragma once

#include <cstdint>
#include <type_traits>

namespace springproof {

/// Fills with numbers from [-1/2, 1/2), by a linear congruential generator that starts anew.
template <class Range>
void fill_with_noise(Range&& values) {
  std::uint32_t state = 1;
  for (auto& value : values) {
    using Real = std::remove_reference_t<decltype(value)>;
    state = 1664525u * state + 1013904223u;
    value = static_cast<Real>(state) / static_cast<Real>(4294967296) - static_cast<Real>(0.5);
  }
}

}  // namespace springproof
