// What explicit steps divide forces by: the masses of the nodes, and at supports of cut cells a support mass.
#pragma once

#include "msm/dynamics/motion.h"
#include "msm/dynamics/terms/mass_average.h"

namespace springproof {

/// Support mass of the corners of anchored cells: with dt^2/4 sum_q k_q |w_qa| sum_b |w_qb| at corner a, k_q the
/// largest row sum of |K_q|, no anchor limits the step dt, as the row sums of |w| |w|^T dominate w w^T.  It has no
/// weight and no damping of its own, and moves with the support (SupportInertia); it tends to zero with the step and
/// changes no equilibrium.
/// @param network with anchors or without
/// @param options with a time step, of which integrator and mass_consistency are read; zero for large steps
/// @return [kg], n x 3: an anchor has it along the axes on which it acts
NodalVectors support_masses(const Network& network, const MotionOptions& options);

/// Inverse of masses and support masses.
/// @param network with Network::volume
/// @param density [kg/m^3]
/// @param options as of support_masses()
/// @return [1/kg], n x 3: 0 for carried nodes and others without mass, which no force moves
NodalVectors inverse_inertia(const Network& network, double density, const MotionOptions& options);

/// The average of momenta over masses and support masses.
/// @param network with Network::volume
/// @param density [kg/m^3]
/// @param options as of support_masses()
MassAverage mass_average(const Network& network, double density, const MotionOptions& options);

/// Forces that move the support masses with supports which move: these times acceleration and damped velocity of the
/// step to come.
class SupportInertia {
 public:
  /// @param network to which a reference is kept
  /// @param options with a time step, of which integrator, damping and mass_consistency are read
  /// @param start displacements of the supports, which rest there [m], n x 3
  SupportInertia(const Network& network, const MotionOptions& options, const NodalVectors& start);

  /// Whether there are support masses.
  bool acts() const { return !shares_.empty(); }
  /// Adds the forces of a step that ends with the supports at their next places.
  /// @param conditions of that step
  void add(BoundaryConditions& conditions);

 private:
  struct Share {
    int corner, node, axis;
    double mass;  ///< of the anchor of `node` in the corner [kg]
  };

  const Network& network_;
  double dt_, damping_;
  std::vector<Share> shares_;
  NodalVectors here_, before_;  ///< displacements of the supports [m]
};

}  // namespace springproof
