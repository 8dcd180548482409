// Uncertainty of a reference from three grids: observed order, Richardson limit, grid convergence index (GCI).
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "problem/vector.h"

namespace springproof {

/// Convergence of a sequence of grids.
enum class Sequence { equal, converging, not_converging };

/// A number with its uncertainty (about two standard deviations, in ASME V&V 20's sense).
struct ReferenceValue {
  double value = 0;
  double uncertainty = 0;
  std::optional<double> observed_order;  ///< empty: not extrapolated
  std::string note;
  Sequence sequence = Sequence::converging;  ///< equal: on all grids, to solver accuracy
  bool matters = true;  ///< false if less than a tenth of the scale set by the body's forces, stresses or displacements
};

/// "force.z_max" of "force.z_max.x"; measures without components are returned unchanged.
std::string without_component(const std::string& measure);

inline constexpr double solver_noise = 1e-7;       ///< of a value or field, relative to its scale
inline constexpr double safety_factor = 1.25;      ///< Fs for three grids (Roache)
inline constexpr double coarse_safety_factor = 3;  ///< Fs for two grids, and for three that are hardly refined
inline constexpr double smallest_ratio = 1.2;      ///< of cell sizes, below which no order can be observed
inline constexpr double smallest_correlation =
    0.5;  ///< of a field's two differences, below which it is not extrapolated

/// The highest order used for extrapolation, whatever order is observed: 2 with clamped edges, whose singularities keep
/// the true order low.
inline constexpr double clamped_order = 2;

/// Which orders a sequence is believed to converge with.
struct TrustedOrders {
  double highest = clamped_order;  ///< of the step to the limit
  double lowest = 0.5;  ///< a slower sequence is not extrapolated; what remains of it is taken to fall with this order
  double first = highest;  ///< with which the first difference may fall
};

/// Those of a scalar measure with an element ("q1", "q2", "p1", "p2").  In a smooth solution displacements converge
/// with degree + 1 and stresses with degree; all else as with clamped edges.  The error of a displacement is an energy
/// of the field's error, of first order at least with elements of degree 2 (those of degree 1 may lock and be slower),
/// and its first difference falls with up to degree + 1.
TrustedOrders trusted_orders(const std::string& measure, const std::string& element, bool smooth);

/// Cell sizes of the first grid over the second's, and of the second over the third's.
struct GridRatios {
  double coarse = 2, fine = 2;
};

/// False for ratios below smallest_ratio, or inverted ones.
bool are_refined(const GridRatios& ratios);

/// Limit of a quantity computed on three grids (coarse to fine; the last three of more).  `noise`: round-off of the
/// values. For monotone values with an order p, `lowest` or more, whose limit is no further from the finest value than
/// the spread of the three: Richardson extrapolation with p, at most `highest`.  Its uncertainty is Fs times the larger
/// of two estimates of the finest grid's error, from the last difference at that order and from the first at p, at most
/// `first`; the latter may be the larger where p exceeds `highest`.  Otherwise the finest value, with an uncertainty of
/// Fs times: for slow sequences the extrapolation step with p, at least `lowest`, or the spread of the three; for
/// sequences that are not monotone the last difference, or what remains of the first at first order. For grids that are
/// not refined: the finest value, 3 times the spread.
ReferenceValue extrapolate(const std::vector<double>& values, double noise, const TrustedOrders& orders = {},
                           const GridRatios& ratios = {});

/// The finest of three values beside their limit, at a place where the grids are hardly refined: as for ratios below
/// smallest_ratio, with 3 times the spread of the three as uncertainty at least.
ReferenceValue finest_of(const std::vector<double>& values, ReferenceValue limit);

/// Limit from grids of cell sizes h and h/2 alone, first order being assumed (edges of cubes and of supports are
/// singular): 2 f2 - f1, uncertainty 3 |f2 - f1| (Roache's safety factor for two grids).
ReferenceValue extrapolate_two(double f1, double f2);

/// Three grids may agree by accident: raises the uncertainty of every value to the median of its kind ("force",
/// "stress", ...), both as fractions of the magnitude of the vector or tensor that the value is a component of.  Values
/// that are equal on all grids neither count nor change; uncertainties larger than that magnitude, as of a held patch's
/// mean displacement, do not count.  Magnitudes, which differences of grids may carry below 0, are
/// 0 there.
void raise_to_usual(std::map<std::string, ReferenceValue>& limits);

/// Median relative uncertainty of the values that matter, if most of them do not converge; otherwise 0.  What it casts
/// doubt on is the displacement: stresses, which converge one order later, have no vote.
double doubt_of(const std::map<std::string, ReferenceValue>& limits);

/// "force", "displacement", "stress", "volume_change", ... of a measure.
std::string kind_of(const std::string& measure);

/// The same for a displacement field sampled at the same points on three grids, in the weighted L2 norm: the order is
/// that of the first difference's component along the second.  It is extrapolated only if the two are correlated
/// (smallest_correlation) and there is no `doubt` (above) larger than the uncertainty that follows.  Otherwise the
/// uncertainty is Fs times the error that first order leaves after the last difference, or, if the differences do not
/// decrease that fast, Fs times the largest of the three distances, node by node; never less than the doubt.  `orders`:
/// as of a displacement at a point (trusted_orders).
struct ReferenceField {
  NodalVectors displacement;
  double uncertainty = 0;             ///< relative to the norm of the finest field
  Eigen::VectorXd nodal_uncertainty;  ///< the same at each node, absolute [m]
  std::optional<double> observed_order;
  std::string note;
  Sequence sequence = Sequence::converging;
  std::optional<double> correlation;  ///< of u2 - u1 and u3 - u2, from -1 to 1; empty: one of them is round-off
};
ReferenceField extrapolate(const std::vector<NodalVectors>& fields, const Eigen::VectorXd& weights,
                           const GridRatios& ratios = {}, double doubt = 0, const TrustedOrders& orders = {});

/// Weighted L2 norm of a nodal field: sqrt(sum w |u|^2 / sum w).
double weighted_norm(const NodalVectors& u, const Eigen::VectorXd& weights);

}  // namespace springproof
