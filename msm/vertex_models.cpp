#include "msm/vertex_models.h"

#include <cmath>

#include "meshes/materials.h"
#include "msm/embedding/surface_shares.h"
#include "msm/parameters/patch_fit.h"
#include "msm/periodic/laws_of_model.h"
#include "msm/topology/vertex_network.h"

namespace springproof {
Network fitted_on_vertices(const ModelParameters& p, const Mesh& tetrahedra) {
  require_one_material(tetrahedra);
  Network network = vertex_network(tetrahedra, static_cast<int>(std::lround(p.random.springs_per_node)));
  fit_patch(vertex_shares(tetrahedra, network).area, 1, network);
  return network;
}

EmbeddedModel build_on_vertices(const ModelParameters& p, const Mesh& tetrahedra, const IsotropicMaterial& material,
                                const Network& fitted) {
  const BulkCalibration calibration = affine_calibration(p, material);
  SurfaceShares shares = vertex_shares(tetrahedra, fitted);
  EmbeddedModel built;
  built.embedding = nodes_of_mesh(tetrahedra);
  built.embedding.patches = std::move(shares.patches);
  built.embedding.volumes = nodal_volumes(tetrahedra);
  Network& network = built.model.network;
  network = fitted;
  for (Spring& s : network.springs) s.stiffness *= calibration.spring_shear_modulus;
  const bool below = material.poisson_ratio < springs_poisson_ratio(p);
  built.model.laws = laws_of(p, network, material, calibration, shares.area,
                             below ? WeightStart::near_springs : WeightStart::stiffness);
  return built;
}

}  // namespace springproof
