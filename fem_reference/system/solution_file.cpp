#include "fem_reference/system/solution_file.h"

#include <array>
#include <cmath>

#include "problem/files/files.h"

namespace springproof::fem {
namespace {

/// A cell of VTK: its number, and for each of its nodes which shape function of deal.II is that node's.
struct VtkCell {
  std::uint8_t type;
  std::vector<int> order;
};

// deal.II: vertices (x fastest), then edges, faces, the middle.  VTK goes round the bottom, then round the top.
const VtkCell& vtk_cell(std::size_t nodes) {
  static const VtkCell tetrahedron = {10, {0, 1, 2, 3}}, hexahedron = {12, {0, 1, 3, 2, 4, 5, 7, 6}},
                       quadratic_tetrahedron = {24, {0, 1, 2, 3, 4, 5, 6, 7, 8, 9}},
                       triquadratic_hexahedron = {29, {0,  1,  3,  2,  4,  5,  7,  6,  10, 9,  11, 8,  14, 13,
                                                       15, 12, 16, 17, 19, 18, 20, 21, 22, 23, 24, 25, 26}};
  switch (nodes) {
    case 4:
      return tetrahedron;
    case 8:
      return hexahedron;
    case 10:
      return quadratic_tetrahedron;
    default:
      return triquadratic_hexahedron;
  }
}

/// sqrt(3/2 s : s), s the deviator.
double von_mises(const Eigen::Matrix<double, 1, 6>& s) {
  const double xy = s[0] - s[1], yz = s[1] - s[2], zx = s[2] - s[0];
  return std::sqrt((xy * xy + yz * yz + zx * zx) / 2 + 3 * s.tail<3>().squaredNorm());
}

template <class Rows>
VtuArray array_of(const std::string& name, const Rows& rows) {
  return {name, static_cast<int>(rows.cols()), {rows.data(), rows.data() + rows.size()}};
}

}  // namespace

void write_solution(const std::string& file, const NodalSolution& solution, const VtuNotes& notes) {
  VtuFile vtu{solution.X, {}, {}, {}, {}, {}, notes};
  std::vector<int> nodes;
  for (const std::vector<int>& cell : solution.cells) {
    const auto& [type, order] = vtk_cell(cell.size());
    nodes.clear();
    for (const int a : order) nodes.push_back(cell[static_cast<std::size_t>(a)]);
    vtu.add_cell(nodes, type);
  }
  VtuArray mises{"von_mises", 1, {}};
  for (Eigen::Index n = 0; n < solution.stress.rows(); ++n) mises.values.push_back(von_mises(solution.stress.row(n)));
  vtu.point_data = {array_of("displacement", solution.displacement), array_of("stress", solution.stress),
                    std::move(mises)};
  if (!solution.materials.empty()) vtu.cell_data = {{"material", 1, solution.materials}};
  write_file(file, text_of(vtu));
}

}  // namespace springproof::fem
