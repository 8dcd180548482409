#include "fem_reference/grid/triangulate.h"

#include <deal.II/base/quadrature_lib.h>
#include <deal.II/distributed/fully_distributed_tria.h>
#include <deal.II/distributed/tria.h>
#include <deal.II/fe/fe_dgp.h>
#include <deal.II/fe/fe_q.h>
#include <deal.II/fe/fe_simplex_p.h>
#include <deal.II/fe/mapping_fe.h>
#include <deal.II/fe/mapping_q.h>
#include <deal.II/fe/mapping_q_cache.h>
#include <deal.II/grid/grid_tools.h>
#include <deal.II/grid/tria_description.h>
#include <fmt/format.h>
#include <boost/serialization/set.hpp>

#include <algorithm>

#include "fem_reference/grid/grid_problem.h"
#include "fem_reference/grid/processes.h"
#include "meshes/volume.h"
#include "problem/system/input_error.h"

namespace springproof::fem {
namespace {

using Corners = std::array<int, 4>;
using Points = std::vector<dealii::Point<3>>;
using Patches = std::map<std::string, std::set<dealii::types::boundary_id>>;

// A mesh as deal.II reads it.
struct CellList {
  Points vertices;
  std::vector<dealii::CellData<3>> cells;
};

Corners sorted(Corners corners) {
  std::sort(corners.begin(), corners.end());
  return corners;
}

// Each set of patches that some facet belongs to becomes one boundary id; 0 is "no patch".
Patches mark_patches(const Mesh& mesh, const dealii::Triangulation<3>& triangulation) {
  Patches patches;
  std::map<Corners, std::set<std::string>> patches_of_facet;
  for (const Patch& patch : mesh.patches) {
    patches[patch.name];
    for (const auto& facet : patch.facets) patches_of_facet[sorted(facet)].insert(patch.name);
  }
  std::map<std::set<std::string>, dealii::types::boundary_id> ids = {{{}, 0}};
  for (const auto& face : triangulation.active_face_iterators()) {
    if (!face->at_boundary()) continue;
    Corners corners = {-1, -1, -1, -1};
    for (const unsigned int v : face->vertex_indices()) corners[v] = int(face->vertex_index(v));
    const auto found = patches_of_facet.find(sorted(corners));
    const std::set<std::string> names = found == patches_of_facet.end() ? std::set<std::string>{} : found->second;
    const auto id = ids.emplace(names, ids.size()).first->second;
    face->set_boundary_id(id);
    for (const std::string& name : names) patches[name].insert(id);
  }
  return patches;
}

std::vector<dealii::CellData<3>> hexahedra(const Mesh& mesh, const Points& vertices) {
  constexpr std::array<int, 8> gmsh_corner = {0, 1, 3, 2, 4, 5, 7, 6};  // deal.II counts corners x fastest
  std::vector<dealii::CellData<3>> cells;
  for (std::size_t c = 0; c < mesh.hexahedra.size(); ++c) {
    const Hexahedron& hexahedron = mesh.hexahedra[c];
    dealii::CellData<3> cell;
    cell.material_id = mesh.materials.empty() ? 0 : mesh.materials[c];
    for (int v = 0; v < 8; ++v) cell.vertices[v] = hexahedron[gmsh_corner[v]];
    cells.push_back(cell);
  }
  if (dealii::GridTools::invert_cells_with_negative_measure(vertices, cells) > 0)
    throw InputError("the mesh has inverted cells");
  dealii::GridTools::consistently_order_cells(cells);
  return cells;
}

std::vector<dealii::CellData<3>> tetrahedra(const Mesh& mesh) {
  std::vector<dealii::CellData<3>> cells;
  for (std::size_t c = 0; c < mesh.tetrahedra.size(); ++c) {
    const Tetrahedron& tetrahedron = mesh.tetrahedra[c];
    Eigen::Matrix<double, 4, 3> x;
    for (int v = 0; v < 4; ++v) x.row(v) = mesh.nodes.row(tetrahedron[v]);
    if (!(tetrahedron_volume(x) > 0)) throw InputError("the mesh has inverted cells");
    dealii::CellData<3> cell(4);
    cell.material_id = mesh.materials.empty() ? 0 : mesh.materials[c];
    for (int v = 0; v < 4; ++v) cell.vertices[v] = tetrahedron[v];
    cells.push_back(cell);
  }
  return cells;
}

CellList cell_list(const Mesh& mesh) {
  if (mesh.hexahedra.empty() == mesh.tetrahedra.empty())
    throw InputError(fmt::format("a mesh of {} hexahedra and {} tetrahedra (allowed: one kind, at least one cell)",
                                 mesh.hexahedra.size(), mesh.tetrahedra.size()));
  CellList list;
  for (const auto& X : mesh.nodes.rowwise()) list.vertices.emplace_back(X[0], X[1], X[2]);
  list.cells = mesh.tetrahedra.empty() ? hexahedra(mesh, list.vertices) : tetrahedra(mesh);
  return list;
}

// The second-order points of cell c of the mesh, in deal.II's order.  deal.II may have reoriented the cell, so a point
// is identified by the corners it lies between.
Points curved_points(const Mesh& mesh, const CellList& list, std::size_t c) {
  static const Points units = dealii::FE_Q<3>(2).get_unit_support_points();
  const Hexahedron& corners = mesh.hexahedra[c];
  Points points;
  for (const dealii::Point<3>& unit : units) {
    Vec3 place = Vec3::Zero();  // reference coordinates in the mesh's orientation of the cell
    for (unsigned int v = 0; v < 8; ++v) {
      const auto corner = std::find(corners.begin(), corners.end(), int(list.cells[c].vertices[v]));
      const auto& at = hexahedron_corners[corner - corners.begin()];
      place += dealii::GeometryInfo<3>::d_linear_shape_function(unit, v) * Vec3(at[0], at[1], at[2]);
    }
    const auto index = std::lround(2 * place[0]) + 3 * std::lround(2 * place[1]) + 9 * std::lround(2 * place[2]);
    const Vec3 X = mesh.curved.row(27 * Eigen::Index(c) + index);
    points.emplace_back(X[0], X[1], X[2]);
  }
  return points;
}

// Second-order edges; points_of: of a cell by its index in the triangulation.
std::unique_ptr<dealii::Mapping<3>> curved_mapping(const dealii::Triangulation<3>& triangulation,
                                                   const std::function<Points(unsigned int)>& points_of) {
  auto mapping = std::make_unique<dealii::MappingQCache<3>>(2);
  mapping->initialize(triangulation, [&](const dealii::Triangulation<3>::cell_iterator& cell) {
    return points_of(unsigned(cell->index()));
  });
  return mapping;
}

std::unique_ptr<dealii::Mapping<3>> linear_tetrahedra() {
  return std::make_unique<dealii::MappingFE<3>>(dealii::FE_SimplexP<3>(1));
}

// The cells of the first process, whose mesh it is, divided by METIS among all.
std::unique_ptr<Body3> in_parts(const Mesh& mesh, const CellList& list) {
  using Cells = dealii::Triangulation<3>;
  const MPI_Comm comm = MPI_COMM_WORLD;
  Patches patches;
  const auto part = dealii::TriangulationDescription::Utilities::create_description_from_triangulation_in_groups<3, 3>(
      [&](Cells& whole) {
        whole.create_triangulation(list.vertices, list.cells, dealii::SubCellData());
        patches = mark_patches(mesh, whole);
      },
      [](Cells& whole, const MPI_Comm&, unsigned int processes) {
        dealii::GridTools::partition_triangulation(processes, whole, dealii::SparsityTools::Partitioner::metis);
      },
      comm, process_count());
  auto cells = std::make_unique<dealii::parallel::fullydistributed::Triangulation<3>>(comm);
  cells->create_triangulation(part);
  auto body = std::make_unique<Body3>(std::move(cells));
  body->patches = dealii::Utilities::MPI::broadcast(comm, patches);
  if (body->has_tetrahedra()) {
    body->mapping = linear_tetrahedra();
    return body;
  }
  // A process asks the first for the points of its cells, by their numbers in the mesh.
  std::vector<dealii::types::coarse_cell_id> own;
  for (const auto& cell : body->triangulation.active_cell_iterators()) own.push_back(cell->id().get_coarse_cell_id());
  std::map<unsigned int, Points> answers;
  const auto asked = dealii::Utilities::MPI::gather(comm, own);
  for (std::size_t process = 0; process < asked.size(); ++process)
    for (const auto c : asked[process])
      for (const auto& X : curved_points(mesh, list, c)) answers[unsigned(process)].push_back(X);
  const Points points = dealii::Utilities::MPI::some_to_some(comm, answers)[0];
  body->curved = true;
  body->mapping = curved_mapping(body->triangulation, [&](unsigned int index) {
    return Points(points.begin() + 27 * index, points.begin() + 27 * (index + 1));
  });
  return body;
}

// The same cells in the same order, but the vertices of each material are its own.
std::unique_ptr<dealii::Triangulation<3>> materials_apart(const CellList& list) {
  CellList own;
  std::map<std::pair<dealii::types::material_id, unsigned int>, unsigned int> numbers;
  for (dealii::CellData<3> cell : list.cells) {
    for (unsigned int& v : cell.vertices) {
      const auto [at, is_new] = numbers.try_emplace({cell.material_id, v}, unsigned(own.vertices.size()));
      if (is_new) own.vertices.push_back(list.vertices[v]);
      v = at->second;
    }
    own.cells.push_back(cell);
  }
  auto cells = std::make_unique<dealii::Triangulation<3>>();
  cells->create_triangulation(own.vertices, own.cells, dealii::SubCellData());
  return cells;
}

// p4est partitions the cells of a refined block.
std::unique_ptr<dealii::Triangulation<3>> no_cells() {
  constexpr auto smoothing = dealii::Triangulation<3>::limit_level_difference_at_vertices;
  if (process_count() == 1) return std::make_unique<dealii::Triangulation<3>>(smoothing);
  using Distributed = dealii::parallel::distributed::Triangulation<3>;
  return std::make_unique<Distributed>(MPI_COMM_WORLD, smoothing, Distributed::construct_multigrid_hierarchy);
}

void refine(Body3& body, int refinements, const std::function<Vec3(const Vec3&)>& place) {
  body.triangulation.refine_global(refinements);
  if (!place) return;
  const auto move = [&](const dealii::Point<3>& X) {
    const Vec3 x = place(Vec3(X[0], X[1], X[2]));
    return dealii::Point<3>(x[0], x[1], x[2]);
  };
  dealii::GridTools::transform(move, body.triangulation);
}

}  // namespace

std::unique_ptr<Body3> triangulate(const Mesh& mesh, int refinements, const std::function<Vec3(const Vec3&)>& place) {
  const bool whole = process_count() == 1 || every_process_needs(mesh);
  CellList list;
  together([&] {
    if (whole || process_rank() == 0) list = cell_list(mesh);
    if (!whole && process_rank() == 0 && int(list.cells.size()) < process_count())
      throw InputError(fmt::format("{} processes for a mesh of {} cells (allowed: one per cell)", process_count(),
                                   list.cells.size()));
  });
  if (!whole) return in_parts(mesh, list);
  auto body = std::make_unique<Body3>(no_cells());
  body->triangulation.create_triangulation(list.vertices, list.cells, dealii::SubCellData());
  body->patches = mark_patches(mesh, body->triangulation);
  if (!mesh.tetrahedra.empty()) {
    body->mapping = linear_tetrahedra();
    if (!mesh.materials.empty()) body->apart = materials_apart(list);
  } else if (mesh.curved.size() > 0) {
    body->curved = true;
    body->mapping = curved_mapping(body->triangulation, [&](unsigned int c) { return curved_points(mesh, list, c); });
  } else {
    refine(*body, refinements, place);
    body->mapping = std::make_unique<dealii::MappingQ<3>>(1);
  }
  return body;
}

std::unique_ptr<dealii::FiniteElement<3>> scalar_element(const Body3& body, int degree) {
  if (body.has_tetrahedra()) return std::make_unique<dealii::FE_SimplexP<3>>(degree);
  return std::make_unique<dealii::FE_Q<3>>(degree);
}

std::unique_ptr<dealii::FESystem<3>> displacement_element(const Body3& body, int degree) {
  return std::make_unique<dealii::FESystem<3>>(*scalar_element(body, degree), 3);
}

std::unique_ptr<dealii::FiniteElement<3>> pressure_element(const Body3& body, int degree) {
  if (body.has_tetrahedra()) return std::make_unique<dealii::FE_SimplexP<3>>(1);
  return std::make_unique<dealii::FE_DGP<3>>(degree - 1);
}

Eigen::MatrixXd values_at(const dealii::FiniteElement<3>& fe, const dealii::Quadrature<3>& quadrature) {
  Eigen::MatrixXd values(quadrature.size(), fe.n_dofs_per_cell());
  for (unsigned int q = 0; q < quadrature.size(); ++q)
    for (unsigned int f = 0; f < fe.n_dofs_per_cell(); ++f) values(q, f) = fe.shape_value(f, quadrature.point(q));
  return values;
}

dealii::Quadrature<3> cell_quadrature(const Body3& body, unsigned int n) {
  if (body.has_tetrahedra()) return dealii::QGaussSimplex<3>(n);
  return dealii::QGauss<3>(n);
}

dealii::Quadrature<2> face_quadrature(const Body3& body, unsigned int n) {
  if (body.has_tetrahedra()) return dealii::QGaussSimplex<2>(n);
  return dealii::QGauss<2>(n);
}

}  // namespace springproof::fem
