#include "msm/exchange/read_cells.h"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

#include "msm/exchange/springs_document.h"

namespace springproof {
namespace {

constexpr double at_rest = 1e-6;  // of an edge, and of other numbers that follow from each other
constexpr std::size_t most_regions = 255;
constexpr const char* of_a_spring = "a symmetric matrix without negative eigenvalues, row by row";

/// Whether it is symmetric without negative eigenvalues.
bool pulls_together(const Eigen::Matrix3d& K) {
  return (K - K.transpose()).cwiseAbs().maxCoeff() <= at_rest * K.cwiseAbs().maxCoeff() &&
         K.selfadjointView<Eigen::Lower>().eigenvalues().minCoeff() >= -at_rest * K.cwiseAbs().maxCoeff();
}

/// A number each before the version of stiff walls.
std::vector<Eigen::Matrix3d> read_stiffness(const JsonPlace& place, double version, std::size_t count) {
  std::vector<Eigen::Matrix3d> all;
  const bool of_walls = version >= springs_version_of_stiff_walls;
  const std::vector<double> numbers =
      of_walls ? place.numbers(9, count, "weights") : place.numbers(1, count, "weights", 0);
  for (std::size_t a = 0; a < count; ++a) {
    all.push_back(of_walls ? Eigen::Matrix3d(Eigen::Map<const Eigen::Matrix3d>(&numbers[9 * a]))
                           : Eigen::Matrix3d(numbers[a] * Eigen::Matrix3d::Identity()));
    if (!pulls_together(all.back())) place.refuse(fmt::format("anchor {} pushes apart", a), of_a_spring);
  }
  return all;
}

std::vector<Anchor> read_anchors(const JsonPlace& place, double version, const Network& network) {
  place.require_known({"position_m", "nodes", "weights", "stiffness_N_m"});
  const std::vector<int> nodes = place.at("nodes").integers(8, network.nodes() - 1);
  const std::size_t count = nodes.size() / 8;
  const std::vector<double> weights = place.at("weights").numbers(8, count, "nodes"),
                            position = place.at("position_m").numbers(3, count, "nodes");
  const std::vector<Eigen::Matrix3d> stiffness = read_stiffness(place.at("stiffness_N_m"), version, count);
  std::vector<Anchor> anchors(count);
  for (std::size_t a = 0; a < count; ++a) {
    std::copy_n(&nodes[8 * a], 8, anchors[a].corners.begin());
    std::copy_n(&weights[8 * a], 8, anchors[a].weights.begin());
    anchors[a].node = -1;
    anchors[a].stiffness = stiffness[a];
    const Vec3 off = anchored_point(anchors[a], network.X) - Eigen::Map<const Vec3>(&position[3 * a]);
    if (!(off.cwiseAbs().maxCoeff() <= at_rest * network.cells.edge))
      place.at("position_m")
          .refuse(fmt::format("anchor {} is {:.3g} m from the mean of its nodes", a, off.norm()),
                  "the mean of the nodes by the weights, where it is at rest");
  }
  return anchors;
}

std::vector<SpringsRegion> read_regions(const JsonPlace& list) {
  std::vector<SpringsRegion> regions;
  for (const JsonPlace& item : list.items()) {
    item.require_known({"name", "youngs_modulus_Pa", "poisson_ratio", "density_kg_m3"});
    const auto positive = [&](const char* key) {
      return item.at(key).number(smallest_of_file, largest_number_of_file);
    };
    regions.push_back(
        {item.at("name").text(),
         {positive("youngs_modulus_Pa"), item.at("poisson_ratio").number(-1, 0.5), positive("density_kg_m3")}});
  }
  if (regions.empty() || regions.size() > most_regions)
    list.refuse(fmt::format("has {} regions", regions.size()), fmt::format("1 to {}", most_regions));
  return regions;
}

/// The volumes of the nodes, which have had the body's own density till now.
/// @throws InputError unless their masses are those of the cells.
void share_volumes(const JsonPlace& masses, Network& network) {
  const Eigen::VectorXd by_mass = volumes_by_mass(network), off = (by_mass - network.volume).cwiseAbs();
  Eigen::Index worst = 0;
  if (off.maxCoeff(&worst) > at_rest * by_mass.maxCoeff())
    masses.refuse(fmt::format("node {} has not an eighth of the masses of its cells", worst),
                  "fraction times volume times density of the cells' regions, in eighths");
  network.volume.setZero();
  for (std::size_t c = 0; c < network.cells.size(); ++c)
    for (const int n : network.cells.corners[c]) network.volume[n] += network.cells.shape(c).volume() / 8;
  hand_back(network.cells.carried, network.volume, 1);
}

InterfaceBond bond_of(const int* nodes, const double* weights, const double* stiffness) {
  InterfaceBond bond;
  for (int side = 0; side < 2; ++side) {
    std::copy_n(nodes + 8 * side, 8, bond.corners[side].begin());
    std::copy_n(weights + 8 * side, 8, bond.weights[side].begin());
  }
  bond.stiffness = Eigen::Map<const Eigen::Matrix3d>(stiffness);
  return bond;
}

void require_bond(const InterfaceBond& bond, std::size_t number, const JsonPlace& place, const Network& network) {
  const auto refuse = [&](const char* key, const char* what, const char* allowed) {
    place.at(key).refuse(fmt::format("bond {} {}", number, what), allowed);
  };
  for (const auto& side : bond.weights)
    if (std::abs(std::accumulate(side.begin(), side.end(), -1.0)) > at_rest)
      refuse("weights", "has weights that do not sum to 1", "eight of each cell that sum to 1");
  if (gap(bond, network.X).cwiseAbs().maxCoeff() > at_rest * network.cells.edge)
    refuse("weights", "is stretched at rest", "means of both cells at the same point");
  if (!pulls_together(bond.stiffness)) refuse("stiffness_N_m", "pushes apart", of_a_spring);
}

PatchShares read_load(const JsonPlace& place, int nodes_of_network) {
  place.require_known({"nodes", "area_m2", "normal_m2"});
  const std::vector<int> nodes = place.at("nodes").integers(1, nodes_of_network - 1);
  const std::vector<double> area = place.at("area_m2").numbers(1, nodes.size(), "nodes"),
                            normal = place.at("normal_m2").numbers(3, nodes.size(), "nodes");
  PatchShares shares{Eigen::VectorXd::Zero(nodes_of_network), NodalVectors::Zero(nodes_of_network, 3)};
  for (std::size_t n = 0; n < nodes.size(); ++n) {
    shares.area[nodes[n]] += area[n];
    shares.normal.row(nodes[n]) += Eigen::Map<const Eigen::RowVector3d>(&normal[3 * n]);
  }
  return shares;
}

/// Of several sizes, from version 3 on, a list.
void read_edges(const JsonPlace& cells, double version, Network& network) {
  const JsonPlace place = cells.at("edge_m");
  if (version < springs_version_of_several_sizes || !place.is_list()) {
    network.cells.edge = place.number(smallest_of_file, farthest_node);
    return;
  }
  network.cells.edges = place.numbers(1, network.cells.size(), "cells", smallest_of_file, farthest_node);
  if (network.cells.edges.empty()) place.refuse("is empty", "an edge for each cell");
  network.cells.edge = *std::min_element(network.cells.edges.begin(), network.cells.edges.end());
}

/// Boxes instead of cubes, from version 4 on: full ones of one size.
void read_proportions(const JsonPlace& cells, double version, Network& network) {
  const auto place = cells.find("proportions");
  if (!place) return;
  if (version < springs_version_of_boxes) place->refuse("is of boxes", "version 4");
  const std::vector<double> p = place->numbers(1, 3, "axes", smallest_of_file, largest_number_of_file);
  network.cells.proportions = Vec3(p[0], p[1], p[2]);
  if (!(std::abs(network.cells.proportions.prod() - 1) <= 1e-9))
    place->refuse(fmt::format("has the product {:.10g}", network.cells.proportions.prod()),
                  "three edges over that of the cube of their volume: a product of 1");
  if (network.cells.kind() == CellKind::sizes || cells.find("fraction"))
    place->refuse("is beside cut cells", "boxes that are full, of one edge_m");
}

/// The moments beside the cells' nodes, if there are any.
void read_filled(const JsonPlace& cells, Network& network) {
  const auto fraction = cells.find("fraction");
  if (!fraction) return;
  constexpr double least = 1e-6;  // of a cube, so that masses and stiffnesses keep their digits
  const std::size_t count = network.cells.size();
  const std::vector<double> alpha = fraction->numbers(1, count, "cells", least, 1),
                            mean = cells.at("mean").numbers(3, count, "cells", -0.5, 0.5),
                            mixed = cells.at("mixed").numbers(3, count, "cells", -0.25, 0.25),
                            variance = cells.at("variance").numbers(3, count, "cells", 0, 0.25);
  for (std::size_t c = 0; c < count; ++c)
    network.cells.filled.push_back({alpha[c], Eigen::Map<const Vec3>(&mean[3 * c]),
                                    Eigen::Map<const Vec3>(&mixed[3 * c]), Eigen::Map<const Vec3>(&variance[3 * c])});
}

constexpr double equal = 1e-9;  // relative, of stiffnesses and volumes
constexpr double most_points_per_node = 1000;

/// A pair of corners of a cell with the spring that each cell has there.
struct CornerPair {
  int a, b;
  std::optional<Spring> spring = {};  ///< of one cell
};

std::vector<CornerPair> corner_pairs() {
  std::vector<CornerPair> pairs;
  for (int a = 0; a < 8; ++a)
    for (int b = a + 1; b < 8; ++b) pairs.push_back({a, b});
  return pairs;
}

/// Number of the spring between two nodes, or -1.
int find_spring(const Network& network, int i, int j) {
  if (i > j) std::swap(i, j);
  const auto before = [](const Spring& s, const std::pair<int, int>& p) { return std::pair(s.i, s.j) < p; };
  const auto at = std::lower_bound(network.springs.begin(), network.springs.end(), std::pair(i, j), before);
  return at != network.springs.end() && at->i == i && at->j == j ? static_cast<int>(at - network.springs.begin()) : -1;
}

bool power_of_two(int n) { return (n & (n - 1)) == 0; }

/// The springs of one cell; nothing if the network's are not theirs superposed.
std::optional<std::vector<Spring>> springs_of_cell(const Network& network) {
  std::vector<CornerPair> pairs = corner_pairs();
  std::vector<int> sharing(network.springs.size(), 0);  // cells that a spring belongs to
  for (const Hexahedron& cell : network.cells.corners)
    for (const CornerPair& p : pairs)
      if (const int s = find_spring(network, cell[p.a], cell[p.b]); s >= 0) ++sharing[s];
  if (std::count(sharing.begin(), sharing.end(), 0) > 0) return {};
  for (const Hexahedron& cell : network.cells.corners)
    for (CornerPair& p : pairs) {
      const int s = find_spring(network, cell[p.a], cell[p.b]);
      // A quotient by 1, 2 or 4 is exact.
      if (s < 0 || (p.spring && !power_of_two(sharing[s]))) continue;
      if (const Spring& whole = network.springs[s]; !p.spring || power_of_two(sharing[s]))
        p.spring = {p.a, p.b, whole.stiffness / sharing[s], whole.rest_length};
    }
  for (const Hexahedron& cell : network.cells.corners)
    for (const CornerPair& p : pairs) {
      const int s = find_spring(network, cell[p.a], cell[p.b]);
      if ((s >= 0) != p.spring.has_value()) return {};
      if (s < 0) continue;
      const Spring& whole = network.springs[s];
      if (!(std::abs(whole.stiffness - sharing[s] * p.spring->stiffness) <= equal * whole.stiffness)) return {};
      if (!(std::abs(whole.rest_length - p.spring->rest_length) <= equal * whole.rest_length)) return {};
    }
  std::vector<Spring> springs;
  for (const CornerPair& p : pairs)
    if (p.spring) springs.push_back(*p.spring);
  return springs;
}

/// Sets CellSet::grid and springs of a network with cells if its springs are those of its equal cells superposed, and
/// its volume shares the cells': then it has the kernels and solvers of lattices.  Else it has neither.
void recognise_lattice(Network& network) {
  network.cells.grid.reset();
  network.cells.springs.clear();
  Mesh mesh;
  mesh.nodes = network.X;
  mesh.hexahedra = network.cells.corners;
  const std::optional<Grid> grid = detect_grid(mesh);
  const Vec3 edges = network.cells.edge * network.cells.proportions;
  if (!grid || ((grid->spacing - edges).array().abs() > 1e-6 * edges.array()).any()) return;
  double points = 1;  // kernels of lattices have a place for each
  for (const int n : grid->cells) points *= n + 1;
  if (points > most_points_per_node * network.nodes()) return;
  const Eigen::VectorXd volume = nodal_volumes(mesh);
  if (((network.volume - volume).array().abs() > equal * volume.array()).any()) return;
  auto springs = springs_of_cell(network);
  if (!springs) return;
  network.cells.grid = grid;
  network.cells.springs = std::move(*springs);
}

}  // namespace

void read_cells(const JsonPlace& document, double version, Network& network) {
  const int last = network.nodes() - 1;
  if (const auto triangles = document.find("triangles")) network.triangles = rows<3>(*triangles, last, "triangle");
  const auto place = document.find("cells");
  if (!place) return;
  CellSet& cells = network.cells;
  place->require_known({"nodes", "edge_m", "proportions", "fraction", "mean", "mixed", "variance", "material"});
  cells.corners = rows<8>(place->at("nodes"), last, "cell");
  read_edges(*place, version, network);
  read_proportions(*place, version, network);
  for (std::size_t c = 0; c < cells.size(); ++c)
    for (int n = 0; n < 8; ++n) {
      const Vec3 corner(hexahedron_corners[n][0], hexahedron_corners[n][1], hexahedron_corners[n][2]);
      const Vec3 at = (network.X.row(cells.corners[c][n]) - network.X.row(cells.corners[c][0])).transpose();
      const Vec3 expected = cells.edge_of(c) * cells.proportions.cwiseProduct(corner);
      if ((at - expected).cwiseAbs().maxCoeff() > 1e-6 * cells.edge * cells.proportions.minCoeff())
        place->at("nodes").refuse(fmt::format("cell {} is no cube of edge_m in the order of corners", c),
                                  "axis-aligned cubes, or boxes of proportions, corners (0,0,0) (1,0,0) (1,1,0) "
                                  "(0,1,0) (0,0,1) (1,0,1) (1,1,1) "
                                  "(0,1,1)");
    }
  read_filled(*place, network);
  if (cells.kind() == CellKind::sizes && !cells.cut())
    place->at("edge_m").refuse("is a list, of whole cells", "one edge; or with fraction, mean, mixed and variance");
  if (!cells.empty() && !cells.cut()) recognise_lattice(network);
}

void read_carried(const JsonPlace& document, Network& network) {
  const auto place = document.find("carried");
  if (!place) return;
  if (network.cells.kind() != CellKind::sizes)
    place->refuse("is beside cells of one size", "version 3 with a list edge_m");
  place->require_known({"nodes", "by"});
  const std::vector<int> nodes = place->at("nodes").integers(1, network.nodes() - 1),
                         by = place->at("by").integers(4, network.nodes() - 1, nodes.size(), "nodes");
  std::vector<char> later(static_cast<std::size_t>(network.nodes()), 0);
  for (const int node : nodes)
    if (later[node]++) place->at("nodes").refuse(fmt::format("node {} is carried twice", node), "each node once");
  for (std::size_t c = 0; c < nodes.size(); ++c) {
    Eigen::RowVector3d mean = Eigen::RowVector3d::Zero();
    CarriedPoint carried{nodes[c], {}};
    for (std::size_t n = 4 * c; n < 4 * c + 4; ++n) {
      if (later[by[n]])
        place->at("by").refuse(
            fmt::format("number {} names node {}, which is carried itself, and not before", c, by[n]),
            "nodes that are not carried, or further up in the list");
      carried.by.push_back(by[n]);
      mean += network.X.row(by[n]) / 4;
    }
    later[nodes[c]] = 0;
    if (!((mean - network.X.row(nodes[c])).cwiseAbs().maxCoeff() <= 1e-6 * network.cells.edge))
      place->at("by").refuse(fmt::format("node {} is not in the mean of its four", nodes[c]),
                             "four nodes, or two of them twice, whose mean it is at rest");
    if (network.volume[nodes[c]] != 0)
      place->refuse(fmt::format("node {} has a mass", nodes[c]), "0 kg; the nodes that carry it have its share");
    network.cells.carried.push_back(std::move(carried));
  }
  if ((network.volume.array() == 0).count() != static_cast<Eigen::Index>(nodes.size()))
    document.at("nodes").at("mass_kg").refuse("has nodes of 0 kg that nothing carries", "a mass, or a row in /carried");
}

void read_materials(const JsonPlace& document, double version, SpringsFile& file) {
  Network& network = file.model.network;
  const auto cells = document.find("cells"), regions = document.find("regions"), bonds = document.find("bonds");
  const auto material = cells ? cells->find("material") : std::nullopt;
  for (const auto& place : {material, regions, bonds}) {
    if (!place) continue;
    if (version < springs_version_of_materials) place->refuse("is of several materials", "version 5");
    if (!material || !regions)
      place->refuse("is without the others of several materials", "regions beside cells.material");
  }
  if (!material) return;
  if (!network.cells.cut()) material->refuse("is of whole cells", "cut cells, with fraction, mean, mixed and variance");
  file.regions = read_regions(*regions);
  const std::vector<int> numbers =
      material->integers(1, static_cast<int>(file.regions.size()), network.cells.size(), "cells");
  network.cells.materials.assign(numbers.begin(), numbers.end());
  network.cells.relative_densities = {1};
  for (const SpringsRegion& r : file.regions)
    network.cells.relative_densities.push_back(r.material.density / file.density);
  share_volumes(document.at("nodes").at("mass_kg"), network);
  if (!bonds) return;
  bonds->require_known({"nodes", "weights", "stiffness_N_m"});
  const std::vector<int> nodes = bonds->at("nodes").integers(16, network.nodes() - 1);
  const std::size_t count = nodes.size() / 16;
  const std::vector<double> weights = bonds->at("weights").numbers(16, count, "bonds"),
                            stiffness = bonds->at("stiffness_N_m").numbers(9, count, "bonds");
  for (std::size_t b = 0; b < count; ++b) {
    network.bonds.push_back(bond_of(&nodes[16 * b], &weights[16 * b], &stiffness[9 * b]));
    require_bond(network.bonds.back(), b, *bonds, network);
  }
}

void read_supports_and_loads(const JsonPlace& document, double version, SpringsFile& file) {
  const Network& network = file.model.network;
  if (const auto anchors = document.find("anchors"))
    for (const std::string& name : anchors->keys())
      file.anchors[name] = read_anchors(anchors->at(name), version, network);
  if (const auto loads = document.find("loads"))
    for (const std::string& name : loads->keys()) file.loads[name] = read_load(loads->at(name), network.nodes());
  if (const auto weight = document.at("nodes").find("weight_kg")) {
    const std::vector<double> kg = weight->numbers(1, static_cast<std::size_t>(network.nodes()), "nodes");
    Eigen::VectorXd own = Eigen::Map<const Eigen::VectorXd>(kg.data(), static_cast<Eigen::Index>(kg.size()));
    if (network.attached.size() > 0) own -= network.attached;
    file.volumes = own / file.density;
  }
}

}  // namespace springproof
