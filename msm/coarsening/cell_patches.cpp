#include "msm/coarsening/cell_patches.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <unordered_map>

#include "msm/coarsening/layered_solver.h"
#include "msm/coarsening/states.h"
#include "msm/embedding/supports.h"

namespace springproof {
namespace {

using CellStiffnessMatrix = Eigen::Matrix<double, 24, 24>;

constexpr double smoothing = 1e-2;  // of the patterns of the corners in the restriction

CellShape shape_of(const CutBody& body, int cell) { return {body.grid.edge, body.cells[cell].filled}; }

double youngs_modulus(const AveragedSprings& law) {
  const double G = law.shear_modulus, lambda = law.lame_lambda;
  return G * (3 * lambda + 2 * G) / (lambda + G);
}

/// The free unknowns of fine nodes, layer by layer along the axis that makes the least work; a layer has `thickness`
/// planes of nodes.
struct Layers {
  std::vector<int> layer, place;    ///< of each node, and its first unknown in the layer; -1: held
  std::vector<int> unknowns;        ///< of each layer
  std::vector<Eigen::Index> first;  ///< unknown of each layer, then their number

  Layers(const CutBody& fine, const std::vector<int>& nodes, const std::vector<char>& held, int thickness) {
    double least = std::numeric_limits<double>::infinity();
    for (int axis = 0; axis < 3; ++axis) {
      Layers next(fine, nodes, held, thickness, axis);
      double work = 0;
      for (const int n : next.unknowns) work += std::pow(n, 3);
      if (work >= least) continue;
      least = work;
      *this = std::move(next);
    }
    first = {0};
    for (const int n : unknowns) first.push_back(first.back() + n);
  }

  Eigen::Index unknown(int node) const { return first[layer[node]] + place[node]; }

 private:
  Layers(const CutBody& fine, const std::vector<int>& nodes, const std::vector<char>& held, int thickness, int axis)
      : layer(nodes.size(), -1), place(nodes.size(), -1) {
    int lowest = std::numeric_limits<int>::max();
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      if (held[i]) continue;
      layer[i] = static_cast<int>(std::lround((fine.points(nodes[i], axis) - fine.grid.origin[axis]) / fine.grid.edge));
      lowest = std::min(lowest, layer[i]);
    }
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      if (held[i]) continue;
      layer[i] = (layer[i] - lowest) / thickness;
      if (layer[i] >= static_cast<int>(unknowns.size())) unknowns.resize(layer[i] + 1, 0);
      place[i] = unknowns[layer[i]];
      unknowns[layer[i]] += 3;
    }
  }
};

}  // namespace

/// The cells around a cell.
struct CellPatches::Patch {
  std::vector<int> cells, nodes;        ///< of the coarse lattice
  std::unordered_map<int, int> number;  ///< of a coarse node among these
  std::vector<int> fine;                ///< cells
};

/// The fine nodes of a patch.
struct CellPatches::FineNodes {
  std::vector<int> node;                      ///< of the fine lattice
  std::vector<double> volume;                 ///< share of each in the patch [m^3]
  std::vector<std::array<int, 8>> coarse;     ///< of each, the nodes of the patch that it follows ...
  std::vector<std::array<double, 8>> weight;  ///< ... and their weights
  std::vector<char> held;                     ///< cut off from the rest of the body
  std::unordered_map<int, int> number;        ///< of a fine node among these
  std::vector<std::array<int, 8>> corners;    ///< of the patch's fine cells
};

CellPatches::CellPatches(const CutBody& coarse, const FineCells& fine, const AveragedSprings& law,
                         const std::vector<std::string>& held)
    : coarse_(coarse), fine_(fine), law_(law) {
  for (std::size_t m = 0; m <= law.regions.size(); ++m)
    stiffness_.push_back(law.in(static_cast<int>(m)).cell_matrix({fine.body.grid.edge}));
  at_.resize(coarse.points.rows());
  for (int c = 0; c < static_cast<int>(coarse.cells.size()); ++c)
    for (const int n : coarse.cells[c].corners) at_[n].push_back(c);
  cells_at_.resize(fine.body.points.rows(), 0);
  for (int f = 0; f < static_cast<int>(fine.in.size()); ++f) {
    const CutCell& cell = fine.body.cells[f];
    const bool full = cell.filled.fraction == 1;
    number_.push_back(full ? cell.material : static_cast<int>(stiffness_.size()));
    if (!full) stiffness_.push_back(law.in(cell.material).cell_matrix(shape_of(fine.body, f)));
    if (fine.in[f] < 0) continue;
    for (const int n : fine.body.cells[f].corners) ++cells_at_[n];
  }
  add_supports(held);
  add_bonds();
}

void CellPatches::add_bonds() {
  bonds_ = bonds_of_interfaces(fine_.body, materials_of(law_));
  bonds_of_.resize(fine_.in.size());
  reaches_.resize(fine_.in.size(), 0);
  for (std::size_t b = 0; b < bonds_.size(); ++b) {
    const auto& sides = fine_.body.interfaces[b / bonds_of_part].sides;
    bonds_of_[sides[0].cell].push_back(static_cast<int>(b));
    if (fine_.body.cells[sides[0].cell].index != fine_.body.cells[sides[1].cell].index) reaches_[sides[0].cell] = 1;
  }
}

void CellPatches::add_supports(const std::vector<std::string>& held) {
  at_support_.assign(fine_.body.points.rows(), 0);
  for (const std::string& name : held) {
    const std::vector<PatchInCell>& parts = fine_.body.patches.at(name);
    const std::vector<Anchor> anchors = anchors_of_patch(fine_.body, name, materials_of(law_));
    for (std::size_t a = 0; a < anchors.size(); ++a) {
      const int cell = parts[a / anchors_of_part].cell;
      CellStiffnessMatrix& K = anchors_.try_emplace(cell, CellStiffnessMatrix::Zero()).first->second;
      const std::array<double, 8>& w = anchors[a].weights;
      for (int m = 0; m < 8; ++m)
        for (int n = 0; n < 8; ++n) K.block<3, 3>(3 * m, 3 * n) += w[m] * w[n] * anchors[a].stiffness;
      for (const int n : fine_.body.cells[cell].corners) at_support_[n] = 1;
    }
  }
}

std::vector<char> CellPatches::near_supports() const {
  std::vector<char> holds(coarse_.cells.size(), 0), near = holds;
  for (const auto& [cell, stiffness] : anchors_)
    if (fine_.in[cell] >= 0) holds[fine_.in[cell]] = 1;
  for (std::size_t c = 0; c < near.size(); ++c)
    for (const int n : coarse_.cells[c].corners)
      for (const int other : at_[n]) near[c] |= holds[other];
  return near;
}

const CellStiffnessMatrix& CellPatches::stiffness(int fine) const { return stiffness_[number_[fine]]; }

/// Unless it leads out of the patch.
template <class Act>
void CellPatches::each_of_bond(const InterfaceBond& bond, const FineNodes& nodes, const Act& act) const {
  std::vector<std::pair<int, double>> ends;
  bool inside = true;
  for_each_corner(bond, [&](int node, double weight) {
    const auto at = nodes.number.find(node);
    inside = inside && at != nodes.number.end();
    if (inside) ends.emplace_back(at->second, weight);
  });
  if (!inside) return;
  for (const auto& [m, v] : ends)
    for (const auto& [n, w] : ends) act(m, n, Eigen::Matrix3d(v * w * bond.stiffness));
}

template <class Act>
void CellPatches::each_coupling(const Patch& patch, const FineNodes& nodes, const Act& act) const {
  for (std::size_t f = 0; f < patch.fine.size(); ++f) {
    const CellStiffnessMatrix& k = stiffness(patch.fine[f]);
    const auto anchors = anchors_.find(patch.fine[f]);
    for (int m = 0; m < 8; ++m)
      for (int n = 0; n < 8; ++n) {
        Eigen::Matrix3d block = k.block<3, 3>(3 * m, 3 * n);
        if (anchors != anchors_.end()) block += anchors->second.block<3, 3>(3 * m, 3 * n);
        act(nodes.corners[f][m], nodes.corners[f][n], block);
      }
    for (const int b : bonds_of_[patch.fine[f]]) each_of_bond(bonds_[b], nodes, act);
  }
}

CellPatches::Patch CellPatches::patch_of(int cell) const {
  Patch patch;
  for (const int n : coarse_.cells[cell].corners) patch.cells.insert(patch.cells.end(), at_[n].begin(), at_[n].end());
  std::sort(patch.cells.begin(), patch.cells.end());
  patch.cells.erase(std::unique(patch.cells.begin(), patch.cells.end()), patch.cells.end());
  for (const int c : patch.cells) {
    patch.fine.insert(patch.fine.end(), fine_.of[c].begin(), fine_.of[c].end());
    for (const int n : coarse_.cells[c].corners)
      if (patch.number.try_emplace(n, static_cast<int>(patch.nodes.size())).second) patch.nodes.push_back(n);
  }
  return patch;
}

CellPatches::FineNodes CellPatches::nodes_of(const Patch& patch) const {
  FineNodes all;
  std::vector<int> cells;  // of the patch, that have each node
  for (const int f : patch.fine) {
    const Hexahedron& corners = coarse_.cells[fine_.in[f]].corners;
    std::array<int, 8> own, coarse;
    for (int k = 0; k < 8; ++k) coarse[k] = patch.number.at(corners[k]);
    for (int k = 0; k < 8; ++k) {
      const int n = fine_.body.cells[f].corners[k];
      const auto [at, is_new] = all.number.try_emplace(n, static_cast<int>(all.node.size()));
      own[k] = at->second;
      if (is_new) {
        all.node.push_back(n);
        all.coarse.push_back(coarse);
        all.weight.push_back(coarse_.weights(fine_.in[f], fine_.body.points.row(n).transpose()));
        all.volume.push_back(0);
        cells.push_back(0);
      }
      ++cells[own[k]];
      all.volume[own[k]] += shape_of(fine_.body, f).volume() / 8;
    }
    all.corners.push_back(own);
  }
  for (std::size_t i = 0; i < all.node.size(); ++i) all.held.push_back(cells[i] < cells_at_[all.node[i]]);
  return all;
}

Eigen::MatrixXd CellPatches::stress_rows(int cell, const FineNodes& nodes) const {
  const DeformationRows T = deformation_of(shape_of(coarse_, cell));
  const DeformationRows inverse = (T * T.transpose()).ldlt().solve(T);
  Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(deformations_of_cell, 3 * static_cast<Eigen::Index>(nodes.node.size()));
  for (const int f : fine_.of[cell]) {
    const CellStiffnessMatrix& k = stiffness(f);
    CellStiffnessMatrix PTk = CellStiffnessMatrix::Zero();
    std::array<int, 8> own;
    for (int m = 0; m < 8; ++m) {
      const int n = fine_.body.cells[f].corners[m];
      own[m] = nodes.number.at(n);
      const std::array<double, 8> w = coarse_.weights(cell, fine_.body.points.row(n).transpose());
      for (int a = 0; a < 8; ++a) PTk.middleRows<3>(3 * a) += w[a] * k.middleRows<3>(3 * m);
    }
    const DeformationRows of_cell = inverse * PTk;
    for (int m = 0; m < 8; ++m) rows.middleCols<3>(3 * own[m]) += of_cell.middleCols<3>(3 * m);
  }
  return rows;
}

Eigen::MatrixXd CellPatches::restriction_matrix(const Patch& patch, const FineNodes& nodes) const {
  const auto points = static_cast<Eigen::Index>(patch.nodes.size());
  Eigen::MatrixXd M = Eigen::MatrixXd::Zero(3 * points, 3 * points);
  for (std::size_t i = 0; i < nodes.node.size(); ++i)
    for (int a = 0; a < 8; ++a)
      for (int b = 0; b < 8; ++b) {
        const double mass = nodes.volume[i] * nodes.weight[i][a] * nodes.weight[i][b];
        M.block<3, 3>(3 * nodes.coarse[i][a], 3 * nodes.coarse[i][b]).diagonal().array() += mass;
      }
  const double unit = smoothing * std::pow(coarse_.grid.edge, 2) / youngs_modulus(law_);
  for (const int c : patch.cells) {
    const CellShape shape = shape_of(coarse_, c);
    const Eigen::Matrix<double, 12, 24> Q = deformation_of(shape).bottomRows<12>();
    const CellStiffnessMatrix H = unit * Q.transpose() * cell_form(law_, shape).hourglass * Q;
    std::array<int, 8> own;
    for (int n = 0; n < 8; ++n) own[n] = patch.number.at(coarse_.cells[c].corners[n]);
    for (int m = 0; m < 8; ++m)
      for (int n = 0; n < 8; ++n) M.block<3, 3>(3 * own[m], 3 * own[n]) += H.block<3, 3>(3 * m, 3 * n);
  }
  return M;
}

Eigen::MatrixXd CellPatches::deformation_rows(int cell, const Patch& patch, const FineNodes& nodes) const {
  Eigen::MatrixXd corners =
      Eigen::MatrixXd::Zero(3 * static_cast<Eigen::Index>(patch.nodes.size()), deformations_of_cell);
  const DeformationRows T = deformation_of(shape_of(coarse_, cell));
  for (int n = 0; n < 8; ++n)
    corners.middleRows<3>(3 * patch.number.at(coarse_.cells[cell].corners[n])) = T.middleCols<3>(3 * n).transpose();
  const Eigen::MatrixXd dual = restriction_matrix(patch, nodes).ldlt().solve(corners);
  Eigen::MatrixXd rows(deformations_of_cell, 3 * static_cast<Eigen::Index>(nodes.node.size()));
  for (std::size_t i = 0; i < nodes.node.size(); ++i) {
    Eigen::Matrix<double, 3, deformations_of_cell> sum = Eigen::Matrix<double, 3, deformations_of_cell>::Zero();
    for (int a = 0; a < 8; ++a)
      sum += nodes.volume[i] * nodes.weight[i][a] * dual.middleRows<3>(3 * nodes.coarse[i][a]);
    rows.middleCols<3>(3 * static_cast<Eigen::Index>(i)) = sum.transpose();
  }
  return rows;
}

PatchAnswer CellPatches::answer(int cell) const {
  const Patch patch = patch_of(cell);
  const FineNodes nodes = nodes_of(patch);
  if (fine_.of[cell].empty() || std::count(nodes.held.begin(), nodes.held.end(), 1) == 0) return {};
  const bool reaches = std::any_of(patch.fine.begin(), patch.fine.end(), [&](int f) { return reaches_[f] != 0; });
  const Layers layers(fine_.body, nodes.node, nodes.held, reaches ? 2 : 1);
  LayeredMatrix K(layers.unknowns);
  each_coupling(patch, nodes, [&](int m, int n, const Eigen::Matrix3d& k) {
    if (nodes.held[m] || nodes.held[n]) return;
    if (layers.layer[m] == layers.layer[n]) K.of(layers.layer[m]).block<3, 3>(layers.place[m], layers.place[n]) += k;
    if (layers.layer[m] == layers.layer[n] + 1)
      K.below(layers.layer[n]).block<3, 3>(layers.place[m], layers.place[n]) += k;
  });
  if (!K.factor()) return {};

  // Rows of y and s over all fine nodes; then those of free nodes are expressed by the held ones.
  const auto count = static_cast<Eigen::Index>(nodes.node.size());
  Eigen::MatrixXd rows(2 * deformations_of_cell, 3 * count);
  rows << deformation_rows(cell, patch, nodes), stress_rows(cell, nodes);
  Eigen::MatrixXd dual(layers.first.back(), 2 * deformations_of_cell);
  for (int i = 0; i < count; ++i)
    if (!nodes.held[i]) dual.middleRows<3>(layers.unknown(i)) = rows.middleCols<3>(3 * i).transpose();
  K.solve(dual);
  each_coupling(patch, nodes, [&](int m, int n, const Eigen::Matrix3d& k) {
    if (!nodes.held[m] && nodes.held[n])
      rows.middleCols<3>(3 * n) -= dual.middleRows<3>(layers.unknown(m)).transpose() * k;
  });
  Eigen::MatrixXd of_coarse = Eigen::MatrixXd::Zero(rows.rows(), 3 * static_cast<Eigen::Index>(patch.nodes.size()));
  for (int i = 0; i < count; ++i)
    for (int a = 0; a < 8 && nodes.held[i] && !at_support_[nodes.node[i]]; ++a)
      of_coarse.middleCols<3>(3 * nodes.coarse[i][a]) += nodes.weight[i][a] * rows.middleCols<3>(3 * i);
  return {patch.nodes, of_coarse.topRows(deformations_of_cell), of_coarse.bottomRows(deformations_of_cell)};
}

}  // namespace springproof
