#include "comparisons/run/springs_of_case.h"

#include <Eigen/Geometry>

#include "comparisons/run/input_checksum.h"
#include "meshes/locate/locate.h"
#include "meshes/locate/outer_facets.h"
#include "msm/dynamics/time_step.h"
#include "msm/measure/moduli.h"
#include "msm/models.h"

namespace springproof {
namespace {

/// The surface of a mesh as triangles, its vertices in the order of the mesh's nodes.
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

EmbeddedSurface carried_surface(const PreparedCase& prepared, const EmbeddedModel& built) {
  const Mesh& cells = *prepared.lattices.front().mesh;
  EmbeddedSurface surface = surface_of_mesh(prepared.tetrahedra.empty() ? cells : *prepared.tetrahedra.back());
  if (built.model.network.cells.empty()) {
    Mesh vertices;
    vertices.nodes = surface.vertices;
    surface.weights = embed(vertices, built.model.network, 0).weights;
  } else {
    surface.weights = weights_in_cells(surface.vertices, cells) * built.embedding.weights;
  }
  return surface;
}

EmbeddedSurface carried_surface(const PreparedCase& prepared, const CutBody& body) {
  EmbeddedSurface surface = surface_of_mesh(*prepared.tetrahedra.back());
  std::vector<Eigen::Triplet<double>> entries;
  for (int v = 0; v < surface.vertices.rows(); ++v) {
    const CutBody::Place at = body.place(surface.vertices.row(v).transpose());
    for (int n = 0; n < 8; ++n)
      if (at.weights[n] != 0) entries.emplace_back(v, body.cells[at.cell].corners[n], at.weights[n]);
  }
  surface.weights.resize(surface.vertices.rows(), body.points.rows());
  surface.weights.setFromTriplets(entries.begin(), entries.end());
  return surface;
}

/// Whole cells, or a network without cells.
void add_network(const PreparedCase& prepared, SpringsFile& file) {
  const Lattice& lattice = prepared.lattices.front();
  const ModelParameters& parameters = prepared.models.front();
  EmbeddedModel built = build_embedded(parameters, *lattice.mesh, *file.material, lattice.region.get());
  file.grip = parameters.springs ? parameters.springs->grip : grip_of(parameters, *lattice.mesh);
  file.grip_from_cells =
      parameters.springs ? parameters.springs->grip_from_cells : parameters.row.topology != Topology::random;
  file.patches = built.embedding.held;
  file.surface = carried_surface(prepared, built);
  file.model = std::move(built.model);
}

/// Cut cells.  Every node has a mass: anchors are kept apart, each patch has beside them the nodes at it.
void add_cut_network(const PreparedCase& prepared, SpringsFile& file) {
  const Lattice& lattice = prepared.lattices.front();
  const CutBody& body = *lattice.cut;
  file.model = build_cut(prepared.models.front(), body, {}, *lattice.mesh, *file.material).model;
  std::erase_if(file.model.laws, [](const ForceLaw& law) { return std::holds_alternative<Anchors>(law); });
  Embedding loads = embed(body, {}, file.model.network, Mesh{});
  file.loads = std::move(loads.patches);
  file.volumes = std::move(loads.volumes);
  for (const auto& [name, parts] : body.patches) {
    file.patches[name] = nodes_at_patch(body, name);
    file.anchors[name] = cut_lattice(body, {name}, file.material->youngs_modulus).anchors;
  }
  file.surface = carried_surface(prepared, body);
}

std::map<std::string, double> derived_of(const SpringsFile& file, const ModelParameters& parameters) {
  std::map<std::string, double> derived = {{"safe_time_step_s", safe_time_step(file.model, file.density)},
                                           {"mass_kg", masses(file.model.network, file.density).sum()}};
  if (!parameters.springs) {
    const MeasuredModuli m = measure_moduli(parameters, *file.material);
    derived.merge(std::map<std::string, double>{{"measured_youngs_modulus_Pa", m.youngs_modulus},
                                                {"measured_poisson_ratio", m.poisson_ratio},
                                                {"measured_shear_modulus_Pa", m.shear_modulus}});
  }
  for (const ForceLaw& law : file.model.laws)
    if (const auto* hourglass = std::get_if<HourglassCorrection>(&law)) {
      const HourglassCorrection::Stiffness k = hourglass->stiffness(file.model.network.cell_edge);
      derived.merge(std::map<std::string, double>{{"hourglass_bending_N_m", k.bending},
                                                  {"hourglass_coupling_N_m", k.coupling},
                                                  {"hourglass_torsion_N_m", k.torsion},
                                                  {"hourglass_torsion_coupling_N_m", k.torsion_coupling}});
    }
  return derived;
}

}  // namespace

SpringsFile springs_of(const PreparedCase& prepared) {
  const ModelParameters& parameters = prepared.models.front();
  const ModelChoice& choice = prepared.experiment.models.front();
  SpringsFile file;
  file.material = prepared.experiment.materials.front();
  file.density = file.material->density;
  parameters.cut.value_or(false) ? add_cut_network(prepared, file) : add_network(prepared, file);
  file.origin = {"springproof " SPRINGPROOF_VERSION, choice.name, choice.options,
                 prepared.experiment.text.empty() ? prepared.geo.filename().string()
                                                  : prepared.experiment.file.filename().string(),
                 input_checksum(prepared)};
  file.derived = derived_of(file, parameters);
  return file;
}

}  // namespace springproof
