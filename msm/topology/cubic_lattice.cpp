#include "msm/topology/cubic_lattice.h"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>

namespace springproof {

CubicPattern isotropic_pattern(double face_to_cube) {
  if (!(face_to_cube >= 0)) throw std::invalid_argument("face_to_cube: A must be >= 0 (or infinite)");
  if (std::isinf(face_to_cube)) return {1.0, 1.0, 0.0};
  return {8.0 / 3.0 + face_to_cube, face_to_cube, 1.0};
}

namespace {

const Grid& grid_of(const Mesh& mesh) {
  if (!mesh.grid || mesh.hexahedra.empty())
    throw std::invalid_argument("a cubic lattice needs a mesh of equal cubes; this mesh is not cut from one lattice");
  return *mesh.grid;
}

}  // namespace

bool has_cubes(const Grid& grid) {
  return (grid.spacing.array() - grid.spacing[0]).abs().maxCoeff() <= 1e-6 * grid.spacing[0];
}

double cube_edge(const Mesh& mesh) {
  const Vec3& edge = grid_of(mesh).spacing;
  if (!has_cubes(*mesh.grid))
    throw std::invalid_argument(fmt::format(
        "a cubic lattice needs cubes; the cells are {:.6g} x {:.6g} x {:.6g} m (choose cells in proportion to size)",
        edge[0], edge[1], edge[2]));
  return edge[0];
}

// 13 slots per lattice point, one for each direction away from it.
std::vector<Spring> superposed(const Network& network, const std::vector<double>& of_material) {
  const Grid& grid = *network.cells.grid;
  const std::array<int, 3> points = {grid.cells[0] + 1, grid.cells[1] + 1, grid.cells[2] + 1};
  const auto point = [&](const std::array<int, 3>& p) {
    return (std::size_t(p[2]) * points[1] + p[1]) * points[0] + p[0];
  };
  struct Part {
    std::size_t from;  ///< start of the spring, relative to the cell's lowest corner
    int slot, i, j;
    double stiffness, rest_length;
  };
  std::vector<Part> parts;
  for (const Spring& s : network.cells.springs) {
    std::array<int, 3> a = hexahedron_corners[s.i], b = hexahedron_corners[s.j];
    int direction = (b[0] - a[0]) + 3 * (b[1] - a[1]) + 9 * (b[2] - a[2]);
    if (direction < 0) std::swap(a, b), direction = -direction;
    parts.push_back({point(a), direction - 1, s.i, s.j, s.stiffness, s.rest_length});
  }
  std::vector<int> spring_at(13 * point(points), -1);
  std::vector<Spring> springs;
  for (std::size_t c = 0; c < network.cells.size(); ++c) {
    const std::size_t corner = point(grid.cell_index[c]);
    const double times = of_material[network.cells.material(c)];
    for (const Part& part : parts) {
      int& s = spring_at[13 * (corner + part.from) + part.slot];
      if (s >= 0) {
        springs[s].stiffness += times * part.stiffness;
        continue;
      }
      s = static_cast<int>(springs.size());
      springs.push_back({network.cells.corners[c][part.i], network.cells.corners[c][part.j], times * part.stiffness,
                         part.rest_length});
    }
  }
  return merge_springs(std::move(springs));
}

Network lattice_without_springs(const Mesh& mesh) {
  const Grid& grid = grid_of(mesh);
  Network network;
  network.X = mesh.nodes;
  network.cells.corners = mesh.hexahedra;
  network.cells.edge = has_cubes(grid) ? grid.spacing[0] : std::cbrt(grid.spacing.prod());
  if (!has_cubes(grid)) network.cells.proportions = grid.spacing / network.cells.edge;
  network.volume = nodal_volumes(mesh);
  network.cells.grid = mesh.grid;
  return network;
}

Network cubic_lattice(const Mesh& mesh, const CubicPattern& pattern) {
  const double edge = cube_edge(mesh);
  Network network = lattice_without_springs(mesh);
  const double share[4] = {0, pattern.k_e / 4, pattern.k_f / 2, pattern.k_c};  // by number of differing axes
  for (int a = 0; a < 8; ++a)
    for (int b = a + 1; b < 8; ++b) {
      int axes = 0;
      for (int d = 0; d < 3; ++d) axes += hexahedron_corners[a][d] != hexahedron_corners[b][d];
      if (share[axes] > 0) network.cells.springs.push_back({a, b, share[axes], edge * std::sqrt(double(axes))});
    }
  network.springs = superposed(network, {1});
  return network;
}

}  // namespace springproof
