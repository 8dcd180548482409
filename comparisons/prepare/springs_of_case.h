// The springs of a case's body as a springs file.
#pragma once

#include "comparisons/prepare/prepared_case.h"
#include "msm/exchange/springs_file.h"

namespace springproof {

/// The first model of the case on its first lattice, of its first material: the network, its laws and supports, a
/// surface carried by it, the safe time step and the moduli measured back.
/// @param prepared a case
/// @param carried vertices and triangles of MeshKind::vertices; null: the surface of the body
/// @throws InputError if the mesh does not suit the model; std::runtime_error if the network cannot have the material's
///   moduli.
SpringsFile springs_of(const PreparedCase& prepared, const Mesh* carried = nullptr);

}  // namespace springproof
