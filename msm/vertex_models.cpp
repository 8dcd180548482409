#include "msm/vertex_models.h"

#include <cmath>

#include "meshes/volume.h"
#include "msm/parameters/patch_fit.h"
#include "msm/periodic/laws_of_model.h"
#include "msm/topology/vertex_network.h"

namespace springproof {
namespace {

/// A patch of a mesh whose nodes are the network's.
PatchShares shares_of(const Mesh& mesh, const Patch& patch) {
  PatchShares shares{nodal_areas(mesh, patch), NodalVectors::Zero(mesh.nodes.rows(), 3)};
  const auto X = [&](int n) -> Vec3 { return mesh.nodes.row(n).transpose(); };
  for (const auto& f : patch.facets)
    for (int corner = 0; corner < 3; ++corner)
      shares.normal.row(f[corner]) += (X(f[1]) - X(f[0])).cross(X(f[2]) - X(f[0])).transpose() / 6;
  return shares;
}

}  // namespace

Network fitted_on_vertices(const ModelParameters& p, const Mesh& tetrahedra) {
  Network network = vertex_network(tetrahedra, static_cast<int>(std::lround(p.random.springs_per_node)));
  fit_patch(volume_gradient(tetrahedra), 1, network);
  return network;
}

EmbeddedModel build_on_vertices(const ModelParameters& p, const Mesh& tetrahedra, const IsotropicMaterial& material,
                                const Network& fitted) {
  const BulkCalibration calibration = affine_calibration(p, material);
  const NodalVectors gradient = volume_gradient(tetrahedra);
  EmbeddedModel built;
  built.embedding = nodes_of_mesh(tetrahedra);
  for (const Patch& patch : tetrahedra.patches) built.embedding.patches[patch.name] = shares_of(tetrahedra, patch);
  built.embedding.volumes = nodal_volumes(tetrahedra);
  Network& network = built.model.network;
  network = fitted;
  for (Spring& s : network.springs) s.stiffness *= calibration.spring_shear_modulus;
  const bool below = material.poisson_ratio < springs_poisson_ratio(p);
  built.model.laws =
      laws_of(p, network, material, calibration, gradient, below ? WeightStart::near_springs : WeightStart::stiffness);
  return built;
}

}  // namespace springproof
