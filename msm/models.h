// A model of the table in the body that it stands for.
#pragma once

#include "msm/embedding/embedding.h"
#include "msm/parameters/model_table.h"

namespace springproof {

/// A model in the body that it stands for.
struct EmbeddedModel {
  MassSpringModel model;
  Embedding embedding;
};

/// The model of a body.  Disordered networks fill `region`, where there is one that the mesh's cells only roughly fill.
/// @throws InputError if the mesh does not suit it; std::runtime_error if the network cannot have the material's
/// moduli.
EmbeddedModel build_embedded(const ModelParameters& parameters, const Mesh& mesh, const IsotropicMaterial& material,
                             const Region* region = nullptr);

/// The same without its embedding.
inline MassSpringModel build_model(const ModelParameters& p, const Mesh& mesh, const IsotropicMaterial& material) {
  return build_embedded(p, mesh, material).model;
}

}  // namespace springproof
