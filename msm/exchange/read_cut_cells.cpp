#include "msm/exchange/read_cut_cells.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "msm/exchange/springs_document.h"

namespace springproof {
namespace {

constexpr double at_rest = 1e-6;  // of an edge

std::vector<Anchor> read_anchors(const JsonPlace& place, const Network& network) {
  place.require_known({"position_m", "nodes", "weights", "stiffness_N_m"});
  const std::vector<double> stiffness = place.at("stiffness_N_m").numbers(1, 0, nullptr, 0);
  const std::size_t count = stiffness.size();
  const std::vector<int> nodes = place.at("nodes").integers(8, network.nodes() - 1, count, "constants");
  const std::vector<double> weights = place.at("weights").numbers(8, count, "constants"),
                            position = place.at("position_m").numbers(3, count, "constants");
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

void read_supports_and_loads(const JsonPlace& document, SpringsFile& file) {
  const Network& network = file.model.network;
  if (const auto anchors = document.find("anchors"))
    for (const std::string& name : anchors->keys()) file.anchors[name] = read_anchors(anchors->at(name), network);
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
