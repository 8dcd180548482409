// The one file that includes CGAL's polygon mesh processing, which is under the GPL.
#include "meshes/surface/surface_check.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/detect_features.h>
#include <CGAL/Polygon_mesh_processing/remesh.h>
#include <CGAL/Polygon_mesh_processing/repair_self_intersections.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Bounded_normal_change_placement.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Count_stop_predicate.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/GarlandHeckbert_policies.h>
#include <CGAL/Surface_mesh_simplification/edge_collapse.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>

#include "meshes/surface/balanced.h"

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
std::vector<SurfaceMesh::Vertex_index> along(const SurfaceMesh& mesh, const EdgeMarks& marked,
                                             SurfaceMesh::Vertex_index v) {
  std::vector<SurfaceMesh::Vertex_index> ends;
  for (const auto h : mesh.halfedges_around_target(mesh.halfedge(v)))
    if (marked[mesh.edge(h)]) ends.push_back(mesh.source(h));
  return ends;
}

/// Whether a line of marked edges turns sharply.
bool is_bend(const SurfaceMesh& mesh, SurfaceMesh::Vertex_index v, const std::vector<SurfaceMesh::Vertex_index>& ends) {
  constexpr double degrees = 60;
  return ends.size() == 2 &&
         CGAL::approximate_angle(mesh.point(ends[0]), mesh.point(v), mesh.point(ends[1])) < 180 - degrees;
}

/// Takes the mark off lines shorter than eight edges, and off those with a bend, a branch or an end every one and a
/// half edges: noise, or too small for the triangles to come.
void unmark_small_lines(const SurfaceMesh& mesh, EdgeMarks& marked, double edge) {
  std::vector<bool> seen(mesh.number_of_vertices(), false);
  std::vector<SurfaceMesh::Vertex_index> line;
  for (const auto first : mesh.vertices()) {
    if (seen[first]) continue;
    seen[first] = true;
    line.assign(1, first);
    double length = 0, corners = 0;
    for (std::size_t i = 0; i < line.size(); ++i) {
      const auto ends = along(mesh, marked, line[i]);
      corners += ends.size() != 2 || is_bend(mesh, line[i], ends);
      for (const auto next : ends) {
        length += std::sqrt(CGAL::squared_distance(mesh.point(line[i]), mesh.point(next))) / 2;
        if (seen[next]) continue;
        seen[next] = true;
        line.push_back(next);
      }
    }
    if (length >= std::max(8.0, 1.5 * corners) * edge) continue;
    for (const auto v : line)
      for (const auto h : mesh.halfedges_around_target(mesh.halfedge(v))) marked[mesh.edge(h)] = false;
  }
}

/// Marks the vertices where a line of marked edges turns sharply; where lines meet or end CGAL keeps them itself.
void mark_bends(const SurfaceMesh& mesh, const EdgeMarks& marked, VertexMarks& bends) {
  for (const auto v : mesh.vertices()) bends[v] = is_bend(mesh, v, along(mesh, marked, v));
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

namespace {

constexpr std::size_t most_cuts = 1000;  ///< of facets by others that are repaired

/// Facets of this edge that would cover the surface.
double facets_of(const Surface& surface, double edge) { return area(surface) / (std::sqrt(3.0) / 4 * edge * edge); }

auto euler_characteristic(const SurfaceMesh& mesh) {
  return std::ptrdiff_t(mesh.number_of_vertices()) - std::ptrdiff_t(mesh.number_of_edges()) +
         std::ptrdiff_t(mesh.number_of_faces());
}

/// The surface without facets that cut each other: few of them and those around are made anew; none where that fails.
std::optional<Surface> without_cuts(SurfaceMesh& mesh) {
  Surface result = from_cgal(mesh);
  const std::size_t cuts = intersecting_facets(result, most_cuts).size();
  if (cuts == 0) return result;
  const auto before = euler_characteristic(mesh);
  if (cuts == most_cuts || !pmp::experimental::remove_self_intersections(mesh) || !CGAL::is_closed(mesh))
    return std::nullopt;
  result = from_cgal(mesh);
  if (euler_characteristic(mesh) != before || !intersecting_facets(result, 1).empty()) return std::nullopt;
  return result;
}

/// Collapses edges, those first that matter least (Garland & Heckbert 1997): flat faces and creases stay, noise is
/// averaged.
void collapse_to(SurfaceMesh& mesh, double facets) {
  namespace sms = CGAL::Surface_mesh_simplification;
  using Policies = sms::GarlandHeckbert_plane_policies<SurfaceMesh, Kernel>;
  const Policies policies(mesh);
  const sms::Bounded_normal_change_placement<Policies::Get_placement> placement(policies.get_placement());
  sms::edge_collapse(mesh, sms::Count_stop_predicate<SurfaceMesh>(static_cast<std::size_t>(1.5 * facets)),
                     CGAL::parameters::get_cost(policies.get_cost()).get_placement(placement));
}

}  // namespace

Surface thinned(const Surface& surface, double edge) {
  constexpr double worth_it = 2, most_change = 1e-3;
  const double before = volume(surface);
  for (;; edge /= std::sqrt(2)) {
    const double facets = facets_of(surface, edge);
    if (worth_it * facets > double(surface.triangles.size())) return surface;
    SurfaceMesh mesh = to_cgal(surface);
    collapse_to(mesh, facets);
    std::optional<Surface> thin = without_cuts(mesh);
    if (thin && std::abs(volume(*thin) / before - 1) < most_change) return std::move(*thin);
  }
}

Surface remesh(const Surface& surface, double edge, double most_change, double most_balanced) {
  if (!(edge > 0)) throw std::runtime_error("remesh: edge must be positive");
  const double facets = facets_of(surface, edge);
  if (!(facets < 4e6)) throw std::runtime_error(fmt::format("would make {:.2g} facets (allowed: 4e6)", facets));

  SurfaceMesh mesh = to_cgal(surface);
  EdgeMarks sharp = mesh.add_property_map<SurfaceMesh::Edge_index, bool>("e:sharp", false).first;
  VertexMarks bends = mesh.add_property_map<SurfaceMesh::Vertex_index, bool>("v:bend", false).first;
  pmp::detect_sharp_edges(mesh, 40, sharp);
  unmark_small_lines(mesh, sharp, edge);
  mark_bends(mesh, sharp, bends);
  pmp::isotropic_remeshing(
      mesh.faces(), edge, mesh,
      CGAL::parameters::number_of_iterations(5).edge_is_constrained_map(sharp).vertex_is_constrained_map(bends));

  if (!CGAL::is_closed(mesh) || !CGAL::is_triangle_mesh(mesh)) throw std::runtime_error("leaves the surface open");
  const double before = volume(surface);
  const auto check_volume = [&](const Surface& result, double most) {
    const double change = std::abs(volume(result) - before) / before;
    if (!(change < most)) throw std::runtime_error(fmt::format("changes the volume by {:.2g} %", 100 * change));
  };
  check_volume(from_cgal(mesh), most_change);  // in vain to look for cuts
  std::optional<Surface> result = without_cuts(mesh);
  if (!result) throw std::runtime_error("makes facets that cut each other");
  Surface even = balanced(*result, surface);
  // Where facets cut each other now their points go back to where they cut none.
  for (auto cuts = intersecting_facets(even, most_cuts); !cuts.empty(); cuts = intersecting_facets(even, most_cuts))
    for (const auto& [f, g] : cuts)
      for (const int facet : {f, g})
        for (const int n : even.triangles[facet]) even.points[n] = result->points[n];
  check_volume(even, most_balanced);
  return even;
}

}  // namespace springproof
