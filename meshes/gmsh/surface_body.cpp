#include <fmt/format.h>
#include <gmsh.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>

#include "meshes/facets.h"
#include "meshes/gmsh/bodies.h"
#include "meshes/mesher/mesher_exchange.h"
#include "meshes/mesher/refined_meshes.h"
#include "meshes/patches/transfer_patches.h"
#include "meshes/surface/surface_check.h"
#include "meshes/surface/surface_files.h"

namespace springproof {
namespace {

/// Whether most facets have edges of about this length.
bool suits(const Surface& surface, double edge) {
  double sum = 0;
  std::size_t far_off = 0;
  for (const auto& t : surface.triangles) {
    bool off = false;
    for (int i = 0; i < 3; ++i) {
      const double length = (surface.points[t[i]] - surface.points[t[(i + 1) % 3]]).norm();
      sum += length;
      off |= length > 2 * edge || length < edge / 2;
    }
    far_off += off;
  }
  const double mean = sum / (3 * double(surface.triangles.size()));
  return mean < 1.5 * edge && mean > edge / 1.5 && double(far_off) < 0.05 * double(surface.triangles.size());
}

/// Its shells: the outer one and those of cavities, each with points of its own.
std::vector<Surface> shells_of(const Surface& surface) {
  UnitedNumbers shell(surface.points.size());
  for (const auto& [a, b, c] : surface.triangles) {
    shell.unite(a, b);
    shell.unite(a, c);
  }
  std::map<int, Surface> shells;
  std::vector<int> number(surface.points.size());
  for (std::size_t n = 0; n < number.size(); ++n) {
    std::vector<Vec3>& points = shells[shell.of(static_cast<int>(n))].points;
    number[n] = static_cast<int>(points.size());
    points.push_back(surface.points[n]);
  }
  for (const auto& [a, b, c] : surface.triangles)
    shells.at(shell.of(a)).triangles.push_back({number[a], number[b], number[c]});
  std::vector<Surface> all;
  for (auto& [head, s] : shells)
    if (!s.triangles.empty()) all.push_back(std::move(s));
  return all;
}

Mesh fill(const MeshRequest& r, const Surface& surface) {
  GmshSession session({});
  want_edge(r.edge / r.scale);
  gmsh::option::setNumber("Mesh.MeshSizeExtendFromBoundary", 0);  // the inside follows `edge`, not the facets
  std::vector<int> entities;
  std::size_t nodes = 0;
  for (const Surface& shell : shells_of(surface)) {
    const int entity = static_cast<int>(entities.size()) + 1;
    gmsh::model::addDiscreteEntity(2, entity);
    std::vector<std::size_t> node_tags(shell.points.size()), corners;
    std::iota(node_tags.begin(), node_tags.end(), nodes + 1);
    std::vector<double> coordinates;
    for (const Vec3& p : shell.points) coordinates.insert(coordinates.end(), p.begin(), p.end());
    for (const auto& t : shell.triangles)
      for (const int n : t) corners.push_back(nodes + static_cast<std::size_t>(n) + 1);
    gmsh::model::mesh::addNodes(2, entity, node_tags, coordinates);
    gmsh::model::mesh::addElementsByType(entity, 2, {}, corners);
    nodes += shell.points.size();
    entities.push_back(entity);
  }
  gmsh::model::geo::addVolume({gmsh::model::geo::addSurfaceLoop(entities)}, 1);
  gmsh::model::geo::synchronize();
  gmsh::model::setPhysicalName(2, gmsh::model::addPhysicalGroup(2, entities), "surface");
  session.stop_on_error(r.file);
  std::vector<std::string> none;  // a surface and the volume in it
  return fill_with_tetrahedra(r, session, none);
}

constexpr double most_change = 0.01;  ///< of the volume by remeshing, of the finest mesh
constexpr double slack = 1.5;         ///< of the coarser ones, whose loss is the square of their edges only on average

/// The surface of a file, thinned out once for all meshes where it is much denser than they need.
class FileSurface {
 public:
  explicit FileSurface(const Surface& surface) : full_(surface), volume_(volume(surface)) {}

  /// For triangles of this edge or longer ones.  Should shorter ones be asked for, a half of it is prepared for: few
  /// rounds, whoever asks.
  const Surface& for_edge(double edge) {
    if (edge < edge_ && thin_.triangles.size() < full_.triangles.size()) {
      edge_ = std::isinf(edge_) ? edge : std::min(edge, edge_ / 2);
      thin_ = thinned(full_, edge_ / 2);
      lost_ = std::abs(volume(thin_) / volume_ - 1);
    }
    return thin_;
  }
  double lost() const { return lost_; }  ///< share of the volume by thinning out
  double change(const Surface& s) const { return volume(s) / volume_ - 1; }
  std::size_t facets() const { return full_.triangles.size(); }
  std::string note() const {
    if (thin_.triangles.size() == facets()) return {};
    return fmt::format("{} facets thinned out to {}; the volume changed by {:.2g} %", facets(), thin_.triangles.size(),
                       100 * change(thin_));
  }

 private:
  const Surface& full_;
  double volume_, edge_ = std::numeric_limits<double>::infinity(), lost_ = 0;
  Surface thin_;
};

/// Fills the surface, with even triangles of the edge.  What remeshing cuts off falls as the edge squared: coarser
/// meshes may lose more, of which balanced facets give back all but `most_lost`.  The triangles' edges are `shorter`
/// times the tetrahedra's.
MeshAt surface_at(const MeshRequest& r, FileSurface& source, double shorter = 1, double most_lost = 1) {
  return [&r, &source, shorter, most_lost](double edge, double times) {
    MeshRequest own = r;
    own.edge = edge;
    const double side = shorter * edge / r.scale;
    const Surface& surface = source.for_edge(side);
    if (suits(surface, edge / r.scale)) return OneMesh{fill(own, surface), {}, edge};
    Surface even;
    try {
      even = remesh(surface, side, (times > 1 ? slack * most_change * times * times : most_change) - source.lost(),
                    most_lost);
    } catch (const std::runtime_error& e) {
      refuse(r.file, fmt::format("remeshing with edges of {:.3g} m {}", shorter * edge, e.what()));
    }
    const std::string note =
        fmt::format("{} facets remeshed to {} of edge {:.3g} m; the volume changed by {:.2g} %", source.facets(),
                    even.triangles.size(), shorter * edge, 100 * source.change(even));
    return OneMesh{fill(own, even), {note}, edge};
  };
}

/// Meshes that all have the whole body, or, of struts and the like, as much of it as can be had.
MeshedBody filled_refined(const MeshRequest& r, FileSurface& source) {
  try {
    return mesh_refined(r, surface_at(r, source, 1, most_change));
  } catch (const InputError&) {
    return mesh_refined(r, surface_at(r, source));
  }
}

/// One mesh alone: a body may be too thin or too round for its edge.
MeshedBody filled_alone(const MeshRequest& r, FileSurface& source) {
  std::string failure;
  for (const double shorter : {1.0, 0.7, 0.5}) try {
      return mesh_alone(r, surface_at(r, source, shorter)(r.edge, 1));
    } catch (const InputError& e) {
      if (failure.empty()) failure = e.what();
    }
  return mesh_alone(r, {fill(r, source.for_edge(r.edge / r.scale)),
                        {"the facets of the file are kept, as remeshing them failed: " + failure},
                        r.edge});
}

}  // namespace

/// Adds the parts that the file names as patches.
void add_parts(const Surface& raw, Mesh& mesh) {
  Mesh from;
  from.nodes = rows_of(raw.points);
  std::vector<OuterFacet> facets;
  for (const auto& [a, b, c] : raw.triangles)
    facets.push_back({ascending(std::array{-1, a, b, c}), {a, b, c, -1}, Vec3::Zero()});
  for (const auto& [name, triangles] : raw.parts) {
    Patch& patch = from.patches.emplace_back(Patch{name, {}});
    for (const int t : triangles) patch.facets.push_back(facets[t].nodes);
  }
  transfer_patches(from, facets, mesh);
}

MeshedBody fill_surface(const MeshRequest& request, const Surface& raw) {
  if (has_volumes(request))
    refuse(request.file,
           "holds a surface, and so no physical volume for a [[region]] (allowed: stl, box_m, near or beyond)");
  auto [surface, notes] = check_surface(raw, request.file.string());
  const double inside = volume(surface);
  MeshRequest r = request;
  if (r.edge == 0) r.edge = r.scale * edge_for(r.tetrahedra, inside);
  refuse_too_many(r, inside * std::pow(r.scale, 3));
  FileSurface source(surface);
  MeshedBody body = r.coarser.empty() ? filled_alone(r, source) : filled_refined(r, source);
  if (const std::string note = source.note(); !note.empty()) notes.push_back(note);
  body.notes.insert(body.notes.begin(), notes.begin(), notes.end());
  body.facets = std::move(surface);
  if (raw.parts.empty()) return body;
  add_parts(raw, body.mesh);
  for (Mesh& mesh : body.coarser) add_parts(raw, mesh);
  return body;
}

namespace {

Surface read_surface(const std::filesystem::path& file) {
  const std::string ending = extension_of(file);
  return ending == ".obj" ? read_obj(file) : ending == ".ply" ? read_ply(file) : read_stl(file);
}

}  // namespace

MeshedBody mesh_surface(const MeshRequest& r) { return fill_surface(r, read_surface(r.file)); }

MeshedBody closed_surface_of(const MeshRequest& r) {
  CheckedSurface checked = check_surface(read_surface(r.file), r.file.string());
  MeshedBody body;
  body.mesh = mesh_of(checked.surface, "triangles");
  body.facets = std::move(checked.surface);
  body.notes = std::move(checked.notes);
  return body;
}

MeshedBody vertices_of(const MeshRequest& r) {
  const Surface surface = extension_of(r.file) == ".msh" ? vertices_of_msh(r) : read_surface(r.file);
  MeshedBody body;
  body.mesh = mesh_of(surface, "triangles");
  return body;
}

}  // namespace springproof
