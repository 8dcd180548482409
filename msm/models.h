// Construction of a model of the table in a body.
#pragma once

#include "msm/embedding/cut_lattice.h"
#include "msm/embedding/embedding.h"
#include "msm/parameters/model_table.h"

namespace springproof {

/// A model and its embedding in a body.
struct EmbeddedModel {
  MassSpringModel model;
  Embedding embedding;
};

/// Builds the model of a body.  Disordered networks fill `region`, if given, which the mesh's cells only approximate.
/// Topology::file: the network as it is, embedded at the mesh's nodes if it has those, else as a disordered one.
/// @throws InputError if the mesh or the material does not suit the model; std::runtime_error if the network cannot
/// have the material's
///   moduli.
EmbeddedModel build_embedded(const ModelParameters& parameters, const Mesh& mesh, const IsotropicMaterial& material,
                             const Region* region = nullptr);

/// Whether a model can be built of cut cells: lattices of cells, but for momentum dispersion, which needs springs.
bool has_cut_cells(const ModelRow& row);

/// Builds the model of the cells of a cut body (msm/laws/averaged_springs.h), whose supports may hold the patches
/// `held`; embedded at the nodes of `mesh`.
/// @throws InputError unless has_cut_cells(parameters.row).
EmbeddedModel build_cut(const ModelParameters& parameters, const CutBody& body, const std::vector<std::string>& held,
                        const Mesh& mesh, const IsotropicMaterial& material);

/// The network of a springs file stands for one material.
/// @throws InputError if the model is a springs file of another one.
void require_material(const ModelParameters& parameters, const IsotropicMaterial& material);

/// Depth [m] to which a support holds nodes of a model that are not the mesh's: the surface, the outermost layer, or
/// the case's value.
double grip_of(const ModelParameters& parameters, const Mesh& mesh);

/// The same without its embedding.
inline MassSpringModel build_model(const ModelParameters& p, const Mesh& mesh, const IsotropicMaterial& material) {
  return build_embedded(p, mesh, material).model;
}

}  // namespace springproof
