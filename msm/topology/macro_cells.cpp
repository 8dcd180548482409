#include "msm/topology/macro_cells.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>
#include <stdexcept>

#include "meshes/united_numbers.h"
#include "problem/system/input_error.h"

namespace springproof {

std::vector<MacroCell> macro_cells_of(const Mesh& mesh) {
  if (!mesh.grid) throw std::invalid_argument("macro-cells need a mesh of equal cubes");
  const auto [nx, ny, nz] = mesh.grid->cells;
  if (mesh.hexahedra.size() != static_cast<std::size_t>(nx) * ny * nz)
    throw std::invalid_argument(
        "macro-cells of whole cubes fill blocks only (allowed: a body of `cells`, or a cut body at rest; hybmss_avg "
        "takes any body)");
  if (nx % 2 != 0 || ny % 2 != 0 || nz % 2 != 0)
    throw std::invalid_argument(fmt::format(
        "body.cells: [{}, {}, {}]: a macro-cell is two cubes along each axis (allowed: even numbers)", nx, ny, nz));
  std::vector<MacroCell> cells(mesh.hexahedra.size() / 8);
  for (std::size_t c = 0; c < mesh.hexahedra.size(); ++c) {
    const auto [i, j, k] = mesh.grid->cell_index[c];
    MacroCell& cell = cells[(static_cast<std::size_t>(k / 2) * (ny / 2) + j / 2) * (nx / 2) + i / 2];
    for (int a = 0; a < 8; ++a) {
      const auto [x, y, z] = hexahedron_corners[a];
      cell[i % 2 + x + 3 * (j % 2 + y) + 9 * (k % 2 + z)] = mesh.hexahedra[c][a];
    }
  }
  return cells;
}

namespace {

/// Number of the point (x, y, z) half edges from the lowest corner of a macro-cell.
constexpr int node_at(const std::array<int, 3>& at) { return at[0] + 3 * at[1] + 9 * at[2]; }

/// Cells of the body with a common face: lower, upper, axis.
std::vector<MacroFace> linked_cells(const CutBody& body) {
  std::map<std::array<int, 3>, std::vector<int>> in_cube;
  for (std::size_t c = 0; c < body.cells.size(); ++c) in_cube[body.cells[c].index].push_back(static_cast<int>(c));
  std::vector<MacroFace> links;
  for (const auto& [index, cells] : in_cube)
    for (int axis = 0; axis < 3; ++axis) {
      std::array<int, 3> next = index;
      ++next[axis];
      const auto beside = in_cube.find(next);
      if (beside == in_cube.end()) continue;
      for (const int c : cells)
        for (const int d : beside->second) {
          int common = 0;
          for (int n = 0; n < 8; ++n)
            if (hexahedron_corners[n][axis] == 1)
              common += static_cast<int>(
                  std::count(body.cells[d].corners.begin(), body.cells[d].corners.end(), body.cells[c].corners[n]));
          if (common == 4) links.push_back({c, d, axis});
        }
    }
  return links;
}

/// Two parts of one cube together.
FilledPart united(const FilledPart& a, const FilledPart& b) {
  return filled_part(a.fraction + b.fraction, a.fraction * a.mean + b.fraction * b.mean,
                     a.fraction * second_moments(a) + b.fraction * second_moments(b));
}

std::array<int, 3> block_of(const std::array<int, 3>& cube) { return {cube[0] / 2, cube[1] / 2, cube[2] / 2}; }

}  // namespace

CutMacroCells macro_cells_of(const CutBody& body) {
  if (!body.grid.doubled.empty())
    throw std::invalid_argument(
        "cells of several sizes cannot be macro-cells (allowed: voxels or voxel_edge_m without accuracy; hybmss_avg)");
  const std::vector<MacroFace> links = linked_cells(body);
  UnitedNumbers family(body.cells.size());
  for (const MacroFace& f : links)
    if (block_of(body.cells[f.lower].index) == block_of(body.cells[f.upper].index)) family.unite(f.lower, f.upper);

  CutMacroCells out;
  std::vector<std::array<int, 3>> block;
  for (std::size_t c = 0; c < body.cells.size(); ++c) {
    const int head = family.of(static_cast<int>(c));  // the first of its family
    const auto& [i, j, k] = body.cells[c].index;
    const int m = head == static_cast<int>(c) ? static_cast<int>(block.size()) : out.place[head][0];
    if (m == static_cast<int>(block.size())) {
      block.push_back(block_of(body.cells[c].index));
      out.filled.emplace_back().fill({.fraction = 0});
    }
    out.place.push_back({m, i % 2 + 2 * (j % 2) + 4 * (k % 2)});
    FilledPart& part = out.filled[m][out.place[c][1]];
    part = part.fraction == 0 ? body.cells[c].filled : united(part, body.cells[c].filled);
  }

  UnitedNumbers same(27 * block.size());
  std::set<std::array<int, 3>> faces;
  for (const MacroFace& f : links)
    if (const int lower = out.place[f.lower][0], upper = out.place[f.upper][0]; lower != upper)
      faces.insert({lower, upper, f.axis});
  const auto is_full = [&](int m) {
    return std::all_of(out.filled[m].begin(), out.filled[m].end(), [](const FilledPart& p) { return p.fraction == 1; });
  };
  for (const auto& [lower, upper, axis] : faces) {
    for (int n = 0; n < 9; ++n) {
      std::array<int, 3> at{};
      at[(axis + 1) % 3] = n % 3;
      at[(axis + 2) % 3] = n / 3;
      const int on_upper = node_at(at);
      at[axis] = 2;
      same.unite(27 * lower + node_at(at), 27 * upper + on_upper);
    }
    if (!is_full(lower) || !is_full(upper)) out.faces.push_back({lower, upper, axis});
  }

  std::vector<int> number(27 * block.size(), -1);
  std::vector<Vec3> points;
  for (std::size_t m = 0; m < block.size(); ++m) {
    MacroCell& cell = out.cells.emplace_back();
    for (int n = 0; n < 27; ++n) {
      int& node = number[same.of(static_cast<int>(27 * m) + n)];
      if (node < 0) {
        node = static_cast<int>(points.size());
        const auto [i, j, k] = block[m];
        points.push_back(body.grid.origin + body.grid.edge * Vec3(2 * i + n % 3, 2 * j + n / 3 % 3, 2 * k + n / 9));
      }
      cell[n] = node;
    }
  }
  out.points.resize(static_cast<Eigen::Index>(points.size()), 3);
  for (std::size_t n = 0; n < points.size(); ++n) out.points.row(static_cast<Eigen::Index>(n)) = points[n].transpose();
  return out;
}

void require_no_macro_cells(const Network& network, const std::string& what) {
  if (!network.macro_cells.empty())
    throw InputError(what + ": hybmss_macro has cells of 27 nodes, which are for bodies at rest (allowed: hybmss_avg)");
}

}  // namespace springproof
