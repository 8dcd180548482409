// Models whose springs pass the patch test, on the vertices of a body's tetrahedra.
#pragma once

#include "msm/models.h"
#include "msm/topology/network.h"

namespace springproof {

/// The network of such a model for G = 1 Pa.  It depends on the body and on the option `springs_per_node` alone: one
/// serves all materials.
/// @param parameters of a model that passes_patch_test()
/// @param tetrahedra of the body
/// @throws std::runtime_error as fit_patch(); std::invalid_argument if the body has several materials
Network fitted_on_vertices(const ModelParameters& parameters, const Mesh& tetrahedra);

/// The model of a material on such a network, embedded at the tetrahedra's vertices.  Exact nodal volumes from nu = 1/4
/// on; below, weights k L, where only these are stable in any body, and exact volumes of near springs on demand.
/// @param parameters of the model
/// @param tetrahedra of the body
/// @param material of the body
/// @param fitted fitted_on_vertices(parameters, tetrahedra)
EmbeddedModel build_on_vertices(const ModelParameters& parameters, const Mesh& tetrahedra,
                                const IsotropicMaterial& material, const Network& fitted);

/// Springs of stiffness 1 N/m between each vertex and the nearest `springs_per_node` others to which the line passes in
/// the body (tested at fifteen points): not across a gap.  Nodes have the volume of a quarter of their tetrahedra.
/// @param tetrahedra of the body
/// @param springs_per_node of each node at least, if so many are seen within six spacings
/// @throws std::invalid_argument unless there are more vertices than that.
Network vertex_network(const Mesh& tetrahedra, int springs_per_node);

}  // namespace springproof
