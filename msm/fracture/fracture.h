// Quasi-static fracture of a drying network (Kot et al. 2014, Fig. 15).
#pragma once

#include <vector>

#include "msm/fracture/shrinking_springs.h"
#include "problem/fracture.h"

namespace springproof {

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
