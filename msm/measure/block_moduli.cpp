#include "msm/measure/block_moduli.h"

#include <Eigen/Dense>
#include <algorithm>
#include <stdexcept>

#include "msm/algebra/dense.h"

namespace springproof {
namespace {

constexpr double central = 0.8;

/// Displacement gradient of the affine field fitted to the displacements of the central nodes by least squares.
Eigen::Matrix3d central_gradient(const Network& network, const NodalVectors& u, const StretchedBlock& block) {
  const Vec3 middle = (block.lower + block.upper) / 2, reach = central / 2 * (block.upper - block.lower);
  std::vector<int> nodes;
  for (int n = 0; n < network.nodes(); ++n)
    if (((network.X.row(n).transpose() - middle).array().abs() <= reach.array() * (1 + 1e-9)).all()) nodes.push_back(n);
  Eigen::MatrixXd basis(nodes.size(), 4);
  basis << Eigen::VectorXd::Ones(static_cast<Eigen::Index>(nodes.size())),
      (network.X(nodes, Eigen::all).rowwise() - middle.transpose());
  const LeastSquares fit = least_squares(basis, u(nodes, Eigen::all));
  if (fit.rank < 4) throw std::invalid_argument("too few nodes in the central region of the block");
  return fit.X.bottomRows(3).transpose();
}

}  // namespace

BlockModuli measure_block(const MassSpringModel& model, const NodalVectors& u, const StretchedBlock& block,
                          double radius) {
  const Network& network = model.network;
  const std::vector<double> tensions = linear_tensions(model, u);
  const Vec3 size = block.upper - block.lower, middle = (block.lower + block.upper) / 2;
  const Eigen::Matrix3d mean = central_gradient(network, u, block);

  BlockModuli m{};
  m.force = momentum_flow(network, network.X, tensions, middle, Vec3::UnitX());
  const double stress = m.force / (size[1] * size[2]);
  m.youngs_modulus_nominal = stress / (block.elongation / size[0]);
  m.youngs_modulus_local = stress / mean(0, 0);
  m.poisson_ratio = -(mean(1, 1) + mean(2, 2)) / (2 * mean(0, 0));

  const Vec3 reach = (central / 2 * size.array()).min(size.array() / 2 - radius).max(0.0);
  const int points = 7 * 3 * 3;
  for (int i = -3; i <= 3; ++i)
    for (int j = -1; j <= 1; ++j)
      for (int k = -1; k <= 1; ++k) {
        const Vec3 at = middle + reach.cwiseProduct(Vec3(i / 3.0, j, k));
        const Eigen::Matrix3d gradient = displacement_gradient(network, u, at, radius);
        const Eigen::Matrix3d strain = (gradient + gradient.transpose()) / 2;
        const Eigen::Matrix3d local_stress = hardy_stress(network, network.X, tensions, at, radius);
        m.poisson_ratio_of_fields += poisson_ratio_of(strain, local_stress) / points;
        m.poisson_ratio_as_printed += poisson_ratio_as_printed(strain, local_stress) / points;
      }
  return m;
}

}  // namespace springproof
