// Prescribed degrees of freedom, load vector and reactions from the loads of an experiment.
#pragma once

#include <deal.II/dofs/dof_handler.h>

#include <set>
#include <vector>

#include "fem_reference/grid/grid_problem.h"
#include "fem_reference/grid/triangulate.h"
#include "fem_reference/system/elastic_system.h"
#include "meshes/field.h"
#include "problem/loads.h"
#include "problem/material.h"

namespace springproof::fem {

/// A degree of freedom with prescribed value.
struct Prescribed {
  unsigned int dof;
  int component;
  std::set<int> loads;  ///< that prescribe it, by index
  Vec3 X;               ///< rest position [m]

  int load() const { return *loads.begin(); }
};

/// @throws InputError naming the load's patch and those of the body, if the body has no such patch.
void check_patches(const Body3& body, const std::vector<Load>& loads);

/// On locally owned and ghost cells; ascending in dof.
/// @throws InputError if two loads prescribe different values.
std::vector<Prescribed> prescribed(const dealii::DoFHandler<3>& dof_handler, const Body3& body,
                                   const std::vector<Load>& loads);

/// The same on every multigrid level.
std::vector<dealii::IndexSet> prescribed_on_levels(const dealii::DoFHandler<3>& dof_handler, const Body3& body,
                                                   const std::vector<Load>& loads);

/// Checks that no rigid-body motion is left.  `prescribed` holds locally owned degrees of freedom, as for reactions().
/// @throws InputError with the motion that is left if the body can translate or rotate as a whole.
void check_held(const std::vector<Prescribed>& prescribed, MPI_Comm comm);

/// Right-hand side [N]: tractions, pressures, patch forces, gravity, point forces and body forces, these at `time` [s];
/// `material`: of all what acts on the cells of this material_id.
DofVector load_vector(const dealii::DoFHandler<3>& dof_handler, const Body3& body, const GridProblem& problem,
                      double time = 0, std::optional<unsigned int> material = {});

/// One per patch with prescribed displacement, in the order of the loads; `imbalance` is internal force -
/// load [N].  Patches that prescribe one degree of freedom share its force by the integrals of its shape function,
/// equally where these are zero.  Lever arms run from the patch's rest centroid to the rest positions plus `arm` (the
/// displacement, or null).
std::vector<PatchReaction> reactions(const dealii::DoFHandler<3>& dof_handler, const Body3& body,
                                     const std::vector<Load>& loads, const std::vector<Prescribed>& prescribed,
                                     const DofVector& imbalance, const DofVector* arm);

}  // namespace springproof::fem
