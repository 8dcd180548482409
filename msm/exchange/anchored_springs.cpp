#include "msm/exchange/anchored_springs.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <numeric>

#include "meshes/locate/locate.h"
#include "problem/system/input_error.h"

namespace springproof {
namespace {

/// Appends a node for each anchor.
void add_anchors(const SpringsFile& file, const std::set<std::string>& held, Network& network, Embedding& embedding) {
  const int corners = network.nodes();
  for (const std::string& name : held) {
    for (Anchor a : file.anchors.at(name)) {
      a.node = corners + static_cast<int>(network.anchors.size());
      embedding.held[name].push_back(a.node);
      network.anchors.push_back(a);
    }
  }
  const auto nodes = corners + static_cast<Eigen::Index>(network.anchors.size());
  network.X.conservativeResize(nodes, 3);
  for (Eigen::VectorXd* of_nodes : {&network.volume, &network.attached}) {
    if (of_nodes->size() == 0) continue;
    of_nodes->conservativeResize(nodes);
    of_nodes->tail(nodes - corners).setZero();
  }
  for (const Anchor& a : network.anchors) network.X.row(a.node) = anchored_point(a, file.model.network.X).transpose();
}

/// Cells by what the body fills of them, the fullest first: of several in one cube that one has its middle.
std::vector<std::size_t> fullest_first(const CellSet& cells) {
  std::vector<std::size_t> order(cells.size());
  std::iota(order.begin(), order.end(), 0);
  std::ranges::stable_sort(order, std::greater(), [&](std::size_t c) { return cells.part(c).fraction; });
  return order;
}

void embed_mesh(const Mesh& mesh, const Network& network, Embedding& embedding) {
  const std::vector<std::size_t> order = fullest_first(network.cells);
  Mesh cells;
  cells.nodes = network.X;
  for (const std::size_t c : order) cells.hexahedra.push_back(network.cells.corners[c]);
  const Locator locator(cells);
  std::vector<Eigen::Triplet<double>> entries;
  std::vector<char> done(static_cast<std::size_t>(mesh.nodes.rows()), 0);
  for (const Hexahedron& cube : mesh.hexahedra) {
    const Vec3 middle = (mesh.nodes.row(cube[0]) + mesh.nodes.row(cube[6])).transpose() / 2;
    const std::size_t of_cube = order[locator(middle).cell];
    for (const int n : cube) {
      if (done[n]) continue;
      done[n] = 1;
      const Vec3 at = mesh.nodes.row(n).transpose();
      const auto position = [&](std::size_t c) -> Vec3 {
        return (at - network.X.row(network.cells.corners[c][0]).transpose()) / network.cells.edge_of(c);
      };
      std::size_t c = of_cube;  // of one size, cells continue to the nodes of their cube
      if (network.cells.kind() == CellKind::sizes && (position(c).array() - 0.5).abs().maxCoeff() > 0.5 + 1e-9)
        c = order[locator(at).cell];
      const Hexahedron& cell = network.cells.corners[c];
      const Vec3 xi = position(c);
      for (int k = 0; k < 8; ++k) {
        double weight = 1;
        for (int d = 0; d < 3; ++d) weight *= hexahedron_corners[k][d] ? xi[d] : 1 - xi[d];
        if (weight != 0) entries.emplace_back(n, cell[k], weight);
      }
    }
  }
  embedding.weights.resize(mesh.nodes.rows(), network.X.rows());
  embedding.weights.setFromTriplets(entries.begin(), entries.end());
}

}  // namespace

std::pair<MassSpringModel, Embedding> anchored(const SpringsFile& file, const std::set<std::string>& held,
                                               const Mesh& mesh) {
  if (file.volumes.size() == 0)
    throw InputError("/nodes: has no weight_kg, by which cut cells share the weight of the body");
  std::pair<MassSpringModel, Embedding> result{file.model, {}};
  auto& [model, embedding] = result;
  if (!law_of<Anchors>(model)) model.laws.emplace_back(Anchors{});
  Network& network = model.network;
  embed_mesh(mesh, network, embedding);
  add_anchors(file, held, network, embedding);
  embedding.weights.conservativeResize(embedding.weights.rows(), network.X.rows());
  const auto padded = [&](const auto& of_corners) {
    auto all = of_corners;
    all.conservativeResize(network.X.rows(), of_corners.cols());
    all.bottomRows(network.X.rows() - of_corners.rows()).setZero();
    return all;
  };
  embedding.volumes = padded(file.volumes);
  for (const auto& [name, shares] : file.loads) embedding.patches[name] = {padded(shares.area), padded(shares.normal)};
  return result;
}

}  // namespace springproof
