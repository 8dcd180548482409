#include "msm/topology/random/random_nodes.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "msm/topology/random/random_addition.h"
#include "msm/topology/random/surface_features.h"

namespace springproof {
namespace {

/// Number of interior nodes that a node of a face replaces, per minL/l: with it the density far from the surface is
/// that of the sample without surface.  Measured on cubes of 24 l: 0.14, 0.26, 0.37, 0.44, 0.46, 0.50 nodes at minL/l =
/// 0.3, 0.5, 0.7, 0.8, 0.85, 0.88.
constexpr double surface_weight = 0.54;

/// Number of nodes for so many lengths, areas or volumes of l.
long count_for(double amount) { return std::lround(amount); }

/// Throws unless all `wanted` nodes were placed beside `others` that had been placed before.
void require_placed(long placed, long wanted, const RandomParameters& parameters, long others = 0) {
  if (placed >= wanted) return;
  // The number of nodes per minL^3 is the same in all jammed samples.
  const double largest = parameters.min_length * std::cbrt(double(placed) / double(wanted));
  throw std::invalid_argument(
      fmt::format("min_length: minL/l = {:.4g} was asked for, but random addition jams at {} of {} nodes; "
                  "this sample has room for minL/l = {:.3f} at most",
                  parameters.min_length, others + placed, others + wanted, std::floor(1000 * largest) / 1000));
}

double length(const std::vector<std::array<Vec3, 2>>& edges) {
  double sum = 0;
  for (const auto& [a, b] : edges) sum += (b - a).norm();
  return sum;
}

double distance_to_segment(const Vec3& x, const std::array<Vec3, 2>& segment) {
  const Vec3 along = segment[1] - segment[0];
  const double at = std::clamp(along.dot(x - segment[0]) / along.squaredNorm(), 0.0, 1.0);
  return (x - segment[0] - at * along).norm();
}

double area(const std::vector<std::array<Vec3, 3>>& triangles) {
  double sum = 0;
  for (const auto& [a, b, c] : triangles) sum += (b - a).cross(c - a).norm() / 2;
  return sum;
}

/// The pieces of the surface that are at least `clearance` [m] from its sharp edges; 0: the whole surface.
std::vector<std::array<Vec3, 3>> clear_of_edges(const SurfaceFeatures& features, double clearance) {
  if (!(clearance > 0)) return features.triangles;
  std::vector<std::array<Vec3, 3>> pieces;
  for (const auto& t : features.triangles)
    for_pieces(t[0], t[1], t[2], clearance / 3, [&](const Vec3& a, const Vec3& b, const Vec3& c) {
      const bool clear = std::none_of(features.edges.begin(), features.edges.end(), [&](const auto& edge) {
        return distance_to_segment((a + b + c) / 3, edge) < clearance;
      });
      if (clear) pieces.push_back({a, b, c});
    });
  return pieces;
}

/// Spherical windows that step through the box, each filled to its expected number.  The paper steps by sqrt(2) R_s,
/// which covers a plane but not space: between eight spheres in a cubic arrangement holes are left.  2 R_s / sqrt(3)
/// is the largest step that covers.
void fill_windows(Sample& sample, const Vec3& lower, const Vec3& upper, double density) {
  const double radius = 3 * sample.min_distance, step = 2 * radius / std::sqrt(3.0);
  const double expected = 4 * std::numbers::pi / 3 * radius * radius * radius * density;
  int count[3];
  for (int a = 0; a < 3; ++a) count[a] = static_cast<int>(std::ceil((upper[a] - lower[a]) / step));
  for (int k = 0; k < count[2]; ++k)
    for (int j = 0; j < count[1]; ++j)
      for (int i = 0; i < count[0]; ++i) {
        const Vec3 centre = lower + step * Vec3(i + 0.5, j + 0.5, k + 0.5);
        const auto in_window = [&](const Vec3& x) { return (x - centre).squaredNorm() < radius * radius; };
        long present = 0;
        sample.cells.any_near(
            centre,
            [&](int p) {
              present += in_window(sample.points[p]);
              return false;
            },
            4);
        const long wanted = static_cast<long>(expected + uniform(sample.random)) - present;
        const Vec3 reach = Vec3::Constant(radius);
        if (wanted > 0) fill_box(sample, centre - reach, centre + reach, in_window, wanted);
      }
}

}  // namespace

std::vector<Vec3> nodes_from_surface(const Region& region, const RandomParameters& parameters) {
  const double l = parameters.spacing;
  const SurfaceFeatures features = surface_features(region);
  Sample sample(region.lower, region.upper, parameters.min_length * l, false, parameters.seed);
  for (const Vec3& corner : features.corners)
    if (sample.is_free(corner)) sample.add(corner);
  const double corners = double(sample.points.size());
  const double edges = fill_edges(sample, features.edges, count_for(length(features.edges) / l - corners / 2));
  const double faces = fill_triangles(sample, clear_of_edges(features, parameters.edge_clearance * l),
                                      count_for(area(features.triangles) / (l * l) - edges / 2 - corners / 4));
  const double weight = surface_weight * parameters.min_length;
  const long inner = count_for(region.volume / (l * l * l) - weight * (faces + edges / 2 + corners / 4));
  const long placed = fill_box(sample, region.lower, region.upper, region.inside, inner);
  const long on_surface = static_cast<long>(faces + edges + corners);
  require_placed(placed, inner, parameters, on_surface);
  return std::move(sample.points);
}

std::vector<Vec3> nodes_cut_by_surface(const Region& region, const RandomParameters& parameters, double margin) {
  const double density = 1 / (parameters.spacing * parameters.spacing * parameters.spacing);
  const Vec3 lower = region.lower - Vec3::Constant(margin), upper = region.upper + Vec3::Constant(margin);
  const long wanted = count_for((upper - lower).prod() * density);
  // Walls would attract nodes; a periodic sample has none.  Windows leave their walls outside the box.
  Sample sample(lower, upper, parameters.min_length * parameters.spacing, !parameters.windows, parameters.seed);
  if (parameters.windows) fill_windows(sample, lower, upper, density);
  const auto in_box = [&](const Vec3& x) {
    return (x.array() >= lower.array()).all() && (x.array() <= upper.array()).all();
  };
  const long present = std::count_if(sample.points.begin(), sample.points.end(), in_box);
  require_placed(present + fill_box(sample, lower, upper, {}, wanted - present), wanted, parameters);
  std::vector<Vec3> nodes;
  for (const Vec3& x : sample.points)
    if (region.inside(x)) nodes.push_back(x);
  return nodes;
}

std::vector<Vec3> periodic_nodes_up_to_jamming(const Vec3& box, const RandomParameters& parameters) {
  const double l = parameters.spacing;
  Sample sample(Vec3::Zero(), box, parameters.min_length * l, true, parameters.seed);
  fill_box(sample, Vec3::Zero(), box, {}, count_for(box.prod() / (l * l * l)));
  return std::move(sample.points);
}

std::vector<Vec3> periodic_nodes(const Vec3& box, const RandomParameters& parameters) {
  const double l = parameters.spacing;
  std::vector<Vec3> nodes = periodic_nodes_up_to_jamming(box, parameters);
  require_placed(static_cast<long>(nodes.size()), count_for(box.prod() / (l * l * l)), parameters);
  return nodes;
}

}  // namespace springproof
