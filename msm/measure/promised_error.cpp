#include "msm/measure/promised_error.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <optional>
#include <set>
#include <stdexcept>

#include "meshes/voxels/cells_apart.h"
#include "meshes/voxels/refined_grid.h"

namespace springproof {
namespace {

constexpr double share_of_the_error = 0.3;  // of the cells that are halved at once
constexpr int most_halvings = 4;
constexpr double least_fall = 1.1;    // of an estimate, for how far it falls short
constexpr double least_spread = 0.1;  // variance of the middles of cells along any axis, in edges; of eight cells 1/4
constexpr int most_rings = 3;         // of cells around a node

/// Strains as rows of nine.
using Strains = Eigen::Matrix<double, Eigen::Dynamic, 9, Eigen::RowMajor>;

Eigen::Matrix3d as_matrix(const Eigen::Matrix<double, 1, 9>& row) {
  return Eigen::Map<const Eigen::Matrix3d>(row.data());
}

double energy_density(const AveragedSprings& law, const Eigen::Matrix3d& strain) {
  return law.lame_lambda / 2 * strain.trace() * strain.trace() + law.shear_modulus * strain.squaredNorm();
}

/// Mean strain of each cell.
Strains cell_strains(const Network& network, const NodalVectors& u) {
  Strains strains(static_cast<Eigen::Index>(network.cells.size()), 9);
  for (std::size_t c = 0; c < network.cells.size(); ++c) {
    const Eigen::Matrix3d H = mean_gradient(network, c, u);
    const Eigen::Matrix3d strain = (H + H.transpose()) / 2;
    strains.row(static_cast<Eigen::Index>(c)) = Eigen::Map<const Eigen::Matrix<double, 1, 9>>(strain.data());
  }
  return strains;
}

/// Strain at each node; that of a carried one follows from the others.
Strains nodal_strains(const Network& network, const Strains& of_cells) {
  Strains sum = Strains::Zero(network.nodes(), 9);
  Eigen::VectorXd volume = Eigen::VectorXd::Zero(network.nodes());
  for (std::size_t c = 0; c < network.cells.size(); ++c)
    for (const int n : network.cells.corners[c]) {
      sum.row(n) += filled_volume(network, c) * of_cells.row(static_cast<Eigen::Index>(c));
      volume[n] += filled_volume(network, c);
    }
  for (auto p = network.cells.carried.rbegin(); p != network.cells.carried.rend(); ++p)
    for (const int n : p->by) {
      sum.row(n) += sum.row(p->point) / static_cast<double>(p->by.size());
      volume[n] += volume[p->point] / static_cast<double>(p->by.size());
    }
  for (int n = 0; n < network.nodes(); ++n)
    if (volume[n] > 0) sum.row(n) /= volume[n];
  for (const CarriedPoint& p : network.cells.carried) {
    sum.row(p.point).setZero();
    for (const int n : p.by) sum.row(p.point) += sum.row(n) / static_cast<double>(p.by.size());
  }
  return sum;
}

/// Weight of each corner of a cell where what it holds has its middle.
std::array<double, 8> weights_of_middle(const FilledPart& part) {
  std::array<double, 8> weights;
  for (int n = 0; n < 8; ++n) {
    weights[n] = 1;
    for (int d = 0; d < 3; ++d) weights[n] *= 0.5 + corner_side(n, d) * part.mean[d];
  }
  return weights;
}

/// The strain at a place that is linear in some cells and nearest to their mean strains; nothing where the cells do not
/// span the space.
class LinearStrain {
 public:
  LinearStrain(const Network& network, const Strains& of_cells)
      : of_cells_(of_cells),
        edges_(network.cells.edge * network.cells.proportions.transpose()),
        middle_(static_cast<Eigen::Index>(network.cells.size()), 3) {
    for (std::size_t c = 0; c < network.cells.size(); ++c) {
      const std::array<double, 8> weights = weights_of_middle(network.cells.part(c));
      Eigen::RowVector3d X = Eigen::RowVector3d::Zero();
      for (int n = 0; n < 8; ++n) X += weights[n] * network.X.row(network.cells.corners[c][n]);
      middle_.row(static_cast<Eigen::Index>(c)) = X;
      volume_.push_back(filled_volume(network, c));
    }
  }

  std::optional<Eigen::Matrix<double, 1, 9>> operator()(const std::set<int>& cells, const Eigen::RowVector3d& X) const {
    Eigen::Matrix4d moments = Eigen::Matrix4d::Zero();
    Eigen::Matrix<double, 4, 9> sum = Eigen::Matrix<double, 4, 9>::Zero();
    double volume = 0;
    for (const int c : cells) {
      Eigen::Vector4d of;
      of << 1, (middle_.row(c) - X).cwiseQuotient(edges_).transpose();
      moments += volume_[c] * of * of.transpose();
      sum += volume_[c] * of * of_cells_.row(c);
      volume += volume_[c];
    }
    const Vec3 mean = moments.col(0).tail<3>() / volume;
    const Eigen::Matrix3d spread = moments.bottomRightCorner<3, 3>() / volume - mean * mean.transpose();
    if (spread.selfadjointView<Eigen::Lower>().eigenvalues()[0] < least_spread) return {};
    return moments.ldlt().solve(sum).row(0).eval();
  }

  Eigen::Matrix<double, 1, 9> mean(const std::vector<int>& cells) const {
    Eigen::Matrix<double, 1, 9> sum = Eigen::Matrix<double, 1, 9>::Zero();
    double volume = 0;
    for (const int c : cells) {
      sum += volume_[c] * of_cells_.row(c);
      volume += volume_[c];
    }
    return sum / volume;
  }

 private:
  const Strains& of_cells_;
  Eigen::RowVector3d edges_;
  NodalVectors middle_;
  std::vector<double> volume_;
};

std::set<int> cells_at_corners(const CellsApart& all, const std::vector<std::vector<int>>& at,
                               const std::set<int>& cells) {
  std::set<int> around;
  for (const int c : cells)
    for (const int n : all.corners[c]) around.insert(at[n].begin(), at[n].end());
  return around;
}

/// Energy of the anchors of each cell, and half of that of its bonds.
std::vector<double> anchor_energies(const Network& network, const NodalVectors& u) {
  std::map<Hexahedron, std::size_t> cell_of;
  for (std::size_t c = 0; c < network.cells.size(); ++c) cell_of[network.cells.corners[c]] = c;
  std::vector<double> energies(network.cells.size());
  for (const Anchor& anchor : network.anchors) {
    Vec3 gap = -u.row(anchor.node).transpose();
    for (int n = 0; n < 8; ++n) gap += anchor.weights[n] * u.row(anchor.corners[n]).transpose();
    energies[cell_of.at(anchor.corners)] += gap.dot(anchor.stiffness * gap) / 2;
  }
  for (const InterfaceBond& bond : network.bonds) {
    const Vec3 g = gap(bond, u);
    for (const Hexahedron& side : bond.corners) energies[cell_of.at(side)] += g.dot(bond.stiffness * g) / 4;
  }
  return energies;
}

double sum_of(const std::vector<double>& energies) { return std::accumulate(energies.begin(), energies.end(), 0.0); }

/// The cells whose errors, the largest first, make up this share of the error.
std::vector<int> worst_cells(const std::vector<double>& errors, double share) {
  std::vector<int> order(errors.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return errors[a] > errors[b]; });
  const double enough = share * sum_of(errors);
  double sum = 0;
  std::size_t taken = 0;
  while (taken < order.size() && sum < enough) sum += errors[order[taken++]];
  order.resize(taken);
  return order;
}

}  // namespace

double CellEnergies::estimated_error() const {
  double sum = 0;
  for (std::size_t c = 0; c < error.size(); ++c) sum += std::max(error[c], anchors[c]);
  return elastic > 0 ? sum / elastic : 0;
}

std::optional<double> falls_short(const std::vector<LatticeEstimate>& lattices) {
  const auto n = static_cast<double>(lattices.size());
  double error = 0, elastic = 0, largest = 0;
  for (const LatticeEstimate& l : lattices) {
    error += l.error / n;
    elastic += l.elastic / n;
    largest = std::max(largest, l.error);
  }
  if (lattices.size() < 2 || largest <= least_fall * lattices.back().error) return {};
  double both = 0, square = 0;
  for (const LatticeEstimate& l : lattices) {
    both += (l.error - error) * (l.elastic - elastic);
    square += (l.error - error) * (l.error - error);
  }
  const double slope = both / square, limit = elastic - slope * error;
  if (limit <= 0) return {};
  return std::max(1.0, std::abs(slope) / limit);
}

const std::vector<double>& CellEnergies::larger() const { return sum_of(error) < sum_of(anchors) ? anchors : error; }

CellEnergies cell_energies(const MassSpringModel& model, const NodalVectors& u) {
  const AveragedSprings* law = averaged_springs_of(model);
  if (!law) throw std::invalid_argument("the error of a model without averaged springs cannot be estimated");
  const Network& network = model.network;
  const Strains of_cells = cell_strains(network, u), of_nodes = nodal_strains(network, of_cells);
  CellEnergies energies;
  energies.anchors = anchor_energies(network, u);
  energies.elastic = sum_of(energies.anchors);
  for (std::size_t c = 0; c < network.cells.size(); ++c) {
    const FilledPart& part = network.cells.part(c);
    const AveragedSprings& own = law->in(network.cells.material(c));
    double mean = 0;  // over eight points with the moments of the filled part along each axis
    for (int point = 0; point < 8; ++point) {
      Eigen::Matrix<double, 1, 9> difference = -of_cells.row(static_cast<Eigen::Index>(c));
      for (int n = 0; n < 8; ++n) {
        double weight = 1;
        for (int d = 0; d < 3; ++d) {
          const double xi = part.mean[d] + corner_side(point, d) * std::sqrt(part.variance[d]);
          weight *= 0.5 + corner_side(n, d) * xi;
        }
        difference += weight * of_nodes.row(network.cells.corners[c][n]);
      }
      mean += energy_density(own, as_matrix(difference)) / 8;
    }
    energies.error.push_back(filled_volume(network, c) * mean);
    Eigen::Matrix<double, 24, 1> of_corners;
    for (int n = 0; n < 8; ++n) of_corners.segment<3>(3 * n) = u.row(network.cells.corners[c][n]).transpose();
    energies.elastic += of_corners.dot(law->cell_matrix(network.cells.shape(c)) * of_corners) / 2;
  }
  return energies;
}

NodalStresses recovered_stress(const MassSpringModel& model, const NodalVectors& u) {
  const AveragedSprings* law = averaged_springs_of(model);
  if (!law) throw std::invalid_argument("stresses are recovered in cells of averaged springs");
  const Network& network = model.network;
  const Strains of_cells = cell_strains(network, u);
  const LinearStrain linear(network, of_cells);
  const CellsApart all = apart(network.cells.corners, network.cells.materials);
  std::vector<std::vector<int>> at(all.node.size());
  for (std::size_t c = 0; c < network.cells.size(); ++c)
    for (const int n : all.corners[c]) at[n].push_back(static_cast<int>(c));
  NodalStresses stress = NodalStresses::Zero(static_cast<Eigen::Index>(at.size()), 6);
  for (std::size_t n = 0; n < at.size(); ++n) {
    std::set<int> cells(at[n].begin(), at[n].end());
    if (cells.empty()) continue;
    std::optional<Eigen::Matrix<double, 1, 9>> strain;
    for (int ring = 0; ring < most_rings && !(strain = linear(cells, network.X.row(all.node[n]))); ++ring)
      cells = cells_at_corners(all, at, cells);
    const AveragedSprings& own = law->in(network.cells.material(at[n].front()));
    const Eigen::Matrix3d E = as_matrix(strain ? *strain : linear.mean(at[n]));
    const Eigen::Matrix3d S = 2 * own.shear_modulus * E + own.lame_lambda * E.trace() * Eigen::Matrix3d::Identity();
    stress.row(static_cast<Eigen::Index>(n)) << S.diagonal().transpose(), S(0, 1), S(1, 2), S(0, 2);
  }
  return stress;
}

bool halve_worst_cells(const CutBody& cut, const std::vector<double>& errors, VoxelGrid& grid) {
  const int most = grid.doubled.empty() ? 0 : *std::max_element(grid.doubled.begin(), grid.doubled.end());
  std::vector<LatticeCube> cubes;
  for (const int c : worst_cells(errors, share_of_the_error)) cubes.push_back({cut.cells[c].index, cut.cells[c].size});
  if (most < most_halvings && std::any_of(cubes.begin(), cubes.end(), [](const auto& c) { return c.size == 1; })) {
    grid = with_halved_cubes(grid);
    for (LatticeCube& c : cubes) c = {{2 * c.at[0], 2 * c.at[1], 2 * c.at[2]}, 2 * c.size};
  }
  bool halved = false;
  for (const LatticeCube& c : cubes) {
    if (c.size == 1 || cell_size(grid, c.at) < c.size) continue;  // as small as may be, or halved for a neighbour
    halve_cell(grid, c.at);
    halved = true;
  }
  return halved;
}

}  // namespace springproof
