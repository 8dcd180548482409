// Stresses against those of the reference.
#pragma once

#include <array>

#include "comparisons/judge/measures.h"

namespace springproof {

/// Von Mises' stress, the mean normal stress and the largest principal stress [Pa], one row per point: in the order of
/// the rows of the measure stress_error.
NodalVectors invariants(const ProbeStresses& stress);

/// The invariants of the reference.
struct StressLimit {
  std::array<NodalVectors, 3> of_grids;  ///< coarse to fine, one row per point [Pa]
  NodalVectors of_points;                ///< their limit
  std::array<ReferenceField, 3> fields;  ///< each invariant's in its own column
  ReferenceValue peak;                   ///< largest von Mises' stress of all points [Pa]
  Eigen::Index place = 0;                ///< its row

  std::array<double, 3> peaks() const;  ///< of the grids [Pa]

  /// Whether the peak grows with every grid and has no limit, as at a singular edge or corner: there is nothing to
  /// compare with.
  bool peak_is_singular() const;
};

/// Each invariant as extrapolate() takes a field; where the grids' differences point apart, its uncertainty is that of
/// scalars that do not converge monotonically.
/// @param grids stresses at the same points on three grids, coarse to fine
/// @param volumes that points stand for [m^3]; 0: they count for the peak alone
/// @param doubt of the displacement, as extrapolate() takes it
StressLimit stress_limit(const std::array<ProbeStresses, 3>& grids, const Eigen::VectorXd& volumes,
                         const GridRatios& ratios = {}, double doubt = 0);

/// L2 norms over the body [1], relative to the invariant's own, or to a tenth of von Mises' if that is more.
/// @param off differences of the invariants, one row per point [Pa]
Eigen::Vector3d stress_errors(const NodalVectors& off, const StressLimit& limit, const Eigen::VectorXd& volumes);

}  // namespace springproof
