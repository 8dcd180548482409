#include "comparisons/live/live_body.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "meshes/surface/surface_files.h"
#include "meshes/voxels/voxelise.h"
#include "problem/system/input_error.h"

namespace springproof {
namespace {

constexpr double height_of_stl = 0.25;  // [m]
constexpr double standing = 0.02;       // of the height
constexpr double reach = 1;             // cubes by which the surface may leave those that are there

/// The surface as the cone over it from one point: faces between cone cells are inner, so that its outer facets are
/// those of the surface, and where this has a hole, the cone over the rim.
Mesh cone_over(const Surface& surface, const std::vector<LivePart>& parts) {
  Mesh cone;
  const int apex = static_cast<int>(surface.points.size());
  cone.nodes.resize(apex + 1, 3);
  Vec3 middle = Vec3::Zero();
  for (int n = 0; n < apex; ++n) {
    cone.nodes.row(n) = surface.points[n].transpose();
    middle += surface.points[n] / apex;
  }
  cone.nodes.row(apex) = middle.transpose();
  cone.patches = {{"held", {}}, {"pulled", {}}};
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    const auto& [a, b, c] = surface.triangles[t];
    cone.tetrahedra.push_back({a, b, c, apex});
    if (parts[t] != LivePart::free) cone.patches[parts[t] == LivePart::held ? 0 : 1].facets.push_back({a, b, c, -1});
  }
  std::erase_if(cone.patches, [](const Patch& p) { return p.facets.empty(); });
  return cone;
}

/// @throws InputError if an edge belongs to three facets, or another odd number above one.
void require_even_edges(const Surface& surface) {
  std::map<std::pair<int, int>, int> facets;
  for (const auto& t : surface.triangles)
    for (int e = 0; e < 3; ++e) ++facets[std::minmax(t[e], t[(e + 1) % 3])];
  const auto odd = std::count_if(facets.begin(), facets.end(),
                                 [](const auto& edge) { return edge.second > 1 && edge.second % 2 == 1; });
  if (odd > 0)
    throw InputError(
        fmt::format("the surface has {} edges where three facets meet (allowed: two); repair it first", odd));
}

/// The cube nearest to a point, of those that are there.
int nearest_cell(const Grid& grid, const std::map<std::array<int, 3>, int>& cells, const Vec3& at) {
  std::array<int, 3> cube;
  for (int d = 0; d < 3; ++d) cube[d] = static_cast<int>(std::floor(at[d]));
  int nearest = -1;
  double least = std::numeric_limits<double>::infinity();
  for (int radius = 0; radius < 64 && nearest < 0; ++radius)
    for (int k = -radius; k <= radius; ++k)
      for (int j = -radius; j <= radius; ++j)
        for (int i = -radius; i <= radius; ++i) {
          const auto found = cells.find({cube[0] + i, cube[1] + j, cube[2] + k});
          if (found == cells.end()) continue;
          const auto& index = grid.cell_index[found->second];
          const double distance = (at - Vec3(index[0] + 0.5, index[1] + 0.5, index[2] + 0.5)).squaredNorm();
          if (distance < least) least = distance, nearest = found->second;
        }
  return std::max(nearest, 0);
}

LivePoint place_of(const Grid& grid, const std::map<std::array<int, 3>, int>& cells, const Vec3& point) {
  const Vec3 at = (point - grid.origin) / grid.spacing[0];
  LivePoint place{nearest_cell(grid, cells, at), {}};
  Vec3 t;
  for (int d = 0; d < 3; ++d) t[d] = std::clamp(at[d] - grid.cell_index[place.cell][d], -reach, 1 + reach);
  for (int n = 0; n < 8; ++n) {
    place.weights[n] = 1;
    for (int d = 0; d < 3; ++d) place.weights[n] *= hexahedron_corners[n][d] ? t[d] : 1 - t[d];
  }
  return place;
}

/// Share of each node in a uniform traction on the pulled facets: its resultant and moment are those of the surface.
Eigen::VectorXd shares_of_pull(const LiveBody& body) {
  Eigen::VectorXd share = Eigen::VectorXd::Zero(body.mesh.nodes.rows());
  double total = 0;
  for (std::size_t t = 0; t < body.parts.size(); ++t) {
    if (body.parts[t] != LivePart::pulled) continue;
    const auto& [a, b, c] = body.surface.triangles[t];
    const Vec3 &p = body.surface.points[a], &q = body.surface.points[b], &r = body.surface.points[c];
    const double area = (q - p).cross(r - p).norm() / 2;
    total += area;
    for (const int corner : {a, b, c})
      for (int n = 0; n < 8; ++n)
        share[body.mesh.hexahedra[body.places[corner].cell][n]] += area / 3 * body.places[corner].weights[n];
  }
  if (total > 0) share /= total;
  return share;
}

/// Nodes of the lowest cubes' lower faces.
std::vector<int> lowest_nodes(const Mesh& mesh) {
  std::vector<int> nodes;
  const double low = mesh.nodes.col(2).minCoeff() + mesh.grid->spacing[2] / 2;
  for (int n = 0; n < mesh.nodes.rows(); ++n)
    if (mesh.nodes(n, 2) < low) nodes.push_back(n);
  return nodes;
}

/// Points with equal coordinates once.
Surface welded(const Surface& loose) {
  Surface surface;
  std::map<std::array<double, 3>, int> known;
  for (const auto& t : loose.triangles) {
    std::array<int, 3> facet;
    for (int c = 0; c < 3; ++c) {
      const Vec3& p = loose.points[t[c]];
      const auto [at, added] = known.try_emplace({p[0], p[1], p[2]}, static_cast<int>(surface.points.size()));
      if (added) surface.points.push_back(p);
      facet[c] = at->second;
    }
    if (facet[0] != facet[1] && facet[1] != facet[2] && facet[2] != facet[0]) surface.triangles.push_back(facet);
  }
  return surface;
}

}  // namespace

LiveBody live_body(Surface surface, std::vector<LivePart> parts, double cells) try {
  require_even_edges(surface);
  LiveBody body;
  const Mesh cone = cone_over(surface, parts);
  const double size = std::abs(volume(surface));
  const Box box = bounding_box(surface);
  if (!(size > 0)) throw InputError("the surface encloses no volume");
  // The edge that divides the longest side of the box: a block is cut without a rest.
  const double wanted = std::cbrt(size / cells), longest = (box.high - box.low).maxCoeff();
  Voxels voxels = voxelise(voxel_grid(cone, longest / std::max(1.0, std::round(longest / wanted))), cone);
  body.surface = std::move(surface);
  body.parts = std::move(parts);
  body.mesh = std::move(voxels.mesh);
  body.notes = std::move(voxels.notes);
  std::map<std::array<int, 3>, int> cell_at;
  for (std::size_t c = 0; c < body.mesh.hexahedra.size(); ++c)
    cell_at[body.mesh.grid->cell_index[c]] = static_cast<int>(c);
  for (const Vec3& p : body.surface.points) body.places.push_back(place_of(*body.mesh.grid, cell_at, p));
  for (const Patch& p : body.mesh.patches)
    if (p.name == "held") body.held = nodes_of(p);
  if (body.held.empty()) body.held = lowest_nodes(body.mesh);
  body.pull = shares_of_pull(body);
  return body;
} catch (const std::invalid_argument& e) {
  throw InputError(e.what());
}

LiveBody live_stl(std::string_view bytes, double cells) {
  Surface surface = welded(parse_stl(bytes, "the file"));
  const Box box = bounding_box(surface);
  const double height = box.high[2] - box.low[2];
  if (!(height > 0)) throw InputError("the body is flat");
  const double scale = height_of_stl / height;
  for (Vec3& p : surface.points) p = scale * (p - box.low);
  std::vector<LivePart> parts;
  for (const auto& t : surface.triangles) {
    const bool low =
        std::all_of(t.begin(), t.end(), [&](int n) { return surface.points[n][2] < standing * height_of_stl; });
    parts.push_back(low ? LivePart::held : LivePart::free);
  }
  return live_body(std::move(surface), std::move(parts), cells);
}

}  // namespace springproof
