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
  for (const PatchSamples& p : prepared.samples.of_patches) {
    points.conservativeResize(points.rows() + p.points.rows(), 3);
    points.bottomRows(p.points.rows()) = p.points;
  }
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

NodalVectors at_measured(const PreparedCase& prepared, const NodalVectors& samples) {
  return samples.bottomRows(samples.rows() - prepared.nodes());
}

NodalVectors known_at(const PreparedCase& prepared, const Lattice& lattice, const NodalVectors& at_nodes,
                      const NodalVectors& at_measured) {
  NodalVectors of_lattices = NodalVectors::Zero(prepared.nodes(), 3);
  of_lattices.middleRows(lattice.first_node, at_nodes.rows()) = at_nodes;
  return stacked(of_lattices, at_measured);
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

NodalVectors at_measured_points(const PreparedCase& prepared, const Lattice& lattice,
                                const NodalVectors& displacement) {
  const Experiment& e = prepared.experiment;
  const Mesh& mesh = *lattice.mesh;
  if (!e.body.is_voxels()) interpolate(mesh, displacement, probe_points(e));  // throws for a probe outside
  return at_points(mesh, displacement, measured_points(prepared));
}

NodalVectors at_points(const Mesh& mesh, const NodalVectors& of_nodes, const NodalVectors& points) {
  const Locator locator(mesh);
  NodalVectors out = NodalVectors::Zero(points.rows(), 3);
  for (Eigen::Index i = 0; i < points.rows(); ++i) {
    const Location at = locator(points.row(i).transpose());
    for (int n = 0; n < 8; ++n) out.row(i) += at.shape[n] * of_nodes.row(mesh.hexahedra[at.cell][n]);
  }
  return out;
}

namespace {

/// Of a body of voxels the middles of its coarsest tetrahedra, of a block the nodes of its finest lattice.
std::pair<NodalVectors, Eigen::VectorXd> compared_stresses(const PreparedCase& prepared) {
  if (!wanted("stress_error.peak", prepared.experiment.measures)) return {NodalVectors(0, 3), Eigen::VectorXd(0)};
  if (!prepared.experiment.body.is_voxels()) {
    const Mesh& finest = *prepared.lattices[finest_lattice(prepared)].mesh;
    return {finest.nodes, nodal_volumes(finest)};
  }
  const Mesh& body = *prepared.body.tetrahedra.front();
  const auto count = static_cast<Eigen::Index>(body.tetrahedra.size());
  std::pair<NodalVectors, Eigen::VectorXd> out = {NodalVectors(count, 3), Eigen::VectorXd(count)};
  for (Eigen::Index t = 0; t < count; ++t) {
    const auto& corners = body.tetrahedra[static_cast<std::size_t>(t)];
    Eigen::Matrix3d edges;
    for (int k = 0; k < 3; ++k) edges.row(k) = body.nodes.row(corners[k + 1]) - body.nodes.row(corners[0]);
    out.first.row(t) = body.nodes.row(corners[0]) + edges.colwise().sum() / 4;
    out.second[t] = edges.determinant() / 6;
  }
  return out;
}

NodalVectors pictured_surface(const PreparedCase& prepared) {
  if (prepared.lattices.empty() || prepared.experiment.models.empty()) return NodalVectors(0, 3);
  return pictured_points(prepared.experiment.body.is_voxels() ? *prepared.body.tetrahedra.back()
                                                              : *prepared.lattices.front().mesh);
}

}  // namespace

Eigen::Index first_compared_stress(const PreparedCase& prepared) {
  const Experiment& e = prepared.experiment;
  return wanted("stress", e.measures) ? static_cast<Eigen::Index>(e.probes.size()) : 0;
}

Eigen::Index first_pictured_stress(const PreparedCase& prepared) {
  return first_compared_stress(prepared) + compared_stresses(prepared).first.rows();
}

NodalVectors stress_points(const PreparedCase& prepared) {
  const NodalVectors probes = probe_points(prepared.experiment).topRows(first_compared_stress(prepared));
  return stacked(stacked(probes, compared_stresses(prepared).first), pictured_surface(prepared));
}

Eigen::VectorXd compared_stress_volumes(const PreparedCase& prepared) {
  Eigen::VectorXd volumes = compared_stresses(prepared).second;
  if (volumes.size() == 0) return volumes;
  const Eigen::Index compared = volumes.size(), surface = pictured_surface(prepared).rows();
  volumes.conservativeResize(compared + surface);
  volumes.tail(surface).setZero();
  return volumes;
}

}  // namespace springproof
