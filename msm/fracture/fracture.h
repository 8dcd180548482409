// Quasi-static fracture of a drying network (Kot et al. 2014, Fig. 15).
#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "msm/algebra/krylov.h"
#include "msm/topology/network.h"
#include "problem/fracture.h"

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

/// State after one step of drying.  At every step stored = work - broken_energy - relaxed: the balance of energy.
struct FractureStep {
  double shrinkage = 0;      ///< at the top [1]
  int broken = 0;            ///< springs so far
  double stored = 0;         ///< energy of the springs that are left [J]
  double work = 0;           ///< of the shrinkage so far: sum of T p L da, exact as T is linear in a [J]
  double broken_energy = 0;  ///< that the springs held when they broke [J]
  int fragments = 0;         ///< of the top, see fragments(); moved apart by more than twice the threshold
  double relaxed = 0;        ///< lost by the others as they found new equilibria, r . du / 2, r the force released [J]
};

/// How a network broke.
struct FractureResult {
  std::vector<FractureStep> steps;  ///< one per step of drying
  std::vector<int> broken_at;       ///< per spring: step in which it broke, from 1; 0: intact
  std::vector<double> stretch;  ///< of the intact springs at the end [1]; 0 of broken ones and of those of the support
  NodalVectors displacement;    ///< at the end [m]
  std::vector<char> held;       ///< per node, as given
  long solves = 0;              ///< equilibria
  long iterations = 0;          ///< of conjugate gradients, all together
  double worst_residual = 0;    ///< of all equilibria, as in ShrinkingSprings::solve

  double released() const { return steps.empty() ? 0 : steps.back().broken_energy + steps.back().relaxed; }  ///< [J]
  /// Largest |stored - (work - broken_energy - relaxed)| of all steps over the work at the end [1].
  double imbalance() const;
};

/// Thresholds of the springs: threshold * (1 + scatter * x), x uniform with mean 0 and standard deviation 1; the same
/// seed gives the same numbers on every machine.
std::vector<double> thresholds(const Fracture& fracture, std::size_t springs, std::uint64_t seed);

/// Shrinkage of each spring over that at the top: exp(-d / depth), d the depth of its middle below the highest node.
std::vector<double> drying_profile(const Fracture& fracture, const Network& network);

/// Dries the network with the nodes `held` at rest.  In each step the springs whose stretch has reached their threshold
/// break, in rounds: the most overloaded one (largest stretch over threshold), with all others that are `apart` from it
/// and from each other; then a new equilibrium, until no spring is overloaded.  Only stretched springs break; crack
/// faces may pass through each other.
/// @throws std::invalid_argument for parameters out of range, or if no node is held; std::runtime_error if an
///   equilibrium is not found.
FractureResult run_fracture(const Network& network, const std::vector<char>& held, const Fracture& fracture,
                            std::uint64_t seed);

}  // namespace springproof
