// Springs whose rest lengths shrink: equilibrium under an eigenstrain, while springs are removed.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "msm/algebra/krylov.h"
#include "msm/topology/network.h"

namespace springproof {

/// Springs linearised at rest.  With amplitude a of the shrinkage the tension of spring s is
///   T_s = k_s (n_s . (u_j - u_i) + a p_s L_s),
/// n_s its direction at rest, p_s the profile.  The forces of the shrinkage lie in the range of the stiffness matrix
/// whatever springs are left, so parts that have come loose and mechanisms need no regularisation: conjugate gradients
/// leave their free motions as they were.
class ShrinkingSprings {
 public:
  /// `held`: per node, no displacement; springs between two held nodes are left out (they belong to the support).
  /// `profile`: p_s per spring [1].
  /// @throws std::invalid_argument if the sizes do not fit.
  ShrinkingSprings(const Network& network, const std::vector<char>& held, const std::vector<double>& profile);

  /// Sets amplitude [1] and scales the displacement with it, which keeps the equilibrium.
  void set_amplitude(double amplitude);

  void remove(int spring);

  /// Equilibrium by conjugate gradients from the present displacement; the preconditioner are the pseudo-inverses of
  /// the diagonal 3 x 3 blocks.  `tolerance`: out-of-balance forces over those of the shrinkage on undeformed springs.
  KrylovResult solve(double tolerance, int max_iterations);

  double amplitude() const { return amplitude_; }
  bool present(int spring) const { return present_[spring]; }
  double stretch(int spring) const;                           ///< of a present spring, T_s / (k_s L_s) [1]
  double energy() const;                                      ///< sum of T_s^2 / (2 k_s) [J]
  double energy_of(int spring) const;                         ///< [J]
  double eigen_power() const;                                 ///< sum of T_s p_s L_s: dE/da at equilibrium [J]
  Eigen::VectorXd forces() const;                             ///< of the springs on the nodes, 3 n, 0 on held ones [N]
  const Eigen::VectorXd& displacement() const { return u_; }  ///< 3 n [m]

 private:
  /// sqrt(k) n of a spring and its ends; zero once removed.
  struct Scaled {
    double x, y, z;
    int i, j;
  };

  double scaled_tension(int spring) const;  ///< T / sqrt(k)
  Eigen::VectorXd nodal_forces(const std::function<double(int spring)>& scaled) const;
  void multiply(const Eigen::VectorXd& u, Eigen::VectorXd& f) const;
  void precondition(const Eigen::VectorXd& r, Eigen::VectorXd& z) const;
  void set_block(int node);

  std::vector<Scaled> springs_;
  std::vector<double> root_length_, shrinkage_;  ///< sqrt(k) L; sqrt(k) p L, zero once removed
  std::vector<char> present_;
  std::vector<int> held_;                ///< nodes
  std::vector<char> is_held_;            ///< per node
  std::vector<int> first_, springs_of_;  ///< springs of node n: springs_of_[first_[n]] ... [first_[n + 1] - 1]
  std::vector<Eigen::Matrix3d> block_;   ///< pseudo-inverse of each node's diagonal block
  Eigen::VectorXd u_;
  double amplitude_ = 0;
};

}  // namespace springproof
