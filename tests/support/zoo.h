// The zoo: every model of the table, on small networks, strained and turned.
#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "meshes/voxels/refined_grid.h"
#include "msm/models.h"
#include "support/bodies.h"
#include "support/solids.h"

namespace springproof::test {

inline ModelParameters model(const std::string& name) { return resolve({name, {}, name, {}}); }

/// Models whose nodes are those of the mesh: exact for affine fields.
inline std::vector<std::string> model_names() {
  std::vector<std::string> names;
  for (const ModelRow& row : model_table())
    if (row.topology == Topology::cells) names.push_back(row.name);
  return names;
}

/// Every model that stands large displacements, with both volume energies where there is one.
inline std::vector<ModelParameters> large_displacement_models() {
  std::vector<ModelParameters> all;
  for (const ModelRow& row : model_table()) {
    if (row.bending_correction || row.topology != Topology::cells) continue;
    ModelParameters p = model(row.name);
    all.push_back(p);
    if (row.extension != Extension::volume_correction) continue;
    p.volume_energy = VolumeEnergy::paper;
    all.push_back(p);
  }
  return all;
}

/// A block of 3 x 2 x 2 cells with an L-shaped piece missing: faces, edges and a re-entrant corner.
inline Mesh notched_block(const Vec3& edges) {
  return voxels_of(block_mesh(edges.cwiseProduct(Vec3(3, 2, 2)), {3, 2, 2}),
                   [](int i, int j, int k) { return i + j + k != 0 && !(i == 2 && j == 1 && k == 1); });
}
inline Mesh notched_block(double edge = 0.5) { return notched_block(Vec3::Constant(edge)); }

/// Repeatable noise in [-size, size] (the generator's raw bits, not a library distribution).
inline NodalVectors noise(Eigen::Index nodes, double size, unsigned seed = 1) {
  std::mt19937 generator(seed);
  NodalVectors v(nodes, 3);
  for (Eigen::Index i = 0; i < v.size(); ++i) v.data()[i] = size * (2.0 * generator() / 4294967295.0 - 1);
  return v;
}

/// Two by two by one cells that a body fills in part, with moments at random, one of them full, and two anchors.
inline Network cut_network(double edge = 0.5) {
  const Mesh mesh = block_mesh(edge * Vec3(2, 2, 1), {2, 2, 1});
  Network network;
  network.cells.edge = edge;
  network.cells.corners = mesh.hexahedra;
  network.X.resize(mesh.nodes.rows() + 2, 3);
  network.X.topRows(mesh.nodes.rows()) = mesh.nodes;
  network.volume = Eigen::VectorXd::Zero(network.X.rows());
  for (int c = 0; c < 4; ++c) {
    FilledPart part;
    if (c > 0) part = {0.2 * c, 0.1 * Vec3(c, -1, 0.5), 0.01 * Vec3(1, -c, 2), Vec3(0.01, 0.02 * c, 0.001)};
    network.cells.filled.push_back(part);
    for (const int n : network.cells.corners[c]) network.volume[n] += part.fraction * edge * edge * edge / 8;
  }
  for (int a = 0; a < 2; ++a) {
    Anchor anchor{
        network.cells.corners[a], {}, static_cast<int>(mesh.nodes.rows()) + a, 100 * Eigen::Matrix3d::Identity()};
    Vec3 at = Vec3::Zero();
    for (int n = 0; n < 8; ++n) {
      anchor.weights[n] = n == a ? 0.3 : 0.1;
      at += anchor.weights[n] * mesh.nodes.row(anchor.corners[n]).transpose();
    }
    network.X.row(anchor.node) = at.transpose();
    network.anchors.push_back(anchor);
  }
  return network;
}

/// Eight cells beside one of twice their edge, cut at the top, with anchors at one end.
inline Network refined_network(double edge = 0.5) {
  const Mesh body = solid_of(block_mesh(edge * Vec3(4, 2, 1.7), {2, 1, 1}));
  VoxelGrid grid = with_halved_cubes({Vec3::Zero(), 2 * edge, {2, 1, 1}});
  halve_cell(grid, {2, 0, 0});
  return cut_lattice(cut_body(grid, body), {"x_min"}, {{100, 0, 1}});
}

/// A sheet of 3 x 3 rhombi cut into two triangles each, nodes moved in the plane and out of it.
inline Network bent_triangles(double edge = 0.5) {
  const int n = 4;
  Network network;
  network.X.resize(n * n, 3);
  std::vector<Spring> sides;
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      const int a = j * n + i;
      network.X.row(a) << edge * (i + 0.5 * j), edge * std::sqrt(0.75) * j, 0;
      if (i + 1 == n || j + 1 == n) continue;
      network.triangles.push_back({a, a + 1, a + n});
      network.triangles.push_back({a + 1, a + n + 1, a + n});
    }
  network.X += noise(n * n, 0.1 * edge, 7);
  for (const auto& t : network.triangles)
    for (int c = 0; c < 3; ++c)
      sides.push_back({t[c], t[(c + 1) % 3], 500, (network.X.row(t[c]) - network.X.row(t[(c + 1) % 3])).norm()});
  network.springs = merge_springs(std::move(sides));
  network.volume = Eigen::VectorXd::Constant(n * n, edge * edge * edge);
  network.cells.edge = edge;
  return network;
}

/// A model of averaged springs with a form of its own in every cell, in which everything is coupled.
inline MassSpringModel with_measured_cells(MassSpringModel model) {
  MeasuredCells measured;
  for (std::size_t c = 0; c < model.network.cells.size(); ++c) {
    const DeformationForm averaged = form_of(*averaged_springs_of(model), model.network.cells.shape(c));
    const NodalVectors r = noise(6, 1, static_cast<unsigned>(c));
    const Eigen::Map<const Eigen::Matrix<double, deformations_of_cell, 1>> coupled(r.data());
    measured.add_form(averaged + averaged.trace() / 100 * coupled * coupled.transpose());
  }
  model.laws[0] = measured;
  return model;
}

inline Eigen::Matrix3d rotation() { return Eigen::AngleAxisd(0.7, Vec3(1, 2, -1).normalized()).toRotationMatrix(); }

}  // namespace springproof::test
