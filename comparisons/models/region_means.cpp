#include "comparisons/models/region_means.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <stdexcept>
#include <utility>

#include "comparisons/reference/reference_grids.h"
#include "msm/cells/filled_volume.h"
#include "msm/embedding/cut_lattice.h"
#include "msm/laws/anchors.h"

namespace springproof {
namespace {

/// Mean of the corners' displacement over the filled part of a cell, but for its triple moment.
Vec3 mean_displacement(const Network& network, std::size_t cell, const NodalVectors& u) {
  const FilledPart& part = network.cells.part(cell);
  Vec3 sum = Vec3::Zero();
  for (int a = 0; a < 8; ++a)
    sum += weight_of_corner(part, a) / part.fraction * u.row(network.cells.corners[cell][a]).transpose();
  return sum;
}

/// The cells of one material, with nothing else.
Network cells_of(const Network& network, int material) {
  std::vector<int> numbers;
  for (std::size_t c = 0; c < network.cells.size(); ++c)
    if (network.cells.material(c) == material) numbers.push_back(static_cast<int>(c));
  Network part;
  part.X = network.X;
  part.cells = network.cells.of(numbers);
  return part;
}

/// Integral of Cauchy's stress over the deformed cells, and their energy.
struct Elastic {
  Eigen::Matrix3d moment = Eigen::Matrix3d::Zero();  ///< [N m]
  double energy = 0;                                 ///< [J]
};

NodalVectors forces_of(const AveragedSprings& law, const Network& cells, const NodalVectors& x) {
  NodalVectors f = NodalVectors::Zero(x.rows(), 3);
  law.add_forces(cells, x, f);
  return f;
}

Elastic at_large_strain(const AveragedSprings& law, const Network& cells, const NodalVectors& u) {
  const NodalVectors x = cells.X + u;
  return {-x.transpose() * forces_of(law, cells, x), law.energy(cells, x)};
}

Eigen::Matrix<double, 24, 1> of_corners(const Hexahedron& corners, const NodalVectors& u) {
  Eigen::Matrix<double, 24, 1> all;
  for (int n = 0; n < 8; ++n) all.segment<3>(3 * n) = u.row(corners[n]).transpose();
  return all;
}

/// At small strain.
NodalVectors linear_forces_of(const AveragedSprings& law, const Network& cells, const NodalVectors& u) {
  NodalVectors f = NodalVectors::Zero(u.rows(), 3);
  for (std::size_t c = 0; c < cells.cells.size(); ++c) {
    const Hexahedron& corners = cells.cells.corners[c];
    const Eigen::Matrix<double, 24, 1> force = law.cell_matrix(cells.cells.shape(c)) * of_corners(corners, u);
    for (int n = 0; n < 8; ++n) f.row(corners[n]) -= force.segment<3>(3 * n).transpose();
  }
  return f;
}

Elastic at_small_strain(const AveragedSprings& law, const Network& cells, const NodalVectors& u) {
  Elastic sum;
  for (std::size_t c = 0; c < cells.cells.size(); ++c) {
    const Eigen::Matrix<double, 24, 1> at = of_corners(cells.cells.corners[c], u);
    sum.energy += at.dot(law.cell_matrix(cells.cells.shape(c)) * at) / 2;
    sum.moment += filled_volume(cells, c) * mean_gradient(cells, c, u);
  }
  return sum;
}

/// Of a strain, or its integral.
Eigen::Matrix3d hooke(const IsotropicMaterial& m, const Eigen::Matrix3d& H) {
  return shear_modulus(m) * (H + H.transpose()) + lame_lambda(m) * H.trace() * Eigen::Matrix3d::Identity();
}

fem::RegionMeans means_of(const AveragedSprings& law, const IsotropicMaterial& material, const Network& cells,
                          const NodalVectors& u, Kinematics kinematics) {
  constexpr int pair[6][2] = {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {1, 2}, {0, 2}};
  fem::RegionMeans mean;
  double volume = 0;
  for (std::size_t c = 0; c < cells.cells.size(); ++c) {
    const double V = filled_volume(cells, c);
    volume += V;
    mean.volume_change += V * ((Eigen::Matrix3d::Identity() + mean_gradient(cells, c, u)).determinant() - 1);
    mean.displacement += V * mean_displacement(cells, c, u);
  }
  mean.volume_change /= volume;
  mean.displacement /= volume;
  const bool finite = kinematics == Kinematics::finite;
  const Elastic all = finite ? at_large_strain(law, cells, u) : at_small_strain(law, cells, u);
  mean.energy = all.energy;
  const Eigen::Matrix3d stress =
      finite ? Eigen::Matrix3d(all.moment / (volume * (1 + mean.volume_change))) : hooke(material, all.moment / volume);
  for (int i = 0; i < 6; ++i) mean.stress(0, i) = stress(pair[i][0], pair[i][1]);
  return mean;
}

/// Forces between materials, by their numbers, the larger first: on it by the other.
class InterfaceForces {
 public:
  void add(int on, int by, const Vec3& force) {
    Vec3& sum = forces_.try_emplace({std::max(on, by), std::min(on, by)}, Vec3::Zero()).first->second;
    sum += on > by ? force : Vec3(-force);
  }

  std::vector<fem::InterfaceForce> all() const {
    std::vector<fem::InterfaceForce> all;
    for (const auto& [materials, force] : forces_) all.push_back({materials.first, materials.second, force});
    return all;
  }

 private:
  std::map<std::pair<int, int>, Vec3> forces_;
};

/// On the first cell of a bond.
Vec3 force_of(const InterfaceBond& bond, const Network& network, const NodalVectors& u, Kinematics kinematics) {
  if (kinematics == Kinematics::linear || !turns(bond)) return -bond.stiffness * gap(bond, u);
  const TurnedBond at(bond, network.X, network.X + u);
  return -at.F * (bond.stiffness * at.v());
}

void add_bonds(const Network& network, const NodalVectors& u, Kinematics kinematics, InterfaceForces& forces) {
  std::map<Hexahedron, int> material_of;
  for (std::size_t c = 0; c < network.cells.size(); ++c)
    material_of[network.cells.corners[c]] = network.cells.material(c);
  for (const InterfaceBond& bond : network.bonds) {
    double apart = 1;  // what acts on corners that both cells have is among the forces of these
    for (int n = 0; n < 8; ++n)
      for (int m = 0; m < 8; ++m)
        if (bond.corners[0][n] == bond.corners[1][m]) apart -= (bond.weights[0][n] + bond.weights[1][m]) / 2;
    forces.add(material_of.at(bond.corners[0]), material_of.at(bond.corners[1]),
               apart * force_of(bond, network, u, kinematics));
  }
}

/// Mass of the cells of each material at the nodes, in that of material 0: nodes x materials.
Eigen::MatrixXd masses_of_materials(const CellSet& cells, Eigen::Index nodes, Eigen::Index materials) {
  Eigen::MatrixXd mass = Eigen::MatrixXd::Zero(nodes, materials);
  for (std::size_t c = 0; c < cells.size(); ++c) {
    const int m = cells.material(c);
    const double of_cube = std::pow(cells.edge_of(c), 3) * cells.relative_densities[m];
    for (int n = 0; n < 8; ++n) mass(cells.corners[c][n], m) += of_cube * weight_of_corner(cells.part(c), n);
  }
  return mass;
}

/// Of corners that cells of several materials have.
void add_common_corners(const AveragedSprings& law, const Network& network, const NodalVectors& u,
                        const NodalVectors& weight, Kinematics kinematics, InterfaceForces& forces) {
  std::map<int, std::set<int>> at;  // node, materials
  for (std::size_t c = 0; c < network.cells.size(); ++c)
    for (const int n : network.cells.corners[c]) at[n].insert(network.cells.material(c));
  std::erase_if(at, [](const auto& node) { return node.second.size() < 2; });
  if (at.empty()) return;
  const Eigen::MatrixXd mass =
      masses_of_materials(network.cells, u.rows(), static_cast<Eigen::Index>(law.regions.size() + 1));
  std::vector<NodalVectors> of_material;  // of its springs, and of its weight
  for (int m = 0; m <= static_cast<int>(law.regions.size()); ++m) {
    const Network cells = cells_of(network, m);
    of_material.push_back(kinematics == Kinematics::finite ? forces_of(law, cells, network.X + u)
                                                           : linear_forces_of(law, cells, u));
    for (const auto& [node, materials] : at)
      of_material.back().row(node) += mass(node, m) / mass.row(node).sum() * weight.row(node);
  }
  for (const auto& [node, materials] : at)
    for (const int on : materials)
      for (const int by : materials)
        if (on > by)
          forces.add(on, by,
                     (of_material[by].row(node) - of_material[on].row(node)).transpose() /
                         static_cast<double>(materials.size()));
}

}  // namespace

std::map<std::string, double> interface_forces(const MassSpringModel& model, const std::vector<MaterialRegion>& regions,
                                               const NodalVectors& u, const NodalVectors& weight,
                                               Kinematics kinematics) {
  const AveragedSprings* law = averaged_springs_of(model);
  if (!law) throw std::invalid_argument("a model without averaged springs has no regions");
  InterfaceForces forces;
  add_bonds(model.network, u, kinematics, forces);
  add_common_corners(*law, model.network, u, weight, kinematics, forces);
  return interface_measures(regions, forces.all());
}

std::map<std::string, double> region_means(const MassSpringModel& model, const std::vector<MaterialRegion>& regions,
                                           const NodalVectors& u, Kinematics kinematics) {
  const AveragedSprings* law = averaged_springs_of(model);
  if (!law) throw std::invalid_argument("a model without averaged springs has no regions");
  std::vector<fem::RegionMeans> means;
  for (std::size_t r = 0; r < regions.size(); ++r)
    means.push_back(
        means_of(*law, regions[r].material, cells_of(model.network, static_cast<int>(r + 1)), u, kinematics));
  return region_measures(regions, means);
}

}  // namespace springproof
