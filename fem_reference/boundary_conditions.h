// Loads of an experiment -> prescribed degrees of freedom, load vector, reactions.
#pragma once

#include <deal.II/dofs/dof_handler.h>

#include <functional>
#include <vector>

#include "fem_reference/elastic_system.h"
#include "fem_reference/triangulate.h"
#include "meshes/field.h"
#include "problem/loads.h"
#include "problem/material.h"

namespace springproof::fem {

/// A degree of freedom with prescribed value.  Where several loads prescribe it, it belongs to the first.
struct Prescribed {
  unsigned int dof;
  int component;
  int load;  ///< index into the loads
  Vec3 X;    ///< rest position [m]
};

/// @throws InputError naming the load's patch and those there are.
void check_patches(const Body3& body, const std::vector<Load>& loads);

/// On the cells of this process and around them; ascending in dof.
/// @throws InputError if two loads prescribe different values.
std::vector<Prescribed> prescribed(const dealii::DoFHandler<3>& dof_handler, const Body3& body,
                                   const std::vector<Load>& loads);

/// The same on every multigrid level.
std::vector<dealii::IndexSet> prescribed_on_levels(const dealii::DoFHandler<3>& dof_handler, const Body3& body,
                                                   const std::vector<Load>& loads);

/// `prescribed` is what this process owns, as for reactions().
/// @throws InputError with the motion that is left if the body can move or turn as a whole.
void check_held(const std::vector<Prescribed>& prescribed, MPI_Comm comm);

/// Traction, patch forces, gravity, point forces and a body force [N] on every degree of freedom.
DofVector load_vector(const dealii::DoFHandler<3>& dof_handler, const Body3& body, const std::vector<Load>& loads,
                      const IsotropicMaterial& material, const std::function<Vec3(const Vec3&)>& body_force);

/// One per patch with prescribed displacement, in the order of the loads; `imbalance` is internal force -
/// load [N]. Lever arms are about the patch's rest centroid, to the rest positions plus `arm` (the
/// displacement, or nothing).
std::vector<PatchReaction> reactions(const dealii::DoFHandler<3>& dof_handler, const Body3& body,
                                     const std::vector<Load>& loads, const std::vector<Prescribed>& prescribed,
                                     const DofVector& imbalance, const DofVector* arm);

}  // namespace springproof::fem
