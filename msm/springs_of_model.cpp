#include "msm/springs_of_model.h"

#include <Eigen/Geometry>

#include "meshes/locate/locate.h"
#include "meshes/locate/outer_facets.h"
#include "msm/dynamics/time_step.h"

namespace springproof {
namespace {

/// Vertices by the shape functions of the cells that hold them, or are nearest.
Eigen::SparseMatrix<double, Eigen::RowMajor> weights_in_cells(const NodalVectors& vertices, const Mesh& cells) {
  const Locator locator(cells);
  std::vector<Eigen::Triplet<double>> entries;
  for (int v = 0; v < vertices.rows(); ++v) {
    const Location at = locator(vertices.row(v).transpose());
    for (int n = 0; n < 8; ++n)
      if (at.shape[n] != 0) entries.emplace_back(v, cells.hexahedra[at.cell][n], at.shape[n]);
  }
  Eigen::SparseMatrix<double, Eigen::RowMajor> weights(vertices.rows(), cells.nodes.rows());
  weights.setFromTriplets(entries.begin(), entries.end());
  return weights;
}

}  // namespace

EmbeddedSurface surface_of_mesh(const Mesh& mesh) {
  EmbeddedSurface surface;
  std::vector<int> vertex(static_cast<std::size_t>(mesh.nodes.rows()), -1);
  const std::vector<OuterFacet> facets = outer_facets(mesh);
  for (const OuterFacet& f : facets)
    for (const int n : f.nodes)
      if (n >= 0) vertex[n] = 0;
  int vertices = 0;
  for (int& v : vertex)
    if (v == 0) v = vertices++;
  surface.vertices.resize(vertices, 3);
  for (Eigen::Index n = 0; n < mesh.nodes.rows(); ++n)
    if (vertex[n] >= 0) surface.vertices.row(vertex[n]) = mesh.nodes.row(n);
  for (const OuterFacet& f : facets)
    for (int t = 0; t < (f.nodes[3] < 0 ? 1 : 2); ++t) {
      std::array<int, 3> triangle = {vertex[f.nodes[0]], vertex[f.nodes[1 + t]], vertex[f.nodes[2 + t]]};
      const auto X = [&](int i) -> Vec3 { return surface.vertices.row(triangle[i]).transpose(); };
      if ((X(1) - X(0)).cross(X(2) - X(0)).dot(X(0) - f.cell_centre) < 0) std::swap(triangle[1], triangle[2]);
      surface.facets.push_back(triangle);
    }
  return surface;
}

EmbeddedSurface carried_surface(EmbeddedSurface surface, const Mesh& cells, const Network& network,
                                const Embedding& embedding) {
  if (network.cells.empty()) {
    Mesh vertices;
    vertices.nodes = surface.vertices;
    surface.weights = embed(vertices, network, 0).weights;
  } else {
    surface.weights = weights_in_cells(surface.vertices, cells) * embedding.weights;
  }
  return surface;
}

std::map<std::string, double> derived_of(const SpringsFile& file) {
  std::map<std::string, double> derived = {
      {"safe_time_step_s",
       relaxing_time_step(file.model, file.density, file.relaxing, safe_time_step(file.model, file.density))},
      {"mass_kg", masses(file.model.network, file.density).sum()}};
  if (const auto* hourglass = law_of<HourglassCorrection>(file.model)) {
    const HourglassCorrection::Stiffness k = hourglass->stiffness(file.model.network.cells.edge);
    derived.merge(std::map<std::string, double>{{"hourglass_bending_N_m", k.bending},
                                                {"hourglass_coupling_N_m", k.coupling},
                                                {"hourglass_torsion_N_m", k.torsion},
                                                {"hourglass_torsion_coupling_N_m", k.torsion_coupling}});
  }
  return derived;
}

}  // namespace springproof
