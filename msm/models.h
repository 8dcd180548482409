// Construction of a model of the table in a body.
#pragma once

#include "msm/embedding/embedding.h"
#include "msm/parameters/model_table.h"

namespace springproof {

/// A model and its embedding in a body.
struct EmbeddedModel {
  MassSpringModel model;
  Embedding embedding;
};

/// Builds the model of a body.  Disordered networks fill `region`, if given, which the mesh's cells only approximate.
/// @throws InputError if the mesh does not suit the model; std::runtime_error if the network cannot have the material's
///   moduli.
EmbeddedModel build_embedded(const ModelParameters& parameters, const Mesh& mesh, const IsotropicMaterial& material,
                             const Region* region = nullptr);

/// The same without its embedding.
inline MassSpringModel build_model(const ModelParameters& p, const Mesh& mesh, const IsotropicMaterial& material) {
  return build_embedded(p, mesh, material).model;
}

}  // namespace springproof
