// A displacement that is known at points anywhere, brought to others.
#pragma once

#include <vector>

#include "msm/topology/point_cells.h"

namespace springproof {

class ScatteredField {
 public:
  /// Points and their displacements, n x 3 [m], at least one.
  ScatteredField(NodalVectors points, NodalVectors displacement);

  /// Median distance of a point from the nearest other place that has one [m]; 0 for a single place.
  double spacing() const { return spacing_; }

  double distance(const Vec3& p) const;  ///< from the nearest point [m]

  /// Whether there is a point at p, to 1e-4 of the spacing.
  bool is_at(const Vec3& p) const { return distance(p) <= same_place(); }
  std::vector<int> points_at(const Vec3& p) const { return near(p, same_place()); }  ///< their rows

  /// At a point its displacement (of several the mean); elsewhere that of the affine field fitted to the points around
  /// p by moving least squares, with weights (1 - (d / R)^2)^3 up to a distance R of 1.6 spacings, or as many more as
  /// they need to span a volume.  Affine displacements are reproduced exactly.
  /// @throws std::invalid_argument if points within ten spacings span no volume.
  Vec3 at(const Vec3& p) const;

 private:
  std::vector<int> near(const Vec3& p, double radius) const;
  double same_place() const { return 1e-4 * spacing_; }

  NodalVectors X_, u_;
  double edge_;  ///< of the cells [m]
  PointCells cells_;
  double spacing_ = 0;
};

}  // namespace springproof
