#include "msm/dynamics/time_step.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <stdexcept>

#include "msm/algebra/dense.h"
#include "msm/cells/stiffness_of_cells.h"
#include "msm/dynamics/terms/mass_average.h"
#include "msm/laws/capabilities.h"
#include "msm/laws/nodal_gradients.h"
#include "msm/multigrid/cell_stiffness.h"

namespace springproof {
namespace {

using NodeBlocks = std::vector<Eigen::Matrix3d>;

double largest_eigenvalue(const NodeBlocks& blocks) {
  double largest = 0;
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen;
  for (const Eigen::Matrix3d& b : blocks)
    largest = std::max(largest, eigen.computeDirect(b, Eigen::EigenvaluesOnly).eigenvalues()[2]);
  return largest;
}

/// Adds to each node's block the bound of springs of the given stiffness [N/m], divided by the masses.
void add_springs(const Network& network, const Eigen::VectorXd& mass, const std::vector<double>& stiffness,
                 NodeBlocks& blocks) {
  for (std::size_t s = 0; s < stiffness.size(); ++s) {
    const int i = network.master(network.springs[s].i), j = network.master(network.springs[s].j);
    const Vec3 n = (network.X.row(network.springs[s].j) - network.X.row(network.springs[s].i)).transpose().normalized();
    const Eigen::Matrix3d k = stiffness[s] * n * n.transpose();
    const double both = 1 / std::sqrt(mass[i] * mass[j]);
    blocks[i] += (1 / mass[i] + both) * k;
    blocks[j] += (1 / mass[j] + both) * k;
  }
}

/// The same for the volumes of nodes: (sum of g . dd)^2 <= sum |g|^2/k sum k (g . dd)^2 / |g|^2 over a node's spring
/// ends.
void add_volumes(const NodalGradients& nodes, const Eigen::VectorXd& mass, NodeBlocks& blocks) {
  const Network& network = nodes.network;
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(network.nodes());
  nodes.each_end(
      [&](std::size_t s, int end, int n) { sum[n] += nodes.g[s][end].squaredNorm() / network.springs[s].stiffness; });
  nodes.each_end([&](std::size_t s, int end, int n) {
    const int i = network.master(network.springs[s].i), j = network.master(network.springs[s].j);
    const Vec3 e = nodes.g[s][end].normalized();
    const Eigen::Matrix3d k = std::max(0.0, added_lambda(nodes.law)) * nodes.GV[n] * sum[n] *
                              network.springs[s].stiffness * e * e.transpose();
    const double both = 1 / std::sqrt(mass[i] * mass[j]);
    blocks[i] += (1 / mass[i] + both) * k;
    blocks[j] += (1 / mass[j] + both) * k;
  });
}

/// The same for any law, from the norms of the blocks of its stiffness at rest.
template <class Law>
void add_norms(const Network& network, const Eigen::VectorXd& mass, const Law& law, NodeBlocks& blocks) {
  Carriers carriers = carriers_of(network.nodes(), network.cells.carried);
  const auto coupled = coupled_through(carriers, coupled_nodes(network));
  BlockMatrix K(coupled, std::move(carriers));
  law.add_tangent(network, network.X, K);
  for (int i = 0; i < network.nodes(); ++i)
    for (int j : coupled[i]) {
      if (K.at(i, j).isZero(0)) continue;  // that of a carried node
      const double norm = K.at(i, j).norm() / std::sqrt(mass[network.master(i)] * mass[network.master(j)]);
      blocks[network.master(i)] += norm * Eigen::Matrix3d::Identity();
    }
}

Eigen::VectorXd checked_masses(const Network& network, double density) {
  const Eigen::VectorXd mass = masses(network, density);
  std::vector<char> massless(static_cast<std::size_t>(network.nodes()), 0);
  for (const Anchor& a : network.anchors) massless[a.node] = 1;
  for (const CarriedPoint& c : network.cells.carried) massless[c.point] = 1;
  for (int n = 0; n < network.nodes(); ++n)
    if (network.master(n) == n && !massless[n] && !(mass[n] > 0))
      throw std::invalid_argument("a node has no mass: explicit dynamics cannot move it");
  return mass;
}

/// Whether the springs and the laws of cells make the same stiffness in every cell.
bool has_whole_cells(const MassSpringModel& model) {
  if (!model.network.cells.materials.empty()) return false;
  bool of_cells = false;
  for (const ForceLaw& law : model.laws) {
    if (traits(law).reach != Reach::cells) continue;
    if (!lacks(law, Capability::equal_cells).empty()) return false;
    of_cells = true;
  }
  return of_cells && !model.network.cells.springs.empty();
}

/// Adds the bound of a law, but of those of a cell whose stiffness is known as a whole.
struct AddBound {
  const Network& network;
  const Eigen::VectorXd& mass;
  bool lagged, whole_cells;  ///< springs and laws of cells are in the stiffness of a cell
  NodeBlocks& blocks;

  void operator()(const Anchors&) const {}          // their nodes have a support mass
  void operator()(const AveragedSprings&) const {}  // by whole cells, or by frequency_squared_of_cells()
  void operator()(const MeasuredCells&) const {}    // the same
  void operator()(const Springs&) const {
    if (whole_cells) return;
    std::vector<double> k;
    for (const Spring& s : network.springs) k.push_back(s.stiffness);
    add_springs(network, mass, k, blocks);
  }
  void operator()(const MomentumDispersion& law) const {
    if (law.of_volumes())
      add_volumes(NodalGradients(law, network), mass, blocks);
    else
      add_springs(network, mass, law.stiffness_bound(network, lagged), blocks);
  }
  template <class Law>
  void operator()(const Law& law) const {
    if (!whole_cells || Law::traits.reach != Reach::cells) add_norms(network, mass, law, blocks);
  }
};

/// Largest squared frequency of a full cell alone, of stiffness K and mass `full`, a share theta of it consistent.
double cell_frequency_squared(const CellMatrix& K, double full, double theta) {
  const double lumped = symmetric_eigenvalues(K)[23] / (full / 8);
  if (theta == 0) return lumped;
  const double a = 2 * theta / 3, beta = 1 / ((1 + a) * (1 + a)), alpha = (1 + 2 * a) * beta;
  const Eigen::Matrix<double, 8, 8> A = MassAverage::of_cell();
  CellMatrix M = CellMatrix::Zero();
  for (int m = 0; m < 8; ++m)
    for (int n = 0; n < 8; ++n)
      M.block<3, 3>(3 * m, 3 * n)
          .diagonal()
          .setConstant((m == n ? alpha - beta * theta : 0.0) + beta * theta * A(m, n));
  return std::min(symmetric_eigenvalues(K, full / 8 * M)[23], MassAverage::largest_gain(theta) * lumped);
}

/// Weights of the nodes that carry the corners of a bond.
std::map<int, double> weights_of(const InterfaceBond& bond, const Carriers& carriers) {
  std::map<int, double> weights;
  for_each_corner(bond, [&](int n, double w) {
    for_each_carrier(carriers, n, [&](int p, double share) { weights[p] += w * share; });
  });
  std::erase_if(weights, [](const auto& at) { return std::abs(at.second) < 1e-9; });
  return weights;
}

double largest_stiffness(const InterfaceBond& bond) {
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(bond.stiffness).eigenvalues()[2];
}

/// By cells, and bonds as such: no squared frequency is above the largest that a cell has alone, with any shares of its
/// nodes' masses that add up over the cells of a node (Irons and Treharne).  A cell's share is in proportion to its own
/// stiffness at the node; in a second round times the frequency that it then has.  The nodes of a cell with carried
/// corners are those that carry them.
class CellFrequencies {
 public:
  CellFrequencies(StiffnessOfCells cells, const Network& network, const Eigen::VectorXd& mass)
      : cells_(std::move(cells)),
        network_(network),
        mass_(mass),
        nodes_(network.cells.size()),
        weight_(network.cells.size()) {
    const Carriers carriers = carriers_of(network.nodes(), network.cells.carried);
    for (std::size_t c = 0; c < network.cells.size(); ++c) {
      find_nodes(c, carriers);
      const Eigen::MatrixXd K = stiffness(c);
      for (std::size_t n = 0; n < nodes_[c].size(); ++n) {
        const auto at = 3 * static_cast<Eigen::Index>(n);
        weight_[c].push_back(K.diagonal().segment<3>(at).sum());
      }
    }
  }

  void add_bonds() {
    const Carriers carriers = carriers_of(network_.nodes(), network_.cells.carried);
    for (const InterfaceBond& bond : network_.bonds) {
      nodes_.emplace_back();
      weight_.emplace_back();
      bonds_.push_back({largest_stiffness(bond), {}});
      for (const auto& [node, w] : weights_of(bond, carriers)) {
        nodes_.back().push_back(node);
        weight_.back().push_back(bond.stiffness.trace() * w * w);
        bonds_.back().squares.push_back(w * w);
      }
    }
  }

  /// Largest squared frequency of a cell alone; raises the weights of stiff ones.
  double round() {
    Eigen::VectorXd total = Eigen::VectorXd::Zero(network_.nodes());
    for (std::size_t c = 0; c < weight_.size(); ++c)
      for (std::size_t n = 0; n < nodes_[c].size(); ++n) total[nodes_[c][n]] += weight_[c][n];
    std::map<std::vector<float>, double> of_full;  // by the shares, whose neighbours are the same for most cells
    double largest = 0;
    for (std::size_t c = 0; c < weight_.size(); ++c) {
      std::vector<double> share;
      for (std::size_t n = 0; n < nodes_[c].size(); ++n)
        share.push_back(mass_[nodes_[c][n]] * weight_[c][n] / total[nodes_[c][n]]);
      if (c >= network_.cells.size()) {
        const double own = bonds_[c - network_.cells.size()].alone(share);
        largest = std::max(largest, own);
        for (double& w : weight_[c]) w *= std::sqrt(own);
        continue;
      }
      std::vector<float> key = {static_cast<float>(network_.cells.edge_of(c)),
                                static_cast<float>(network_.cells.material(c))};
      for (const double s : share) key.push_back(static_cast<float>(s));
      const bool full = cells_.full_alike && network_.cells.is_full(c) && !through_.contains(c);
      const auto known = full ? of_full.find(key) : of_full.end();
      const double own = known != of_full.end() ? known->second : alone(c, share);
      if (full) of_full[key] = own;
      largest = std::max(largest, own);
      for (double& w : weight_[c]) w *= std::sqrt(own);
    }
    return largest * (1 + rounding);
  }

 private:
  static constexpr double rounding = 1e-6;  // of the keys

  void find_nodes(std::size_t cell, const Carriers& carriers) {
    const Hexahedron& corners = network_.cells.corners[cell];
    const auto is_carried = [&](int corner) { return !carriers.empty() && !carriers[corner].empty(); };
    if (std::none_of(corners.begin(), corners.end(), is_carried)) {
      for (const int corner : corners) nodes_[cell].push_back(network_.master(corner));
      return;
    }
    std::map<int, Eigen::VectorXd> shares;  // of the corners, per node that carries some
    for (int n = 0; n < 8; ++n)
      for_each_carrier(carriers, corners[n], [&](int node, double w) {
        shares.try_emplace(node, Eigen::VectorXd::Zero(8)).first->second[n] += w;
      });
    Eigen::MatrixXd W = Eigen::MatrixXd::Zero(24, 3 * static_cast<Eigen::Index>(shares.size()));
    for (const auto& [node, w] : shares) {
      const auto column = 3 * static_cast<Eigen::Index>(nodes_[cell].size());
      for (int n = 0; n < 8; ++n) W.block<3, 3>(3 * n, column).diagonal().setConstant(w[n]);
      nodes_[cell].push_back(node);
    }
    through_[cell] = std::move(W);
  }

  /// Between the nodes of the cell.
  Eigen::MatrixXd stiffness(std::size_t cell) const {
    const CellMatrix K = cells_.of(cell);
    const auto at = through_.find(cell);
    if (at == through_.end()) return K;
    return at->second.transpose() * K * at->second;
  }

  double alone(std::size_t cell, const std::vector<double>& share) const {
    Eigen::VectorXd scale(3 * static_cast<Eigen::Index>(share.size()));
    for (std::size_t n = 0; n < share.size(); ++n)
      scale.segment<3>(3 * static_cast<Eigen::Index>(n)).setConstant(1 / std::sqrt(share[n]));
    const Eigen::VectorXd values = symmetric_eigenvalues(scale.asDiagonal() * stiffness(cell) * scale.asDiagonal());
    return values[values.size() - 1];
  }

  struct Alone {
    double stiffness;             ///< largest [N/m]
    std::vector<double> squares;  ///< of the weights of its nodes

    double alone(const std::vector<double>& share) const {
      double sum = 0;
      for (std::size_t n = 0; n < share.size(); ++n) sum += squares[n] / share[n];
      return stiffness * sum;
    }
  };

  StiffnessOfCells cells_;
  const Network& network_;
  const Eigen::VectorXd& mass_;
  std::vector<Alone> bonds_;
  std::vector<std::vector<int>> nodes_;             ///< of each cell, then of each bond
  std::vector<std::vector<double>> weight_;         ///< of a cell in the mass of its nodes
  std::map<std::size_t, Eigen::MatrixXd> through_;  ///< corners from nodes, 24 x 3 nodes; cells with carried corners
};

double frequency_squared_of_cells(const StiffnessOfCells& of, const Network& network, const Eigen::VectorXd& mass,
                                  bool bonded = false) {
  CellFrequencies cells(of, network, mass);
  if (bonded) cells.add_bonds();
  const double first = cells.round();
  double least = std::min(first, cells.round());
  for (int further = 0; bonded && further < 6; ++further) least = std::min(least, cells.round());
  return least;
}

}  // namespace

double safe_time_step(const MassSpringModel& model, double density, bool lagged, double theta) {
  const Network& network = model.network;
  const Eigen::VectorXd mass = checked_masses(network, density);
  const bool cells = has_whole_cells(model);
  NodeBlocks blocks(network.nodes(), Eigen::Matrix3d::Zero());
  const AveragedSprings* averaged = cells ? nullptr : averaged_springs_of(model);
  for (const ForceLaw& law : model.laws) std::visit(AddBound{network, mass, lagged, cells, blocks}, law);
  const double gain = MassAverage::largest_gain(theta);
  double largest = gain * largest_eigenvalue(blocks);
  if (cells) {
    const CellStiffness cell = cell_stiffness(model);
    largest += cell_frequency_squared(cell.total, density * cell.volume, theta);
  }
  if (averaged) {  // the smaller of two bounds
    const bool full = theta > 0 && !network.cells.cut(), bonded = !network.bonds.empty() && law_of<Anchors>(model);
    largest += full ? cell_frequency_squared(averaged->cell_matrix(network.cells.full()),
                                             density * network.cells.volume(), theta)
                    : gain * frequency_squared_of_cells(
                                 {[&](std::size_t c) { return averaged->cell_matrix(network.cells.shape(c)); }, true},
                                 network, mass, bonded);
    if (!bonded) {
      add_norms(network, mass, *averaged, blocks);
      largest = std::min(largest, gain * largest_eigenvalue(blocks));
    }
  }
  if (const auto* measured = law_of<MeasuredCells>(model)) {
    largest +=
        gain * frequency_squared_of_cells(
                   {[&](std::size_t c) { return measured->cell_matrix(network.cells, c); }, false}, network, mass);
    add_norms(network, mass, *measured, blocks);
    largest = std::min(largest, gain * largest_eigenvalue(blocks));
  }
  return 2 / std::sqrt(largest);
}

void soften_bonds(MassSpringModel& model, double density) {
  constexpr double share_of_cells = 0.25;
  Network& network = model.network;
  const AveragedSprings* law = averaged_springs_of(model);
  if (network.bonds.empty() || !law) return;
  const Eigen::VectorXd mass = masses(network, density);
  const Carriers carriers = carriers_of(network.nodes(), network.cells.carried);
  std::map<Hexahedron, std::size_t> cell_of;
  for (std::size_t c = 0; c < network.cells.size(); ++c) cell_of[network.cells.corners[c]] = c;
  const auto full_cell = [&](const Hexahedron& corners) {
    CellShape cell = network.cells.shape(cell_of.at(corners));
    cell.part = {};
    const double of_material = network.cells.relative_densities[cell.material];
    return cell_frequency_squared(law->cell_matrix(cell), density * of_material * cell.volume(), 0);
  };
  std::map<std::array<Hexahedron, 2>, double> together;  // squared frequencies of the bonds of two cells
  for (InterfaceBond& bond : network.bonds) {
    const double softest = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(bond.stiffness).eigenvalues()[0];
    bond.stiffness = softest * Eigen::Matrix3d::Identity();
    for (const auto& [node, w] : weights_of(bond, carriers)) together[bond.corners] += softest * w * w / mass[node];
  }
  for (InterfaceBond& bond : network.bonds) {
    const double cells = std::max(full_cell(bond.corners[0]), full_cell(bond.corners[1]));
    bond.stiffness *= std::min(1.0, share_of_cells * cells / together[bond.corners]);
  }
}

double viscous_time_step(const MassSpringModel& model, double density, const Viscosity& viscosity, double elastic,
                         double theta) {
  if (!viscosity.acts()) return elastic;
  const ForceLaw cells = viscosity.of_measured() ? ForceLaw(viscosity.measured()) : viscosity.cells();
  const MassSpringModel dashpots{model.network, {cells}};
  const double of_dashpots = viscosity.along_springs() ? elastic : safe_time_step(dashpots, density, false, theta);
  const double frequency = 2 / elastic, rate = viscosity.time() * 4 / (of_dashpots * of_dashpots);
  return 4 / (std::sqrt(rate * rate + 4 * frequency * frequency) + rate);
}

double relaxing_time_step(const MassSpringModel& model, double density, const RelaxingCells& relaxing, double elastic,
                          double theta) {
  if (!relaxing.acts()) return elastic;
  const double shares = relaxing.relaxation.instantaneous() - 1;
  if (relaxing.of_measured()) {
    MassSpringModel sudden = model;
    std::vector<double>& form = law_of<MeasuredCells>(sudden)->form;
    for (std::size_t i = 0; i < form.size(); ++i) form[i] += shares * relaxing.measured.form[i];
    return safe_time_step(sudden, density, false, theta);
  }
  AveragedSprings branches = relaxing.cells;
  branches.shear_modulus *= shares;
  branches.lame_lambda = -2 * branches.shear_modulus / 3;  // no bulk modulus
  if (!averaged_springs_of(model)) {
    const double of_branches = safe_time_step({model.network, {branches}}, density, false, theta);
    return 1 / std::sqrt(1 / (elastic * elastic) + 1 / (of_branches * of_branches));
  }
  MassSpringModel sudden = model;
  AveragedSprings& own = *law_of<AveragedSprings>(sudden);
  own.shear_modulus += branches.shear_modulus;
  own.lame_lambda += branches.lame_lambda;
  return safe_time_step(sudden, density, false, theta);
}

double dispersion_frequency_squared(const MassSpringModel& model, double density) {
  const MomentumDispersion* dispersion = dispersion_of(model);
  if (!dispersion) return 0;
  NodeBlocks blocks(model.network.nodes(), Eigen::Matrix3d::Zero());
  add_springs(model.network, checked_masses(model.network, density), dispersion->stiffness_bound(model.network, false),
              blocks);
  return largest_eigenvalue(blocks);
}

}  // namespace springproof
