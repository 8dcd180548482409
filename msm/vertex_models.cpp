#include "msm/vertex_models.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <stdexcept>
#include <utility>

#include "meshes/materials.h"
#include "msm/embedding/surface_shares.h"
#include "msm/parameters/patch_fit.h"
#include "msm/periodic/laws_of_model.h"
#include "msm/topology/point_cells.h"
#include "msm/topology/region.h"

namespace springproof {
namespace {

constexpr int line_parts = 16;
constexpr int farthest = 6;  // in spacings

bool in_body(const Region& body, const Vec3& a, const Vec3& b) {
  for (int part = 1; part < line_parts; ++part)
    if (!body.inside(a + (b - a) * (static_cast<double>(part) / line_parts))) return false;
  return true;
}

}  // namespace

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

Network vertex_network(const Mesh& tetrahedra, int springs_per_node) {
  Network network;
  network.X = tetrahedra.nodes;
  network.volume = nodal_volumes(tetrahedra);
  if (network.nodes() <= springs_per_node)
    throw std::invalid_argument(fmt::format("springs_per_node: {}, the body has {} vertices (allowed: fewer springs)",
                                            springs_per_node, network.nodes()));
  const Region body = region_of(tetrahedra);
  const double spacing = std::cbrt(body.volume / network.nodes());
  PointCells cells(body.lower, body.upper, spacing, false);
  const auto X = [&](int n) -> Vec3 { return network.X.row(n).transpose(); };
  for (int n = 0; n < network.nodes(); ++n) cells.add(X(n));
  std::set<std::pair<int, int>> joined;
  for (int n = 0; n < network.nodes(); ++n) {
    std::vector<std::pair<double, int>> others;
    cells.any_near(
        X(n),
        [&](int m) {
          if (m != n) others.emplace_back((X(m) - X(n)).norm(), m);
          return false;
        },
        farthest);
    std::sort(others.begin(), others.end());
    int springs = 0;
    for (auto other = others.begin(); other != others.end() && springs < springs_per_node; ++other) {
      if (!in_body(body, X(n), X(other->second))) continue;
      ++springs;
      joined.insert(std::minmax(n, other->second));
    }
  }
  for (const auto& [i, j] : joined) network.springs.push_back({i, j, 1.0, (X(j) - X(i)).norm()});
  return network;
}

}  // namespace springproof
