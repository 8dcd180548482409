// How sure a reference is: three grids, observed order, Richardson limit, grid convergence index (GCI).
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "problem/vector.h"

namespace springproof {

/// A number with its uncertainty (about two standard deviations, in ASME V&V 20's sense).
struct ReferenceValue {
  double value = 0;
  double uncertainty = 0;
  std::optional<double> observed_order;  ///< empty: the sequence is not monotone
  std::string note;
};

inline constexpr double safety_factor = 1.25;   ///< Fs for three grids (Roache)

/// What is believed of the order that a sequence shows.  By default that of a body with clamped edges, which keep the
/// true order low whatever a sequence shows.
struct TrustedOrder {
  double highest = 2;       ///< a higher one is taken as this
  double suspicious = 2.5;  ///< beyond it two grids are likely to agree by accident
};

/// Orders of a scalar measure with an element ("q1", "q2", "p1", "p2").  In a smooth solution displacements converge with
/// degree + 1 and stresses with degree, at nodes with up to 2 degree; all else as with clamped edges.
TrustedOrder trusted_order(const std::string& measure, const std::string& element, bool smooth);

/// Cell sizes of the first grid over the second's, and of the second over the third's.
struct GridRatios {
  double coarse = 2, fine = 2;
};

/// Limit of a quantity computed on three grids (coarse to fine; the last three of more).
/// Monotone with an order p of 1/2 or more: Richardson extrapolation, uncertainty Fs |f3 - f2| / (ratio^p - 1), p taken as
/// at most `trusted.highest`; where it shows more than `trusted.suspicious` the uncertainty is Fs |f3 - f2|.
/// Otherwise the finest value, uncertainty Fs times the spread.  `noise`: round-off of the values.
ReferenceValue extrapolate(const std::vector<double>& values, double noise, const TrustedOrder& trusted = {}, const GridRatios& ratios = {});

/// Limit from grids of cell sizes h and h/2 alone, first order being assumed (edges of cubes and of supports are singular):
/// 2 f2 - f1, uncertainty 3 |f2 - f1| (Roache's safety factor for two grids).
ReferenceValue extrapolate_two(double f1, double f2);

/// The same for a displacement field sampled at the same points on three grids: order and uncertainty from weighted L2
/// norms of the differences; `uncertainty` is relative to the limit's norm.
struct ReferenceField {
  NodalVectors displacement;
  double uncertainty = 0;
  Eigen::VectorXd nodal_uncertainty;   ///< the same at each node, absolute [m]
  std::optional<double> observed_order;
  std::string note;
};
ReferenceField extrapolate(const std::vector<NodalVectors>& fields, const Eigen::VectorXd& weights, const GridRatios& ratios = {});

/// Weighted L2 norm of a nodal field: sqrt(sum w |u|^2 / sum w).
double weighted_norm(const NodalVectors& u, const Eigen::VectorXd& weights);

}  // namespace springproof
