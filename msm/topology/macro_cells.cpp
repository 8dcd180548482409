#include "msm/topology/macro_cells.h"

#include <fmt/format.h>

#include <stdexcept>

#include "problem/system/input_error.h"

namespace springproof {

std::vector<MacroCell> macro_cells_of(const Mesh& mesh) {
  if (!mesh.grid) throw std::invalid_argument("macro-cells need a mesh of equal cubes");
  const auto [nx, ny, nz] = mesh.grid->cells;
  if (mesh.hexahedra.size() != static_cast<std::size_t>(nx) * ny * nz)
    throw std::invalid_argument("macro-cells fill blocks only (allowed: a body of `cells`; hybmss_avg takes any body)");
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

void require_no_macro_cells(const Network& network, const std::string& what) {
  if (!network.macro_cells.empty())
    throw InputError(what + ": hybmss_macro has cells of 27 nodes, which are for bodies at rest (allowed: hybmss_avg)");
}

}  // namespace springproof
