#include "fem_reference/system/local_refinement.h"

#include <deal.II/fe/fe_values.h>

#include <algorithm>
#include <numeric>

#include "meshes/patches/cut_mesh.h"

namespace springproof::fem {
namespace {

using Strain = dealii::SymmetricTensor<2, 3>;

struct CornerStrains {
  std::array<std::size_t, 4> at;  // corners, apart for each material
  std::array<Strain, 4> strain;
  double volume;  // [m^3]
};

std::vector<CornerStrains> corner_strains(const Body3& body, const dealii::DoFHandler<3>& dof_handler,
                                          const DofVector& displacement) {
  const std::vector<dealii::Point<3>> corners = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  dealii::FEValues<3> values(*body.mapping, dof_handler.get_fe(), dealii::Quadrature<3>(corners),
                             dealii::update_gradients);
  std::vector<Strain> strains(corners.size());
  std::vector<CornerStrains> cells;
  for (const auto& cell : dof_handler.active_cell_iterators()) {
    values.reinit(cell);
    values[dealii::FEValuesExtractors::Vector(0)].get_function_symmetric_gradients(displacement, strains);
    CornerStrains& c = cells.emplace_back();
    c.volume = cell->measure();
    for (unsigned int v = 0; v < corners.size(); ++v) {
      c.at[v] = cell->vertex_index(v) + cell->material_id() * std::size_t(body.triangulation.n_vertices());
      c.strain[v] = dealii::deviator(strains[v]);
    }
  }
  return cells;
}

/// Of each cell [m^3].
std::vector<double> squared_errors(const std::vector<CornerStrains>& cells) {
  std::size_t corners = 0;
  for (const CornerStrains& c : cells) corners = std::max(corners, *std::max_element(c.at.begin(), c.at.end()) + 1);
  std::vector<Strain> mean(corners);
  std::vector<double> volumes(corners, 0.0), errors;
  for (const CornerStrains& c : cells)
    for (int v = 0; v < 4; ++v) {
      mean[c.at[v]] += c.volume * c.strain[v];
      volumes[c.at[v]] += c.volume;
    }
  for (const CornerStrains& c : cells) {
    double sum = 0;
    for (int v = 0; v < 4; ++v) {
      const Strain apart = c.strain[v] - mean[c.at[v]] / volumes[c.at[v]];
      sum += apart * apart;
    }
    errors.push_back(sum * c.volume / 4);
  }
  return errors;
}

double length(const CutMesh& mesh, const std::array<int, 2>& edge) {
  return (mesh.points()[edge[0]] - mesh.points()[edge[1]]).norm();
}

std::array<int, 2> longest_edge(const CutMesh& mesh, const Tetrahedron& cell) {
  std::array<int, 2> longest{};
  double most = 0;
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < i; ++j)
      if (const double l = length(mesh, {cell[i], cell[j]}); l > most) {
        most = l;
        longest = {cell[i], cell[j]};
      }
  return longest;
}

}  // namespace

Mesh cut_where_errors_are_largest(const Mesh& mesh, const Body3& body, const dealii::DoFHandler<3>& dof_handler,
                                  const DofVector& displacement, std::size_t most, double shortest) {
  CutMesh cut(mesh);
  std::vector<double> errors = squared_errors(corner_strains(body, dof_handler, displacement));
  for (std::size_t c = 0; c < errors.size(); ++c)
    if (length(cut, longest_edge(cut, mesh.tetrahedra[c])) < 2 * shortest) errors[c] = 0;
  std::vector<std::size_t> order(errors.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return errors[a] > errors[b]; });
  for (const std::size_t c : order) {
    if (!(errors[c] > 0) || cut.cells() >= most) break;
    const auto [a, b] = longest_edge(cut, mesh.tetrahedra[c]);
    cut.refine(a, b);
  }
  std::vector<std::string> names;
  for (const Patch& p : mesh.patches) names.push_back(p.name);
  return cut.mesh(names);
}

}  // namespace springproof::fem
