#include "meshes/voxels/voxelise.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "meshes/box.h"
#include "meshes/locate/tetrahedron_locator.h"
#include "meshes/patches/transfer_patches.h"
#include "meshes/united_numbers.h"
#include "meshes/voxels/scan_lines.h"

namespace springproof {
namespace {

constexpr double tolerance = 1e-6;  // of an edge
constexpr double most_cubes = 1e9;  // in the box
constexpr double most_left_out = 0.02;

Box extent_of(const Mesh& body) {
  Box box = empty_box();
  const auto add = [&](const auto& cells) {
    for (const auto& cell : cells)
      for (const int n : cell) add_to(box, body.nodes.row(n).transpose());
  };
  add(body.hexahedra);
  add(body.tetrahedra);
  return box;
}

void check_edge(double edge, double cubes) {
  if (!(edge > 0) || !std::isfinite(edge))
    throw std::invalid_argument(fmt::format("voxels: an edge of {:.6g} m is not positive", edge));
  if (!(cubes <= most_cubes))
    throw std::invalid_argument(
        fmt::format("voxels: cubes of {:.6g} m are too small: the box around the body holds {:.3g}, at most {:.0e} are "
                    "taken",
                    edge, cubes, most_cubes));
}

void check_grid(const VoxelGrid& grid, const Mesh& body) {
  if (*std::min_element(grid.cells.begin(), grid.cells.end()) < 1)
    throw std::invalid_argument("voxels: the grid has no cells");
  check_edge(grid.edge, double(grid.cells[0]) * grid.cells[1] * grid.cells[2]);
  const Box body_box = extent_of(body);
  const Vec3 slack = Vec3::Constant(2 * tolerance * grid.edge);
  const Vec3 end = grid.origin + grid.edge * Vec3(grid.cells[0], grid.cells[1], grid.cells[2]);
  if ((body_box.low.array() >= (grid.origin - slack).array()).all() &&
      (body_box.high.array() <= (end + slack).array()).all())
    return;
  const auto text = [](const Vec3& p) { return fmt::format("({:.6g}, {:.6g}, {:.6g})", p[0], p[1], p[2]); };
  throw std::invalid_argument(
      fmt::format("voxels: the body spans {} to {} m, which is not within the box from {} to {} m", text(body_box.low),
                  text(body_box.high), text(grid.origin), text(end)));
}

/// The cubes whose centres lie inside; cube (0,0,0) has its centre at the lattice's origin.
std::vector<RowRun> cubes_inside(const VoxelGrid& grid, const Mesh& body, const std::vector<OuterFacet>& facets) {
  std::vector<Vec3> points(body.nodes.rows());
  for (Eigen::Index n = 0; n < body.nodes.rows(); ++n)
    points[n] = (body.nodes.row(n).transpose() - grid.origin) / grid.edge - Vec3::Constant(0.5);
  std::vector<std::array<int, 3>> triangles;
  triangles.reserve(2 * facets.size());
  for (const OuterFacet& f : facets) {
    triangles.push_back({f.nodes[0], f.nodes[1], f.nodes[2]});
    if (f.nodes[3] >= 0) triangles.push_back({f.nodes[0], f.nodes[2], f.nodes[3]});
  }
  return runs_inside(points, triangles, grid.cells);
}

std::size_t cubes_in(const std::vector<RowRun>& runs) {
  std::size_t sum = 0;
  for (const RowRun& r : runs) sum += r.end - r.begin;
  return sum;
}

/// The pieces that the runs belong to: runs are connected where cubes share a face.
UnitedNumbers pieces_of(const std::vector<RowRun>& runs, const std::array<int, 3>& cells) {
  UnitedNumbers piece(runs.size());
  const auto join_rows = [&](int distance, bool over_layers) {  // of rows: to the next in y, or in z
    for (std::size_t a = 0, b = 0; a < runs.size(); ++a) {
      if (!over_layers && (runs[a].row + 1) % cells[1] == 0) continue;  // the last row of its layer
      const int row = runs[a].row + distance;
      while (b < runs.size() && (runs[b].row < row || (runs[b].row == row && runs[b].end <= runs[a].begin))) ++b;
      for (std::size_t c = b; c < runs.size() && runs[c].row == row && runs[c].begin < runs[a].end; ++c)
        piece.unite(static_cast<int>(c), static_cast<int>(a));
    }
  };
  join_rows(1, false);
  join_rows(cells[1], true);
  return piece;
}

/// Drops all but the largest piece.
void keep_one_piece(std::vector<RowRun>& runs, const VoxelGrid& grid, std::vector<std::string>& notes) {
  UnitedNumbers piece = pieces_of(runs, grid.cells);
  std::vector<std::size_t> size(runs.size(), 0);
  for (std::size_t r = 0; r < runs.size(); ++r) size[piece.of(static_cast<int>(r))] += runs[r].end - runs[r].begin;
  const auto largest = std::max_element(size.begin(), size.end());
  const auto pieces = std::count_if(size.begin(), size.end(), [](std::size_t n) { return n > 0; });
  if (pieces == 1) return;
  const std::size_t all = cubes_in(runs), left_out = all - *largest;
  if (double(left_out) > most_left_out * double(all))
    throw std::invalid_argument(fmt::format(
        "voxels: the {} cubes of {:.6g} m fall into {} pieces that share no face, the largest of {}; take smaller "
        "voxels",
        all, grid.edge, pieces, *largest));
  notes.push_back(fmt::format("{} of {} cubes {} on by an edge or {} apart: left out", left_out, all,
                              left_out == 1 ? "hangs" : "hang", left_out == 1 ? "lies" : "lie"));
  const int kept = static_cast<int>(largest - size.begin());
  std::size_t next = 0;
  for (std::size_t r = 0; r < runs.size(); ++r)
    if (piece.of(static_cast<int>(r)) == kept) runs[next++] = runs[r];
  runs.resize(next);
}

/// The cubes and their nodes, both x fastest; only points that a cube uses are nodes.
class CubeMesh {
 public:
  CubeMesh(const VoxelGrid& grid, const std::vector<RowRun>& runs)
      : grid_(grid), runs_(runs), layer_start_(grid.cells[2] + 1) {
    for (int k = 0; k <= grid.cells[2]; ++k)
      layer_start_[k] = std::lower_bound(runs.begin(), runs.end(), std::int64_t{k} * grid.cells[1],
                                         [](const RowRun& r, std::int64_t row) { return r.row < row; }) -
                        runs.begin();
  }

  Mesh build() {
    mesh_.hexahedra.reserve(cubes_in(runs_));
    std::vector<int> below = number_points(0);
    for (int k = 0; k < grid_.cells[2]; ++k) {
      const std::vector<int> above = number_points(k + 1);
      add_cubes(k, below, above);
      below = above;
    }
    mesh_.nodes.resize(points_.size(), 3);
    for (std::size_t n = 0; n < points_.size(); ++n)
      for (int axis = 0; axis < 3; ++axis) mesh_.nodes(n, axis) = grid_.origin[axis] + points_[n][axis] * grid_.edge;
    set_grid();
    return std::move(mesh_);
  }

 private:
  std::size_t point(int i, int j) const { return std::size_t(j) * (grid_.cells[0] + 1) + i; }

  /// f(run, j) for the runs of layer k of cubes, if there is one.
  template <class F>
  void for_layer(int k, F f) const {
    if (k < 0 || k >= grid_.cells[2]) return;
    for (std::size_t r = layer_start_[k]; r < layer_start_[k + 1]; ++r) f(runs_[r], runs_[r].row % grid_.cells[1]);
  }

  /// Node numbers of the lattice points of height k; -1 where there is none.
  std::vector<int> number_points(int k) {
    std::vector<int> number(point(0, grid_.cells[1] + 1), -1);
    for (const int layer : {k - 1, k})
      for_layer(layer, [&](const RowRun& run, int j) {
        for (const int row : {j, j + 1}) std::fill(&number[point(run.begin, row)], &number[point(run.end, row)] + 1, 0);
      });
    for (int j = 0; j <= grid_.cells[1]; ++j)
      for (int i = 0; i <= grid_.cells[0]; ++i)
        if (int& n = number[point(i, j)]; n == 0) {
          n = static_cast<int>(points_.size());
          points_.push_back({i, j, k});
        }
    return number;
  }

  void add_cubes(int k, const std::vector<int>& below, const std::vector<int>& above) {
    for_layer(k, [&](const RowRun& run, int j) {
      for (int i = run.begin; i < run.end; ++i) {
        Hexahedron cube;
        for (int c = 0; c < 8; ++c) {
          const auto& [di, dj, dk] = hexahedron_corners[c];
          cube[c] = (dk ? above : below)[point(i + di, j + dj)];
        }
        mesh_.hexahedra.push_back(cube);
        index_.push_back({i, j, k});
      }
    });
  }

  /// The grid of the cubes that are there.
  void set_grid() {
    std::array<int, 3> low = index_.front(), high = low;
    for (const auto& index : index_)
      for (int axis = 0; axis < 3; ++axis) {
        low[axis] = std::min(low[axis], index[axis]);
        high[axis] = std::max(high[axis], index[axis]);
      }
    Grid grid;
    for (int axis = 0; axis < 3; ++axis) {
      grid.cells[axis] = high[axis] - low[axis] + 1;
      grid.origin[axis] = grid_.origin[axis] + low[axis] * grid_.edge;
      grid.spacing[axis] = grid_.edge;
    }
    for (auto& index : index_)
      for (int axis = 0; axis < 3; ++axis) index[axis] -= low[axis];
    grid.cell_index = std::move(index_);
    mesh_.grid = std::move(grid);
  }

  const VoxelGrid& grid_;
  const std::vector<RowRun>& runs_;
  std::vector<std::size_t> layer_start_;  ///< of the runs
  std::vector<std::array<int, 3>> points_, index_;
  Mesh mesh_;
};

/// Materials of cubes by those of a body of tetrahedra at their middles.
std::vector<std::uint8_t> materials_at_middles(const Mesh& cubes, const Mesh& body) {
  const TetrahedronLocator locate(body.nodes, body.tetrahedra);
  std::vector<std::uint8_t> materials;
  for (const Hexahedron& cube : cubes.hexahedra)
    materials.push_back(
        body.materials[locate((cubes.nodes.row(cube[0]) + cubes.nodes.row(cube[6])).transpose() / 2).cell]);
  return materials;
}

}  // namespace

int cell_size(const VoxelGrid& grid, const std::array<int, 3>& cube) {
  return grid.doubled.empty() ? 1 : 1 << grid.doubled[cube_number(grid, cube)];
}

std::array<int, 3> cell_at(const VoxelGrid& grid, const std::array<int, 3>& cube) {
  const int size = cell_size(grid, cube);
  return {cube[0] - cube[0] % size, cube[1] - cube[1] % size, cube[2] - cube[2] % size};
}

long cube_number(const VoxelGrid& grid, const std::array<int, 3>& at) {
  return (long(at[2]) * grid.cells[1] + at[1]) * grid.cells[0] + at[0];
}

std::array<int, 3> cube_at(const VoxelGrid& grid, const Vec3& point) {
  std::array<int, 3> at;
  for (int d = 0; d < 3; ++d)
    at[d] = std::clamp(static_cast<int>(std::floor((point[d] - grid.origin[d]) / grid.edge)), 0, grid.cells[d] - 1);
  return at;
}

VoxelGrid voxel_grid(const Mesh& body, double edge) {
  if (body.hexahedra.empty() && body.tetrahedra.empty()) throw std::invalid_argument("voxels: the body has no cells");
  const Box box = extent_of(body);
  const Vec3 counts =
      ((box.high - box.low) / edge).unaryExpr([](double n) { return std::max(1.0, std::ceil(n - tolerance)); });
  check_edge(edge, counts.prod());
  VoxelGrid grid{box.low, edge, {}};
  for (int axis = 0; axis < 3; ++axis) {
    grid.cells[axis] = static_cast<int>(counts[axis]);
    const double excess = counts[axis] * edge - (box.high[axis] - box.low[axis]);
    if (excess > tolerance * edge) grid.origin[axis] -= excess / 2;
  }
  return grid;
}

Voxels voxelise(const VoxelGrid& grid, const Mesh& body) {
  check_grid(grid, body);
  const std::vector<OuterFacet> facets = outer_facets(body);
  std::vector<RowRun> runs = cubes_inside(grid, body, facets);
  if (runs.empty())
    throw std::invalid_argument(
        fmt::format("voxels: no cube of {:.6g} m has its centre in the body; take smaller voxels", grid.edge));
  Voxels voxels;
  keep_one_piece(runs, grid, voxels.notes);
  voxels.mesh = CubeMesh(grid, runs).build();
  if (!body.materials.empty()) voxels.mesh.materials = materials_at_middles(voxels.mesh, body);
  for (const std::string& name : transfer_patches(body, facets, voxels.mesh))
    voxels.notes.push_back(fmt::format(
        "patch '{}' is smaller than the cubes' faces of {:.6g} m: one of them stands for it", name, grid.edge));
  return voxels;
}

}  // namespace springproof
