// Bonds between random points, and the removal of nodes that they hold insufficiently.
#pragma once

#include <functional>

#include "msm/topology/point_cells.h"
#include "msm/topology/random/random_network.h"

namespace springproof {

/// Two nodes i < j to be connected, j possibly by its image at j + shift * box.
struct Bond {
  int i, j;
  std::array<int, 3> shift;
};

/// Points reordered along a Morton curve through cells of the given edge [m], so that neighbours are near in memory.
std::vector<Vec3> spatially_sorted(const std::vector<Vec3>& points, double edge);

/// All pairs closer than max_length [m] whose line passes `inside` (empty: no test) at 1/4, 1/2 and 3/4, sorted by (i,
/// j). Linear in the number of points.
std::vector<Bond> bonds_within(const std::vector<Vec3>& points, const PointCells& cells, double max_length,
                               const std::function<bool(const Vec3&)>& inside);

/// Joins points that have fewer than `least` bonds to the nearest points within 2 max_length [m] until they have, under
/// the same test; not for periodic boxes.
void join_sparse_points(const std::vector<Vec3>& points, const PointCells& cells, double max_length, int least,
                        const std::function<bool(const Vec3&)>& inside, std::vector<Bond>& bonds);

/// Length [m] up to which each point of a periodic box has `springs_per_node` neighbours on average.
double length_for(double springs_per_node, const std::vector<Vec3>& points, const Vec3& box);

/// Volume nearest to each point [m^3], by a lattice of about `step` [m] through the box of the cells; the sum is
/// `volume`. `inside` (empty: everywhere) determines which lattice points count; a point that gets none is given half
/// of one.
std::vector<double> nearest_volumes(const std::vector<Vec3>& points, const PointCells& cells, double step,
                                    double volume, const std::function<bool(const Vec3&)>& inside);

/// Removes floppy and detached nodes (NetworkRepair) with their bonds, repeatedly until there are none.
/// `box` [m]: the period of bonds with a shift.
NetworkRepair repair(std::vector<Vec3>& points, std::vector<Bond>& bonds, const Vec3& box);

}  // namespace springproof
