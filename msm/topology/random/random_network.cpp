#include "msm/topology/random/random_network.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <stdexcept>
#include <tuple>

#include "meshes/facets.h"
#include "msm/topology/random/random_addition.h"
#include "msm/topology/random/repair.h"
#include "msm/topology/random/surface_features.h"

namespace springproof {
namespace {

constexpr double most_nodes = 2e7;
constexpr double largest_loss = 0.2;
constexpr double calibration_box = 20;  // edge of the sample that maxL is read from, in l

void check(const RandomParameters& p, double volume) {
  const auto require = [](bool holds, const std::string& message) {
    if (!holds) throw std::invalid_argument(message);
  };
  require(p.spacing > 0 && std::isfinite(p.spacing), fmt::format("spacing: {} m, must be positive", p.spacing));
  const double nodes = volume / (p.spacing * p.spacing * p.spacing);
  require(nodes >= 8 && nodes <= most_nodes,
          fmt::format("spacing: {:.6g} m makes {:.3g} nodes, must be 8 to {:.0e}", p.spacing, nodes, most_nodes));
  require(p.min_length > 0, fmt::format("min_length: minL/l = {}, must be positive", p.min_length));
  require(p.min_length >= 0.05, fmt::format("min_length: minL/l = {}, below 0.05 nodes may coincide", p.min_length));
  require(!p.max_length || (*p.max_length > p.min_length && *p.max_length <= 4),
          fmt::format("max_length: maxL/l = {}, must be above minL/l = {} and at most 4", p.max_length.value_or(0),
                      p.min_length));
  require(p.springs_per_node >= 6 && p.springs_per_node <= 60,
          fmt::format("springs_per_node: {}, must be 6 (fewer cannot hold a node) to 60", p.springs_per_node));
  require(std::abs(p.stiffness_exponent) <= 10,
          fmt::format("stiffness_exponent: {}, must be -10 to 10", p.stiffness_exponent));
  require(!p.windows || !p.surface_nodes, "windows: only for a sample cut by the surface (surface_nodes = false)");
}

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
        const Vec3 middle = (a + b + c) / 3;
        return (closest_point(middle, edge[0], edge[1]) - middle).norm() < clearance;
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
        sample.cells.for_near(centre, 4, [&](int p) { present += in_window(sample.points[p]); });
        const long wanted = static_cast<long>(expected + uniform(sample.random)) - present;
        const Vec3 reach = Vec3::Constant(radius);
        if (wanted > 0) fill_box(sample, centre - reach, centre + reach, in_window, wanted);
      }
}

/// Nodes on corners, sharp edges and faces, then in the inside.
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

/// A sample of a box that is larger than the body by `margin` [m], cut by the surface; in windows if asked for.
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

/// V/l^3 nodes in the periodic box [0, box], or as many of them as fit.
std::vector<Vec3> periodic_nodes_up_to_jamming(const Vec3& box, const RandomParameters& parameters) {
  const double l = parameters.spacing;
  Sample sample(Vec3::Zero(), box, parameters.min_length * l, true, parameters.seed);
  fill_box(sample, Vec3::Zero(), box, {}, count_for(box.prod() / (l * l * l)));
  return std::move(sample.points);
}

/// maxL [m] of the bulk.
double bulk_max_length(const RandomParameters& parameters) {
  if (parameters.max_length) return *parameters.max_length * parameters.spacing;
  RandomParameters sample = parameters;
  sample.seed = 1;  // the length is a property of the ensemble
  const Vec3 box = Vec3::Constant(calibration_box * parameters.spacing);
  return length_for(parameters.springs_per_node, periodic_nodes_up_to_jamming(box, sample), box);
}

NetworkRepair repair_or_refuse(std::vector<Vec3>& points, std::vector<Bond>& bonds, const Vec3& box) {
  const double before = double(points.size());
  const NetworkRepair counts = repair(points, bonds, box);
  if (points.empty() || counts.floppy_nodes + counts.detached_nodes > largest_loss * before)
    throw std::invalid_argument(
        fmt::format("springs_per_node: {} of {} nodes are held by too few springs and {} hang apart; choose more "
                    "springs per node (or a "
                    "larger max_length), or a smaller spacing",
                    counts.floppy_nodes, before, counts.detached_nodes));
  return counts;
}

/// Adds a ghost for every image that a bond ends on.
void add_ghosts(const std::vector<Vec3>& points, std::vector<Bond>& bonds, const Vec3& box, Network& network) {
  std::map<std::tuple<int, std::array<int, 3>>, int> ghosts;
  std::vector<Vec3> images;
  for (std::size_t n = 0; n < points.size(); ++n) network.image_of.push_back(static_cast<int>(n));
  for (Bond& b : bonds) {
    if (b.shift == std::array<int, 3>{}) continue;
    const auto [place, is_new] = ghosts.try_emplace({b.j, b.shift}, network.image_of.size());
    if (is_new) {
      images.push_back(points[b.j] + box.cwiseProduct(Vec3(b.shift[0], b.shift[1], b.shift[2])));
      network.image_of.push_back(b.j);
    }
    b.j = place->second;
  }
  network.X.conservativeResize(network.X.rows() + static_cast<Eigen::Index>(images.size()), 3);
  network.X.bottomRows(static_cast<Eigen::Index>(images.size())) = rows_of(images);
  std::sort(bonds.begin(), bonds.end(),
            [](const Bond& a, const Bond& b) { return std::tie(a.i, a.j) < std::tie(b.i, b.j); });
}

Network assemble(const std::vector<Vec3>& points, std::vector<Bond> bonds, const RandomParameters& parameters,
                 const Vec3* box) {
  Network network;
  network.X = rows_of(points);
  if (box) add_ghosts(points, bonds, *box, network);
  network.springs.reserve(bonds.size());
  for (const Bond& b : bonds) {
    const double length = (network.X.row(b.j) - network.X.row(b.i)).norm();
    const double p = parameters.stiffness_exponent;
    network.springs.push_back({b.i, b.j, p == 0 ? 1.0 : std::pow(length / parameters.spacing, -p), length});
  }
  return network;
}

void set_volumes(Network& network, const std::vector<Vec3>& points, const Vec3& lower, const Vec3& upper, bool periodic,
                 double spacing, double volume, const std::function<bool(const Vec3&)>& inside) {
  PointCells cells(lower, upper, 1.2 * spacing, periodic);
  for (const Vec3& p : points) cells.add(p);
  const std::vector<double> shares = nearest_volumes(points, cells, spacing / 3, volume, inside);
  network.volume = Eigen::VectorXd::Zero(network.X.rows());
  std::copy(shares.begin(), shares.end(), network.volume.begin());
}

}  // namespace

Network random_network(const Region& region, const RandomParameters& parameters, NetworkRepair* repaired) {
  check(parameters, region.volume);
  const double max_length = bulk_max_length(parameters);
  if (!parameters.surface_nodes)
    check(parameters, (region.upper - region.lower + Vec3::Constant(2 * max_length)).prod());
  std::vector<Vec3> points =
      spatially_sorted(parameters.surface_nodes ? nodes_from_surface(region, parameters)
                                                : nodes_cut_by_surface(region, parameters, max_length),
                       max_length);
  PointCells cells(region.lower, region.upper, max_length, false);
  for (const Vec3& p : points) cells.add(p);
  std::vector<Bond> bonds = bonds_within(points, cells, max_length, region.inside);
  if (parameters.least_springs > 0)
    join_sparse_points(points, cells, max_length, parameters.least_springs, region.inside, bonds);
  const NetworkRepair counts = repair_or_refuse(points, bonds, Vec3::Zero());
  if (repaired) *repaired = counts;
  Network network = assemble(points, std::move(bonds), parameters, nullptr);
  set_volumes(network, points, region.lower, region.upper, false, parameters.spacing, region.volume, region.inside);
  return network;
}

Network periodic_random_network(const Vec3& box, const RandomParameters& parameters, NetworkRepair* repaired) {
  if (!(box.minCoeff() > 0) || !box.allFinite()) throw std::invalid_argument("box: the sides must be positive");
  check(parameters, box.prod());
  if (parameters.windows) throw std::invalid_argument("windows: not for a periodic box");
  const std::vector<Vec3> nodes = periodic_nodes_up_to_jamming(box, parameters);
  const double l = parameters.spacing;
  require_placed(static_cast<long>(nodes.size()), count_for(box.prod() / (l * l * l)), parameters);
  std::vector<Vec3> points = spatially_sorted(nodes, parameters.spacing);
  const double max_length = parameters.max_length ? *parameters.max_length * parameters.spacing
                                                  : length_for(parameters.springs_per_node, points, box);
  PointCells cells(Vec3::Zero(), box, max_length, true);
  for (const Vec3& p : points) cells.add(p);
  std::vector<Bond> bonds = bonds_within(points, cells, max_length, {});
  const NetworkRepair counts = repair_or_refuse(points, bonds, box);
  if (repaired) *repaired = counts;
  Network network = assemble(points, std::move(bonds), parameters, &box);
  set_volumes(network, points, Vec3::Zero(), box, true, parameters.spacing, box.prod(), {});
  return network;
}

}  // namespace springproof
