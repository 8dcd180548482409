// Construction of a model of the table in a body.
#pragma once

#include "msm/embedding/cut_lattice.h"
#include "msm/embedding/embedding.h"
#include "msm/parameters/model_table.h"

namespace springproof {

/// A model and its embedding in a body.
struct EmbeddedModel {
  MassSpringModel model;  ///< network and laws
  Embedding embedding;    ///< at the nodes of the body's mesh
};

/// Builds the model of a body.  Disordered networks fill `region`, if given, which the mesh's cells only approximate.
/// Networks that pass the patch test have their nodes on the vertices of a mesh of tetrahedra (msm/vertex_models.h).
/// Topology::file: the network as it is, embedded at the mesh's nodes if it has those, else as a disordered one.
/// @param parameters a row of the table of models with its options: resolve()
/// @param mesh of the body; lattices of cells need one of equal cubes (block_mesh(), voxelise())
/// @param material of the body
/// @param region the true body, for disordered networks; nullptr: the cells of the mesh
/// @param others materials 1, 2, ... of the mesh's cells: whole cells of one material each, whose springs add up where
///   they share them; for has_cut_cells(parameters.row)
/// @return the model and how the mesh hangs in it
/// @throws InputError if the mesh or the material does not suit the model; std::runtime_error if the network cannot
///   have the material's moduli.
EmbeddedModel build_embedded(const ModelParameters& parameters, const Mesh& mesh, const IsotropicMaterial& material,
                             const Region* region = nullptr, const std::vector<IsotropicMaterial>& others = {});

/// Whether a model can be built of cut cells, or of whole cells of several materials: lattices of cells, but for
/// momentum dispersion, which needs springs and couples nodes beyond a cell.
/// @param row of the table of models
/// @return true: build_cut() takes it
bool has_cut_cells(const ModelRow& row);

/// Builds the model of the cells of a cut body (msm/laws/averaged_springs.h), whose supports may hold the patches
/// `held`; embedded at the nodes of `mesh`.
/// @param parameters a row of the table of models with its options
/// @param body cut by a lattice of cubes: cut_body()
/// @param held names of the patches that supports hold
/// @param mesh in the body, at whose nodes results are given
/// @param material of the body
/// @param regions materials 1, 2, ... of the body's cells
/// @return the model and how the mesh hangs in it
/// @throws InputError unless has_cut_cells(parameters.row), for measured cells (ModelParameters::coarsened), and if a
///   cell has a material that is not given.
EmbeddedModel build_cut(const ModelParameters& parameters, const CutBody& body, const std::vector<std::string>& held,
                        const Mesh& mesh, const IsotropicMaterial& material,
                        const std::vector<IsotropicMaterial>& regions = {});

/// The network of a springs file stands for one material.
/// @param parameters of the model
/// @param material that the case asks for
/// @throws InputError if the model is a springs file of another one.
void require_material(const ModelParameters& parameters, const IsotropicMaterial& material);

/// Depth [m] to which a support holds nodes of a model that are not the mesh's: the surface, the outermost layer, or
/// the case's value.
/// @param parameters of the model
/// @param mesh of the body
/// @return [m]
double grip_of(const ModelParameters& parameters, const Mesh& mesh);

/// The model of build_embedded() without its embedding.
/// @param p a row of the table of models with its options
/// @param mesh of the body
/// @param material of the body
/// @return network and laws
inline MassSpringModel build_model(const ModelParameters& p, const Mesh& mesh, const IsotropicMaterial& material) {
  return build_embedded(p, mesh, material).model;
}

}  // namespace springproof
