#include <fmt/format.h>
#include <gmsh.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "meshes/gmsh/bodies.h"
#include "meshes/mesher/refined_meshes.h"
#include "meshes/surface/stl.h"
#include "meshes/surface/surface_check.h"

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

Mesh fill(const MeshRequest& r, const Surface& surface) {
  GmshSession session({});
  want_edge(r.edge / r.scale);
  gmsh::option::setNumber("Mesh.MeshSizeExtendFromBoundary", 0);  // the inside follows `edge`, not the facets
  gmsh::model::addDiscreteEntity(2, 1);
  std::vector<std::size_t> node_tags(surface.points.size()), corners;
  std::iota(node_tags.begin(), node_tags.end(), 1);
  std::vector<double> coordinates;
  for (const Vec3& p : surface.points) coordinates.insert(coordinates.end(), p.begin(), p.end());
  for (const auto& t : surface.triangles)
    for (const int n : t) corners.push_back(n + 1);
  gmsh::model::mesh::addNodes(2, 1, node_tags, coordinates);
  gmsh::model::mesh::addElementsByType(1, 2, {}, corners);
  gmsh::model::geo::addSurfaceLoop({1}, 1);
  gmsh::model::geo::addVolume({1}, 1);
  gmsh::model::geo::synchronize();
  gmsh::model::setPhysicalName(2, gmsh::model::addPhysicalGroup(2, {1}), "surface");
  session.stop_on_error(r.file);
  return fill_with_tetrahedra(r.file, session);
}

}  // namespace

namespace {

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
/// meshes may lose more.  The triangles' edges are `shorter` times the tetrahedra's.
MeshAt surface_at(const MeshRequest& r, FileSurface& source, double shorter = 1) {
  return [&r, &source, shorter](double edge, double times) {
    MeshRequest own = r;
    own.edge = edge;
    const double side = shorter * edge / r.scale;
    const Surface& surface = source.for_edge(side);
    if (suits(surface, edge / r.scale)) return OneMesh{fill(own, surface), {}, edge};
    Surface even;
    try {
      even = remesh(surface, side, (times > 1 ? slack * most_change * times * times : most_change) - source.lost());
    } catch (const std::runtime_error& e) {
      refuse(r.file, e.what());
    }
    const std::string note =
        fmt::format("{} facets remeshed to {} of edge {:.3g} m; the volume changed by {:.2g} %", source.facets(),
                    even.triangles.size(), shorter * edge, 100 * source.change(even));
    return OneMesh{fill(own, even), {note}, edge};
  };
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

MeshedBody fill_surface(const MeshRequest& request, const Surface& raw) {
  auto [surface, notes] = check_surface(raw, request.file.string());
  const double inside = volume(surface);
  MeshRequest r = request;
  if (r.edge == 0) r.edge = r.scale * edge_for(r.tetrahedra, inside);
  refuse_too_many(r, inside * std::pow(r.scale, 3));
  FileSurface source(surface);
  MeshedBody body = r.coarser.empty() ? filled_alone(r, source) : mesh_refined(r, surface_at(r, source));
  if (const std::string note = source.note(); !note.empty()) notes.push_back(note);
  body.notes.insert(body.notes.begin(), notes.begin(), notes.end());
  return body;
}

MeshedBody mesh_stl(const MeshRequest& r) { return fill_surface(r, read_stl(r.file)); }

}  // namespace springproof
