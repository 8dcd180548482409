// What a springs file states beside the model itself: the surface that it carries, and what follows from it.
#pragma once

#include "msm/embedding/embedding.h"
#include "msm/exchange/springs_file.h"

namespace springproof {

/// The surface of a mesh as triangles, its vertices in the order of the mesh's nodes; without weights.
EmbeddedSurface surface_of_mesh(const Mesh& mesh);

/// A surface with the weights by which a network embedded in the mesh `cells` carries it: by the shape functions of the
/// cells that hold its vertices, or are nearest; in networks without cells by the nodes near them.
EmbeddedSurface carried_surface(EmbeddedSurface surface, const Mesh& cells, const Network& network,
                                const Embedding& embedding);

/// Safe time step, mass, and constants of the hourglass correction: SpringsFile::derived.
std::map<std::string, double> derived_of(const SpringsFile& file);

}  // namespace springproof
