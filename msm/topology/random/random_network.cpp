#include "msm/topology/random/random_network.h"

#include <fmt/format.h>

#include <cmath>
#include <map>
#include <stdexcept>
#include <tuple>

#include "msm/topology/random/random_nodes.h"
#include "msm/topology/random/repair.h"

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
  for (std::size_t g = 0; g < images.size(); ++g)
    network.X.row(static_cast<Eigen::Index>(points.size() + g)) = images[g].transpose();
  std::sort(bonds.begin(), bonds.end(),
            [](const Bond& a, const Bond& b) { return std::tie(a.i, a.j) < std::tie(b.i, b.j); });
}

Network assemble(const std::vector<Vec3>& points, std::vector<Bond> bonds, const RandomParameters& parameters,
                 const Vec3* box) {
  Network network;
  network.X.resize(static_cast<Eigen::Index>(points.size()), 3);
  for (std::size_t n = 0; n < points.size(); ++n) network.X.row(static_cast<Eigen::Index>(n)) = points[n].transpose();
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
  for (std::size_t n = 0; n < shares.size(); ++n) network.volume[static_cast<Eigen::Index>(n)] = shares[n];
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
  std::vector<Vec3> points = spatially_sorted(periodic_nodes(box, parameters), parameters.spacing);
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
