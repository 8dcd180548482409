// Finite element reference values of the bench of engines, computed by springproof-fem on three grids.
#pragma once

#include "comparisons/bench/engine_bar.h"
#include "comparisons/judge/reference_value.h"

namespace springproof::bench {

/// The measure of a load (measure_of()) in the limit of three grids, small strains.
/// @throws std::runtime_error if springproof-fem fails.
ReferenceValue bar_reference(BarLoad load, double poisson_ratio);

/// The first bending frequency of the clamped bar [Hz].
ReferenceValue bar_frequency(double poisson_ratio);

}  // namespace springproof::bench
