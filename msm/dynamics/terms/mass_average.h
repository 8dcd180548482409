// Mass that is partly consistent in explicit motion: velocities from momenta by one average over the cells.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "msm/topology/network.h"

namespace springproof {

/// Integral of rho N_a N_b over the filled part of a cell of mass rho l^3 = `full`, N the corners' trilinear weights:
/// at the two Gauss points per axis of the part's own mean and variance; of a full cell exact.
Eigen::Matrix<double, 8, 8> consistent_mass(const FilledPart& part, double full);

/// Momenta p = L s of the nodes, L their lumped masses, move them with
///   v = W p,  W = L^-1 (2 L - M) L^-1,  M = theta C + (1 - theta) L,
/// the first two terms of Neumann's series of M^-1: v = s + theta (s - L^-1 C s), no equations to solve.  W is
/// symmetric and the same for each axis, so that forces with neither sum nor torque keep sum p and sum x x p, and the
/// energy is p . W p / 2 + E(x).  C: the consistent mass of the trilinear displacement in each cell; of a cut cell that
/// of a full one times the fraction, as its corners have equal shares of L too.  L^-1 C has its eigenvalues in 1/27
/// to 1.
class MassAverage {
 public:
  /// Lumped mass: v = s.
  MassAverage() = default;

  /// Keeps a reference to the network's cells.
  /// @param network with cells
  /// @param theta share of consistent mass, 0 to 1
  /// @param volumes lumped masses L over the density [m^3], one per node
  /// @throws std::invalid_argument outside of it, and for a network that lacks Capability::mass_average.
  MassAverage(const Network& network, double theta, const Eigen::VectorXd& volumes);
  MassAverage(const Network& network, double theta) : MassAverage(network, theta, network.volume) {}

  bool acts() const { return theta_ > 0; }
  double theta() const { return theta_; }

  /// Of W, corner by corner, for kernels: v = s + sum over the cells of part() share() (s - average of s over the
  /// cell).
  const Network& network() const { return *network_; }
  double part(std::size_t cell) const { return theta_ * network_->cells.part(cell).fraction; }
  double share(int node) const { return share_[node]; }

  /// Velocities of the nodes.
  /// @param s momenta over lumped masses [m/s], n x 3; of supports their velocities
  /// @param fixed unknowns, three of each node, whose velocity is s; none: all are free
  /// @return v [m/s], n x 3
  NodalVectors velocities(const NodalVectors& s, const std::vector<char>& fixed = {}) const;

  /// The momenta over lumped masses that have given velocities, to round-off.
  /// @param v [m/s], n x 3; those of `fixed` unknowns are s too
  /// @param fixed unknowns, three of each node
  /// @return s [m/s], n x 3
  NodalVectors momenta(const NodalVectors& v, const std::vector<char>& fixed) const;

  /// The largest eigenvalue of L W: squared frequencies grow at most by it.
  static double largest_gain(double theta) { return 1 + theta * 26 / 27; }

  /// L^-1 C of one cell between its corners.
  static Eigen::Matrix<double, 8, 8> of_cell();

 private:
  double theta_ = 0;
  const Network* network_ = nullptr;
  Eigen::VectorXd share_;  ///< of a corner of a full cell in the node's mass; 0 where there is none
};

}  // namespace springproof
