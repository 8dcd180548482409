#include "msm/embedding/cut_lattice.h"

#include <cmath>

#include "msm/embedding/supports.h"

namespace springproof {
namespace {

constexpr double least_weight = 1e-12;

/// Calls act(node, weight) for a point [m] of the body, in a cell or beside it.
template <class Act>
void interpolate(const CutBody& body, int cell, const Vec3& point, const Act& act) {
  const Hexahedron& corners = body.cells[cell].corners;
  const auto weights = body.weights(cell, point);
  for (int n = 0; n < 8; ++n)
    if (std::abs(weights[n]) > least_weight) act(corners[n], weights[n]);
}

/// The points of the surface as means of the nodes that nothing carries.
Eigen::SparseMatrix<double, Eigen::RowMajor> surface_weights(const CutBody& body, Eigen::Index nodes) {
  const Carriers carriers = carriers_of(static_cast<int>(nodes), body.carried);
  std::vector<Eigen::Triplet<double>> entries;
  const int points = static_cast<int>(body.surface.size());
  for (int p = 0; p < points; ++p)
    interpolate(body, body.surface[p].cell, body.surface[p].position, [&](int n, double weight) {
      for_each_carrier(carriers, n, [&](int node, double share) { entries.emplace_back(p, node, weight * share); });
    });
  Eigen::SparseMatrix<double, Eigen::RowMajor> all(points, nodes);
  all.setFromTriplets(entries.begin(), entries.end());
  return all;
}

/// The materials of the cells, their densities, and the bonds between them.
void add_materials(const CutBody& body, const std::vector<IsotropicMaterial>& materials, Network& network) {
  for (const CutCell& cell : body.cells) network.cells.materials.push_back(static_cast<std::uint8_t>(cell.material));
  for (const IsotropicMaterial& m : materials)
    network.cells.relative_densities.push_back(m.density / materials[0].density);
  network.bonds = bonds_of_interfaces(body, materials);
}

}  // namespace

double weight_of_corner(const FilledPart& part, int corner) {
  Vec3 s;
  for (int d = 0; d < 3; ++d) s[d] = 2.0 * hexahedron_corners[corner][d] - 1;
  const double mixed = s[1] * s[2] * part.mixed[0] + s[2] * s[0] * part.mixed[1] + s[0] * s[1] * part.mixed[2];
  return part.fraction * (0.125 + s.dot(part.mean) / 4 + mixed / 2);
}

Network cut_lattice(const CutBody& body, const std::vector<std::string>& held,
                    const std::vector<IsotropicMaterial>& materials) {
  require_materials(body, materials.size());
  Network network;
  const double l = body.grid.edge;
  network.cells.edge = l;
  const auto corners = body.points.rows();
  for (const std::string& name : held)
    for (Anchor& anchor : anchors_of_patch(body, name, materials)) {
      anchor.node = static_cast<int>(corners) + static_cast<int>(network.anchors.size());
      network.anchors.push_back(anchor);
    }
  network.X.resize(corners + static_cast<Eigen::Index>(network.anchors.size()), 3);
  network.X.topRows(corners) = body.points;
  for (const Anchor& anchor : network.anchors)
    network.X.row(anchor.node) = anchored_point(anchor, body.points).transpose();
  network.volume = Eigen::VectorXd::Zero(network.X.rows());
  for (const CutCell& cell : body.cells) {
    network.cells.corners.push_back(cell.corners);
    network.cells.filled.push_back(cell.filled);
    network.cells.edges.push_back(l * cell.size);
    for (const int n : cell.corners) network.volume[n] += cell.filled.fraction * std::pow(l * cell.size, 3) / 8;
  }
  network.cells.carried = body.carried;
  hand_back(network.cells.carried, network.volume, 1);
  if (body.grid.doubled.empty()) network.cells.edges.clear();
  if (materials.size() > 1) add_materials(body, materials, network);
  return network;
}

Embedding embed(const CutBody& body, const std::vector<std::string>& held, const Network& network, const Mesh& mesh) {
  Embedding e;
  std::vector<Eigen::Triplet<double>> entries;
  std::vector<char> done(mesh.nodes.rows(), 0);
  const auto follow = [&](int node, int cell) {
    if (done[node]) return;
    done[node] = 1;
    interpolate(body, cell, mesh.nodes.row(node).transpose(),
                [&](int n, double w) { entries.emplace_back(node, n, w); });
  };
  const auto holds = [&](int cell, const Vec3& point) {  // of one size, cells continue to the nodes of their cube
    const double half = body.grid.edge * body.cells[cell].size * (0.5 + 1e-9);
    return body.grid.doubled.empty() || (point - body.centre(cell)).cwiseAbs().maxCoeff() <= half;
  };
  for (const Hexahedron& cube : mesh.hexahedra) {
    const Vec3 middle = (mesh.nodes.row(cube[0]) + mesh.nodes.row(cube[6])).transpose() / 2;
    const int cell = body.place(middle).cell;
    for (const int n : cube) {
      const Vec3 X = mesh.nodes.row(n).transpose();
      if (!done[n]) follow(n, holds(cell, X) ? cell : body.place(X).cell);
    }
  }
  for (const Tetrahedron& t : mesh.tetrahedra)
    for (const int n : t)
      if (!done[n]) follow(n, body.place(mesh.nodes.row(n).transpose()).cell);
  e.weights.resize(mesh.nodes.rows(), network.X.rows());
  e.weights.setFromTriplets(entries.begin(), entries.end());

  e.surface = surface_weights(body, network.X.rows());
  e.volumes = Eigen::VectorXd::Zero(network.X.rows());
  for (const CutCell& cell : body.cells) {
    const std::vector<double>& densities = network.cells.relative_densities;
    const double volume = std::pow(body.grid.edge * cell.size, 3) * (densities.empty() ? 1 : densities[cell.material]);
    for (int n = 0; n < 8; ++n) e.volumes[cell.corners[n]] += volume * weight_of_corner(cell.filled, n);
  }
  for (const auto& [name, parts] : body.patches) {
    PatchShares shares{Eigen::VectorXd::Zero(network.X.rows()), NodalVectors::Zero(network.X.rows(), 3)};
    for (const PatchInCell& p : parts)
      for (int n = 0; n < 8; ++n) {
        const int node = body.cells[p.cell].corners[n];
        shares.area[node] += p.area[n];
        shares.normal.row(node) += p.normal[n].transpose();
      }
    e.patches[name] = std::move(shares);
  }
  // The anchored nodes follow the others, patch by patch.
  int node = static_cast<int>(body.points.rows());
  for (const std::string& name : held)
    for (std::size_t a = 0; a < anchors_of_part * body.patches.at(name).size(); ++a) e.held[name].push_back(node++);
  return e;
}

NodalVectors displacement_at(const CutBody& body, const NodalVectors& u, const NodalVectors& points) {
  NodalVectors out = NodalVectors::Zero(points.rows(), 3);
  for (Eigen::Index i = 0; i < points.rows(); ++i) {
    const Vec3 point = points.row(i).transpose();
    interpolate(body, body.place(point).cell, point, [&](int n, double weight) { out.row(i) += weight * u.row(n); });
  }
  return out;
}

}  // namespace springproof
