#include "msm/exchange/read_cut_cells.h"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numeric>

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

}  // namespace

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
