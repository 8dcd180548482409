#include "msm/embedding/cut_lattice.h"

#include <cmath>
#include <optional>
#include <set>

#include "meshes/voxels/triquadratic.h"
#include "msm/laws/macro_points.h"
#include "msm/topology/macro_cells.h"

namespace springproof {
namespace {

constexpr double least_weight = 1e-12;

/// How points of the body follow the nodes of its cells or macro-cells.
class Interpolation {
 public:
  Interpolation(const CutBody& body, const CutMacroCells* macro) : body_(body), macro_(macro) {}

  /// Calls act(node, weight) for a point [m] in a cell or beside it.
  template <class Act>
  void operator()(int cell, const Vec3& point, const Act& act) const {
    const auto take = [&](const auto& nodes, const auto& weights) {
      for (std::size_t n = 0; n < nodes.size(); ++n)
        if (std::abs(weights[n]) > least_weight) act(nodes[n], weights[n]);
    };
    if (!macro_) return take(body_.cells[cell].corners, body_.weights(cell, point));
    const auto [m, cube] = macro_->place[cell];
    const Vec3 from_cube = (point - body_.centre(cell)) / body_.grid.edge;
    take(macro_->cells[m], triquadratic_weights(middle_of_cube(cube) + from_cube));
  }

 private:
  const CutBody& body_;
  const CutMacroCells* macro_;
};

/// The points of the surface as means of the nodes that nothing carries.
Eigen::SparseMatrix<double, Eigen::RowMajor> surface_weights(const CutBody& body, const Interpolation& interpolate,
                                                             Eigen::Index nodes) {
  const Carriers carriers = carriers_of(static_cast<int>(nodes), body.carried);
  std::vector<Eigen::Triplet<double>> entries;
  const int points = static_cast<int>(body.surface.size());
  for (int p = 0; p < points; ++p)
    interpolate(body.surface[p].cell, body.surface[p].position, [&](int n, double weight) {
      for_each_carrier(carriers, n, [&](int node, double share) { entries.emplace_back(p, node, weight * share); });
    });
  Eigen::SparseMatrix<double, Eigen::RowMajor> all(points, nodes);
  all.setFromTriplets(entries.begin(), entries.end());
  return all;
}

/// Integral of a corner's trilinear weight over the filled part, in units of the volume of the cube; the moment of
/// third order is left out, so that force and moment of a uniform body force are exact.
double weight_of_corner(const FilledPart& part, int corner) {
  Vec3 s;
  for (int d = 0; d < 3; ++d) s[d] = 2.0 * hexahedron_corners[corner][d] - 1;
  const double mixed = s[1] * s[2] * part.mixed[0] + s[2] * s[0] * part.mixed[1] + s[0] * s[1] * part.mixed[2];
  return part.fraction * (0.125 + s.dot(part.mean) / 4 + mixed / 2);
}

/// Integrals by the triquadratic weights of a macro-cell from those by the weights of the 27 points of one of its
/// cubes.
template <class Value>
std::array<Value, 27> of_macro_cell(int cube, const std::array<Value, 27>& of_cube) {
  std::array<Value, 27> all;
  all.fill(Value(0 * of_cube[0]));
  for (int p = 0; p < 27; ++p) {
    const Vec3 at = middle_of_cube(cube) + (Vec3(p % 3, p / 3 % 3, p / 9) - Vec3::Ones()) / 2;
    const std::array<double, 27> weights = triquadratic_weights(at);
    for (int n = 0; n < 27; ++n) all[n] += weights[n] * of_cube[p];
  }
  return all;
}

/// Points and more of them.
NodalVectors followed_by(const NodalVectors& points, const std::vector<Vec3>& more) {
  NodalVectors all(points.rows() + static_cast<Eigen::Index>(more.size()), 3);
  all.topRows(points.rows()) = points;
  for (std::size_t a = 0; a < more.size(); ++a)
    all.row(points.rows() + static_cast<Eigen::Index>(a)) = more[a].transpose();
  return all;
}

}  // namespace

Network cut_lattice(const CutBody& body, const std::vector<std::string>& held, double youngs_modulus) {
  Network network;
  const double l = body.grid.edge;
  network.cell_edge = l;
  std::vector<Vec3> anchored;
  const int corners = static_cast<int>(body.points.rows());
  for (const std::string& name : held)
    for (const PatchInCell& p : body.patches.at(name)) {
      const double area = p.total_area();
      Anchor anchor{body.cells[p.cell].corners,
                    {},
                    corners + static_cast<int>(anchored.size()),
                    anchor_stiffness * youngs_modulus * area / (l * body.cells[p.cell].size)};
      Vec3 centroid = Vec3::Zero();
      for (int n = 0; n < 8; ++n) {
        anchor.weights[n] = p.area[n] / area;
        centroid += anchor.weights[n] * body.points.row(anchor.corners[n]).transpose();
      }
      anchored.push_back(centroid);
      network.anchors.push_back(anchor);
    }
  network.X = followed_by(body.points, anchored);
  network.volume = Eigen::VectorXd::Zero(network.X.rows());
  for (const CutCell& cell : body.cells) {
    network.cells.push_back(cell.corners);
    network.filled.push_back(cell.filled);
    network.cell_edges.push_back(l * cell.size);
    for (const int n : cell.corners) network.volume[n] += cell.filled.fraction * std::pow(l * cell.size, 3) / 8;
  }
  network.carried = body.carried;
  hand_back(network.carried, network.volume, 1);
  if (body.grid.doubled.empty()) network.cell_edges.clear();
  return network;
}

Network cut_macro_lattice(const CutBody& body, const std::vector<std::string>& held, double youngs_modulus) {
  const CutMacroCells macro = macro_cells_of(body);
  Network network;
  const double l = network.cell_edge = body.grid.edge;
  network.macro_cells = macro.cells;
  network.macro_faces = macro.faces;
  for (std::size_t m = 0; m < macro.cells.size(); ++m)
    for (int cube = 0; cube < 8; ++cube) {
      Hexahedron& corners = network.cells.emplace_back();
      for (int a = 0; a < 8; ++a) corners[a] = macro.cells[m][macro_node(cube, a)];
      network.filled.push_back(macro.filled[m][cube]);
    }
  std::vector<Vec3> anchored;
  const int nodes = static_cast<int>(macro.points.rows());
  for (const std::string& name : held)
    for (const PatchInCell& p : body.patches.at(name)) {
      const auto [m, cube] = macro.place[p.cell];
      const double area = p.total_area();
      MacroAnchor anchor{m, cube, of_macro_cell(cube, p.quadratic_area), nodes + static_cast<int>(anchored.size()),
                         macro_anchor_stiffness * youngs_modulus * area / l};
      Vec3& centroid = anchored.emplace_back(Vec3::Zero());
      for (int n = 0; n < 27; ++n) {
        anchor.weights[n] /= area;
        centroid += anchor.weights[n] * macro.points.row(macro.cells[m][n]).transpose();
      }
      network.macro_anchors.push_back(anchor);
    }
  network.X = followed_by(macro.points, anchored);
  network.volume = Eigen::VectorXd::Zero(network.X.rows());
  for (std::size_t c = 0; c < network.cells.size(); ++c)
    for (const int n : network.cells[c]) network.volume[n] += network.filled[c].fraction * network.cell_volume() / 8;
  return network;
}

Embedding embed(const CutBody& body, const std::vector<std::string>& held, const Network& network, const Mesh& mesh) {
  Embedding e;
  std::optional<CutMacroCells> macro;
  if (!network.macro_cells.empty()) macro = macro_cells_of(body);
  const Interpolation interpolate(body, macro ? &*macro : nullptr);
  std::vector<Eigen::Triplet<double>> entries;
  std::vector<char> done(mesh.nodes.rows(), 0);
  const auto follow = [&](int node, int cell) {
    if (done[node]) return;
    done[node] = 1;
    interpolate(cell, mesh.nodes.row(node).transpose(), [&](int n, double w) { entries.emplace_back(node, n, w); });
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

  e.surface = surface_weights(body, interpolate, network.X.rows());
  e.volumes = Eigen::VectorXd::Zero(network.X.rows());
  if (macro)
    for (std::size_t m = 0; m < network.macro_cells.size(); ++m) {
      const MacroPoints of_cell = macro_points(network, m);
      for (const MacroPoint& p : of_cell.points) {
        const std::array<double, 27> weights = triquadratic_weights(p.at);
        for (int n = 0; n < 27; ++n) e.volumes[network.macro_cells[m][n]] += of_cell.volume * p.share * weights[n];
      }
    }
  else
    for (const CutCell& cell : body.cells) {
      const double volume = std::pow(body.grid.edge * cell.size, 3);
      for (int n = 0; n < 8; ++n) e.volumes[cell.corners[n]] += volume * weight_of_corner(cell.filled, n);
    }
  for (const auto& [name, parts] : body.patches) {
    PatchShares shares{Eigen::VectorXd::Zero(network.X.rows()), NodalVectors::Zero(network.X.rows(), 3)};
    const auto add = [&](const auto& nodes, const auto& area, const auto& normal) {
      for (std::size_t n = 0; n < nodes.size(); ++n) {
        shares.area[nodes[n]] += area[n];
        shares.normal.row(nodes[n]) += normal[n].transpose();
      }
    };
    for (const PatchInCell& p : parts)
      if (macro) {
        const auto [m, cube] = macro->place[p.cell];
        add(macro->cells[m], of_macro_cell(cube, p.quadratic_area), of_macro_cell(cube, p.quadratic_normal));
      } else {
        add(body.cells[p.cell].corners, p.area, p.normal);
      }
    e.patches[name] = std::move(shares);
  }
  // The anchored nodes follow the others, patch by patch.
  int node = static_cast<int>(macro ? macro->points.rows() : body.points.rows());
  for (const std::string& name : held)
    for (std::size_t p = 0; p < body.patches.at(name).size(); ++p) e.held[name].push_back(node++);
  return e;
}

std::vector<int> nodes_at_patch(const CutBody& body, const std::string& patch) {
  std::set<int> nodes;
  for (const PatchInCell& p : body.patches.at(patch))
    for (int n = 0; n < 8; ++n)
      if (p.area[n] >= p.total_area() / 8) nodes.insert(body.cells[p.cell].corners[n]);
  for (const CarriedPoint& c : body.carried) nodes.erase(c.point);
  return {nodes.begin(), nodes.end()};
}

NodalVectors at_points_of_cells(const CutBody& body, const NodalVectors& u) {
  const CutMacroCells macro = macro_cells_of(body);
  NodalVectors out = NodalVectors::Zero(body.points.rows(), 3);
  for (std::size_t c = 0; c < body.cells.size(); ++c)
    for (int n = 0; n < 8; ++n) {
      const auto [m, cube] = macro.place[c];
      out.row(body.cells[c].corners[n]) = u.row(macro.cells[m][macro_node(cube, n)]);
    }
  return out;
}

NodalVectors displacement_at(const CutBody& body, const NodalVectors& u, const NodalVectors& points,
                             bool of_macro_cells) {
  std::optional<CutMacroCells> macro;
  if (of_macro_cells) macro = macro_cells_of(body);
  const Interpolation interpolate(body, macro ? &*macro : nullptr);
  NodalVectors out = NodalVectors::Zero(points.rows(), 3);
  for (Eigen::Index i = 0; i < points.rows(); ++i) {
    const Vec3 point = points.row(i).transpose();
    interpolate(body.place(point).cell, point, [&](int n, double weight) { out.row(i) += weight * u.row(n); });
  }
  return out;
}

}  // namespace springproof
