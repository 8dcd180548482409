#include "msm/parallel/lattice_transfers.h"

#include <algorithm>
#include <map>

#include "msm/multigrid/cut/cut_levels.h"
#include "msm/parallel/parted_equations.h"

namespace springproof {
namespace {

/// Weights of coarser points or cells, per finer one.
using Weights = std::vector<std::vector<std::pair<int, double>>>;

/// Whether all nodes are corners of cubes, or anchored.
bool is_lattice(const Network& network) {
  if (network.cells.empty() || !network.image_of.empty()) return false;
  std::vector<char> known(network.nodes(), 0);
  for (const Hexahedron& cell : network.cells.corners)
    for (const int corner : cell) known[corner] = 1;
  for (const Anchor& a : network.anchors) known[a.node] = 1;
  return std::find(known.begin(), known.end(), 0) == known.end();
}

/// Of the points of a level, carried coarser ones replaced by what carries them.
Weights weights_of_points(const CutLevel& fine, const CutLevel& coarse) {
  const Carriers carriers = carriers_of(static_cast<int>(coarse.point.size()), coarse.carried);
  Weights weights(fine.point.size());
  for (std::size_t i = 0; i < weights.size(); ++i) {
    std::map<int, double> sum;
    for (decltype(fine.weights)::InnerIterator of(fine.weights, static_cast<Eigen::Index>(i)); of; ++of)
      for_each_carrier(carriers, static_cast<int>(of.col()), [&](int p, double w) { sum[p] += w * of.value(); });
    weights[i].assign(sum.begin(), sum.end());
  }
  return weights;
}

/// Appends the anchored nodes, which follow the corners.
void add_anchored(const Network& network, Weights& weights) {
  weights.resize(network.nodes());
  for (const Anchor& a : network.anchors) {
    std::map<int, double> sum;
    for (int n = 0; n < 8; ++n)
      for (const auto& [p, w] : weights[a.corners[n]]) sum[p] += a.weights[n] * w;
    weights[a.node].assign(sum.begin(), sum.end());
  }
}

/// Process of each coarser point: that of the finer one with the largest weight in it.
std::vector<int> owners_above(const Weights& weights, const std::vector<int>& owner, std::size_t coarse) {
  std::vector<int> above(coarse, -1);
  std::vector<double> largest(coarse, 1e-6);
  for (std::size_t i = 0; i < weights.size(); ++i)
    for (const auto& [p, w] : weights[i])
      if (owner[i] >= 0 && w > largest[p]) {
        largest[p] = w;
        above[p] = owner[i];
      }
  return above;
}

/// `block` unknowns per point; rows of `fixed` unknowns (empty: none) are zero.
PetscMatrix transfer_matrix(const Weights& weights, const EquationNumbers& fine, const EquationNumbers& coarse,
                            int block, const std::vector<char>& fixed, MPI_Comm communicator) {
  MatrixRows rows;
  for (const int point : fine.own)
    for (int d = 0; d < block; ++d) {
      const bool is_free = fixed.empty() || !fixed[block * point + d];
      std::vector<std::pair<PetscInt, double>> row;
      for (const auto& [p, w] : weights[point])
        if (coarse.number[p] >= 0) row.emplace_back(block * coarse.number[p] + d, is_free ? w : 0);
      rows.add(std::move(row));
    }
  return rows.matrix(block * coarse.own.size(), block, communicator);
}

/// The equations on each level: those of the finest by `owner`, and as the weights lead to coarser ones.
std::vector<EquationNumbers> equations_of(const std::vector<Weights>& weights, std::vector<int> owner,
                                          const std::vector<std::size_t>& sizes, MPI_Comm communicator) {
  std::vector<EquationNumbers> equations = {number_equations(owner, communicator)};
  for (std::size_t l = 0; l < weights.size(); ++l) {
    owner = owners_above(weights[l], owner, sizes[l + 1]);
    equations.push_back(number_equations(owner, communicator));
  }
  return equations;
}

/// The points that move the corners of cells with anchors or bonds; of the network also the anchored nodes.
std::vector<char> points_at_anchors(const CutLevel& level, const std::vector<Anchor>& nodes, std::size_t points) {
  std::vector<char> marked(points, 0);
  for (const std::vector<int>& together : level.anchored_points())
    for (const int point : together) marked[point] = 1;
  for (const Anchor& a : nodes) marked[a.node] = 1;
  return marked;
}

/// Of marked points, counted from the first own unknown.
PetscIndices own_unknowns(const std::vector<char>& marked, const EquationNumbers& equations) {
  std::vector<PetscInt> unknowns;
  for (std::size_t i = 0; i < equations.own.size(); ++i)
    for (int d = 0; d < 3 && marked[equations.own[i]]; ++d) unknowns.push_back(static_cast<PetscInt>(3 * i) + d);
  PetscIndices indices;
  require(ISCreateGeneral(PETSC_COMM_SELF, static_cast<PetscInt>(unknowns.size()), unknowns.data(), PETSC_COPY_VALUES,
                          &indices));
  return indices;
}

}  // namespace

LatticeTransfers lattice_transfers(const Network& network, const std::vector<char>& fixed,
                                   const std::vector<int>& nodes, const std::vector<int>& cells,
                                   MPI_Comm communicator) {
  LatticeTransfers transfers;
  if (!is_lattice(network)) return transfers;
  std::vector<Weights> of_points, of_cells;
  std::vector<std::size_t> points, cubes;
  const std::vector<CutLevel> levels = cut_levels(network, AnchoredNodes(network, fixed));
  for (const CutLevel& level : levels) {
    points.push_back(level.point.size());
    cubes.push_back(level.cubes.size());
    if (&level == &levels.back()) break;
    of_points.push_back(weights_of_points(level, *(&level + 1)));
    Weights& parents = of_cells.emplace_back();
    for (const int parent : level.parent) parents.push_back({{parent, 1.0}});
  }
  if (of_points.empty()) return transfers;
  add_anchored(network, of_points.front());
  points.front() = of_points.front().size();
  const std::vector<EquationNumbers> of_nodes = equations_of(of_points, nodes, points, communicator);
  for (std::size_t l = 0; l < of_points.size(); ++l) {
    const bool finest = l == 0;
    transfers.displacements.push_back(transfer_matrix(of_points[l], of_nodes[l], of_nodes[l + 1], 3,
                                                      finest ? fixed : std::vector<char>{}, communicator));
    transfers.anchored.push_back(own_unknowns(
        points_at_anchors(levels[l], finest ? network.anchors : std::vector<Anchor>{}, points[l]), of_nodes[l]));
  }
  if (cells.empty()) return transfers;
  const std::vector<EquationNumbers> of_pressures = equations_of(of_cells, cells, cubes, communicator);
  for (std::size_t l = 0; l < of_cells.size(); ++l)
    transfers.pressures.push_back(
        transfer_matrix(of_cells[l], of_pressures[l], of_pressures[l + 1], 1, {}, communicator));
  return transfers;
}

}  // namespace springproof
