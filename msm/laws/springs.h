// Force law: linear springs along the line between two nodes.
#pragma once

#include "msm/algebra/block_matrix.h"
#include "msm/laws/law_traits.h"
#include "msm/topology/network.h"

namespace springproof {

/// Energy sum_s k/2 (L' - L)^2; geometrically nonlinear (L' is the length between the moved nodes).
struct Springs {
  /// What solvers, kernels and the time step use of this law.
  static constexpr LawTraits traits = {"springs",
                                       Reach::springs,
                                       {Capability::lattice_kernels, Capability::gpu, Capability::list_kernels,
                                        Capability::list_stiffness, Capability::energy_momentum, Capability::lammps}};

  /// Names the parameters, for springs files (law_traits.h).
  template <class Fields>
  void fields(Fields&) {}

  double energy(const Network& network, const NodalVectors& x) const;                     ///< [J]
  void add_forces(const Network& network, const NodalVectors& x, NodalVectors& f) const;  ///< f += -dE/dx [N]
  void add_tangent(const Network& network, const NodalVectors& x, BlockMatrix& K) const;  ///< K += d2E/dx2 [N/m]
};

}  // namespace springproof
