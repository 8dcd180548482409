// The one file that includes CGAL, whose polygon mesh processing is under the GPL.
#include "meshes/surface_cgal.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/detect_features.h>
#include <CGAL/Polygon_mesh_processing/remesh.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <CGAL/Surface_mesh.h>
#include <fmt/format.h>

#include <cmath>
#include <stdexcept>

#include "meshes/surface_check.h"

namespace springproof {
namespace {

namespace pmp = CGAL::Polygon_mesh_processing;
using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using SurfaceMesh = CGAL::Surface_mesh<Kernel::Point_3>;

SurfaceMesh to_cgal(const Surface& surface) {
  SurfaceMesh mesh;
  mesh.reserve(surface.points.size(), 3 * surface.triangles.size() / 2, surface.triangles.size());
  using Vertex = SurfaceMesh::Vertex_index;
  for (const Vec3& p : surface.points) mesh.add_vertex({p.x(), p.y(), p.z()});
  for (const auto& [a, b, c] : surface.triangles)
    if (mesh.add_face(Vertex(a), Vertex(b), Vertex(c)) == SurfaceMesh::null_face())
      throw std::runtime_error("the surface is no manifold");
  return mesh;
}

Surface from_cgal(SurfaceMesh& mesh) {
  mesh.collect_garbage();
  Surface surface;
  for (const auto v : mesh.vertices()) {
    const auto& p = mesh.point(v);
    surface.points.emplace_back(p.x(), p.y(), p.z());
  }
  for (const auto f : mesh.faces()) {
    std::array<int, 3> corners{};
    int i = 0;
    for (const auto v : mesh.vertices_around_face(mesh.halfedge(f))) corners[i++] = static_cast<int>(v.idx());
    surface.triangles.push_back(corners);
  }
  return surface;
}

using EdgeMarks = SurfaceMesh::Property_map<SurfaceMesh::Edge_index, bool>;
using VertexMarks = SurfaceMesh::Property_map<SurfaceMesh::Vertex_index, bool>;

/// The ends of the marked edges at a vertex.
std::vector<SurfaceMesh::Vertex_index> along(const SurfaceMesh& mesh, const EdgeMarks& marked, SurfaceMesh::Vertex_index v) {
  std::vector<SurfaceMesh::Vertex_index> ends;
  for (const auto h : mesh.halfedges_around_target(mesh.halfedge(v)))
    if (marked[mesh.edge(h)]) ends.push_back(mesh.source(h));
  return ends;
}

/// Takes the mark off lines shorter than `length`: noise, or too small for the triangles to come.
void unmark_short_lines(const SurfaceMesh& mesh, EdgeMarks& marked, double length) {
  std::vector<bool> seen(mesh.number_of_vertices(), false);
  std::vector<SurfaceMesh::Vertex_index> line;
  for (const auto first : mesh.vertices()) {
    if (seen[first]) continue;
    seen[first] = true;
    line.assign(1, first);
    double twice_length = 0;
    for (std::size_t i = 0; i < line.size(); ++i)
      for (const auto next : along(mesh, marked, line[i])) {
        twice_length += std::sqrt(CGAL::squared_distance(mesh.point(line[i]), mesh.point(next)));
        if (seen[next]) continue;
        seen[next] = true;
        line.push_back(next);
      }
    if (twice_length >= 2 * length) continue;
    for (const auto v : line)
      for (const auto h : mesh.halfedges_around_target(mesh.halfedge(v))) marked[mesh.edge(h)] = false;
  }
}

/// Marks the vertices where a line of marked edges turns sharply; where lines meet or end CGAL keeps them itself.
void mark_bends(const SurfaceMesh& mesh, const EdgeMarks& marked, VertexMarks& bends, double degrees) {
  for (const auto v : mesh.vertices()) {
    const auto ends = along(mesh, marked, v);
    if (ends.size() != 2) continue;
    bends[v] = CGAL::approximate_angle(mesh.point(ends[0]), mesh.point(v), mesh.point(ends[1])) < 180 - degrees;
  }
}

}  // namespace

std::vector<std::pair<int, int>> intersecting_facets(const Surface& surface, unsigned most) {
  const SurfaceMesh mesh = to_cgal(surface);
  std::vector<std::pair<SurfaceMesh::Face_index, SurfaceMesh::Face_index>> found;
  pmp::self_intersections<CGAL::Sequential_tag>(mesh.faces(), mesh, std::back_inserter(found),
                                                CGAL::parameters::maximum_number(most));
  std::vector<std::pair<int, int>> pairs;
  for (const auto& [f, g] : found) pairs.emplace_back(f.idx(), g.idx());
  return pairs;
}

Surface remesh(const Surface& surface, double edge, double most_change) {
  if (!(edge > 0)) throw std::runtime_error("remesh: edge must be positive");
  const double facets = area(surface) / (std::sqrt(3.0) / 4 * edge * edge);
  if (!(facets < 4e6))
    throw std::runtime_error(fmt::format("edges of {:.3g} would make {:.2g} facets (allowed: 4e6)", edge, facets));

  SurfaceMesh mesh = to_cgal(surface);
  EdgeMarks sharp = mesh.add_property_map<SurfaceMesh::Edge_index, bool>("e:sharp", false).first;
  VertexMarks bends = mesh.add_property_map<SurfaceMesh::Vertex_index, bool>("v:bend", false).first;
  pmp::detect_sharp_edges(mesh, 40, sharp);
  unmark_short_lines(mesh, sharp, 8 * edge);
  mark_bends(mesh, sharp, bends, 60);
  pmp::isotropic_remeshing(mesh.faces(), edge, mesh,
                           CGAL::parameters::number_of_iterations(5)
                               .edge_is_constrained_map(sharp)
                               .vertex_is_constrained_map(bends));

  const Surface result = from_cgal(mesh);
  const double before = volume(surface), change = std::abs(volume(result) - before) / before;
  if (!(change < most_change))
    throw std::runtime_error(fmt::format("remeshing with edges of {:.3g} changes the volume by {:.2g} %", edge, 100 * change));
  if (!CGAL::is_closed(mesh) || !CGAL::is_triangle_mesh(mesh)) throw std::runtime_error("remeshing left the surface open");
  if (!intersecting_facets(result, 1).empty())
    throw std::runtime_error(fmt::format("remeshing with edges of {:.3g} makes facets that cut each other", edge));
  return result;
}

}  // namespace springproof
