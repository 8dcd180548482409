#include "comparisons/prepare/sampling.h"

#include "comparisons/judge/measures.h"
#include "comparisons/results/picture.h"
#include "meshes/locate/locate.h"
#include "meshes/volume.h"

namespace springproof {

NodalVectors probe_points(const Experiment& e) {
  NodalVectors points(static_cast<Eigen::Index>(e.probes.size()), 3);
  for (std::size_t i = 0; i < e.probes.size(); ++i)
    points.row(static_cast<Eigen::Index>(i)) = e.probes[i].at.transpose();
  return points;
}

NodalVectors measured_points(const PreparedCase& prepared) {
  NodalVectors points = probe_points(prepared.experiment);
  for (const PatchSamples& p : prepared.samples.of_patches) points = stacked(points, p.points);
  return points;
}

NodalVectors lattice_points(const PreparedCase& prepared) {
  NodalVectors points(prepared.nodes(), 3);
  for (const Lattice& lattice : prepared.lattices)
    points.middleRows(lattice.first_node, lattice.mesh->nodes.rows()) = lattice.mesh->nodes;
  return points;
}

NodalVectors stacked(const NodalVectors& a, const NodalVectors& b) {
  NodalVectors both(a.rows() + b.rows(), 3);
  both << a, b;
  return both;
}

NodalVectors at_nodes(const Lattice& lattice, const NodalVectors& samples) {
  return samples.middleRows(lattice.first_node, lattice.mesh->nodes.rows());
}

NodalVectors at_lattice_nodes(const PreparedCase& prepared, const NodalVectors& u) {
  NodalVectors out(static_cast<Eigen::Index>(prepared.samples.of_nodes.size()), 3);
  for (std::size_t n = 0; n < prepared.samples.of_nodes.size(); ++n) {
    const NodeSample& s = prepared.samples.of_nodes[n];
    const auto row = static_cast<Eigen::Index>(n);
    out.row(row) = s.within < 0 ? Eigen::RowVector3d(u.row(s.at)) : 2 * u.row(s.at) - u.row(s.within);
  }
  return out;
}

/// Beyond the mesh the nearest cell is extrapolated.
static NodalVectors at_points(const Mesh& mesh, const NodalVectors& of_nodes, const NodalVectors& points) {
  const Locator locator(mesh);
  NodalVectors out = NodalVectors::Zero(points.rows(), 3);
  for (Eigen::Index i = 0; i < points.rows(); ++i) {
    const Location at = locator(points.row(i).transpose());
    for (int n = 0; n < 8; ++n) out.row(i) += at.shape[n] * of_nodes.row(mesh.hexahedra[at.cell][n]);
  }
  return out;
}

NodalVectors at_measured_points(const PreparedCase& prepared, const Lattice& lattice,
                                const NodalVectors& displacement) {
  const Experiment& e = prepared.experiment;
  const Mesh& mesh = *lattice.mesh;
  if (!e.body.is_voxels()) interpolate(mesh, displacement, probe_points(e));  // throws for a probe outside
  return at_points(mesh, displacement, measured_points(prepared));
}

namespace {

/// Of a body of voxels the coarsest tetrahedra, of a block the cells of its finest lattice; none: no case compares
/// there.
const Mesh* cells_of_stresses(const PreparedCase& prepared) {
  const std::vector<std::string>& measures = prepared.experiment.measures;
  if (!wanted("stress_error", measures) && !wanted("stress_peak", measures)) return nullptr;
  return prepared.experiment.body.is_voxels() ? prepared.body.tetrahedra.front().get()
                                              : prepared.lattices[finest_lattice(prepared)].mesh.get();
}

NodalVectors middles(const Mesh* mesh) {
  if (!mesh) return NodalVectors(0, 3);
  NodalVectors out(static_cast<Eigen::Index>(mesh->hexahedra.size() + mesh->tetrahedra.size()), 3);
  Eigen::Index row = 0;
  for (const auto& cell : mesh->hexahedra) out.row(row++) = mesh->nodes(cell, Eigen::all).colwise().mean();
  for (const auto& cell : mesh->tetrahedra) out.row(row++) = mesh->nodes(cell, Eigen::all).colwise().mean();
  return out;
}

NodalVectors pictured_surface(const PreparedCase& prepared) {
  if (prepared.lattices.empty() || prepared.experiment.models.empty()) return NodalVectors(0, 3);
  return pictured_points(prepared.experiment.body.is_voxels() ? *prepared.body.tetrahedra.back()
                                                              : *prepared.lattices.front().mesh);
}

}  // namespace

Eigen::Index stress_probes(const PreparedCase& prepared) {
  const Experiment& e = prepared.experiment;
  return wanted("stress", e.measures) ? static_cast<Eigen::Index>(e.probes.size()) : 0;
}

NodalVectors stress_points(const PreparedCase& prepared) {
  const NodalVectors probes = probe_points(prepared.experiment).topRows(stress_probes(prepared));
  return stacked(stacked(probes, middles(cells_of_stresses(prepared))), pictured_surface(prepared));
}

NodalVectors requested_stress_points(const PreparedCase& prepared) {
  const Experiment& e = prepared.experiment;
  NodalVectors points = stress_points(prepared);
  if (cells_of_stresses(prepared) && !e.body.is_voxels() && !e.models.empty())
    for (const Lattice& lattice : prepared.lattices) points = stacked(points, middles(lattice.mesh.get()));
  return points;
}

Eigen::VectorXd stress_volumes(const PreparedCase& prepared) {
  Eigen::VectorXd volumes = Eigen::VectorXd::Zero(stress_points(prepared).rows());
  if (const Mesh* cells = cells_of_stresses(prepared)) {
    const Eigen::VectorXd of_cells = cell_volumes(*cells, cells->nodes);
    volumes.segment(stress_probes(prepared), of_cells.size()) = of_cells;
  }
  return volumes;
}

}  // namespace springproof
