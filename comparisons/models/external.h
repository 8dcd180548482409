// Displacements of another program, compared as a model of the case is: [[external]], docs/engines.md.
#pragma once

#include <vector>

#include "comparisons/models/model_run.h"
#include "comparisons/prepare/prepared_case.h"

namespace springproof {

/// What stands for such an entry in PreparedCase::models: no model can be built of it.
ModelParameters parameters_of_external(const ModelChoice& choice);

/// Reads entry `number` of the case's models and brings its displacements to the nodes of a lattice.
/// @throws InputError for what cannot be read; for points that are not in the body, or so far from a node that its
/// displacement is not known; for a reaction on a patch that the body lacks.
void check_external(const PreparedCase& prepared, std::size_t number);

/// Where displacements are a power of ten times those of the reference, to a fifth, a sentence on the units that would
/// explain it; else empty.
std::string unit_doubt(const NodalVectors& u, const NodalVectors& reference);

/// The entry as the result of a model, if this lattice is the one whose number of nodes is nearest to its number of
/// points and this material its own; else nothing.  At a node where it has a point the displacement is the file's,
/// elsewhere as ScatteredField::at() says, in a body of voxels as the finite elements' is carried to nodes outside.
/// Volume changes are measured where every node has its point.
std::vector<ModelSample> external_samples(const PreparedCase& prepared, const Lattice& lattice, std::size_t number,
                                          const IsotropicMaterial& material);

}  // namespace springproof
